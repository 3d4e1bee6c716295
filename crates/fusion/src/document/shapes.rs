//! Every shape on a document's way, for those who look at it while it is made.

use super::cache::Cache;
use super::evaluate::{Run, Taken};
use super::shape::Shape;
use super::sources::Sources;
use super::{Document, Step};
use crate::operation::Precision;
use crate::{Error, Validity};
use mesh_core::{Origins, Watch};
use mesh_io::Model;
use std::sync::Arc;

/// What a document's parts are and what its steps have made, as far as they came. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// The parts in the document's order, each where it stands.
    pub parts: Vec<Shown>,
    /// The result of every step that was passed, in order; that of one that is off is its first shape.
    pub steps: Vec<Shown>,
    /// The steps that were taken, those that are off left out.
    pub taken: Vec<Taken>,
    /// Why the next step gave no result.
    pub stopped: Option<Arc<Stopped>>,
}

/// A shape to look at.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What the document calls it.
    pub name: String,
    /// Its mesh and attributes.
    pub model: Arc<Model>,
    /// With respect to the document's parts.
    pub origins: Arc<Origins>,
    /// Equal for equal shapes, whatever document they come from.
    pub key: [u8; 32],
    /// What it was found to be; `None` for what was only read or moved.
    pub validity: Option<Validity>,
}

/// A step without a result.
#[derive(Debug)]
pub struct Stopped {
    /// Its index, counting from 0.
    pub step: usize,
    /// Why.
    pub error: Error,
}

impl Document {
    /// Every shape that the document makes, in 64 bits, whatever its outputs ask for. Shapes that were only read or moved are not
    /// checked. A step that fails ends it, and what was made before is there.
    ///
    /// ```
    /// use fusion::document::{Cache, Document, Given};
    /// use fusion::mesh_core::{Watch, shapes};
    /// use std::sync::Arc;
    /// let mut meshes = Given::default();
    /// meshes.0.insert("cube".into(), Arc::new(shapes::cuboid(glam::DVec3::ONE).into()));
    /// let document = Document::parse(r#"
    ///     version = 2
    ///     [[part]]
    ///     name = "cube"
    ///     mesh = "cube"
    ///     [[step]]
    ///     do = "blend"
    ///     radius = 0.1
    ///     [[step]]
    ///     do = "blend"
    ///     ids = [99]
    ///     radius = 0.1
    /// "#)?;
    /// let made = document.shapes(&mut meshes, &Cache::default(), &Watch::default())?;
    /// assert_eq!((made.parts.len(), made.steps.len()), (1, 1));
    /// assert_eq!(made.stopped.as_ref().map(|stopped| stopped.step), Some(1));
    /// assert_eq!(made.left_over(&document), [&made.steps[0]].map(|shown| &shown.name));
    /// # Ok::<(), fusion::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Document`] for a part that cannot be read or placed; [`Error::Cancelled`].
    pub fn shapes(&self, sources: &mut dyn Sources, cache: &Cache, watch: &Watch) -> Result<Shapes, Error> {
        let parts = self.read_parts(sources, watch)?;
        let mut run = Run::new(self, cache, Precision::F64, watch, &parts);
        run.set_parts(sources)?;
        let mut made = Shapes {
            parts: self.parts.iter().filter_map(|p| Some(Shown::of(&p.name, run.shapes.get(&p.name)?))).collect(),
            ..Shapes::default()
        };
        for (i, step) in self.steps.iter().enumerate() {
            match run.take_step(i, sources) {
                Ok(()) => made.steps.extend(run.shapes.get(&step.name).map(|shape| Shown::of(&step.name, shape))),
                Err(error) if error.is_cancelled() => return Err(error),
                Err(error) => {
                    made.stopped = Some(Arc::new(Stopped { step: i, error }));
                    break;
                }
            }
        }
        made.taken = run.taken;
        Ok(made)
    }
}

impl Shapes {
    /// What a name means after all steps that were passed.
    pub fn latest(&self, name: &str) -> Option<&Shown> {
        let of = |shown: &&Shown| shown.name == name;
        self.steps.iter().rev().find(of).or_else(|| self.parts.iter().find(of))
    }

    /// The names of the shapes that no step has taken up, of those that were passed; in the order of
    /// [`Document::left_over`].
    pub fn left_over<'a>(&'a self, document: &'a Document) -> Vec<&'a String> {
        let mut left: Vec<&String> = self.parts.iter().map(|part| &part.name).collect();
        for Step { of, name, .. } in document.steps.iter().take(self.steps.len()) {
            let gone = |n: &String| of.contains(n) || n == name;
            let at = left.iter().position(|n| gone(n)).unwrap_or(left.len());
            left.retain(|n| !gone(n));
            left.insert(at.min(left.len()), name);
        }
        left
    }
}

impl Shown {
    fn of(name: &str, shape: &Shape) -> Self {
        let Shape { model, origins, key, validity, .. } = shape.clone();
        Self { name: name.into(), model, origins, key, validity }
    }
}
