//! The ball that dwindles where a curve runs out.

use crate::network::{Dart, Kind, Network};
use glam::DVec3;
use mesh_core::{Connected, Positions, TriMesh, dihedral_angle};
use spine::{BlendCurve, Dip, RadiusField};

/// Length over which a ball runs out, in radii, and its largest share of the curve.
const RUN_OUT: (f64, f64) = (4.0, 0.4);
/// Share of the radius that a ball has left at the very end.
const TIP: f64 = 0.03;
/// Share of the surface between two curves that run out at one vertex which their blends may take.
const SHARED: f64 = 0.8;
/// The largest of (radius at s) / s over a run-out, in radii per extent: that of 2d − d³.
const STEEPEST: f64 = 1.09;
/// How far along two such curves the gap between them is looked at, in radii.
const LOOK: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// The radius along a curve, which dwindles where the curve runs out.
pub(crate) fn running_out(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    network: &Network,
    curve: usize,
    mut radius: RadiusField,
) -> RadiusField {
    let most = RUN_OUT.1 * curves[curve].length(mesh);
    let nodes = network.ends[curve].iter().flatten().map(|&n| &network.nodes[n]);
    for node in nodes.filter(|n| matches!(n.kind, Kind::RunOut { .. })) {
        let others = network.nodes.iter().filter(|o| o.vertex == node.vertex).flat_map(|o| &o.darts);
        let own = node.darts.iter().find(|d| d.curve == curve);
        let needed = others
            .filter(|o| o.curve != curve)
            .filter_map(|o| Some(room(mesh, curves, [*own?, *o], radius.base)))
            .fold(RUN_OUT.0, f64::max);
        let extent = (needed * radius.base).min(most);
        radius.dips.push(Dip { at: mesh.position(node.vertex), factor: TIP, extent });
    }
    radius
}

/// The length, in radii, over which two curves that part at a narrow angle must run out, so that both blends have room
/// on the surface between them: a step whose height falls to nothing, say.
fn room(mesh: &Connected<TriMesh>, curves: &[BlendCurve], darts: [Dart; 2], r: f64) -> f64 {
    let ways = darts.map(|d| Way::of(mesh, curves, d, LOOK[LOOK.len() - 1] * r));
    let widths: f64 = ways.iter().map(|w| w.width).sum();
    let gap = |s: f64| ways[0].at(s).distance(ways[1].at(s)) / s;
    let shortest = ways[0].length().min(ways[1].length());
    let narrowest = LOOK.map(|l| (l * r).min(shortest)).into_iter().map(gap).fold(f64::INFINITY, f64::min);
    STEEPEST * widths / (SHARED * narrowest)
}

/// The beginning of a curve as seen from a node.
struct Way {
    points: Vec<DVec3>,
    /// Distance of a ball's foot from the curve, in radii.
    width: f64,
}

impl Way {
    fn of(mesh: &Connected<TriMesh>, curves: &[BlendCurve], dart: Dart, reach: f64) -> Self {
        let chain = &curves[dart.curve].halfedges;
        let n = chain.len();
        let (mut points, mut turns, mut length) = (vec![], vec![], 0.0);
        for k in 0..n {
            let h = chain[if dart.end == 0 { k } else { n - 1 - k }];
            let mut ends = mesh.ends(h);
            if dart.end == 1 {
                ends.reverse();
            }
            if k == 0 {
                points.push(ends[0]);
            }
            points.push(ends[1]);
            turns.push(dihedral_angle(mesh, h).map_or(0.0, f64::abs));
            length += ends[0].distance(ends[1]);
            if length >= reach {
                break;
            }
        }
        // A few faces seen edge-on must not count for all.
        turns.sort_by(f64::total_cmp);
        let typical = turns.get(turns.len() * 3 / 4).copied().unwrap_or(0.0);
        Self { points, width: (0.5 * typical).min(1.4).tan() }
    }

    fn length(&self) -> f64 {
        self.points.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// The point at length `s`, or the last one.
    fn at(&self, mut s: f64) -> DVec3 {
        for w in self.points.windows(2) {
            let d = w[0].distance(w[1]);
            if s < d {
                return w[0].lerp(w[1], s / d);
            }
            s -= d;
        }
        self.points.last().copied().unwrap_or(DVec3::ZERO)
    }
}
