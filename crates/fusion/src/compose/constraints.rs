//! What the field must satisfy: the parts' surface around their openings, and which side is out.

use super::openings::Opening;
use super::{Method, Params, SilhouetteCurve};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, one_sided_normal};
use rbf_solve::{Constraint, Kernel, Thinning, thin};

/// Distance of the points off the surface, as a share of the median boundary edge: near enough to act as a normal, far
/// enough to keep the system well conditioned.
const OFFSET: f64 = 0.1;
/// Constraints nearer to each other than this share of the median edge are merged.
const MERGE: f64 = 0.1;

/// Up to how many unknowns silhouettes and creases get exact normals.
const MOST_EXACT: usize = 6000;

/// The constraints, and the distance within which some are merged.
pub(super) struct Constraints {
    pub all: Vec<Constraint>,
    pub merge: f64,
}

/// Boundary vertices first, then rings around them, thinned away from the boundary, then points off the surface.
pub(super) fn constraints(
    parts: &[Connected<TriMesh>],
    openings: &[Opening],
    curves: &[SilhouetteCurve],
    params: &Params,
) -> Constraints {
    let mut on: Vec<Constraint> = vec![];
    let mut rings: Vec<Constraint> = vec![];
    let mut off: Vec<Constraint> = vec![];
    // Places whose normal the rings would spoil, or that have none.
    let mut creased: Vec<(DVec3, DVec3)> = vec![];
    let mut merge = f64::INFINITY;
    let spacing = spacing(openings.iter().map(|o| o.vertices.len()).sum());
    for opening in openings {
        let mesh = &parts[opening.part];
        let offset = OFFSET * median_edge(opening);
        merge = merge.min(MERGE * median_edge(opening));
        let boundary = opening.vertices.len();
        if opening.crease != 0.0 {
            creased.extend(opening.rim.points.iter().copied().zip(opening.normals.iter().copied()));
            continue;
        }
        let vertices = around(mesh, &opening.vertices, params.ring_count());
        let points: Vec<DVec3> = vertices.iter().map(|&v| mesh.position(v)).collect();
        // Vertices by ring come nearest first, so what is thinned away is far out.
        let kept = thin(&points, &points[..boundary], &Thinning::new(opening.mean_edge()));
        let mut outside: Vec<DVec3> = vec![];
        let apart = spacing * opening.mean_edge();
        for i in kept {
            let (v, p) = (vertices[i], points[i]);
            let normal = one_sided_normal(mesh, v, mesh.ring(v).map(HalfedgeId::face));
            let list = if i < boundary { &mut on } else { &mut rings };
            if params.kernel == super::Kernel::Hermite {
                list.push(Constraint::with_normal(p, normal));
                continue;
            }
            list.push(Constraint::on_surface(p));
            if apart > 0.0 && outside.iter().any(|q| q.distance_squared(p) < apart * apart) {
                continue;
            }
            outside.push(p);
            off.push(Constraint::off_surface(p + offset * normal, offset));
            if params.method == Method::Montage {
                off.push(Constraint::off_surface(p - offset * normal, -offset));
            }
        }
    }
    for guide in &params.guides {
        match (guide.normal, params.kernel) {
            (Some(n), super::Kernel::Hermite) => on.push(Constraint::with_normal(guide.point, n)),
            (normal, _) => {
                on.push(Constraint::on_surface(guide.point));
                let step = OFFSET / MERGE * merge;
                off.extend(normal.map(|n| Constraint::off_surface(guide.point + step * n.normalize_or_zero(), step)));
            }
        }
    }
    creased.extend(curves.iter().flat_map(|c| &c.points).map(|at| (at.point, at.normal)));
    // Exact normals cost three unknowns each and a dense solve; where that is too dear, points on both sides do.
    let few = on.len() + rings.len() + off.len() + 4 * creased.len() <= MOST_EXACT;
    for (point, normal) in creased {
        if few && params.kernel != super::Kernel::Biharmonic {
            on.push(Constraint::with_normal(point, normal));
        } else {
            let step = OFFSET / MERGE * merge;
            on.push(Constraint::on_surface(point));
            off.extend([step, -step].map(|s| Constraint::off_surface(point + s * normal, s)));
        }
    }
    on.extend(rings);
    on.extend(off);
    Constraints { all: on, merge }
}

/// How far apart, in edges, points off the surface are. The rings already hold the tangent planes: on smooth parts
/// points three edges apart do as well (mean angle across the weld 1.64° for 1.55°), on rough ones not quite, so only
/// large jobs save them.
fn spacing(boundary: usize) -> f64 {
    match boundary {
        0..600 => 0.0,
        600..1000 => 1.5,
        _ => 3.0,
    }
}

/// How the field is solved.
pub(super) fn fitting(params: &Params, merge: f64) -> rbf_solve::Params {
    let kernel = match params.kernel {
        super::Kernel::Biharmonic => Kernel::Biharmonic,
        super::Kernel::Triharmonic | super::Kernel::Hermite => Kernel::Triharmonic,
    };
    rbf_solve::Params { kernel, merge, ..rbf_solve::Params::default() }
}

fn median_edge(opening: &Opening) -> f64 {
    let mut lengths: Vec<f64> = opening.rim.lengths().filter(|l| *l > 0.0).collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// `seeds` and all vertices within `rings` edges of them, nearest first.
fn around(mesh: &Connected<TriMesh>, seeds: &[VertexId], rings: usize) -> Vec<VertexId> {
    let mut found = seeds.to_vec();
    let mut seen: std::collections::HashSet<VertexId> = seeds.iter().copied().collect();
    let mut start = 0;
    for _ in 0..rings {
        let end = found.len();
        for i in start..end {
            for h in mesh.ring(found[i]) {
                for v in [mesh.head(h), mesh.tail(h.prev())] {
                    if seen.insert(v) {
                        found.push(v);
                    }
                }
            }
        }
        start = end;
    }
    found
}
