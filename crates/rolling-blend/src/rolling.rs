//! The rails: a ball rolled along every curve that has none yet.

use crate::dwindle::running_out;
use crate::error::Error;
use crate::mends::Mends;
use crate::network::Network;
use crate::params::Params;
use crate::trouble::Trouble;
use mesh_core::{Adjacency, Connected, Faces, Positions, TriMesh};
use profile_nurbs::Profile;
use rayon::prelude::*;
use spine::{BlendCurve, Rail, roll_or_halt};
use std::f64::consts::PI;

/// Chord length along and across: matched to the input's edges, within one and two tenths of the radius, or less where
/// the tolerance asks for it.
pub(crate) fn step_length(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params) -> f64 {
    // An arc of radius r has the sagitta s on a chord of √(8·s·r); 0.005·r is that of 0.2·r.
    let widest = params.radius * params.radii.least() * (8.0 * params.tolerance.clamp(1e-6, 0.005)).sqrt();
    let mut edges: Vec<f64> = curves
        .iter()
        .flat_map(|c| &c.halfedges)
        .flat_map(|&h| mesh.ring(mesh.tail(h)))
        .map(|h| mesh.edge_length(h))
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() * 3 / 4).map_or(widest, |&e| (1.2 * e).max(0.5 * widest).min(widest))
}

/// How far ahead of a curve's end its sides are kept apart, in radii.
pub(crate) const REACH_AHEAD: f64 = 6.0;
/// How far a ball may go in one step where its way is straight. The edges of a closed curve stand for a round rim more
/// often than not, so each is seen several times.
fn longest_stride(mesh: &Connected<TriMesh>, curve: &BlendCurve, radius: f64) -> f64 {
    let length = curve.length(mesh);
    let edge = if curve.closed { length / (8 * curve.halfedges.len().max(1)) as f64 } else { length };
    edge.min(length / 64.0).min(4.0 * radius)
}

/// Vertices of a blend at most: some two gigabytes while it is made.
const MOST: f64 = 4e6;
/// Balls at either joint of a curve's edges where it bends, at most: a rim that is cut fine takes fewer.
const AT_JOINTS: f64 = 20.0;

/// About how many vertices a blend of `radius` has: rings of points along the arc, a chord apart where the curve bends
/// and up to four radii where it is straight. O(n) for n edges.
fn estimated_vertices(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params, radius: f64) -> f64 {
    let least = radius * params.radii.least();
    let step = step_length(mesh, curves, &Params { radius, ..params.clone() });
    let rings = |curve: &BlendCurve| {
        let (length, edges) = (curve.length(mesh), curve.halfedges.len() as f64);
        let longest = longest_stride(mesh, curve, radius).max(step);
        (length / longest + AT_JOINTS * edges).min(length / step)
    };
    curves.iter().map(rings).sum::<f64>() * (1.0 + PI * least / step)
}

/// Refuses a radius so small for its curves that the blend would not fit into memory, before anything is made.
///
/// # Errors
/// [`Error::TooFine`], with about the least radius that is taken.
pub(crate) fn affordable(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params) -> Result<(), Error> {
    let estimate = |radius: f64| estimated_vertices(mesh, curves, params, radius);
    let vertices = estimate(params.radius);
    if vertices <= MOST {
        return Ok(());
    }
    let mut least = params.radius;
    while estimate(least) > MOST && least.is_finite() {
        least *= 1.25;
    }
    Err(Error::TooFine { radius: params.radius, vertices, least })
}

/// Rolls along the curves that have no rail.
pub(crate) fn roll_missing(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    network: &Network,
    params: &Params,
    mends: &Mends,
    step: f64,
    rails: &mut [Option<Rail>],
) -> Result<(), Trouble> {
    let spine_params = |curve: usize| spine::Params {
        radius: running_out(mesh, curves, network, curve, mends.field(curve)),
        walls: network.walls(mesh, curve),
        alpha: params.alpha,
        bridge: params.bridge,
        solver: params.solver,
        step,
        longest: longest_stride(mesh, &curves[curve], params.radius).max(step),
        sagitta: 0.2 * params.tolerance,
        softenings: mends.softenings.clone(),
        ..spine::Params::new(params.radius)
    };
    let rolled: Vec<_> = rails
        .par_iter()
        .enumerate()
        .map(|(i, rail)| rail.is_none().then(|| roll_or_halt(mesh, &curves[i], curves, &spine_params(i))))
        .collect();
    let mut places = Vec::new();
    for ((rail, rolled), curve) in rails.iter_mut().zip(rolled).zip(curves) {
        match rolled {
            None => {}
            Some(Ok(mut r)) => {
                if params.uses(&Profile::G2) {
                    r.measure_bends(mesh);
                }
                params.sketch.page(mesh, curve).rail(mesh, &r);
                *rail = Some(r);
            }
            Some(Err(halt)) => match (&halt.error, halt.error.place()) {
                (
                    spine::Error::NoStart { .. }
                    | spine::Error::Stuck { .. }
                    | spine::Error::Astray { .. }
                    | spine::Error::NoLoop { .. }
                    | spine::Error::Folded { .. },
                    Some(at),
                ) => {
                    params.sketch.page(mesh, curve).halt(mesh, &halt);
                    places.push(at);
                }
                _ => return Err(Trouble::Spine(halt.error)),
            },
        }
    }
    if places.is_empty() { Ok(()) } else { Err(Trouble::at("the ball cannot roll on", places)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{self, feature_curves};
    use glam::DVec3;
    use mesh_core::shapes;

    fn edges_of(mesh: TriMesh) -> (Connected<TriMesh>, Vec<BlendCurve>) {
        let mesh = Connected::new(mesh).unwrap();
        let curves = feature_curves(&mesh, &features::Params::default());
        let curves = curves.iter().map(|c| BlendCurve { halfedges: c.halfedges.clone(), closed: c.closed }).collect();
        (mesh, curves)
    }

    /// The least radius told is taken, and one a little smaller is not; it belongs to the model's size.
    #[test]
    fn a_radius_too_small_for_its_curves_is_refused() {
        for size in [1.0, 1e-4, 1e5] {
            for mesh in [shapes::cuboid(DVec3::splat(size)), shapes::cylinder(0.5 * size, size, 200, 4)] {
                let (mesh, curves) = edges_of(mesh);
                let refused = affordable(&mesh, &curves, &Params::new(1e-9 * size));
                let Err(Error::TooFine { radius, vertices, least }) = refused else { panic!("{refused:?}") };
                assert!(radius == 1e-9 * size && vertices > MOST && (1e-8..1e-3).contains(&(least / size)), "{least}");
                assert!(affordable(&mesh, &curves, &Params::new(least)).is_ok());
                assert!(affordable(&mesh, &curves, &Params::new(0.75 * least)).is_err());
            }
        }
    }
}
