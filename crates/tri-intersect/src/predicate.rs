//! Exact signs of orientation, and the scaling that keeps them exact for coordinates of any size.

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord, Coord3D};
use std::borrow::Cow;

/// Coordinates whose size lies outside `[TINY, HUGE]` are scaled by a power of two before any product is formed:
/// products of six of them must neither overflow nor lose bits to underflow.
const HUGE: f64 = 1.267_650_600_228_229_4e30; // 2^100
/// Points handed to one task.
const CHUNK: usize = 1 << 14;
const TINY: f64 = 7.888_609_052_210_118e-31; // 2^-100

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// On which side of the plane of `t` a point lies: +1 where its normal points, −1 behind, 0 on it.
#[inline]
pub(crate) fn side(t: &[DVec3; 3], p: DVec3) -> i8 {
    -volume_sign(t[0], t[1], t[2], p)
}

/// Sign of the determinant of (a−d, b−d, c−d). Zero exactly when the four points are coplanar.
#[inline]
pub(crate) fn volume_sign(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> i8 {
    let p = |v: DVec3| Coord3D { x: v.x, y: v.y, z: v.z };
    sign(robust::orient3d(p(a), p(b), p(c), p(d)))
}

/// The two coordinates left when `axis` is dropped, in the order that keeps a turn's sense seen from +axis.
#[inline]
pub(crate) fn project(axis: usize, p: DVec3) -> [f64; 2] {
    match axis {
        0 => [p.y, p.z],
        1 => [p.z, p.x],
        _ => [p.x, p.y],
    }
}

/// +1 where a, b, c turn left, −1 where they turn right, 0 where they are collinear.
#[inline]
pub(crate) fn turn2(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let p = |v: [f64; 2]| Coord { x: v[0], y: v[1] };
    sign(robust::orient2d(p(a), p(b), p(c)))
}

/// [`turn2`] of three points seen along `axis`.
#[inline]
pub(crate) fn turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> i8 {
    turn2(project(axis, a), project(axis, b), project(axis, c))
}

/// The axis along which the triangle looks largest, and which way it then turns; `None` for a triangle without area.
pub(crate) fn facing(t: &[DVec3; 3]) -> Option<(usize, i8)> {
    let n = (t[1] - t[0]).cross(t[2] - t[0]).abs();
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| n[j].total_cmp(&n[i]));
    axes.into_iter().find_map(|axis| match turn(axis, t[0], t[1], t[2]) {
        0 => None,
        s => Some((axis, s)),
    })
}

/// Where a point lies in a triangle, or where a segment pierces it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Feature {
    /// At corner 0, 1 or 2.
    Corner(u8),
    /// Within the side from corner k to the next.
    Side(u8),
    /// Inside.
    Inside,
}

/// Reads three signs, one per side, all of one sense (or zero) exactly for points of the closed triangle.
fn feature(s: [i8; 3]) -> Option<Feature> {
    if s.contains(&1) && s.contains(&-1) {
        return None;
    }
    match s.map(|x| x == 0) {
        [false, false, false] => Some(Feature::Inside),
        [true, false, false] => Some(Feature::Side(0)),
        [false, true, false] => Some(Feature::Side(1)),
        [false, false, true] => Some(Feature::Side(2)),
        [true, true, false] => Some(Feature::Corner(1)),
        [false, true, true] => Some(Feature::Corner(2)),
        [true, false, true] => Some(Feature::Corner(0)),
        [true, true, true] => None,
    }
}

/// Where the segment `p`–`q`, whose ends lie strictly on either side of the plane of `t`, pierces `t`.
pub(crate) fn pierce(p: DVec3, q: DVec3, t: &[DVec3; 3]) -> Option<Feature> {
    let s0 = volume_sign(p, q, t[0], t[1]);
    let s1 = volume_sign(p, q, t[1], t[2]);
    if s0 * s1 < 0 {
        return None;
    }
    feature([s0, s1, volume_sign(p, q, t[2], t[0])])
}

/// Where a point of the plane of `t` lies in `t`, seen along `axis`, along which `t` has area.
pub(crate) fn locate(axis: usize, p: DVec3, t: &[DVec3; 3]) -> Option<Feature> {
    feature([turn(axis, t[0], t[1], p), turn(axis, t[1], t[2], p), turn(axis, t[2], t[0], p)])
}

/// The same points, scaled by one power of two if they are extreme, so that every predicate is exact on them.
/// Coordinates below 2⁻¹⁰⁰ of the largest become zero. `None` if one is not finite.
pub(crate) fn scaled<'a>(points: impl Into<Cow<'a, [DVec3]>>, largest: f64) -> Cow<'a, [DVec3]> {
    let points = points.into();
    let scale = scale_for(largest);
    let tiny = |x: f64| x != 0.0 && x.abs() < TINY;
    if scale == 1.0 && !points.par_iter().with_min_len(CHUNK).any(|p| tiny(p.x) || tiny(p.y) || tiny(p.z)) {
        return points;
    }
    points.par_iter().with_min_len(CHUNK).map(|p| rescaled(*p, scale)).collect::<Vec<_>>().into()
}

/// One point, scaled, tiny coordinates set to zero.
pub(crate) fn rescaled(p: DVec3, scale: f64) -> DVec3 {
    let q = p * scale;
    DVec3::select(q.abs().cmplt(DVec3::splat(TINY)), DVec3::ZERO, q)
}

/// Coordinates smaller than this become zero by [`rescaled`], in the units of before.
pub(crate) fn vanishing(scale: f64) -> f64 {
    TINY / scale
}

/// The largest coordinate by size; NaN or infinite if one is.
pub(crate) fn largest(points: &[DVec3]) -> f64 {
    let size = |p: &DVec3| if p.is_finite() { p.abs().max_element() } else { f64::INFINITY };
    points.par_iter().with_min_len(CHUNK).map(size).reduce(|| 0.0, f64::max)
}

/// 1 for ordinary sizes, else the power of two that brings `largest` near 1.
pub(crate) fn scale_for(largest: f64) -> f64 {
    if largest == 0.0 || (1e-3..=HUGE).contains(&largest) {
        return 1.0;
    }
    let exponent = largest.log2().floor().clamp(-1022.0, 1022.0);
    (-exponent).exp2()
}
