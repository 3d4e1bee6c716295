//! Roundings taken back, against the solids they were made from.

use fusion::sharpen::{Params, Refusal, sharpen};
use fusion::{Choice, Error, Outcome, blend, features, join, round};
use glam::{DQuat, DVec3};
use mesh_core::{TriMesh, VertexId, Watch, shapes, volume};
use mesh_io::{Format, Model};
use std::f64::consts::FRAC_PI_2;

/// The edges of `mesh` nearest to the places, or all, rounded.
fn rounded(mesh: TriMesh, near: &[DVec3], radius: f64) -> Model {
    let params = round::Params {
        features: features::Params::default(),
        choice: Choice { near: near.iter().map(|&p| p.into()).collect(), ..Choice::default() },
        blend: blend::Params::new(radius),
        format: Format::Off,
    };
    round::round(&mesh.into(), &params, &Watch::default()).unwrap().model
}

fn sharp(model: &Model, near: &[DVec3], radius: Option<f64>) -> Result<Outcome, Error> {
    let params = Params { near: near.to_vec(), radius, angle: 40.0, format: Format::Off };
    sharpen(model, &params, &Watch::default())
}

/// How far a point is from the surface of a cuboid about the origin.
fn off(p: DVec3, half: DVec3) -> f64 {
    let q = p.abs() - half;
    (q.max(DVec3::ZERO).length() + q.max_element().min(0.0)).abs()
}

/// One edge, then four parallel ones: the block comes back with its corners, and what was not rounded keeps its bits.
#[test]
fn a_block_comes_back() {
    let (size, r) = (DVec3::new(2.0, 1.5, 1.0), 0.2);
    let half = 0.5 * size;
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -0.5, 0.7));
    for count in [1, 4] {
        let signs = &[[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]][..count];
        let edges: Vec<DVec3> = signs.iter().map(|s| DVec3::new(0.1, s[0] * half.y, s[1] * half.z)).collect();
        let block = shapes::cuboid(size);
        let mut model = rounded(block.clone(), &edges, r);
        assert!(volume(&model.mesh) < 3.0 - 0.008 * count as f64);
        // The middles of the roundings, in a frame with nothing along its axes.
        let middle = |e: &DVec3| turn * (*e - (1.0 - 0.5f64.sqrt()) * r * DVec3::new(0.0, e.y.signum(), e.z.signum()));
        let near: Vec<DVec3> = edges.iter().map(middle).collect();
        model.mesh = shapes::posed(model.mesh, turn, DVec3::ZERO);
        let back = sharp(&model, &near, None).unwrap();
        assert_eq!(back.report.figures["sharpened"], count as f64);
        let mesh = &back.model.mesh;
        assert!((volume(mesh) - 3.0).abs() < 1e-13, "{}", volume(mesh));
        let at = |p: &DVec3| turn.inverse() * *p;
        assert!(mesh.positions.iter().map(at).all(|p| off(p, half) < 1e-14));
        for corner in &block.positions {
            assert!(mesh.positions.iter().any(|p| at(p).distance(*corner) < 1e-14), "{corner}");
        }
        let bits = |m: &TriMesh| m.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        let kept = back.report.kept_vertices;
        assert!(kept > 8 && kept < mesh.positions.len());
        let before: std::collections::BTreeSet<_> = bits(&model.mesh).into_iter().collect();
        assert!(bits(mesh)[..kept].iter().all(|p| before.contains(p)));
    }
}

/// A fillet all round, in a valley: the post stands on the plate again. Along straight lines the sides are prolonged
/// exactly, so that only the post's facets, cut by the fillet's border, are not quite those of before.
#[test]
fn a_post_stands_on_its_plate_again() {
    let plate = shapes::posed(shapes::cuboid(DVec3::new(4.0, 4.0, 1.0)), DQuat::IDENTITY, DVec3::NEG_Z * 0.5);
    let post = shapes::posed(shapes::cylinder(1.0, 2.0, 48, 2), DQuat::IDENTITY, DVec3::new(0.01, 0.02, 0.25));
    let parts = [Model::from(plate), Model::from(post)];
    let joined = |blend| {
        let params = join::Params {
            operation: fusion::Operation::Union,
            blend,
            seams: join::SeamChoice::default(),
            format: Format::Off,
        };
        fusion::join(&parts, &params, &Watch::default()).unwrap().model
    };
    let (plain, filleted) = (joined(None), joined(Some(blend::Params::new(0.2))));
    let place = DVec3::new(1.068, 0.02, 0.058);
    for radius in [None, Some(0.2), Some(0.25)] {
        let back = sharp(&filleted, &[place], radius).unwrap().model.mesh;
        let [was, filled, is] = [&plain.mesh, &filleted.mesh, &back].map(volume);
        assert!((is - was).abs() < 2e-3 * (filled - was), "{was} {filled} {is}");
    }
}

/// An outline, all of which its first point sees, drawn out from z = 0 to 1.
fn prism(outline: &[[f64; 2]]) -> Model {
    let n = outline.len() as u32;
    let level = |z: f64| outline.iter().map(move |p| DVec3::new(p[0], p[1], z)).collect::<Vec<_>>();
    let caps = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
    let wall = |i: u32| [[i, (i + 1) % n, n + (i + 1) % n], [i, n + (i + 1) % n, n + i]];
    let faces = caps.chain((0..n).flat_map(wall)).map(|f| f.map(VertexId)).collect::<Vec<_>>();
    TriMesh { positions: [level(0.0), level(1.0)].concat(), faces }.into()
}

#[test]
fn what_cannot_be_sharpened_says_why() {
    let all = rounded(shapes::cuboid(DVec3::ONE), &[], 0.1);
    let on_edge = DVec3::new(0.0, 0.47, 0.47);
    let refusal = |result: Result<Outcome, Error>| match result {
        Err(Error::Sharpen(refusal)) => refusal,
        other => panic!("{:?}", other.map(|o| o.report)),
    };
    let met = refusal(sharp(&all, &[on_edge], None));
    assert!(matches!(met, Refusal::NotABand { loops: 6, .. }) && met.to_string().contains("corners"), "{met:?}");
    let flat = DVec3::new(0.01, 0.02, 0.5);
    assert_eq!(refusal(sharp(&all, &[flat], None)), Refusal::NotRounded { at: flat });
    let plain = shapes::cuboid(DVec3::ONE).into();
    assert!(matches!(refusal(sharp(&plain, &[flat], Some(0.1))), Refusal::NotRounded { .. }));
    // The inner edge of a bracket, rounded from end to end.
    let arc = (0..=8).map(|k| {
        let (sin, cos) = (FRAC_PI_2 * f64::from(k) / 8.0).sin_cos();
        [0.7 - 0.2 * sin, 0.7 - 0.2 * cos]
    });
    let outline: Vec<_> =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]].into_iter().chain(arc).chain([[0.5, 1.0], [0.0, 1.0]]).collect();
    let inner = DVec3::new(0.555, 0.555, 0.5);
    assert!(matches!(refusal(sharp(&prism(&outline), &[inner], None)), Refusal::OpenValley { .. }));
    // A picked place that is not a number.
    assert!(sharp(&all, &[DVec3::NAN], None).is_err() && sharp(&all, &[on_edge], Some(f64::NAN)).is_err());
}
