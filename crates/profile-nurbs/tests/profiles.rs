//! Profiles and sweeps against the circle, the torus and their own definitions.

use glam::{DQuat, DVec3};
use profile_nurbs::{Error, Nurbs, Profile, Section, Sweep};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// A ball of radius `r` in some pose, with feet an angle φ apart.
fn ball(r: f64, phi: f64, turn: f64) -> (DVec3, Section) {
    let center = r * DVec3::new(3.0, -2.0, 5.0);
    let pose = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), turn);
    let foot = |angle: f64| center + r * (pose * DVec3::new(angle.cos(), angle.sin(), 0.0));
    (center, Section::from_ball(center, foot(-0.5 * phi), foot(0.5 * phi)).unwrap())
}

fn sampled(profile: &Profile, s: &Section, count: usize) -> Vec<DVec3> {
    let mut points = vec![];
    profile.points(s, count, &mut points);
    assert_eq!((points.len(), points[0], points[count]), (count + 1, s.p1, s.p2));
    points
}

fn unevenness(points: &[DVec3]) -> f64 {
    let chords: Vec<_> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
    chords.iter().copied().fold(0.0, f64::max) / chords.iter().copied().fold(f64::INFINITY, f64::min)
}

proptest! {
    #[test]
    fn the_arc_is_exact_for_every_angle(log_r in -30f64..30.0, phi in 1e-3f64..PI - 1e-4, turn in 0.0f64..6.0) {
        let r = log_r.exp();
        let (center, s) = ball(r, phi, turn);
        let curve = Profile::Arc.curve(&s);
        let dense = (0..=50).map(|i| curve.point(f64::from(i) / 50.0));
        for p in dense.chain(sampled(&Profile::Arc, &s, 13)) {
            // The centre is 6 r from the origin: coordinates round at that size.
            prop_assert!((p.distance(center) / r - 1.0).abs() < 1e-14, "{}", p.distance(center) / r - 1.0);
        }
        prop_assert!(unevenness(&sampled(&Profile::Arc, &s, 13)) < 1.0 + 1e-9);
        prop_assert!((s.angle() - phi).abs() < 1e-9 && (s.arc_weight() - (0.5 * phi).cos()).abs() < 1e-9);
    }

    /// The paper's own formula for the apex, where it keeps its digits.
    #[test]
    fn the_apex_is_the_papers(phi in 0.1f64..2.5, turn in 0.0f64..6.0) {
        let (p, s) = ball(1.0, phi, turn);
        let apex = (phi.cos() - 1.0) / (phi.cos() + 1.0) * p + (s.p1 + s.p2) / (phi.cos() + 1.0);
        prop_assert!(apex.distance(s.p0) < 1e-12);
        let general = Section::from_tangents(s.p1, s.p1 - p, s.p2, p - s.p2).unwrap();
        prop_assert!(general.p0.distance(s.p0) < 1e-12);
    }

    /// Skew feet: the apex lies in both tangent planes and no point of both is nearer to the chord's middle.
    #[test]
    fn tangent_planes_meet_in_the_apex(v in prop::array::uniform12(-1.0f64..1.0), shift in -1.0f64..1.0) {
        let at = |i: usize| DVec3::new(v[i], v[i + 1], v[i + 2]);
        let (p1, n1, p2, n2) = (at(0), at(3), at(6), at(9));
        prop_assume!(n1.cross(n2).length() > 0.1);
        let s = Section::from_tangents(p1, n1, p2, n2).unwrap();
        prop_assert!((s.p0 - p1).dot(n1).abs() < 1e-12 && (s.p0 - p2).dot(n2).abs() < 1e-12);
        let middle = 0.5 * (p1 + p2);
        let other = s.p0 + shift * n1.cross(n2);
        prop_assert!(other.distance(middle) >= s.p0.distance(middle) - 1e-12);
    }

    #[test]
    fn every_profile_joins_the_feet_evenly(phi in 0.2f64..2.2, w in 0.0f64..3.0, stretch in 0.5f64..2.0) {
        let (_, mut s) = ball(1.0, phi, 0.4);
        s.p2 = s.p0.lerp(s.p2, stretch);
        for profile in [Profile::Arc, Profile::Chamfer, Profile::Conic(w), Profile::Hermite, Profile::G2] {
            let points = sampled(&profile, &s, 24);
            // Steps are equal along the curve; chords across a tight bend are shorter than that.
            let even = unevenness(&points);
            prop_assert!(even < 1.25, "{profile:?} {even}");
            // Samples lie on the curve that `curve` returns: compare with its closest of many points.
            let curve = profile.curve(&s);
            let dense: Vec<_> = (0..=4000).map(|i| curve.point(f64::from(i) / 4000.0)).collect();
            let gap = dense.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
            for p in points {
                let nearest = dense.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= 0.51 * gap, "{profile:?} {nearest} {gap}");
            }
        }
    }
}

#[test]
fn conics_run_from_chamfer_to_sharp() {
    let (_, s) = ball(2.0, 1.3, 0.7);
    let middle = |p: &Profile| p.curve(&s).point(0.5);
    assert!(middle(&Profile::Conic(0.0)).distance(0.5 * (s.p1 + s.p2)) < 1e-15);
    assert_eq!(Profile::Conic(1.0).curve(&s), Profile::Arc.curve(&s));
    assert_eq!(middle(&Profile::Conic(f64::INFINITY)), s.p0);
    assert!(middle(&Profile::Conic(1e9)).distance(s.p0) < 1e-8);
    assert_eq!(Profile::Conic(f64::NAN).curve(&s), Profile::Chamfer.curve(&s));
    let height = |p: Profile| p.reach(&s);
    let rising = [0.0, 0.5, 1.0, 2.0, 9.0].map(|w| height(Profile::Conic(w)));
    assert!(rising.is_sorted() && height(Profile::Sharp) == 1.0 && height(Profile::Chamfer) == 0.0);
    // Twice the arc's weight, as in the paper's figure: the definition of the rational quadratic, term by term.
    let (w, curve) = (2.0 * (0.65f64).cos(), Profile::Conic(2.0).curve(&s));
    for u in [0.1, 0.37, 0.5, 0.8] {
        let [a, b, c] = [(1.0 - u) * (1.0 - u), 2.0 * w * u * (1.0 - u), u * u];
        assert!(curve.point(u).distance((a * s.p1 + b * s.p0 + c * s.p2) / (a + b + c)) < 1e-13);
    }
    for p in [Profile::Arc, Profile::Hermite, Profile::G2, Profile::Conic(0.3), Profile::Sharp] {
        let apex_share = p.curve(&s).point(0.5).distance(0.5 * (s.p1 + s.p2)) / s.p0.distance(0.5 * (s.p1 + s.p2));
        assert!((apex_share - p.reach(&s)).abs() < 1e-13, "{p:?}");
    }
}

#[test]
fn the_sharp_edge_keeps_its_corner() {
    let (_, mut s) = ball(1.0, 2.0, 0.0);
    s.p2 = s.p0.lerp(s.p2, 3.0);
    for count in 2..9 {
        let points = sampled(&Profile::Sharp, &s, count);
        assert_eq!(points.iter().filter(|&&p| p == s.p0).count(), 1);
        assert!(points.iter().position(|&p| p == s.p0).unwrap() <= count / 2);
    }
    assert_eq!(sampled(&Profile::Sharp, &s, 1), [s.p1, s.p2]);
}

/// How far a profile is from the ball, as a share of its radius.
fn deviation(profile: &Profile, phi: f64) -> f64 {
    let (center, s) = ball(1.0, phi, 0.3);
    let curve = profile.curve(&s);
    (0..=1000).map(|i| (curve.point(f64::from(i) / 1000.0).distance(center) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn the_stand_ins_stay_near_the_arc() {
    assert!(deviation(&Profile::Hermite, FRAC_PI_2) < 3e-4);
    let g2 = [PI / 6.0, PI / 3.0, FRAC_PI_2, 2.0 * PI / 3.0].map(|phi| deviation(&Profile::G2, phi));
    assert!(g2.is_sorted() && g2[2] < 0.038, "{g2:?}");
}

#[test]
fn g2_leaves_the_legs_without_curvature_or_turning_back() {
    for phi in [0.3, 1.0, FRAC_PI_2, 2.5] {
        let (_, s) = ball(1.0, phi, 1.1);
        let curve = Profile::G2.curve(&s);
        let curvature = |u: f64| {
            let d = curve.derivatives(u, 2);
            d[1].cross(d[2]).length() / d[1].length().powi(3)
        };
        for (u, foot) in [(0.0, s.p1), (1.0, s.p2)] {
            assert!(curvature(u) < 1e-12);
            assert!(curve.derivatives(u, 1)[1].normalize().cross((s.p0 - foot).normalize()).length() < 1e-13);
        }
        let rise: Vec<_> = (0..=50).map(|i| curvature(f64::from(i) / 100.0)).collect();
        let peak = rise.iter().copied().fold(0.0, f64::max);
        assert!(peak < 1.2 && rise[50] > 0.85 * peak && rise[..20].is_sorted(), "{phi}: {rise:?}");
    }
}

/// The ends take the surfaces' curvatures, both of them and with their signs; with those of the ball the quintic is nearly
/// the arc.
#[test]
fn g2_continues_the_curvature_of_its_surfaces() {
    for bends in [[0.4, 0.0], [-1.5, 0.3], [-0.7, -2.0]] {
        for phi in [0.3, 1.0, FRAC_PI_2, 2.5] {
            let (center, s) = ball(1.0, phi, 1.1);
            let s = Section { bends, ..s };
            let curve = Profile::G2.curve(&s);
            for (k, (u, foot)) in [(0.0, s.p1), (1.0, s.p2)].into_iter().enumerate() {
                let d = curve.derivatives(u, 2);
                let towards = (center - foot).normalize();
                let curvature = d[2].reject_from(d[1]).dot(towards) / d[1].length_squared();
                assert!((curvature - bends[k]).abs() < 1e-11, "{phi}: {curvature} {bends:?}");
            }
            let middle = curve.point(0.5);
            let chord = s.p1.midpoint(s.p2);
            let share = (middle - chord).dot(s.p0 - chord) / (s.p0 - chord).length_squared();
            assert!((share - Profile::G2.reach(&s)).abs() < 1e-13);
        }
    }
    let (center, s) = ball(1.0, FRAC_PI_2, 0.3);
    let curve = Profile::G2.curve(&Section { bends: [1.0; 2], ..s });
    assert!((0..=100).all(|i| (curve.point(f64::from(i) / 100.0).distance(center) - 1.0).abs() < 0.01));
}

#[test]
fn custom_profiles_live_in_the_feet_frame() {
    let arc = |w: f64| Nurbs::bezier(&[DVec3::X, DVec3::ZERO, DVec3::Y], &[1.0, w, 1.0]).unwrap();
    let (center, s) = ball(1.0, 1.0, 0.2);
    let custom = Profile::custom(arc(0.5f64.cos())).unwrap();
    for p in sampled(&custom, &s, 9) {
        assert!((p.distance(center) - 1.0).abs() < 1e-14);
    }
    assert!((custom.reach(&s) - Profile::Arc.reach(&s)).abs() < 1e-14);
    let shifted = Nurbs::bezier(&[DVec3::X, DVec3::ZERO, DVec3::Z], &[1.0; 3]).unwrap();
    assert_eq!(Profile::custom(shifted), Err(Error::CustomFrame { point: DVec3::Z }));
}

#[test]
fn impossible_sections_are_refused() {
    let c = DVec3::ZERO;
    assert!(matches!(Section::from_ball(c, DVec3::X, -DVec3::X), Err(Error::NoApex { .. })));
    assert!(matches!(Section::from_ball(c, DVec3::X, DVec3::X), Err(Error::NoApex { .. })));
    assert!(matches!(Section::from_ball(c, DVec3::X, 2.0 * DVec3::Y), Err(Error::UnequalRadii { second: 2.0, .. })));
    assert!(matches!(Section::from_ball(c, DVec3::X, DVec3::NAN), Err(Error::NotFinite { index: 2, .. })));
    assert!(matches!(Section::from_tangents(c, DVec3::X, DVec3::Y, -DVec3::X), Err(Error::NoApex { .. })));
    assert!(matches!(Section::from_tangents(c, DVec3::ZERO, DVec3::Y, DVec3::X), Err(Error::NoApex { .. })));
}

#[test]
fn reach_moves_the_apex_to_the_stated_distance() {
    let (center, s) = ball(0.5, 1.9, 0.0);
    let far = s.with_reach(center, 2.4);
    assert!((far.p0.distance(center) - 1.2).abs() < 1e-14);
    assert!((far.p0 - center).cross(s.p0 - center).length() < 1e-14 && (far.p1, far.p2) == (s.p1, s.p2));
}

/// The ball between a plate and an upright cylinder: the sweep of arcs approaches a torus as the square of the step.
#[test]
fn the_sweep_of_arcs_converges_to_the_torus() {
    let (major, minor) = (3.0, 1.0);
    let worst = |n: u32| {
        let at = |i: u32| 2.0 * PI * f64::from(i) / f64::from(n);
        let arc = |i: u32| {
            let out = DVec3::new(at(i).cos(), at(i).sin(), 0.0);
            let c = major * out + minor * DVec3::Z;
            Profile::Arc.curve(&Section::from_ball(c, c - minor * out, c - minor * DVec3::Z).unwrap())
        };
        let sweep = Sweep::new((0..=n).map(at).collect(), (0..=n).map(arc).collect()).unwrap();
        let mut worst = 0.0f64;
        for i in 0..97 {
            for j in 0..=10 {
                let p = sweep.point(2.0 * PI * f64::from(i) / 96.0, f64::from(j) / 10.0);
                let ring = (p.truncate().length() - major).hypot(p.z - minor);
                worst = worst.max((ring - minor).abs());
            }
        }
        worst
    };
    let errors = [7, 14, 28].map(worst);
    assert!(errors[0] / errors[1] > 3.5 && errors[1] / errors[2] > 3.5, "{errors:?}");
}

#[test]
fn sweep_derivatives_match_differences() {
    let section = |x: f64| Section {
        p1: DVec3::new(x, 0.0, x * x),
        p0: DVec3::new(x, 1.0, 0.0),
        p2: DVec3::new(x, 1.0, 1.0 + x),
        bends: [0.0, 0.1 * x],
    };
    let profiles = [Profile::Arc, Profile::Conic(2.0), Profile::G2];
    let curves = profiles.iter().zip([0.0, 1.0, 3.0]).map(|(p, x)| p.curve(&section(x))).collect();
    let sweep = Sweep::new(vec![0.0, 1.0, 3.0], curves).unwrap();
    let h = 1e-5;
    for (t, u) in [(0.3, 0.2), (0.9, 0.7), (1.4, 0.6), (2.9, 0.1)] {
        let d = sweep.derivatives(t, u);
        let slope = |a: DVec3, b: DVec3| (a - b) / (2.0 * h);
        assert!(d.point.distance(sweep.point(t, u)) < 1e-14);
        assert!(d.along.distance(slope(sweep.point(t + h, u), sweep.point(t - h, u))) < 1e-8);
        assert!(d.across.distance(slope(sweep.point(t, u + h), sweep.point(t, u - h))) < 1e-8);
        let (up, down) = (sweep.derivatives(t, u + h), sweep.derivatives(t, u - h));
        assert!(d.twist.distance(slope(up.along, down.along)) < 1e-8);
        assert!(d.bend.distance(slope(up.across, down.across)) < 1e-7);
        assert!(d.normal().dot(d.along).abs() < 1e-14);
    }
    assert_eq!(sweep.point(-9.0, 0.0), sweep.point(0.0, 0.0));
    assert_eq!(sweep.point(9.0, 2.0), sweep.curves()[2].point(1.0));
    let twice = vec![Profile::Arc.curve(&section(0.0)); 2];
    assert!(matches!(Sweep::new(vec![0.0, 0.0], twice), Err(Error::Sweep { index: 1, .. })));
}
