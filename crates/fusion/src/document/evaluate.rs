//! Parts read, steps taken in order, results checked. A step is taken only if its result is not known.

use super::action::Action;
use super::cache::Cache;
use super::entry::Entry;
use super::place::Ground;
use super::shape::Shape;
use super::sources::{Folder, Sources};
use super::table::Places;
use super::task::{Place, Task};
use super::{Document, key};
use crate::operation::{Pose, Precision};
use crate::validity::{Promise, as_written, crossings_of};
use crate::{Counts, Error, Outcome, Report};
use mesh_core::{Faces, Origins, Stage, Watch};
use mesh_io::Model;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What the results must survive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precisions {
    /// Each what its file can hold.
    ByFile,
    /// All the same.
    All(Precision),
}

/// What a document has given.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// The steps in order, those that are off left out.
    pub steps: Vec<Taken>,
    /// The results in the order of the document's outputs; where it has none, every shape that is left over, without a file.
    pub outputs: Vec<Evaluated>,
}

/// A step that was taken, or whose result was known.
#[derive(Clone, Debug)]
pub struct Taken {
    /// Its number in the document, from 1.
    pub number: usize,
    /// What its result is called.
    pub name: String,
    /// Whether the result was known before.
    pub is_known: bool,
    /// What it did, when it was done.
    pub report: Report,
}

/// A result.
#[derive(Clone, Debug)]
pub struct Evaluated {
    /// The shape.
    pub of: String,
    /// Its file, as the document names it; empty where it has none.
    pub file: PathBuf,
    /// The result, with origins with respect to the document's parts, and the account of all steps that lead to it.
    pub outcome: Outcome,
}

impl Document {
    /// Evaluates the document, whose paths are relative to `folder`.
    ///
    /// ```
    /// use fusion::document::{Cache, Document, Precisions};
    /// use fusion::mesh_core::{Watch, shapes, volume};
    /// # let folder = tempfile::tempdir()?;
    /// # let folder = folder.path();
    /// fusion::mesh_io::write(&shapes::cuboid(glam::DVec3::ONE).into(), &folder.join("cube.off"))?;
    /// let mut document = Document::parse(r#"
    ///     version = 2
    ///     [parameters]
    ///     shift = [0.5, 0.25, 0.125]
    ///     [[part]]
    ///     name = "still"
    ///     mesh = "cube.off"
    ///     [[part]]
    ///     name = "moved"
    ///     mesh = "cube.off"
    ///     translate = "$shift"
    ///     [[step]]
    ///     do = "union"
    ///     of = ["still", "moved"]
    ///     as = "both"
    ///     [[output]]
    ///     file = "both.off"
    /// "#)?;
    /// let cache = Cache::default();
    /// let made = document.evaluate(folder, &cache, Precisions::ByFile, &Watch::default())?;
    /// let shared = 0.5 * 0.75 * 0.875;
    /// assert!((volume(&made.outputs[0].outcome.model.mesh) - (2.0 - shared)).abs() < 1e-14);
    /// document.set("shift", "[0.5, 0.5, 0.5]")?;
    /// let made = document.evaluate(folder, &cache, Precisions::ByFile, &Watch::default())?;
    /// assert!((volume(&made.outputs[0].outcome.model.mesh) - (2.0 - 0.125)).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Document`] for what the document asks for and is not there; [`Error::Step`], naming the step, for one that fails;
    /// [`Error::Invalid`] for a result that is not sound in what its file can hold.
    pub fn evaluate(
        &self,
        folder: &Path,
        cache: &Cache,
        precisions: Precisions,
        watch: &Watch,
    ) -> Result<Evaluation, Error> {
        self.evaluate_from(&mut Folder(folder.to_path_buf()), cache, precisions, watch)
    }

    /// The same with meshes and files from elsewhere.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn evaluate_from(
        &self,
        sources: &mut dyn Sources,
        cache: &Cache,
        precisions: Precisions,
        watch: &Watch,
    ) -> Result<Evaluation, Error> {
        let parts = self.read_parts(sources, watch)?;
        let wanted = self.wanted(precisions);
        let mut steps = None;
        let mut outputs: Vec<(usize, Evaluated)> = vec![];
        for precision in [Precision::F64, Precision::F32] {
            if wanted.iter().all(|w| w.2 != precision) {
                continue;
            }
            let mut run = Run::new(self, cache, precision, watch, &parts);
            run.set_parts(sources)?;
            for i in 0..self.steps.len() {
                run.take_step(i, sources)?;
            }
            for (i, (of, file, _)) in wanted.iter().enumerate().filter(|(_, w)| w.2 == precision) {
                let outcome = run.finish(of)?;
                outputs.push((i, Evaluated { of: of.clone(), file: file.clone(), outcome }));
            }
            steps.get_or_insert(run.taken);
        }
        outputs.sort_by_key(|o| o.0);
        Ok(Evaluation { steps: steps.unwrap_or_default(), outputs: outputs.into_iter().map(|o| o.1).collect() })
    }

    pub(super) fn read_parts(&self, sources: &mut dyn Sources, watch: &Watch) -> Result<Vec<Arc<Model>>, Error> {
        let read = |part: &super::Part| {
            watch.step("read", 0.0)?;
            let unread = |told: String| super::Error::at(&self.text, part.places.span("mesh"), told);
            sources.model(&part.mesh).map_err(|told| unread(told).into())
        };
        self.parts.iter().map(read).collect()
    }

    /// The shapes that are asked for, their files, and what they must survive.
    fn wanted(&self, precisions: Precisions) -> Vec<(String, PathBuf, Precision)> {
        let precision = |by_file| match precisions {
            Precisions::ByFile => by_file,
            Precisions::All(precision) => precision,
        };
        if self.outputs.is_empty() {
            let left = self.left.iter();
            return left.map(|name| (name.clone(), PathBuf::new(), precision(Precision::F64))).collect();
        }
        self.outputs.iter().map(|o| (o.of.clone(), o.file.clone(), precision(o.precision()))).collect()
    }
}

/// A document being evaluated for one precision.
pub(super) struct Run<'a> {
    document: &'a Document,
    cache: &'a Cache,
    precision: Precision,
    watch: &'a Watch,
    parts: &'a [Arc<Model>],
    pub(super) shapes: BTreeMap<String, Shape>,
    pub(super) taken: Vec<Taken>,
}

impl<'a> Run<'a> {
    /// Nothing is done yet.
    pub(super) fn new(
        document: &'a Document,
        cache: &'a Cache,
        precision: Precision,
        watch: &'a Watch,
        parts: &'a [Arc<Model>],
    ) -> Self {
        Self { document, cache, precision, watch, parts, shapes: BTreeMap::new(), taken: vec![] }
    }

    /// The parts, each where it stands.
    pub(super) fn set_parts(&mut self, sources: &mut dyn Sources) -> Result<(), Error> {
        for &i in &self.document.order {
            let (part, model) = (&self.document.parts[i], &self.parts[i]);
            let origins = Origins::identity(i as u32, model.mesh.vertex_count(), model.mesh.face_count());
            let shape = Shape {
                model: Arc::clone(model),
                origins: Arc::new(origins),
                key: self.cache.key_of(model),
                validity: None,
                steps: BTreeSet::new(),
            };
            self.shapes.insert(part.name.clone(), shape);
            if part.pose != Pose::default() {
                let of = std::slice::from_ref(&part.name);
                let (posed, _) = self.take(&part.pose.clone().into(), of, &part.places, sources)?;
                self.shapes.insert(part.name.clone(), posed);
            }
        }
        Ok(())
    }

    /// Takes the step with this index, or passes it over where it is off.
    pub(super) fn take_step(&mut self, i: usize, sources: &mut dyn Sources) -> Result<(), Error> {
        let Some(step) = self.document.steps.get(i) else { return Ok(()) };
        if step.is_off {
            let first = step.of.first().and_then(|name| self.shapes.get(name)).cloned();
            first.map(|shape| self.shapes.insert(step.name.clone(), shape));
            return Ok(());
        }
        let named = |e: Error| match e {
            Error::Option(e) => step.places.wrong(&self.document.text, &e).into(),
            Error::Document(_) | Error::Cancelled(_) => e,
            e => {
                let name = format!("step {}, {} of {}", i + 1, step.action.verb(), step.of.join(", "));
                Error::Step { name, source: Box::new(e) }
            }
        };
        let (mut shape, taken) = self.take(&step.action, &step.of, &step.places, sources).map_err(named)?;
        shape.steps.insert(self.taken.len());
        self.shapes.insert(step.name.clone(), shape);
        self.taken.push(Taken { number: i + 1, name: step.name.clone(), ..taken });
        Ok(())
    }

    /// Takes one step, or the result that is known of it.
    fn take(
        &self,
        action: &Action,
        of: &[String],
        places: &Places,
        sources: &mut dyn Sources,
    ) -> Result<(Shape, Taken), Error> {
        let document = self.document;
        let ground = Ground { text: &document.text, primitives: &document.primitives, shapes: &self.shapes };
        let task = Task::new(action, &Place { of, places }, &ground, sources)?;
        let (verb, options, motion) = task.canonical()?;
        let inputs: Vec<_> = task.inputs.iter().map(|shape| shape.key).collect();
        let key = key::of_step(verb, &options, motion, &inputs, self.precision);
        self.watch.step(verb, 0.0)?;
        let known = self.cache.get(&key);
        let is_known = known.is_some();
        let entry = if let Some(entry) = known {
            entry
        } else {
            let Outcome { model, origins, report } = task.run(self.precision, self.cache, self.watch)?;
            let entry = Arc::new(Entry { model: Arc::new(model), origins, report });
            self.cache.put(key, &entry);
            entry
        };
        let parts: Vec<&dyn Faces> = self.parts.iter().map(|m| &m.mesh as &dyn Faces).collect();
        let stages: Vec<Stage<'_>> =
            task.inputs.iter().map(|s| Stage { origins: &s.origins, faces: &s.model.mesh }).collect();
        let shape = Shape {
            model: Arc::clone(&entry.model),
            origins: Arc::new(entry.origins.compose(&stages, &parts)),
            key,
            // Moving checks nothing.
            validity: Some(entry.report.validity).filter(|_| motion.is_none()),
            steps: task.inputs.iter().flat_map(|s| s.steps.iter().copied()).collect(),
        };
        let mut report = entry.report.clone();
        report.command = verb.into();
        for (counts, name) in report.inputs.iter_mut().zip(of) {
            counts.name.clone_from(name);
        }
        Ok((shape, Taken { number: 0, name: String::new(), is_known, report }))
    }

    /// A shape as a result: checked, and described with respect to the parts.
    fn finish(&self, name: &str) -> Result<Outcome, Error> {
        let Some(shape) = self.shapes.get(name) else {
            return Err(super::Error::about(name, "there is no such shape").into());
        };
        let count = |(part, model): (&super::Part, &Arc<Model>)| Counts::of(part.name.clone(), &model.mesh);
        let mut report = Report::new("run", self.document.parts.iter().zip(self.parts).map(count).collect());
        for taken in shape.steps.iter().filter_map(|&i| self.taken.get(i)) {
            let (title, given) = (format!("{} of {}", taken.report.command, taken.of()), &taken.report);
            report.warnings.extend(given.warnings.iter().cloned());
            report.residuals.extend(given.residuals.clone());
            report.figures.extend(given.figures.clone());
            report.notes.extend(given.notes.iter().cloned());
            report.curves.extend(given.curves.iter().cloned());
            report.diagnostics.extend(given.diagnostics.iter().cloned());
            for stage in &given.stages {
                let name = format!("{title}: {}", stage.name);
                report.stages.push(crate::Stage { name, milliseconds: stage.milliseconds });
            }
        }
        report.describe(&shape.model.mesh, &shape.origins);
        if let Some(validity) = shape.validity {
            report.validity = validity;
            // The step that made it has told them, by its own inputs.
            if validity.self_intersections != Some(0) {
                report.inherited = crossings_of(&shape.model.mesh, &shape.origins, self.watch)?;
            }
        } else {
            let format = self.precision.into();
            report.checked(as_written(&shape.model, &shape.origins, &[], format, Promise::Manifold, self.watch)?);
        }
        Ok(Outcome { model: (*shape.model).clone(), origins: (*shape.origins).clone(), report })
    }
}

impl Taken {
    /// The shapes that it worked on.
    fn of(&self) -> String {
        self.report.inputs.iter().map(|i| i.name.as_str()).collect::<Vec<_>>().join(", ")
    }
}
