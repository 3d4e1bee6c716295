//! The teapot of Martin Newell, University of Utah, 1975: 32 bicubic Bézier patches, evaluated.

use super::round::{Ends, weave};
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};

/// The parts of a teapot, z up, spout towards +x, 3.15 high.
#[derive(Clone, Debug, PartialEq)]
pub struct Teapot {
    /// The body with its rim and bottom.
    pub body: TriMesh,
    /// The lid with its knob.
    pub lid: TriMesh,
    /// The handle.
    pub handle: TriMesh,
    /// The spout.
    pub spout: TriMesh,
}

/// The teapot as it is known, each patch in `n` × `n` cells: the body and the lid are open at the rim, the handle and
/// the spout at both ends, which reach into the body.
pub fn teapot(n: u32) -> Teapot {
    teapot_parts(n, |rows| rows)
}

/// The same with every opening covered by a fan from its middle, so that all four parts are solids.
pub fn closed_teapot(n: u32) -> Teapot {
    teapot_parts(n, |mut rows| {
        let middle = |row: &Vec<DVec3>| vec![row.iter().sum::<DVec3>() / row.len() as f64];
        let (first, last) = (rows.first().map(middle), rows.last().map(middle));
        if rows.first().is_some_and(|row| row.len() > 1) {
            rows.splice(..0, first);
        }
        if rows.last().is_some_and(|row| row.len() > 1) {
            rows.extend(last);
        }
        rows
    })
}

type Rows = Vec<Vec<DVec3>>;

fn teapot_parts(n: u32, finish: impl Fn(Rows) -> Rows) -> Teapot {
    let n = n.max(1);
    let turned = |profile: &[[[f64; 2]; 4]]| weave(&finish(revolve(profile, n)), Ends::Free);
    let bent = |sides: &[[[[f64; 3]; 4]; 4]; 2]| weave(&finish(mirrored(sides, n)), Ends::Free);
    Teapot { body: turned(&BODY), lid: turned(&LID), handle: bent(&HANDLE), spout: bent(&SPOUT) }
}

/// (Radius, height) of the control points, bottom to rim. Four patches each.
const BODY: [[[f64; 2]; 4]; 4] = [
    [[0.0, 0.0], [1.425, 0.0], [1.5, 0.075], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.225], [2.0, 0.45], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 1.35], [1.75, 1.875], [1.5, 2.4]],
    [[1.5, 2.4], [1.4375, 2.53125], [1.3375, 2.53125], [1.4, 2.4]],
];

/// (Radius, height) of the control points, edge to knob. Four patches each.
const LID: [[[f64; 2]; 4]; 2] =
    [[[1.3, 2.4], [1.3, 2.55], [0.4, 2.55], [0.2, 2.7]], [[0.2, 2.7], [0.0, 2.85], [0.8, 3.15], [0.0, 3.15]]];

/// Rows of control points on the side y ≤ 0, upper end to lower end, inner side first. The other side mirrors them.
const HANDLE: [[[[f64; 3]; 4]; 4]; 2] = [
    [
        [[-1.6, 0.0, 2.025], [-1.6, -0.3, 2.025], [-1.5, -0.3, 2.25], [-1.5, 0.0, 2.25]],
        [[-2.3, 0.0, 2.025], [-2.3, -0.3, 2.025], [-2.5, -0.3, 2.25], [-2.5, 0.0, 2.25]],
        [[-2.7, 0.0, 2.025], [-2.7, -0.3, 2.025], [-3.0, -0.3, 2.25], [-3.0, 0.0, 2.25]],
        [[-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8]],
    ],
    [
        [[-2.7, 0.0, 1.8], [-2.7, -0.3, 1.8], [-3.0, -0.3, 1.8], [-3.0, 0.0, 1.8]],
        [[-2.7, 0.0, 1.575], [-2.7, -0.3, 1.575], [-3.0, -0.3, 1.35], [-3.0, 0.0, 1.35]],
        [[-2.5, 0.0, 1.125], [-2.5, -0.3, 1.125], [-2.65, -0.3, 0.9375], [-2.65, 0.0, 0.9375]],
        [[-2.0, 0.0, 0.9], [-2.0, -0.3, 0.9], [-1.9, -0.3, 0.6], [-1.9, 0.0, 0.6]],
    ],
];

/// As [`HANDLE`], from the body to the tip, upper side first.
const SPOUT: [[[[f64; 3]; 4]; 4]; 2] = [
    [
        [[1.7, 0.0, 1.425], [1.7, -0.66, 1.425], [1.7, -0.66, 0.6], [1.7, 0.0, 0.6]],
        [[2.6, 0.0, 1.425], [2.6, -0.66, 1.425], [3.1, -0.66, 0.825], [3.1, 0.0, 0.825]],
        [[2.3, 0.0, 2.1], [2.3, -0.25, 2.1], [2.4, -0.25, 2.025], [2.4, 0.0, 2.025]],
        [[2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4]],
    ],
    [
        [[2.7, 0.0, 2.4], [2.7, -0.25, 2.4], [3.3, -0.25, 2.4], [3.3, 0.0, 2.4]],
        [[2.8, 0.0, 2.475], [2.8, -0.25, 2.475], [3.525, -0.25, 2.49375], [3.525, 0.0, 2.49375]],
        [[2.9, 0.0, 2.475], [2.9, -0.15, 2.475], [3.45, -0.15, 2.5125], [3.45, 0.0, 2.5125]],
        [[2.8, 0.0, 2.4], [2.8, -0.15, 2.4], [3.2, -0.15, 2.4], [3.2, 0.0, 2.4]],
    ],
];

/// Newell's quarter circle: 0.56 where 0.5523 would be nearest to round.
const QUARTER: [DVec3; 4] =
    [DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.56, 0.0), DVec3::new(0.56, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];

fn bezier(mut p: [DVec3; 4], t: f64) -> DVec3 {
    for left in (1..4).rev() {
        for i in 0..left {
            p[i] = p[i].lerp(p[i + 1], t);
        }
    }
    p[0]
}

/// Parameters along `patches` patches in a row, the joints once.
fn steps(patches: usize, n: u32) -> impl Iterator<Item = (usize, f64)> {
    (0..=patches as u32 * n).map(move |i| {
        let patch = ((i / n) as usize).min(patches - 1);
        (patch, f64::from(i - patch as u32 * n) / f64::from(n))
    })
}

fn revolve(profile: &[[[f64; 2]; 4]], n: u32) -> Rows {
    let quarter: Vec<DVec2> = (0..n).map(|i| bezier(QUARTER, f64::from(i) / f64::from(n)).truncate()).collect();
    let row = |(patch, t): (usize, f64)| {
        let p = bezier(profile[patch].map(|[r, z]| DVec3::new(r, 0.0, z)), t);
        if p.x == 0.0 {
            return vec![p];
        }
        let turned = |k: usize| quarter.iter().map(move |&q| (0..k).fold(q, |q, _| q.perp()));
        (0..4).flat_map(turned).map(|q| (p.x * q).extend(p.z)).collect()
    };
    steps(profile.len(), n).map(row).collect()
}

fn mirrored(sides: &[[[[f64; 3]; 4]; 4]; 2], n: u32) -> Rows {
    let row = |(patch, t): (usize, f64)| -> Vec<DVec3> {
        let across = [0, 1, 2, 3].map(|k| bezier([0, 1, 2, 3].map(|j| DVec3::from(sides[patch][j][k])), t));
        let half: Vec<DVec3> = (0..=n).map(|i| bezier(across, f64::from(i) / f64::from(n))).collect();
        let back = half[1..n as usize].iter().rev().map(|p| DVec3::new(p.x, -p.y, p.z));
        half.iter().copied().chain(back).collect()
    };
    steps(2, n).map(row).collect()
}
