//! Curves against independent truth: de Casteljau, the basis recursion, finite differences, the circle.

use glam::DVec3;
use profile_nurbs::{Error, Nurbs};
use proptest::prelude::*;

/// Cox–de Boor basis functions by plain recursion, which shares nothing with the triangle in the crate.
fn basis(knots: &[f64], i: usize, p: usize, u: f64) -> f64 {
    if p == 0 {
        let last = knots[knots.len() - 1];
        let inside = knots[i] <= u && u < knots[i + 1] || u == last && knots[i] < last && knots[i + 1] == last;
        return f64::from(u8::from(inside));
    }
    let part = |num: f64, den: f64, b: f64| if den > 0.0 { num / den * b } else { 0.0 };
    part(u - knots[i], knots[i + p] - knots[i], basis(knots, i, p - 1, u))
        + part(knots[i + p + 1] - u, knots[i + p + 1] - knots[i + 1], basis(knots, i + 1, p - 1, u))
}

fn by_basis(curve: &Nurbs, u: f64) -> DVec3 {
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for (i, (p, w)) in curve.control_points().zip(curve.weights()).enumerate() {
        let b = w * basis(curve.knots(), i, curve.degree(), u);
        sum += b * p;
        weight += b;
    }
    sum / weight
}

/// Random clamped or open curves of degree 1 to 5, some with repeated knots.
fn curve() -> impl Strategy<Value = Nurbs> {
    (1usize..6, 0usize..6, any::<bool>())
        .prop_flat_map(|(p, extra, clamped)| {
            let n = p + 1 + extra;
            let steps = prop::collection::vec(0u8..3, n + p);
            let points = prop::collection::vec(prop::array::uniform3(-1.0f64..1.0), n);
            let weights = prop::collection::vec(0.3f64..3.0, n);
            (Just((p, clamped)), steps, points, weights)
        })
        .prop_filter_map("knots repeat too often", |((p, clamped), steps, points, weights)| {
            let mut knots = vec![0.0];
            for s in steps {
                knots.push(knots[knots.len() - 1] + f64::from(s));
            }
            if clamped {
                let (n, low) = (points.len(), knots[p]);
                let high = knots[n];
                knots = knots.iter().map(|k: &f64| k.clamp(low, high)).collect();
            }
            let points: Vec<_> = points.into_iter().map(DVec3::from).collect();
            Nurbs::new(p, &knots, &points, &weights).ok()
        })
}

fn along(c: &Nurbs) -> impl Iterator<Item = f64> {
    let [a, b] = c.domain();
    (0..=20).map(move |i| if i == 20 { b } else { a + (b - a) * f64::from(i) / 20.0 })
}

proptest! {
    #[test]
    fn evaluation_is_the_sum_over_the_basis(c in curve()) {
        for u in along(&c).filter(|&u| u < c.domain()[1]) {
            prop_assert!(c.point(u).distance(by_basis(&c, u)) < 1e-12);
        }
    }

    #[test]
    fn refinement_keeps_the_curve(c in curve(), at in 0.05f64..0.95, times in 1usize..4) {
        let [a, b] = c.domain();
        let u = a + at * (b - a);
        let finer = c.with_knot(u, times);
        prop_assert!(Nurbs::new(c.degree(), finer.knots(), &finer.control_points().collect::<Vec<_>>(), &finer.weights().collect::<Vec<_>>()).is_ok());
        let [left, right] = c.split(u).unwrap();
        prop_assert_eq!((left.domain(), right.domain()), ([a, u], [u, b]));
        let pieces = c.beziers();
        for v in along(&c) {
            let truth = c.point(v);
            prop_assert!(finer.point(v).distance(truth) < 1e-11);
            let half = if v < u { &left } else { &right };
            prop_assert!(half.point(v).distance(truth) < 1e-11);
            let piece = pieces.iter().find(|p| v <= p.domain()[1]).unwrap();
            prop_assert!(piece.point(v).distance(truth) < 1e-10, "{} {}", piece.point(v), truth);
            prop_assert_eq!(piece.control_points().len(), c.degree() + 1);
        }
    }

    #[test]
    fn derivatives_match_finite_differences(c in curve(), at in 0.0f64..1.0) {
        // Within one polynomial piece, where the curve is smooth.
        let pieces = c.beziers();
        let piece = &pieces[(at * pieces.len() as f64) as usize % pieces.len()];
        let [a, b] = piece.domain();
        let (u, h) = (a + (b - a) * (0.2 + 0.6 * at), 1e-4 * (b - a));
        let d = c.derivatives(u, 4);
        prop_assert!(d[0].distance(c.point(u)) < 1e-12);
        for k in 0..3 {
            let slope = (c.derivatives(u + h, 3)[k] - c.derivatives(u - h, 3)[k]) / (2.0 * h);
            let scale = 1.0 + d[k + 1].length() + c.derivatives(a, 4)[..=4].iter().map(|v| v.length()).fold(0.0, f64::max);
            prop_assert!(slope.distance(d[k + 1]) < 1e-4 * scale, "{k}: {slope} {}", d[k + 1]);
        }
    }
}

#[test]
fn a_bezier_is_de_casteljau() {
    let points: Vec<_> =
        (0..17).map(|i: i32| DVec3::new(f64::from(i * i % 7), f64::from(i % 5), f64::from(i % 3))).collect();
    let curve = Nurbs::bezier(&points, &[1.0; 17]).unwrap();
    for u in along(&curve) {
        let mut q = points.clone();
        while q.len() > 1 {
            q = q.windows(2).map(|w| w[0].lerp(w[1], u)).collect();
        }
        assert!(curve.point(u).distance(q[0]) < 1e-12);
    }
}

/// The nine-point circle: constant distance, and the osculating circle of its derivatives is itself.
#[test]
fn the_rational_quadratic_circle_is_exact() {
    let w = 0.5f64.sqrt();
    let square = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let points = square.map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0));
    let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let circle = Nurbs::new(2, &knots, &points, &[1.0, w, 1.0, w, 1.0, w, 1.0, w, 1.0]).unwrap();
    for u in along(&circle) {
        assert!((circle.point(u).length() - 1.0).abs() < 1e-15);
        let d = circle.derivatives(u, 2);
        assert!(d[1].dot(d[0]).abs() < 1e-14);
        assert!((d[1].cross(d[2]).length() / d[1].length().powi(3) - 1.0).abs() < 1e-13);
    }
}

#[test]
fn unsound_curves_are_refused_with_the_offender() {
    let p = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let make = |knots: &[f64], weights: &[f64]| Nurbs::new(2, knots, &p, weights);
    assert!(matches!(make(&[0.0, 0.0, 1.0, 1.0], &[1.0; 3]), Err(Error::Counts { knots: 4, .. })));
    assert!(matches!(make(&[0.0, 0.0, 0.0, 1.0, 0.5, 1.0], &[1.0; 3]), Err(Error::Knot { index: 4, .. })));
    assert!(matches!(make(&[0.0, 0.0, 0.0, 0.0, 1.0, 1.0], &[1.0; 3]), Err(Error::Knot { .. })));
    assert!(matches!(make(&[0.0, 0.0, f64::NAN, 1.0, 1.0, 1.0], &[1.0; 3]), Err(Error::Knot { index: 2, .. })));
    assert!(matches!(
        make(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &[1.0, f64::NAN, 1.0]),
        Err(Error::Weight { index: 1, .. })
    ));
    assert!(matches!(Nurbs::bezier(&[], &[]), Err(Error::Counts { .. })));
    assert!(matches!(Nurbs::bezier(&[DVec3::NAN, DVec3::X], &[1.0; 2]), Err(Error::NotFinite { index: 0, .. })));
    assert!(Nurbs::bezier(&p, &[1.0; 3]).unwrap().point(f64::NAN).is_nan());
}
