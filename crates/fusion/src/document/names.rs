//! Which shape every name means, at every step.
//!
//! A name means its latest shape. A shape is left over until a step takes it up; what is taken up can still be named.

use super::Error;
use super::action::Action;
use super::parts::{Named, Output, Part, Step};
use super::table::Places;
use crate::operation::{Linked, LoopName, Pose};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Primitives that stand on each other, at most.
const DEEPEST: usize = 64;

/// What is known of a document's names.
pub(super) struct Names<'a> {
    text: &'a str,
    primitives: &'a BTreeMap<String, Named>,
    /// Every name that means a shape by now.
    known: BTreeSet<String>,
    /// What no step has taken up, in order.
    left: Vec<String>,
}

impl<'a> Names<'a> {
    /// The names of parts and primitives, which must differ.
    pub(super) fn new(text: &'a str, parts: &[Part], primitives: &'a BTreeMap<String, Named>) -> Result<Self, Error> {
        let mut names = Self { text, primitives, known: BTreeSet::new(), left: vec![] };
        for part in parts {
            if !names.known.insert(part.name.clone()) {
                let told = Error::at(text, part.places.span("name"), format!("there is another part `{}`", part.name));
                return Err(told.remedy("names must differ"));
            }
            names.left.push(part.name.clone());
        }
        for (name, primitive) in primitives {
            if names.known.contains(name) {
                let told = Error::at(text, primitive.places.whole.clone(), format!("`{name}` is a part, too"));
                return Err(told.remedy("names must differ"));
            }
            if let Some(on) = &primitive.primitive.on {
                names.primitive(&on.primitive, primitive.places.span("on"))?;
            }
        }
        Ok(names)
    }

    /// The parts in an order in which each stands on what stands already.
    pub(super) fn order(&self, parts: &[Part]) -> Result<Vec<usize>, Error> {
        let mut order = vec![];
        let mut placed = BTreeSet::new();
        while order.len() < parts.len() {
            let before = order.len();
            for (i, part) in parts.iter().enumerate() {
                let needs = self.needs(&part.pose, &part.places)?;
                if !placed.contains(&part.name) && needs.iter().all(|n| placed.contains(n)) {
                    placed.insert(part.name.clone());
                    order.push(i);
                }
            }
            if order.len() == before {
                let stuck = parts.iter().find(|p| !placed.contains(&p.name));
                let span = stuck.map_or(0..0, |p| p.places.whole.clone());
                let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).filter(|n| !placed.contains(*n)).collect();
                let told = Error::at(
                    self.text,
                    span,
                    format!("the parts {} stand on each other in a circle", names.join(", ")),
                );
                return Err(told.remedy("pose one of them in a step, or by numbers"));
            }
        }
        Ok(order)
    }

    /// Fills in what a step works on, and what its result is called.
    pub(super) fn step(&mut self, step: &mut Step) -> Result<(), Error> {
        let span = step.places.span("of");
        let written = match (&step.written.of, &step.action) {
            (Some(of), _) => of.clone(),
            (None, Action::Detail(detail)) if detail.target().part.is_some() => {
                detail.target().part.into_iter().map(|part| LoopName { part, index: None }).collect()
            }
            (None, action) if action.takes_several() => self.left.iter().map(|n| whole(n)).collect(),
            (None, _) => vec![whole(&self.only(span.clone())?)],
        };
        step.of.clear();
        for name in &written {
            self.shape(&name.part, span.clone())?;
            if !step.of.contains(&name.part) {
                step.of.push(name.part.clone());
            }
        }
        let loops = written.iter().any(|name| name.index.is_some());
        match &mut step.action {
            Action::Compose(compose) => compose.loops = if loops { written.clone() } else { vec![] },
            _ if loops => {
                let told = Error::at(self.text, span, "only `compose` takes loops");
                return Err(told.remedy("name the shape alone"));
            }
            action if step.of.len() > 1 && !action.takes_several() => {
                let told = Error::at(self.text, span, format!("`{}` works on one shape", action.verb()));
                return Err(told.remedy("take a step for each"));
            }
            _ => {}
        }
        if matches!(step.action, Action::Boolean(_)) && step.of.len() < 2 {
            let told = Error::at(self.text, span, format!("`{}` works on two shapes or more", step.action.verb()));
            return Err(told.remedy("name them with `of`"));
        }
        self.needs_of(step)?;
        step.name = step.written.name.clone().or_else(|| step.of.first().cloned()).unwrap_or_default();
        if self.primitives.contains_key(&step.name) {
            let told = Error::at(self.text, step.places.span("as"), format!("`{}` is a primitive", step.name));
            return Err(told.remedy("names must differ"));
        }
        self.take_up(step);
        Ok(())
    }

    /// Fills in which shape an output is.
    pub(super) fn output(&self, output: &mut Output) -> Result<(), Error> {
        output.of = match &output.written {
            None => self.only(output.places.whole.clone())?,
            Some(name) => {
                self.shape(name, output.places.span("of"))?;
                name.clone()
            }
        };
        Ok(())
    }

    /// Refuses a primitive on an opening of a shape that there never is.
    pub(super) fn check_openings(&self) -> Result<(), Error> {
        let mut openings =
            self.primitives.values().filter_map(|named| Some((named, named.primitive.opening.as_ref()?)));
        openings.try_for_each(|(named, opening)| self.shape(&opening.part, named.places.span("loop")))
    }

    /// What no step has taken up.
    pub(super) fn left(self) -> Vec<String> {
        self.left
    }

    /// The result stands where the first of its shapes stood.
    fn take_up(&mut self, step: &Step) {
        let gone = |name: &String| step.of.contains(name) || *name == step.name;
        let at = self.left.iter().position(gone).unwrap_or(self.left.len());
        self.left.retain(|name| !gone(name));
        self.left.insert(at.min(self.left.len()), step.name.clone());
        self.known.insert(step.name.clone());
    }

    /// Further shapes that a step reads.
    fn needs_of(&self, step: &Step) -> Result<Vec<String>, Error> {
        match &step.action {
            Action::Pose(pose) => self.needs(pose, &step.places),
            Action::Detail(detail) => {
                let parts = detail.source.iter().filter_map(|s| s.part.as_ref());
                parts.map(|p| self.shape(p, step.places.span("source")).map(|()| p.clone())).collect()
            }
            _ => Ok(vec![]),
        }
    }

    /// The shapes that a pose refers to, through primitives.
    fn needs(&self, pose: &Pose, places: &Places) -> Result<Vec<String>, Error> {
        let mut needs = vec![];
        if let Some(on) = &pose.on {
            self.needs_of_primitive(&on.primitive, places.span("on"), &mut vec![], &mut needs)?;
        }
        if let Some(snap) = &pose.snap {
            if self.primitives.contains_key(&snap.to.part) {
                self.needs_of_primitive(&snap.to.part, places.span("snap"), &mut vec![], &mut needs)?;
            } else {
                self.shape(&snap.to.part, places.span("snap"))?;
                needs.push(snap.to.part.clone());
            }
        }
        // What is no name is a file.
        if let Some(Linked::File(path)) = &pose.drop
            && let Some(name) = path.to_str().filter(|name| self.known.contains(*name))
        {
            needs.push(name.to_string());
        }
        Ok(needs)
    }

    fn needs_of_primitive(
        &self,
        name: &str,
        span: Range<usize>,
        below: &mut Vec<String>,
        needs: &mut Vec<String>,
    ) -> Result<(), Error> {
        let named = self.primitive(name, span)?;
        if below.iter().any(|n| n == name) {
            let told = format!("the primitives {} stand on each other in a circle", below.join(", "));
            let told = Error::at(self.text, named.places.span("on"), told);
            return Err(told.remedy("let one of them stand on a loop, or by numbers"));
        }
        if below.len() == DEEPEST {
            let told = format!("more than {DEEPEST} primitives stand on each other");
            return Err(Error::at(self.text, named.places.span("on"), told).remedy("let one of them stand by numbers"));
        }
        below.push(name.to_string());
        if let Some(on) = &named.primitive.on {
            self.needs_of_primitive(&on.primitive, named.places.span("on"), below, needs)?;
        }
        if let Some(opening) = &named.primitive.opening {
            self.shape(&opening.part, named.places.span("loop"))?;
            needs.push(opening.part.clone());
        }
        Ok(())
    }

    fn primitive(&self, name: &str, span: Range<usize>) -> Result<&'a Named, Error> {
        self.primitives.get(name).ok_or_else(|| {
            let told = Error::at(self.text, span, format!("there is no [primitive.{name}]"));
            told.instead_of(name, self.primitives.keys().map(String::as_str))
        })
    }

    fn shape(&self, name: &str, span: Range<usize>) -> Result<(), Error> {
        if self.known.contains(name) {
            return Ok(());
        }
        let told = Error::at(self.text, span, format!("there is no shape `{name}` at this point"));
        Err(told.instead_of(name, self.known.iter().map(String::as_str)))
    }

    fn only(&self, span: Range<usize>) -> Result<String, Error> {
        match &self.left[..] {
            [one] => Ok(one.clone()),
            several => {
                let told = format!("there are several shapes at this point: {}", several.join(", "));
                Err(Error::at(self.text, span, told).remedy("name one with `of`"))
            }
        }
    }
}

fn whole(name: &str) -> LoopName {
    LoopName { part: name.into(), index: None }
}
