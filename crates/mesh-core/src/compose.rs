//! Composition of origins across stages.

use crate::ids::{FaceId, VertexId};
use crate::origin::{FaceOrigin, Origins, VertexOrigin};
use crate::traits::{Faces, Positions};
use glam::DVec3;
use std::collections::HashMap;

/// One output of an earlier stage, which a later stage took as an input.
#[derive(Clone, Copy)]
pub struct Stage<'a> {
    /// Where its vertices and faces came from.
    pub origins: &'a Origins,
    /// Its faces.
    pub faces: &'a dyn Faces,
}

const LOST: &str = "unknown";

impl Origins {
    /// Origins of this stage's output relative to the *first* inputs, when its own parts are `stages`: part `i` here is
    /// the output described by `stages[i]`, whose parts are `inputs`.
    ///
    /// A point on an edge stays on an edge where that edge lies within an input edge, and becomes a point in the parent
    /// face otherwise; points and faces on what an earlier stage made are new, by that stage's name. Ids out of range
    /// become new by `"unknown"`. O(n), and one pass over a stage's faces where edge points cross parent faces.
    #[must_use]
    pub fn compose(&self, stages: &[Stage<'_>], inputs: &[&dyn Faces]) -> Self {
        let parents = self.parents_of_split_edges(stages);
        let vertex = |v: &VertexOrigin| match *v {
            VertexOrigin::Input { part, vertex } => stage_vertex(stages, part, vertex),
            VertexOrigin::Edge { part, ends, t } => {
                let [a, b] = ends.map(|v| stage_vertex(stages, part, v));
                let face = parents.get(&(part, sorted(ends)));
                on_input_edge(a, b, t).unwrap_or_else(|| within(face, &[(a, 1.0 - t), (b, t)], inputs))
            }
            VertexOrigin::Face { part, face, barycentric } => {
                let stage = stages.get(part as usize);
                let parent = stage.and_then(|s| s.origins.faces.get(face));
                match stage.filter(|s| face.index() < s.faces.face_count()) {
                    None => VertexOrigin::New { stage: LOST },
                    Some(s) => {
                        let corners = s.faces.corners(face).map(|v| stage_vertex(stages, part, v));
                        within(parent, &[0, 1, 2].map(|k| (corners[k], barycentric[k])), inputs)
                    }
                }
            }
            new @ VertexOrigin::New { .. } => new,
        };
        let parent = |part: u32, face: FaceId| {
            let origin = stages.get(part as usize).and_then(|s| s.origins.faces.get(face));
            origin.copied().unwrap_or(FaceOrigin::New { stage: LOST })
        };
        let face = |f: &FaceOrigin| match *f {
            FaceOrigin::Input { part, face } => parent(part, face),
            FaceOrigin::Piece { part, face } => match parent(part, face) {
                FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
                other => other,
            },
            new @ FaceOrigin::New { .. } => new,
        };
        Self {
            vertices: self.vertices.as_slice().iter().map(vertex).collect::<Vec<_>>().into(),
            faces: self.faces.as_slice().iter().map(face).collect::<Vec<_>>().into(),
        }
    }

    /// For each split edge of a stage's output, the origin of a face beside it, of an input where there is one.
    fn parents_of_split_edges(&self, stages: &[Stage<'_>]) -> HashMap<(u32, [VertexId; 2]), FaceOrigin> {
        let mut parents = HashMap::new();
        for v in self.vertices.as_slice() {
            if let VertexOrigin::Edge { part, ends, .. } = *v {
                parents.insert((part, sorted(ends)), FaceOrigin::New { stage: LOST });
            }
        }
        if parents.is_empty() {
            return parents;
        }
        for (part, stage) in (0..).zip(stages) {
            // Most faces are far from any split edge: a bit for each vertex spares them the table.
            let mut ends = vec![false; stage.faces.vertex_count()];
            for v in parents.keys().filter(|key| key.0 == part).flat_map(|key| key.1) {
                if let Some(end) = ends.get_mut(v.index()) {
                    *end = true;
                }
            }
            for f in (0..stage.faces.face_count() as u32).map(FaceId) {
                let (c, Some(&origin)) = (stage.faces.corners(f), stage.origins.faces.get(f)) else { continue };
                for (a, b) in [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])] {
                    if !(ends[a.index()] && ends[b.index()]) {
                        continue;
                    }
                    if let Some(best) = parents.get_mut(&(part, sorted([a, b])))
                        && matches!(best, FaceOrigin::New { .. })
                        && (!matches!(origin, FaceOrigin::New { .. }) || *best == FaceOrigin::New { stage: LOST })
                    {
                        *best = origin;
                    }
                }
            }
        }
        parents
    }

    /// Renumbers the parts, for merging results whose inputs were numbered apart.
    #[must_use]
    pub fn map_part(mut self, new_part: impl Fn(u32) -> u32) -> Self {
        for v in self.vertices.as_mut_slice() {
            if let VertexOrigin::Input { part, .. }
            | VertexOrigin::Edge { part, .. }
            | VertexOrigin::Face { part, .. } = v
            {
                *part = new_part(*part);
            }
        }
        for f in self.faces.as_mut_slice() {
            if let FaceOrigin::Input { part, .. } | FaceOrigin::Piece { part, .. } = f {
                *part = new_part(*part);
            }
        }
        self
    }
}

impl VertexOrigin {
    /// The place this origin describes, up to rounding; `None` for new vertices and ids out of range.
    pub fn position<M: Faces + Positions>(&self, inputs: &[M]) -> Option<DVec3> {
        let place = |mesh: &M, v: VertexId| (v.index() < mesh.vertex_count()).then(|| mesh.position(v));
        match *self {
            Self::Input { part, vertex } => place(inputs.get(part as usize)?, vertex),
            Self::Edge { part, ends, t } => {
                let mesh = inputs.get(part as usize)?;
                Some(place(mesh, ends[0])?.lerp(place(mesh, ends[1])?, t))
            }
            Self::Face { part, face, barycentric: [u, v, w] } => {
                let mesh = inputs.get(part as usize).filter(|m| face.index() < m.face_count())?;
                let [a, b, c] = mesh.corners(face);
                Some(u * place(mesh, a)? + v * place(mesh, b)? + w * place(mesh, c)?)
            }
            Self::New { .. } => None,
        }
    }
}

fn sorted([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

fn stage_vertex(stages: &[Stage<'_>], part: u32, v: VertexId) -> VertexOrigin {
    let origin = stages.get(part as usize).and_then(|s| s.origins.vertices.get(v));
    origin.copied().unwrap_or(VertexOrigin::New { stage: LOST })
}

/// The point at `t` from `a` to `b`, when both lie on one input edge.
fn on_input_edge(a: VertexOrigin, b: VertexOrigin, t: f64) -> Option<VertexOrigin> {
    let line = |o: VertexOrigin| match o {
        VertexOrigin::Edge { part, ends, .. } => Some((part, ends)),
        _ => None,
    };
    let (part, ends) = match (a, b) {
        (VertexOrigin::Input { part, vertex }, VertexOrigin::Input { part: other, vertex: end }) if part == other => {
            (part, [vertex, end])
        }
        _ => line(a).or(line(b))?,
    };
    let parameter = |o: VertexOrigin| match o {
        VertexOrigin::Input { part: p, vertex } if p == part && vertex == ends[0] => Some(0.0),
        VertexOrigin::Input { part: p, vertex } if p == part && vertex == ends[1] => Some(1.0),
        VertexOrigin::Edge { part: p, ends: e, t } if p == part && e == ends => Some(t),
        VertexOrigin::Edge { part: p, ends: e, t } if p == part && e == [ends[1], ends[0]] => Some(1.0 - t),
        _ => None,
    };
    let (from, to) = (parameter(a)?, parameter(b)?);
    Some(VertexOrigin::Edge { part, ends, t: (1.0 - t) * from + t * to })
}

/// The weighted mean of points that all lie in the input face `parent`.
fn within(parent: Option<&FaceOrigin>, points: &[(VertexOrigin, f64)], inputs: &[&dyn Faces]) -> VertexOrigin {
    let (part, face) = match parent {
        Some(&(FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face })) => (part, face),
        Some(&FaceOrigin::New { stage }) => return VertexOrigin::New { stage },
        None => return VertexOrigin::New { stage: LOST },
    };
    let Some(corners) =
        inputs.get(part as usize).filter(|m| face.index() < m.face_count()).map(|mesh| mesh.corners(face))
    else {
        return VertexOrigin::New { stage: LOST };
    };
    let mut barycentric = [0.0; 3];
    for &(origin, weight) in points {
        match coordinates(origin, part, face, corners) {
            Ok(one) => (0..3).for_each(|k| barycentric[k] += weight * one[k]),
            Err(stage) => return VertexOrigin::New { stage },
        }
    }
    // A corner that no point leans on has exactly zero: the mean lies on the edge opposite to it.
    match barycentric.iter().position(|&x| x == 0.0) {
        Some(k) => {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            VertexOrigin::Edge { part, ends: [corners[i], corners[j]], t: barycentric[j] }
        }
        None => VertexOrigin::Face { part, face, barycentric },
    }
}

/// Barycentric coordinates of an origin in an input face, or the stage that made a point elsewhere.
fn coordinates(o: VertexOrigin, part: u32, face: FaceId, corners: [VertexId; 3]) -> Result<[f64; 3], &'static str> {
    let corner = |v: VertexId| corners.iter().position(|&c| c == v).ok_or(LOST);
    let mut at = [0.0; 3];
    match o {
        VertexOrigin::Input { part: p, vertex } if p == part => at[corner(vertex)?] = 1.0,
        VertexOrigin::Edge { part: p, ends, t } if p == part => {
            at[corner(ends[0])?] = 1.0 - t;
            at[corner(ends[1])?] = t;
        }
        VertexOrigin::Face { part: p, face: f, barycentric } if p == part && f == face => at = barycentric,
        VertexOrigin::New { stage } => return Err(stage),
        _ => return Err(LOST),
    }
    Ok(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TriMesh, shapes};
    use proptest::prelude::*;

    /// Splits random faces into three and random edges into two, keeping track of origins.
    fn refine(parts: &[TriMesh], picks: &[(u32, f64, f64)]) -> (TriMesh, Origins) {
        let mut mesh = TriMesh::default();
        let mut origins = Origins::default();
        for (part, one) in (0..).zip(parts) {
            let (v0, mine) =
                (mesh.positions.len() as u32, Origins::identity(part, one.positions.len(), one.faces.len()));
            mesh.positions.extend(&one.positions);
            mesh.faces.extend(one.faces.iter().map(|c| c.map(|v| VertexId(v.0 + v0))));
            mine.vertices.as_slice().iter().for_each(|&o| origins.vertices.push(o));
            mine.faces.as_slice().iter().for_each(|&o| origins.faces.push(o));
        }
        let base = mesh.faces.len();
        let mut spent = vec![false; base];
        for &(pick, x, y) in picks {
            let f = pick as usize % base;
            let FaceOrigin::Input { part, face } = origins.faces.as_slice()[f] else { continue };
            if std::mem::replace(&mut spent[f], true) {
                continue;
            }
            let [a, b, c] = mesh.faces[f];
            let (old, new) = (mesh.faces[f], VertexId::from(mesh.positions.len()));
            if y < 0.5 {
                let bary = [x * y, x * (1.0 - y), 1.0 - x * y - x * (1.0 - y)];
                let p = mesh.triangle(FaceId::from(f));
                mesh.positions.push(bary[0] * p[0] + bary[1] * p[1] + bary[2] * p[2]);
                origins.vertices.push(VertexOrigin::Face { part, face, barycentric: bary });
                mesh.faces[f] = [a, b, new];
                mesh.faces.extend([[b, c, new], [c, a, new]]);
                origins.faces.push(FaceOrigin::Piece { part, face });
                origins.faces.push(FaceOrigin::Piece { part, face });
            } else {
                // The edge a–b, from both sides.
                let other = mesh.faces.iter().position(|t| *t != old && t.contains(&a) && t.contains(&b));
                let Some(g) = other.filter(|&g| g < base && !spent[g]) else { continue };
                spent[g] = true;
                let [pa, pb] = [a, b].map(|v| mesh.positions[v.index()]);
                mesh.positions.push(pa.lerp(pb, x));
                let offset = (0..f)
                    .rev()
                    .find(|&i| matches!(origins.faces.as_slice()[i], FaceOrigin::Input { part: p, .. } if p != part));
                let first = offset.map_or(0, |_| parts[0].positions.len() as u32);
                origins.vertices.push(VertexOrigin::Edge { part, ends: [a, b].map(|v| VertexId(v.0 - first)), t: x });
                for side in [f, g] {
                    let parent = match origins.faces.as_slice()[side] {
                        FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
                        other => other,
                    };
                    let whole = mesh.faces[side];
                    mesh.faces.push(whole.map(|v| if v == a { new } else { v }));
                    mesh.faces[side] = whole.map(|v| if v == b { new } else { v });
                    origins.faces.push(parent);
                    origins.faces.as_mut_slice()[side] = parent;
                }
                continue;
            }
            origins.faces.as_mut_slice()[f] = FaceOrigin::Piece { part, face };
        }
        (mesh, origins)
    }

    proptest! {
        /// Two stages of splitting, composed: every vertex is found again from the first inputs alone.
        #[test]
        fn composed_origins_find_every_point(
            first in prop::collection::vec((0u32..40, 0.1f64..0.9, 0.0f64..1.0), 1..30),
            second in prop::collection::vec((0u32..200, 0.1f64..0.9, 0.0f64..1.0), 1..60),
        ) {
            let inputs = [shapes::icosphere(1.0, 0), shapes::cuboid(DVec3::new(1.0, 2.0, 3.0))];
            let (once, inner) = refine(&inputs, &first);
            let (twice, outer) = refine(std::slice::from_ref(&once), &second);
            let whole = outer.compose(&[Stage { origins: &inner, faces: &once }], &[&inputs[0], &inputs[1]]);
            for (v, origin) in whole.vertices.as_slice().iter().enumerate() {
                let found = origin.position(&inputs);
                prop_assert!(found.is_some_and(|p| p.distance(twice.positions[v]) < 1e-14), "{v}: {origin:?}");
                // What one stage put inside an input edge stays addressed by that edge.
                if let Some(VertexOrigin::Edge { .. }) = inner.vertices.as_slice().get(v) {
                    prop_assert_eq!(origin, &inner.vertices.as_slice()[v]);
                }
            }
            for (f, origin) in whole.faces.as_slice().iter().enumerate() {
                let (FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face }) = *origin else { panic!() };
                let parent = inputs[part as usize].triangle(face);
                let normal = crate::triangle_normal(parent);
                for p in twice.triangle(FaceId::from(f)) {
                    prop_assert!((p - parent[0]).dot(normal).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn what_a_stage_made_keeps_its_name() {
        let mesh = shapes::cuboid(DVec3::ONE);
        let mut inner = Origins::identity(3, 8, 12);
        inner.faces.as_mut_slice()[5] = FaceOrigin::New { stage: "blend" };
        inner.vertices.as_mut_slice()[2] = VertexOrigin::New { stage: "blend" };
        let mut outer = Origins::identity(0, 8, 12);
        outer.faces.as_mut_slice()[4] = FaceOrigin::Piece { part: 0, face: FaceId(5) };
        outer.vertices.as_mut_slice()[7] =
            VertexOrigin::Face { part: 0, face: FaceId(5), barycentric: [0.2, 0.3, 0.5] };
        outer.vertices.as_mut_slice()[6] = VertexOrigin::Input { part: 9, vertex: VertexId(0) };
        let inputs: [&dyn Faces; 4] = [&mesh; 4];
        let whole = outer.compose(&[Stage { origins: &inner, faces: &mesh }], &inputs).map_part(|p| p + 1);
        assert_eq!(whole.faces[FaceId(4)], FaceOrigin::New { stage: "blend" });
        assert_eq!(whole.faces[FaceId(6)], FaceOrigin::Input { part: 4, face: FaceId(6) });
        assert_eq!(whole.vertices[VertexId(2)], VertexOrigin::New { stage: "blend" });
        assert_eq!(whole.vertices[VertexId(7)], VertexOrigin::New { stage: "blend" });
        assert_eq!(whole.vertices[VertexId(6)], VertexOrigin::New { stage: LOST });
    }
}
