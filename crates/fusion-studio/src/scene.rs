//! What the clients see, and what they may ask about.

use crate::frame::revision;
use crate::refusal::Refusal;
use crate::request::Of;
use fusion::Document;
use fusion::document::{Shapes, Shown};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What was evaluated last.
#[derive(Debug, Default)]
pub struct Scene {
    /// The document that it comes from.
    pub document: Arc<Document>,
    /// Its folder, relative to the root.
    pub folder: String,
    /// Every shape.
    pub made: Shapes,
    /// The shapes in view, which may be those of an earlier document.
    pub seen: BTreeMap<String, Shown>,
}

impl Scene {
    /// A shape by the name under which it was sent, or any other.
    ///
    /// # Errors
    /// [`Refusal`]: there is no such shape, or it is no longer what the client sees.
    pub fn shape(&self, of: &Of) -> Result<&Shown, Refusal> {
        let shown = self.seen.get(&of.shape).or_else(|| find(&self.made, &of.shape));
        let shown = shown.ok_or_else(|| Refusal::new(format!("there is no shape `{}`", of.shape)))?;
        match &of.revision {
            Some(seen) if *seen != revision(shown) => Err(Refusal::new(format!("`{}` has changed", of.shape))),
            _ => Ok(shown),
        }
    }
}

/// The results, and behind them what else is shown; and how many results there are.
pub fn chosen<'a>(made: &'a Shapes, document: &Document, show: &[String]) -> (Vec<(String, &'a Shown)>, usize) {
    let results = made.left_over(document).into_iter();
    let mut shown: Vec<_> = results.filter_map(|name| Some((name.clone(), made.latest(name)?))).collect();
    let count = shown.len();
    for name in show {
        if shown.iter().all(|(other, _)| other != name)
            && let Some(shape) = find(made, name)
        {
            shown.push((name.clone(), shape));
        }
    }
    (shown, count)
}

/// `part:NAME`, `step:N`, or a name.
fn find<'a>(made: &'a Shapes, name: &str) -> Option<&'a Shown> {
    if let Some(part) = name.strip_prefix("part:") {
        made.parts.iter().find(|shown| shown.name == part)
    } else if let Some(step) = name.strip_prefix("step:") {
        made.steps.get(step.parse::<usize>().ok()?)
    } else {
        made.latest(name)
    }
}
