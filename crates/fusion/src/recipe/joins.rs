//! Joins of openings, which a recipe names by the parts they came with.
//!
//! Loops are numbered once, when each part is cut and posed. A part may be joined several times, and its other loops get other numbers
//! by that; so a loop is remembered by the origin of one of its vertices, which every join keeps.

use super::run::Replay;
use super::tables::{Compose, Creases, Depth, Silhouette};
use super::{Error as Wrong, Recipe};
use crate::Error;
use crate::compose::{self, Crease, compose};
use glam::DVec3;
use mesh_core::{Connected, Faces, Origins, TriMesh, VertexId, VertexOrigin, boundary_loops};
use mesh_io::Format;
use toml::Spanned;

impl Recipe {
    /// How openings are joined; which ones is left open.
    pub(super) fn composing(&self, i: usize, diagonal: f64, format: Format) -> Result<compose::Params, Wrong> {
        let c = &self.compose[i];
        let mut params = compose::Params::new(format);
        if let Some(text) = &c.method {
            params.method = match text.get_ref().as_str() {
                "implicit" => compose::Method::Implicit,
                "montage" => compose::Method::Montage,
                _ => return Err(self.error(text.span(), "a method is implicit or montage")),
            };
        }
        if let Some(text) = &c.kernel {
            params.kernel = match text.get_ref().as_str() {
                "biharmonic" => compose::Kernel::Biharmonic,
                "triharmonic" => compose::Kernel::Triharmonic,
                "hermite" => compose::Kernel::Hermite,
                _ => return Err(self.error(text.span(), "a kernel is triharmonic, biharmonic or hermite")),
            };
        }
        if let Some(rings) = &c.rings {
            if *rings.get_ref() > 16 {
                return Err(self.error(rings.span(), "must be a number from 0 to 16"));
            }
            params.rings = Some(usize::from(*rings.get_ref()));
        }
        if let Some(cell) = &c.cell {
            params.cell = self.within(cell, f64::MIN_POSITIVE, 1e6)?;
        }
        params.edge_length = self.length(c.edge_length.as_ref(), diagonal)?;
        params.adjust = self.length(c.adjust.as_ref(), diagonal)?;
        if let Some(space) = &c.space {
            params.space = self.within(space, f64::MIN_POSITIVE, 1e6)?;
        }
        if let Some(creases) = &c.crease {
            let all = match creases.get_ref() {
                Creases::All(angle) => vec![*angle],
                Creases::Each(each) => each.values().copied().collect(),
            };
            if !all.iter().all(|a| (-90.0..=90.0).contains(a)) {
                return Err(self.error(creases.span(), "a crease is an angle from -90 to 90 degrees"));
            }
            if let Creases::All(angle) = creases.get_ref() {
                params.crease = *angle;
            }
        }
        params.silhouettes = c.silhouette.iter().map(|s| self.silhouette(s)).collect::<Result<_, _>>()?;
        Ok(params)
    }

    /// A silhouette that a joint shall have.
    fn silhouette(&self, s: &Silhouette) -> Result<compose::Silhouette, Wrong> {
        let finite = |all: &[[f64; 3]]| all.iter().flatten().all(|x| x.is_finite());
        let view = *s.view.get_ref();
        if !finite(&[view]) || view == [0.0; 3] {
            return Err(self.error(s.view.span(), "a view is a direction other than 0, 0, 0"));
        }
        let (strokes, span) = match (&s.stroke, &s.strokes) {
            (Some(one), None) => (vec![one.get_ref().clone()], one.span()),
            (None, Some(all)) => (all.get_ref().clone(), all.span()),
            _ => return Err(self.error(s.view.span(), "a silhouette needs either a stroke or strokes")),
        };
        if strokes.iter().map(Vec::len).sum::<usize>() < 2 || !strokes.iter().all(|s| finite(s)) {
            return Err(self.error(span, "a stroke needs two points or more, in finite numbers"));
        }
        let control = s.control.as_ref().map(|c| {
            let fixed = finite(c.get_ref()).then(|| c.get_ref().map(DVec3::from));
            fixed.ok_or_else(|| self.error(c.span(), "control points are two points in finite numbers"))
        });
        let depth = s.depth.as_ref().map_or(Ok([0.0; 2]), |d| {
            let moves = match *d.get_ref() {
                Depth::One(x) => [x; 2],
                Depth::Two(both) => both,
            };
            let fixed = moves.iter().all(|x| x.is_finite()).then_some(moves);
            fixed.ok_or_else(|| self.error(d.span(), "moves along the view are finite numbers"))
        })?;
        Ok(compose::Silhouette {
            view: view.into(),
            strokes: strokes.into_iter().map(|s| s.into_iter().map(DVec3::from).collect()).collect(),
            hole: s.hole,
            control: control.transpose()?,
            depth,
        })
    }
}

impl Replay<'_> {
    pub(super) fn composes(&mut self) -> Result<(), Error> {
        self.name_rims(0);
        for (i, table) in self.recipe.compose.iter().enumerate() {
            let mut params = self.recipe.composing(i, self.diagonal(), self.format)?;
            let mut which: Vec<usize> = (0..self.pieces.len()).collect();
            if let Some(names) = &table.loops {
                let mut chosen = vec![];
                for name in names {
                    chosen.extend(self.loops_of(name)?);
                }
                which = chosen.iter().map(|c| c.0).collect();
                which.sort_unstable();
                which.dedup();
                let place = |w: usize| which.binary_search(&w).unwrap_or(0);
                params.loops = Some(chosen.iter().map(|&(w, l)| (place(w), l)).collect());
            }
            params.creases = self.creases(table, &which)?;
            let at = self.step("compose", &which, |models, watch| compose(models, &params, watch))?;
            self.rename(at, table.name.as_ref());
            self.name_rims(at);
        }
        Ok(())
    }

    /// The creases that a join names one by one, its pieces being those in `which`.
    fn creases(&self, table: &Compose, which: &[usize]) -> Result<Vec<Crease>, Error> {
        let Some(Creases::Each(each)) = table.crease.as_ref().map(Spanned::get_ref) else { return Ok(vec![]) };
        let span = table.crease.as_ref().map_or(0..0, Spanned::span);
        let mut all = vec![];
        for (name, &angle) in each {
            for (w, index) in self.loops_of(&Spanned::new(span.clone(), name.clone()))? {
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
    fn loops_of(&self, text: &Spanned<String>) -> Result<Vec<(usize, usize)>, Error> {
        let wrong = |message: String| -> Error { self.recipe.error(text.span(), message).into() };
        let (part, number) = split_loop(text.get_ref()).unwrap_or_default();
        let Some(rims) = self.rims.iter().find(|r| r.part == part) else {
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
            return Err(wrong(format!("`{}` is not open at this point", text.get_ref())));
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
