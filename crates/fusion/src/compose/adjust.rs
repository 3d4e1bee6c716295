//! Openings that are too near to others, trimmed back along their own parts (\[Lin2008\] §5.1 leaves this to the user).

use super::openings::openings;
use super::{Error, Params};
use crate::cut;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, Faces, Origins, Positions, Stage, TriMesh, VertexId, VertexOrigin, Watch, boundary_loops,
};

/// The parts after trimming, and where they came from.
pub(super) struct Adjusted {
    pub meshes: Vec<Connected<TriMesh>>,
    /// Of every part's vertices and faces, with respect to the parts as given.
    pub origins: Vec<Origins>,
    /// The loops and creases by their new numbers.
    pub params: Params,
    /// How many openings were trimmed.
    pub trimmed: usize,
}

/// Trims every opening that is nearer than `distance`, in model units, to an opening of another part: in two rounds, so that both give way by
/// about as much. O(n m) for n vertices of the parts and m edges of the openings.
pub(super) fn adjust(
    given: &[Connected<TriMesh>],
    params: &Params,
    distance: f64,
    watch: &Watch,
) -> Result<Adjusted, Error> {
    let identity =
        |(part, mesh): (u32, &Connected<TriMesh>)| Origins::identity(part, mesh.vertex_count(), mesh.face_count());
    let mut adjusted = Adjusted {
        meshes: given.to_vec(),
        origins: (0..).zip(given).map(identity).collect(),
        params: params.clone(),
        trimmed: 0,
    };
    let mut done = vec![];
    for halfway in [true, false] {
        let count = openings(&adjusted.meshes, &adjusted.params)?.len();
        // Decided before any of this round is cut, so that the order of the parts does not matter.
        let before = openings(&adjusted.meshes, &adjusted.params)?;
        for k in 0..count {
            watch.step("adjust", k as f64 / count as f64)?;
            let now = openings(&adjusted.meshes, &adjusted.params)?;
            let others = if halfway { &before } else { &now };
            let own = &now[k];
            let segments: Vec<[DVec3; 2]> = others
                .iter()
                .filter(|o| o.part != own.part)
                .flat_map(|o| {
                    (0..o.rim.points.len()).map(|i| [o.rim.points[i], o.rim.points[(i + 1) % o.rim.points.len()]])
                })
                .collect();
            let nearest = own.rim.points.iter().map(|&p| far(p, &segments)).fold(f64::INFINITY, f64::min);
            if nearest >= distance * (1.0 - 1e-9) {
                continue;
            }
            let wanted = if halfway { 0.5 * (distance + nearest) } else { distance };
            let (part, index) = (own.part, own.index);
            let heights = heights(&adjusted.meshes[part], &own.vertices, &segments, wanted);
            let trouble = |source| Error::Adjust { part, index, source: Box::new(source) };
            let (mesh, origins) = cut::trim(&adjusted.meshes[part], &heights, watch).map_err(trouble)?;
            adjusted.renumber(part, index, &mesh, &origins)?;
            let stage = Stage { origins: &adjusted.origins[part], faces: &adjusted.meshes[part] };
            let inputs: Vec<&dyn Faces> = given.iter().map(|m| m as &dyn Faces).collect();
            let composed = origins.compose(&[stage], &inputs);
            adjusted.origins[part] = composed;
            adjusted.meshes[part] = mesh;
            if !done.contains(&(part, k)) {
                done.push((part, k));
            }
        }
    }
    adjusted.trimmed = done.len();
    Ok(adjusted)
}

/// How much nearer than `wanted` every vertex is to the segments, where it hangs together with the opening through others that are.
fn heights(mesh: &Connected<TriMesh>, opening: &[VertexId], segments: &[[DVec3; 2]], wanted: f64) -> Vec<f64> {
    let mut heights: Vec<f64> = mesh.vertex_ids().map(|v| wanted - far(mesh.position(v), segments)).collect();
    let mut reached = vec![false; heights.len()];
    let mut stack: Vec<VertexId> = opening.iter().copied().filter(|v| heights[v.index()] >= 0.0).collect();
    while let Some(v) = stack.pop() {
        if std::mem::replace(&mut reached[v.index()], true) {
            continue;
        }
        for h in mesh.ring(v) {
            stack.extend([mesh.head(h), mesh.tail(h.prev())].into_iter().filter(|w| heights[w.index()] >= 0.0));
        }
    }
    for (height, _) in heights.iter_mut().zip(&reached).filter(|(_, r)| !**r) {
        *height = -height.abs().max(f64::MIN_POSITIVE);
    }
    heights
}

/// Distance of a point from segments.
fn far(p: DVec3, segments: &[[DVec3; 2]]) -> f64 {
    let squared = |[a, b]: &[DVec3; 2]| {
        let t = ((p - *a).dot(*b - *a) / a.distance_squared(*b)).clamp(0.0, 1.0);
        p.distance_squared(if t.is_finite() { a.lerp(*b, t) } else { *a })
    };
    segments.iter().map(squared).fold(f64::INFINITY, f64::min).sqrt()
}

impl Adjusted {
    /// Loop numbers of a part after one of its openings was trimmed: all others keep a vertex, and the one that is left is the trimmed one.
    fn renumber(
        &mut self,
        part: usize,
        trimmed: usize,
        mesh: &Connected<TriMesh>,
        origins: &Origins,
    ) -> Result<(), Error> {
        let vertices = |mesh: &Connected<TriMesh>| -> Vec<Vec<VertexId>> {
            boundary_loops(mesh).iter().map(|l| l.iter().map(|&h| mesh.tail(h)).collect()).collect()
        };
        let (old, new) = (vertices(&self.meshes[part]), vertices(mesh));
        let kept = |v: VertexId, old: VertexId| matches!(origins.vertices[v], VertexOrigin::Input { vertex, .. } if vertex == old);
        let mut numbers: Vec<Option<usize>> = old
            .iter()
            .enumerate()
            .map(|(k, l)| (k != trimmed).then(|| new.iter().position(|n| n.iter().any(|&v| kept(v, l[0])))).flatten())
            .collect();
        let left: Vec<usize> = (0..new.len()).filter(|n| !numbers.contains(&Some(*n))).collect();
        let lost = (0..old.len()).find(|&k| k != trimmed && numbers[k].is_none());
        let [left] = left[..] else {
            let at = self.meshes[part].position(old[trimmed][0]);
            return Err(Error::Trimmed { part, index: trimmed, at });
        };
        if let Some(k) = lost {
            return Err(Error::Trimmed { part, index: k, at: self.meshes[part].position(old[k][0]) });
        }
        numbers[trimmed] = Some(left);
        let number = |k: usize| numbers.get(k).copied().flatten().unwrap_or(k);
        for (_, index) in self.params.loops.iter_mut().flatten().filter(|l| l.0 == part) {
            *index = number(*index);
        }
        for crease in self.params.creases.iter_mut().filter(|c| c.part == part) {
            crease.index = number(crease.index);
        }
        Ok(())
    }
}
