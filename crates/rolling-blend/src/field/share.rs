//! How much of a blend is on balls of the full radius, measured on the result.

use super::sides::Sides;
use crate::Blended;
use glam::DVec3;
use mesh_core::{Positions, VertexOrigin, area_vector};
use rayon::prelude::*;

/// A ball of the radius may miss the surface by this share of it.
const MISS: f64 = 0.05;

/// Share of the blend's area that is on balls of radius `r` which rest on the surface as it was: at each new vertex whose
/// neighbours are new as well, the ball that touches the blend there is a radius away from both sides, within a
/// twentieth. A vertex stands for a third of the faces around it. 1 for a blend without such vertices.
pub(crate) fn full_share(sides: &Sides<'_>, blended: &Blended, r: f64) -> f64 {
    let (mesh, origins) = (&blended.mesh, &blended.origins.vertices);
    let mut inner: Vec<bool> = origins.as_slice().iter().map(|o| !matches!(o, VertexOrigin::Input { .. })).collect();
    let mixed = |c: &[mesh_core::VertexId; 3]| c.iter().any(|&v| matches!(origins[v], VertexOrigin::Input { .. }));
    for v in mesh.faces.iter().filter(|c| mixed(c)).flatten() {
        inner[v.index()] = false;
    }
    let mut normals = vec![DVec3::ZERO; inner.len()];
    let mut areas = vec![0.0; inner.len()];
    for c in mesh.faces.iter().filter(|c| c.iter().any(|v| inner[v.index()])) {
        let area = area_vector(c.map(|v| mesh.position(v)));
        for v in c {
            normals[v.index()] += area;
            areas[v.index()] += area.length();
        }
    }
    let on_ball = |v: usize| {
        let center = mesh.positions[v] + sides.sign * r * normals[v].normalize_or_zero();
        let distance = sides.distance(0, center).min(sides.distance(1, center));
        (distance - r).abs() < MISS * r
    };
    let ids: Vec<usize> = (0..inner.len()).filter(|&v| inner[v]).collect();
    let rest: Vec<bool> = ids.par_iter().with_min_len(32).map(|&v| on_ball(v)).collect();
    let area = |chosen: bool| ids.iter().zip(&rest).filter(|x| *x.1 == chosen).map(|x| areas[*x.0]).sum::<f64>();
    let (full, less) = (area(true), area(false));
    if full + less > 0.0 { full / (full + less) } else { 1.0 }
}
