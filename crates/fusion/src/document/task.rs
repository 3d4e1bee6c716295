//! One step made ready: names of shapes replaced by their numbers, files read, the pose resolved. What is left depends on nothing
//! but its shapes, so equal tasks have equal results.

use super::action::Action;
use super::cache::Cache;
use super::place::Ground;
use super::shape::Shape;
use super::sources::Sources;
use super::table::Places;
use super::{Error, key};
use crate::cluster::cluster;
use crate::compose::compose;
use crate::cut::cut;
use crate::detail::detail;
use crate::join::join_from;
use crate::operation::{Compose, Creases, Detail, Linked, LoopName, OptionError, Pose, Precision, RegionArg, Solid};
use crate::pose::pose;
use crate::pose::similarity::Similarity;
use crate::repair::repair;
use crate::{Outcome, remeshing, round, sharpen};
use mesh_core::{Bounds, FaceOrigin, Faces, Watch, bounds};
use mesh_io::Model;

/// What is to be done, with what.
pub(super) struct Task {
    action: Action,
    /// Of a pose.
    motion: Option<Similarity>,
    /// The shapes that the step takes up, and behind them those it only reads.
    pub(super) inputs: Vec<Shape>,
}

/// Where a step stands in its document.
pub(super) struct Place<'a> {
    pub(super) of: &'a [String],
    pub(super) places: &'a Places,
}

impl Task {
    pub(super) fn new(
        action: &Action,
        at: &Place<'_>,
        ground: &Ground<'_>,
        sources: &mut dyn Sources,
    ) -> Result<Self, Error> {
        let wrong = |e: OptionError| at.places.wrong(ground.text, &e);
        let mut task = Self { action: action.clone(), motion: None, inputs: vec![] };
        for name in at.of {
            let gone = || Error::about(name, "there is no such shape at this point");
            task.inputs.push(ground.shapes.get(name).cloned().ok_or_else(gone)?);
        }
        if let Action::Pose(Pose { drop: Some(onto), .. }) = &mut task.action
            && let Linked::File(path) = &*onto
            && let Some(shape) = path.to_str().and_then(|name| ground.shapes.get(name))
        {
            *onto = Linked::Here(Solid(shape.model.mesh.clone()));
        }
        task.action.load(sources).map_err(wrong)?;
        let inputs = &mut task.inputs;
        match &mut task.action {
            Action::Pose(pose) => {
                let name = at.of.first().map_or("", String::as_str);
                task.motion = Some(ground.pose(pose, name, at.places)?);
            }
            Action::Compose(compose) => number_loops(compose, at.of, inputs).map_err(wrong)?,
            Action::Detail(detail) => number_regions(detail, at.of, ground, inputs).map_err(wrong)?,
            _ => {}
        }
        Ok(task)
    }

    /// All of the task but its shapes: verb, options, motion. A pose is its motion.
    pub(super) fn canonical(&self) -> Result<(&'static str, String, Option<&Similarity>), Error> {
        let options = match self.motion {
            Some(_) => String::new(),
            None => self.action.canonical().map_err(|e| Error::about(self.action.verb(), e.to_string()))?,
        };
        Ok((self.action.verb(), options, self.motion.as_ref()))
    }

    /// Does it. What does not depend on the option that is likely to change next is kept.
    pub(super) fn run(&self, precision: Precision, cache: &Cache, watch: &Watch) -> Result<Outcome, crate::Error> {
        let models: Vec<Model> = self.inputs.iter().map(|shape| (*shape.model).clone()).collect();
        let Some(first) = models.first() else { return Err(crate::Error::TooFew(0)) };
        let diagonal = models.iter().map(|m| bounds(&m.mesh)).fold(Bounds::EMPTY, Bounds::union).diagonal();
        let format = precision.into();
        match &self.action {
            Action::Pose(_) => Ok(pose(first, &self.motion.unwrap_or(Similarity::IDENTITY))),
            Action::Cut(operation) => cut(first, &operation.params(format)?, watch),
            Action::Boolean(operation) => {
                let keys: Vec<_> = self.inputs.iter().take(2).map(|shape| shape.key).collect();
                let first = cache.first(&key::of_first(self.action.verb(), &keys));
                join_from(&models, &operation.params(diagonal, format)?, Some(&first), watch)
            }
            Action::Compose(operation) => compose(&models, &operation.numbered(diagonal, format)?, watch),
            Action::Blend(operation) => match operation.sharpened(first, diagonal, format, watch)? {
                Some(outcome) => Ok(outcome),
                None => round(first, &operation.params(diagonal, format)?, watch),
            },
            Action::Sharpen(operation) => sharpen::sharpen(first, &operation.params(diagonal, format)?, watch),
            Action::Cluster(operation) => Ok(cluster(first, &operation.params(format)?, watch)?.outcome),
            Action::Repair(operation) => repair(first, &operation.params(diagonal, format)?, watch),
            Action::Remesh(operation) => remeshing::remesh(first, &operation.params(diagonal, format)?, watch),
            Action::Detail(operation) => {
                let number = |part: Option<&str>| part.and_then(|part| part.parse().ok()).unwrap_or(0);
                detail(&models, &operation.params(diagonal, format, number)?, watch)
            }
        }
    }
}

/// Loops by the numbers of their shapes and their own. A shape alone stands for all of its loops.
fn number_loops(compose: &mut Compose, of: &[String], shapes: &[Shape]) -> Result<(), OptionError> {
    let numbered = |name: &LoopName, option: &'static str| -> Result<Vec<LoopName>, OptionError> {
        let wrong = |told: String| OptionError::new(option, told);
        let part = of.iter().position(|n| *n == name.part);
        let part = part.ok_or_else(|| wrong(format!("`{}` is none of the shapes of this step", name.part)))?;
        let count = shapes[part].loops().len();
        let one = |index| LoopName { part: part.to_string(), index: Some(index) };
        match name.index {
            None if count == 0 => Err(wrong(format!("`{}` has no loop at this point", name.part))),
            None => Ok((0..count).map(one).collect()),
            Some(index) if index < count => Ok(vec![one(index)]),
            Some(index) => {
                Err(wrong(format!("`{}` has {count} loops at this point, so there is no loop {index}", name.part)))
            }
        }
    };
    let loops = compose.loops.iter().map(|name| numbered(name, "of")).collect::<Result<Vec<_>, _>>()?;
    compose.loops = loops.concat();
    if let Creases::Each(each) = &compose.crease {
        let one = |(name, &angle): (&String, &f64)| {
            let name: LoopName = name.parse().map_err(|e: String| OptionError::new("crease", e))?;
            Ok(numbered(&name, "crease")?.into_iter().map(move |name| (name.to_string(), angle)))
        };
        let all = each.iter().map(one).collect::<Result<Vec<_>, OptionError>>()?;
        compose.crease = Creases::Each(all.into_iter().flatten().collect());
    }
    Ok(())
}

/// Sources by the numbers of their shapes, which are added; what a stage made by its faces, which origins know whatever
/// attributes there are.
fn number_regions(
    detail: &mut Detail,
    of: &[String],
    ground: &Ground<'_>,
    inputs: &mut Vec<Shape>,
) -> Result<(), OptionError> {
    let mut names = of.to_vec();
    let mut target = detail.target();
    target.part = None;
    resolve(&mut target.region, &inputs[0]);
    detail.target = Some(target);
    for source in &mut detail.source {
        let number = match &source.part {
            None => 0,
            Some(name) => names.iter().position(|n| n == name).map_or_else(
                || {
                    let shape = ground.shapes.get(name).cloned();
                    let wrong = || OptionError::new("source", format!("there is no shape `{name}` at this point"));
                    inputs.push(shape.ok_or_else(wrong)?);
                    names.push(name.clone());
                    Ok(names.len() - 1)
                },
                Ok,
            )?,
        };
        resolve(&mut source.region, &inputs[number]);
        source.part = Some(number.to_string());
    }
    Ok(())
}

fn resolve(region: &mut RegionArg, shape: &Shape) {
    let stage = match region {
        RegionArg::Origin { origin } => origin,
        RegionArg::Group { group } if !has_group(&shape.model, group) => group,
        _ => return,
    };
    let of_stage = |o: &FaceOrigin| matches!(o, FaceOrigin::New { stage: made } if *made == stage.as_str());
    let ids = shape.model.mesh.face_ids();
    let faces: Vec<u32> = ids.filter(|&f| of_stage(&shape.origins.faces[f])).map(|f| f.0).collect();
    // Without such a face the name stays, for the message.
    if !faces.is_empty() {
        *region = RegionArg::Faces { faces };
    }
}

fn has_group(model: &Model, name: &str) -> bool {
    model.groups.as_ref().is_some_and(|groups| groups.names.iter().any(|n| n == name))
}
