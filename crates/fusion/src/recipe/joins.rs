//! Joins of openings, which a recipe names by the parts they came with.
//!
//! Loops are numbered once, when each part is cut and posed. A part may be joined several times, and its other loops get other numbers
//! by that; so a loop is remembered by the origin of one of its vertices, which every join keeps.

use super::run::Replay;
use super::step_table::StepTable;
use crate::Error;
use crate::compose::{Crease, compose};
use crate::operation::{Compose, Creases, LoopName, OptionError};
use mesh_core::{Connected, Faces, Origins, TriMesh, VertexId, VertexOrigin, boundary_loops};

impl Replay<'_> {
    pub(super) fn composes(&mut self) -> Result<(), Error> {
        self.name_rims(0);
        for table in &self.recipe.compose {
            let wrong = |e| table.wrong(self.recipe, &e);
            let mut params = table.operation.params(self.diagonal(), self.format).map_err(wrong)?;
            let mut which: Vec<usize> = (0..self.pieces.len()).collect();
            if !table.operation.loops.is_empty() {
                let mut chosen = vec![];
                for name in &table.operation.loops {
                    chosen.extend(self.loops_of(table, "loops", name)?);
                }
                which = chosen.iter().map(|c| c.0).collect();
                which.sort_unstable();
                which.dedup();
                let place = |w: usize| which.binary_search(&w).unwrap_or(0);
                params.loops = Some(chosen.iter().map(|&(w, l)| (place(w), l)).collect());
            }
            params.creases = self.creases(table, &which)?;
            let at = self.step("compose", &which, |models, watch| compose(models, &params, watch))?;
            self.rename(at, table.pieces.name.as_ref());
            self.name_rims(at);
        }
        Ok(())
    }

    /// The creases that a join names one by one, its pieces being those in `which`.
    fn creases(&self, table: &StepTable<Compose>, which: &[usize]) -> Result<Vec<Crease>, Error> {
        let Creases::Each(each) = &table.operation.crease else { return Ok(vec![]) };
        let mut all = vec![];
        for (name, &angle) in each {
            let name = name.parse().map_err(|e: String| table.wrong(self.recipe, &OptionError::new("crease", e)))?;
            for (w, index) in self.loops_of(table, "crease", &name)? {
                all.extend(which.binary_search(&w).ok().map(|part| Crease { part, index, angle }));
            }
        }
        Ok(all)
    }

    /// Numbers the loops of pieces from `first` on that go by a new name.
    fn name_rims(&mut self, first: usize) {
        for piece in &self.pieces[first..] {
            if self.rims.iter().all(|r| r.part != piece.name) {
                self.rims.push(Rims::of(&piece.name, &piece.mesh, &piece.origins));
            }
        }
    }

    /// The loops that a recipe names, as piece and loop by their present numbers.
    fn loops_of(
        &self,
        table: &StepTable<Compose>,
        option: &'static str,
        name: &LoopName,
    ) -> Result<Vec<(usize, usize)>, Error> {
        let wrong = |message: String| -> Error { table.wrong(self.recipe, &OptionError::new(option, message)).into() };
        let (part, number) = (&name.part, name.index);
        let Some(rims) = self.rims.iter().find(|r| r.part == *part) else {
            return Err(wrong(format!("there is no part `{part}` at this point")));
        };
        let marks = match number {
            None => &rims.marks[..],
            Some(n) => rims.marks.get(n..=n).ok_or_else(|| {
                wrong(format!("part `{part}` has {} loops, so there is no loop {n}", rims.marks.len()))
            })?,
        };
        let present = marks.iter().filter_map(|mark| {
            self.pieces.iter().enumerate().find_map(|(w, p)| Some((w, loop_with(&p.mesh, &p.origins, mark)?)))
        });
        let present: Vec<_> = present.collect();
        if present.is_empty() || number.is_some() && present.len() != marks.len() {
            return Err(wrong(format!("`{name}` is not open at this point")));
        }
        Ok(present)
    }
}

/// The part and, where given, the number of a loop written as `part:0` or `part`.
pub(super) fn split_loop(text: &str) -> Option<(&str, Option<usize>)> {
    match text.rsplit_once(':') {
        None => Some((text, None)),
        Some((part, number)) => Some((part, Some(number.parse().ok()?))),
    }
}

/// The loops that one part had, each by the origin of a vertex.
pub(super) struct Rims {
    part: String,
    marks: Vec<VertexOrigin>,
}

impl Rims {
    /// Remembers the loops of a part. A mesh that is no manifold has none.
    fn of(part: &str, mesh: &TriMesh, origins: &Origins) -> Self {
        let marks = loops(mesh).iter().map(|l| origins.vertices[l[0]]).collect();
        Self { part: part.to_string(), marks }
    }
}

/// The loop of a mesh that passes a vertex of this origin.
fn loop_with(mesh: &TriMesh, origins: &Origins, mark: &VertexOrigin) -> Option<usize> {
    loops(mesh).iter().position(|l| l.iter().any(|&v| origins.vertices[v] == *mark))
}

fn loops(mesh: &TriMesh) -> Vec<Vec<VertexId>> {
    let Ok(mesh) = Connected::new(mesh) else { return vec![] };
    boundary_loops(&mesh).iter().map(|l| l.iter().map(|&h| mesh.tail(h)).collect()).collect()
}
