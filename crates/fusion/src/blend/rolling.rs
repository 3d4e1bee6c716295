//! The rails: a ball rolled along every curve that has none yet.

use super::Params;
use super::mends::Mends;
use super::network::{Kind, Network};
use super::trouble::Trouble;
use mesh_core::{Adjacency, Connected, Faces, Positions, TriMesh};
use rayon::prelude::*;
use spine::{BlendCurve, Dip, RadiusField, Rail, roll_or_halt};

/// Chord length along and across: matched to the input's edges, within one and two tenths of the radius, or less where
/// the tolerance asks for it.
pub(super) fn step_length(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params) -> f64 {
    // An arc of radius r has the sagitta s on a chord of √(8·s·r); 0.005·r is that of 0.2·r.
    let widest = params.radius * params.radii.least() * (8.0 * params.tolerance.clamp(1e-6, 0.005)).sqrt();
    let mut edges: Vec<f64> = curves
        .iter()
        .flat_map(|c| &c.halfedges)
        .flat_map(|&h| mesh.ring(mesh.tail(h)))
        .map(|h| mesh.position(mesh.tail(h)).distance(mesh.position(mesh.head(h))))
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() * 3 / 4).map_or(widest, |&e| (1.2 * e).max(0.5 * widest).min(widest))
}

/// How far ahead of a curve's end its sides are kept apart, in radii.
pub(super) const REACH_AHEAD: f64 = 6.0;
/// Length over which a ball runs out, in radii, and its share of the curve where that is short.
const RUN_OUT: (f64, f64) = (4.0, 0.4);
/// Share of the radius that a ball has left at the very end.
const TIP: f64 = 0.03;

/// Rolls along the curves that have no rail.
pub(super) fn roll_missing(
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
        solver: params.solver,
        step,
        longest: if curves[curve].closed {
            step
        } else {
            (curves[curve].length(mesh) / 64.0).clamp(step, (4.0 * params.radius).max(step))
        },
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
            Some(Ok(r)) => {
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

/// The radius along a curve, which dwindles where the curve runs out.
fn running_out(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    network: &Network,
    curve: usize,
    mut radius: RadiusField,
) -> RadiusField {
    let extent = (RUN_OUT.0 * radius.base).min(RUN_OUT.1 * curves[curve].length(mesh));
    let nodes = network.ends[curve].iter().flatten().map(|&n| &network.nodes[n]);
    let tips = nodes.filter(|n| matches!(n.kind, Kind::RunOut { .. }));
    radius.dips.extend(tips.map(|n| Dip { at: mesh.position(n.vertex), factor: TIP, extent }));
    radius
}
