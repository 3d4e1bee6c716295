//! Fitted fields against what is known of them: constraints, affine functions, spheres, similarity, threads.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use rbf_solve::{Constraint, Error, Field, Kernel, Params, Solver, Thinning, thin};

fn fit(constraints: &[Constraint], kernel: Kernel) -> Result<Field, Error> {
    Field::fit(constraints, &Params { kernel, ..Params::default() }, &|_| true)
}

/// Evenly spread directions.
fn directions(count: usize) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (s, c) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * c, r * s, z)
        })
        .collect()
}

/// A bumpy closed surface with an off-surface constraint beside each point.
fn bumpy(count: usize) -> Vec<Constraint> {
    let on = directions(count).into_iter().map(|d| {
        let p = d * (1.0 + 0.1 * (5.0 * d.x).sin() * (4.0 * d.y).cos());
        [Constraint::on_surface(p), Constraint::off_surface(p + 0.02 * d, 0.02)]
    });
    on.flatten().collect()
}

/// Bands of a sphere around its six poles, in rows of a fixed angular step, as six caps cut off a sphere leave them.
fn six_caps(step: f64, rows: usize) -> Vec<DVec3> {
    let mut points = vec![];
    for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
        let (u, v) = axis.any_orthonormal_pair();
        for row in 0..rows {
            let polar = 0.45 - row as f64 * step;
            let around = (std::f64::consts::TAU * polar.sin() / step).ceil();
            points.extend((0..around as u32).map(|i| {
                let (s, c) = (std::f64::consts::TAU * f64::from(i) / around).sin_cos();
                axis * polar.cos() + (u * c + v * s) * polar.sin()
            }));
        }
    }
    points
}

#[test]
fn constraints_hold_to_1e_8_of_the_box() {
    let constraints = bumpy(400);
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        let field = fit(&constraints, kernel).unwrap();
        let worst = constraints.iter().map(|c| (field.value(c.point) - c.value).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-10, "{kernel:?}: {worst:e}");
        assert!((worst - field.residual()).abs() <= 1e-13, "{worst:e} {:e}", field.residual());
    }
}

#[test]
fn hermite_gradients_hold_to_1e_6_degrees() {
    let constraints: Vec<_> = directions(150)
        .into_iter()
        .map(|d| Constraint::with_normal(d * DVec3::new(2.0, 1.0, 1.0), (d / DVec3::new(2.0, 1.0, 1.0)).normalize()))
        .collect();
    let field = fit(&constraints, Kernel::Triharmonic).unwrap();
    for c in &constraints {
        let normal = c.gradient.unwrap();
        // Not by the arc cosine, which has no digits left at such angles.
        let turn = field.gradient(c.point).cross(normal).length().asin().to_degrees();
        assert!(turn < 1e-6 && field.gradient(c.point).distance(normal) < 1e-8, "{turn:e}");
        assert!(field.value(c.point).abs() < 1e-9);
    }
}

#[test]
fn six_caps_of_a_sphere_rejoin_to_the_sphere() {
    let step: f64 = 0.08;
    let points = six_caps(step, 4);
    let outside = points.iter().map(|&p| Constraint::off_surface(p * (1.0 + 0.1 * step), 0.1 * step));
    let constraints: Vec<_> = points.iter().map(|&p| Constraint::on_surface(p)).chain(outside).collect();
    let field = fit(&constraints, Kernel::Triharmonic).unwrap();
    for d in directions(500) {
        let (mut low, mut high) = (0.5, 1.5);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            *(if field.value(middle * d) < 0.0 { &mut low } else { &mut high }) = middle;
        }
        assert!((low - 1.0).abs() < 1e-3, "{d}: {low}");
    }
}

#[test]
fn values_and_gradients_at_once_have_the_bits_of_each_alone() {
    let mut constraints = bumpy(60);
    for tilted in [false, true] {
        if tilted {
            for c in constraints.iter_mut().step_by(6) {
                c.gradient = Some(c.point);
            }
        }
        let field = fit(&constraints, Kernel::Triharmonic).unwrap();
        let points: Vec<DVec3> = directions(41).into_iter().map(|d| 1.3 * d).collect();
        let (mut values, mut gradients) = (vec![0.0; points.len()], vec![DVec3::ZERO; points.len()]);
        field.values_and_gradients(&points, &mut values, &mut gradients);
        assert!(points.iter().zip(&values).all(|(&p, &v)| field.value(p) == v));
        assert!(points.iter().zip(&gradients).all(|(&p, &g)| field.gradient(p) == g));
    }
}

#[test]
fn gradients_are_those_of_the_values() {
    let mut constraints = bumpy(60);
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        if kernel == Kernel::Triharmonic {
            for c in constraints.iter_mut().step_by(6) {
                c.gradient = Some(c.point);
            }
        }
        let field = fit(&constraints, kernel).unwrap();
        for d in directions(40) {
            let (p, h) = (1.3 * d, 1e-5);
            let slope = DVec3::AXES.map(|a| (field.value(p + h * a) - field.value(p - h * a)) / (2.0 * h));
            let error = field.gradient(p).distance(DVec3::from_array(slope));
            assert!(error < 1e-6, "{kernel:?} {error:e}");
        }
    }
}

#[test]
fn the_biharmonic_field_has_the_values_of_a_plain_sum() {
    // Two centres in one dimension's guise: |x - a| between symmetric data is linear along the axis.
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.3, 0.3, 0.3]];
    let constraints: Vec<_> =
        square.iter().enumerate().map(|(i, &p)| Constraint::off_surface(DVec3::from(p), f64::from(i == 4))).collect();
    let field = fit(&constraints, Kernel::Biharmonic).unwrap();
    // Solved by hand: weights are orthogonal to affine functions, so they are t (-0.1, -0.3, -0.3, -0.3, 1).
    let w = [-0.1, -0.3, -0.3, -0.3, 1.0];
    let s = |x: DVec3| square.iter().zip(w).map(|(&c, w)| w * x.distance(DVec3::from(c))).sum::<f64>();
    let at = square.map(|c| s(DVec3::from(c)));
    let t = 1.0 / (at[4] - (0.1 * at[0] + 0.3 * (at[1] + at[2] + at[3])));
    let x = DVec3::new(0.7, -0.4, 1.9);
    let affine = at[0] * (1.0 - x.x - x.y - x.z) + at[1] * x.x + at[2] * x.y + at[3] * x.z;
    assert!((field.value(x) - t * (s(x) - affine)).abs() < 1e-13);
}

#[test]
fn similar_data_give_similar_fields() {
    let constraints = bumpy(100);
    let turn = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_x(1.1);
    for scale in [1e-25, 37.0, 1e25] {
        let moved = |p: DVec3| scale * (turn * p + DVec3::new(3.0, -2.0, 1.0));
        let posed: Vec<_> =
            constraints.iter().map(|c| Constraint::off_surface(moved(c.point), scale * c.value)).collect();
        let (field, other) =
            (fit(&constraints, Kernel::Triharmonic).unwrap(), fit(&posed, Kernel::Triharmonic).unwrap());
        for d in directions(30) {
            let p = 1.2 * d;
            assert!((field.value(p) - other.value(moved(p)) / scale).abs() < 1e-9);
            assert!((turn * field.gradient(p)).distance(other.gradient(moved(p))) < 1e-8);
        }
    }
}

#[test]
fn bits_do_not_depend_on_threads_or_batches() {
    let constraints = bumpy(300);
    let points = directions(1000);
    let run = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let field = fit(&constraints, Kernel::Triharmonic).unwrap();
            let mut values = vec![0.0; points.len()];
            field.values(&points, &mut values);
            (field, values)
        })
    };
    let (one, two) = (run(1), run(2));
    assert!(one.1.iter().zip(&two.1).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!(points.iter().zip(&one.1).all(|(&p, v)| two.0.value(p).to_bits() == v.to_bits()));
}

/// The iteration has the dense solution for its twin.
#[test]
fn the_iterative_field_is_the_dense_field() {
    let constraints = bumpy(600);
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        let solver = Solver::Iterative { tolerance: 1e-9 };
        let fast = Field::fit(&constraints, &Params { kernel, solver, ..Params::default() }, &|_| true).unwrap();
        let dense = fit(&constraints, kernel).unwrap();
        assert!(fast.residual() <= 2.2e-9, "{kernel:?} {:e}", fast.residual());
        for d in directions(100) {
            let p = 1.03 * d;
            assert!((fast.value(p) - dense.value(p)).abs() < 1e-7, "{kernel:?}");
        }
    }
}

/// Scattered through space, in clusters and alone, as no surface is.
#[test]
fn clouds_are_fitted_iteratively_too() {
    let cloud: Vec<Constraint> = directions(900)
        .iter()
        .enumerate()
        .map(|(i, d)| {
            let p = if i % 3 == 0 { 0.01 * *d } else { *d * (1.0 + (i % 17) as f64 / 10.0) };
            Constraint::off_surface(p, (2.0 * p.x).sin() + p.y * p.z)
        })
        .collect();
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        let params = Params { kernel, solver: Solver::Iterative { tolerance: 1e-6 }, ..Params::default() };
        let field = Field::fit(&cloud, &params, &|_| true).unwrap();
        assert!(cloud.iter().all(|c| (field.value(c.point) - c.value).abs() < 1e-5));
    }
}

#[test]
fn many_constraints_hold_to_1e_8_of_the_box_for_any_number_of_threads() {
    let constraints = bumpy(2020);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fit(&constraints, Kernel::Triharmonic).unwrap())
    };
    let (one, two) = (run(1), run(2));
    for c in constraints.iter().step_by(7) {
        assert!((one.value(c.point) - c.value).abs() <= 2.2e-8);
        assert_eq!(one.value(c.point).to_bits(), two.value(c.point).to_bits());
    }
}

#[test]
fn hopeless_data_are_named() {
    let good = bumpy(30);
    let with = |extra: Constraint| {
        let mut all = good.clone();
        all.push(extra);
        fit(&all, Kernel::Triharmonic)
    };
    assert!(matches!(with(Constraint::on_surface(DVec3::NAN)), Err(Error::NotFinite { index: 60, .. })));
    assert!(matches!(with(Constraint::off_surface(DVec3::X, f64::INFINITY)), Err(Error::NotFinite { index: 60, .. })));
    assert!(with(Constraint::on_surface(DVec3::splat(1e300))).is_err());
    let twice = with(Constraint::off_surface(good[7].point, 5.0));
    assert!(matches!(twice, Err(Error::Contradiction { first: 7, second: 60, .. })), "{twice:?}");
    let slope = fit(&[Constraint::with_normal(DVec3::X, DVec3::X), good[0]], Kernel::Biharmonic);
    assert!(matches!(slope, Err(Error::NoGradient { index: 0, .. })));
    assert!(matches!(fit(&[], Kernel::Triharmonic), Err(Error::Flat { count: 0, .. })));
    assert!(matches!(fit(&good[..1], Kernel::Triharmonic), Err(Error::Flat { count: 1, .. })));
    let flat: Vec<_> = directions(50).iter().map(|d| Constraint::on_surface(d.with_z(0.25))).collect();
    assert!(matches!(fit(&flat, Kernel::Triharmonic), Err(Error::Flat { count: 50, .. })));
    let near = with(Constraint::off_surface(good[8].point + DVec3::X * 1e-9, good[8].value));
    assert!(matches!(near, Ok(_) | Err(Error::Singular { first: 8 | 60, second: 8 | 60, .. })), "{near:?}");
    assert_eq!(Field::fit(&good, &Params::default(), &|_| false).unwrap_err(), Error::Cancelled);
}

#[test]
fn twins_are_merged_into_the_first() {
    let mut constraints = bumpy(50);
    constraints.push(constraints[3]);
    constraints.push(Constraint::on_surface(constraints[10].point + DVec3::splat(1e-4)));
    let params = Params { merge: 1e-3, ..Params::default() };
    let field = Field::fit(&constraints, &params, &|_| true).unwrap();
    assert_eq!(field.merged(), [[100, 3], [101, 10]]);
    assert_eq!(field.centres(), 100);
    assert!(field.value(constraints[10].point).abs() < 1e-11);
}

#[test]
fn thinning_keeps_the_boundary_and_spreads_the_rest() {
    let edge = 0.02;
    let points: Vec<DVec3> = (0..2500).map(|i| DVec3::new(f64::from(i / 50), f64::from(i % 50), 0.0) * edge).collect();
    let boundary: Vec<DVec3> = (0..50).map(|i| points[i]).collect();
    let kept = thin(&points, &boundary, &Thinning::new(edge));
    assert!(kept.windows(2).all(|w| w[0] < w[1]));
    assert!((0..100).all(|i| kept.binary_search(&i).is_ok()), "within 1.5 edges all stay");
    assert!(kept.len() < 1000, "{}", kept.len());
    let rows: Vec<usize> = (0..50).map(|r| kept.iter().filter(|&&i| i / 50 == r).count()).collect();
    assert!(rows[2] > rows[3] && rows[3] >= rows[4], "{rows:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Affine data are reproduced exactly, everywhere.
    #[test]
    fn affine_functions_are_reproduced(
        points in prop::collection::vec(prop::array::uniform3(-5.0..5.0f64), 8..60),
        slope in prop::array::uniform3(-2.0..2.0f64),
        offset in -3.0..3.0f64,
        biharmonic: bool,
    ) {
        let slope = DVec3::from(slope);
        let constraints: Vec<_> = points
            .iter()
            .map(|&p| Constraint::off_surface(DVec3::from(p), slope.dot(DVec3::from(p)) + offset))
            .collect();
        let kernel = if biharmonic { Kernel::Biharmonic } else { Kernel::Triharmonic };
        match fit(&constraints, kernel) {
            Ok(field) => {
                for p in directions(20) {
                    prop_assert!((field.value(9.0 * p) - slope.dot(9.0 * p) - offset).abs() < 1e-7);
                    prop_assert!(field.gradient(9.0 * p).distance(slope) < 1e-7);
                }
            }
            Err(error) => prop_assert!(matches!(error, Error::Singular { .. } | Error::Flat { .. }), "{error}"),
        }
    }

    /// Whatever comes in, nothing panics and what is returned keeps its promise.
    #[test]
    fn any_input_is_survived(
        points in prop::collection::vec((prop::array::uniform3(prop::num::f64::ANY), prop::num::f64::ANY), 0..12),
    ) {
        let constraints: Vec<_> =
            points.iter().map(|&(p, v)| Constraint::off_surface(DVec3::from(p), v)).collect();
        if let Ok(field) = fit(&constraints, Kernel::Triharmonic) {
            prop_assert!(field.residual().is_finite());
        }
    }
}

/// Thousands of points in a tight band leave the iteration nothing to gain; what dense memory can hold is solved there.
#[test]
fn a_tight_band_is_solved_densely() {
    let turn = |i: u32| (std::f64::consts::TAU * f64::from(i) / 1050.0).sin_cos();
    let constraints: Vec<Constraint> = [-0.4, 0.4]
        .into_iter()
        .flat_map(|z| (0..1050).map(move |i| (DVec3::new(turn(i).1, turn(i).0, 0.0), z)))
        .flat_map(|(d, z)| {
            let at = d + z * DVec3::Z;
            [Constraint::on_surface(at), Constraint::off_surface(at + 1e-5 * d, 1e-5)]
        })
        .collect();
    let fit = |solver| Field::fit(&constraints, &Params { solver, ..Params::default() }, &|_| true);
    let iterative = fit(Solver::Iterative { tolerance: Solver::TOLERANCE });
    assert!(matches!(iterative, Err(Error::NotConverged { .. })), "{:?}", iterative.map(|f| f.residual()));
    let field = fit(Solver::Auto).unwrap();
    assert!(field.residual() < 1e-8, "{:e}", field.residual());
}
