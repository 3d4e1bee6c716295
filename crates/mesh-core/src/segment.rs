//! Distances of points from segments and polylines.

use glam::DVec3;

/// The nearest point of the segment from `a` to `b`: its parameter from 0 to 1, and where it is. A segment without length answers with its
/// start.
///
/// ```
/// use glam::DVec3;
/// let (t, place) = mesh_core::closest_on_segment(DVec3::new(1.0, 5.0, 0.0), [DVec3::ZERO, 4.0 * DVec3::X]);
/// assert_eq!((t, place), (0.25, DVec3::X));
/// ```
#[inline]
pub fn closest_on_segment(p: DVec3, [a, b]: [DVec3; 2]) -> (f64, DVec3) {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let t = if t.is_nan() { 0.0 } else { t };
    (t, a + t * along)
}

/// Distance of a point from a segment, in model units.
#[inline]
pub fn distance_to_segment(p: DVec3, segment: [DVec3; 2]) -> f64 {
    closest_on_segment(p, segment).1.distance(p)
}

/// Distance of a point from the nearest of some segments; infinite where there are none.
///
/// ```
/// use glam::DVec3;
/// use mesh_core::{closed_segments, distance_to_segments, open_segments};
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::ONE - DVec3::Z];
/// let p = DVec3::new(0.0, 0.5, 0.0);
/// assert_eq!(distance_to_segments(p, open_segments(&corner)), 0.5);
/// assert!(distance_to_segments(p, closed_segments(&corner)) < 0.36);
/// ```
pub fn distance_to_segments(p: DVec3, segments: impl IntoIterator<Item = [DVec3; 2]>) -> f64 {
    segments.into_iter().map(|segment| distance_to_segment(p, segment)).fold(f64::INFINITY, f64::min)
}

/// The segments between consecutive points.
pub fn open_segments(points: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    points.windows(2).map(|w| [w[0], w[1]])
}

/// The segments between consecutive points, and from the last back to the first.
pub fn closed_segments(points: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    let back = points.last().zip(points.first()).filter(|_| points.len() > 1);
    open_segments(points).chain(back.map(|(&last, &first)| [last, first]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// No point of the segment is nearer, by sampling it.
        #[test]
        fn nothing_is_nearer(x in prop::array::uniform9(-1.0f64..1.0)) {
            let [p, a, b] = [0, 3, 6].map(|i| DVec3::from_slice(&x[i..i + 3]));
            let found = distance_to_segment(p, [a, b]);
            for i in 0..=100 {
                prop_assert!(p.distance(a.lerp(b, f64::from(i) / 100.0)) >= found - 1e-15);
            }
            let (t, place) = closest_on_segment(p, [a, b]);
            prop_assert!((0.0..=1.0).contains(&t) && place.distance(a.lerp(b, t)) < 1e-15);
        }
    }

    #[test]
    fn segments_without_length_and_curves_without_segments() {
        assert_eq!(closest_on_segment(DVec3::X, [DVec3::Y; 2]), (0.0, DVec3::Y));
        assert_eq!(distance_to_segments(DVec3::X, open_segments(&[DVec3::ZERO])), f64::INFINITY);
        assert_eq!(closed_segments(&[DVec3::ZERO]).count(), 0);
        assert_eq!(closed_segments(&[DVec3::ZERO, DVec3::X]).count(), 2);
    }
}
