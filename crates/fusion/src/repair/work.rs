//! A mesh between two steps of a repair.

use super::step::{Done, Step};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::{Counts, Error, Report};
use mesh_core::{Faces, Origins, Stage, Watch};
use mesh_io::Model;

/// A mesh between two steps.
pub(super) struct Work<'a> {
    part: &'a Model,
    pub(super) model: Model,
    /// With respect to the input.
    pub(super) origins: Origins,
    pub(super) report: Report,
}

impl<'a> Work<'a> {
    pub(super) fn new(command: &str, part: &'a Model) -> Self {
        Self {
            part,
            model: part.clone(),
            origins: Origins::identity(0, part.mesh.vertex_count(), part.mesh.face_count()),
            report: Report::new(command, vec![Counts::of("", &part.mesh)]),
        }
    }

    /// Does a step, and tells what it mended.
    pub(super) fn step(&mut self, step: Step, watch: &Watch) -> Result<(), Error> {
        let (name, before) = (step.name(), [self.model.mesh.vertex_count(), self.model.mesh.face_count()]);
        let done = self.report.time(name, || step.apply(&self.model, watch))?;
        let Some(Done { model, origins, mended, left }) = done else { return Ok(()) };
        self.origins =
            origins.compose(&[Stage { origins: &self.origins, faces: &self.model.mesh }], &[&self.part.mesh]);
        self.model = model;
        let after = [self.model.mesh.vertex_count(), self.model.mesh.face_count()];
        for ((what, old), new) in ["vertices", "faces"].into_iter().zip(before).zip(after) {
            if old != new {
                *self.report.figures.entry(format!("{name}: {what}")).or_default() += new as f64 - old as f64;
            }
        }
        let (count, what) = mended;
        if count > 0 {
            *self.report.figures.entry(format!("{name}: {what}")).or_default() += count as f64;
            let told = Diagnostic::new(Code::Repaired, Severity::Note, format!("{name}: {count} {what}"));
            self.report.tell(told.with("count", count as f64));
        }
        for warning in left {
            self.report.tell(warning);
        }
        Ok(())
    }
}
