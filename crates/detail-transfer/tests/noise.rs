//! Noise without structure: what is filled in is as rough as the source, at every scale.

use detail_transfer::{Exemplar, Params, Roughness, roughness, transfer};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, FaceMap, Faces, TriMesh, Watch, centroid, dihedral_angle, shapes};
use std::f64::consts::TAU;

/// Evenly distributed in [0, 1), the same ones for the same seed.
fn dice(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn normal(dice: &mut impl FnMut() -> f64) -> f64 {
    (-2.0 * dice().max(f64::MIN_POSITIVE).ln()).sqrt() * (TAU * dice()).cos()
}

/// 64 waves in all directions of space, or of the plane, of about one length; mean square 1.
fn waves(length: f64, seed: u64, flat: bool) -> impl Fn(DVec3) -> f64 {
    let mut dice = dice(seed);
    let mut wave = || {
        let mut along = DVec3::new(normal(&mut dice), normal(&mut dice), normal(&mut dice));
        if flat {
            along.z = 0.0;
        }
        (along.normalize() * TAU / (length * (0.75 + 0.5 * dice())), TAU * dice())
    };
    let waves: Vec<(DVec3, f64)> = (0..64).map(|_| wave()).collect();
    move |p| waves.iter().map(|(k, phase)| (k.dot(p) + phase).sin()).sum::<f64>() / 32f64.sqrt()
}

/// Every vertex on its own, or, blurred, the mean over its one-ring.
fn white(mesh: &TriMesh, seed: u64, blurred: bool) -> Vec<f64> {
    let mut dice = dice(seed);
    let own: Vec<f64> = mesh.positions.iter().map(|_| normal(&mut dice)).collect();
    let connected = Connected::new(mesh).unwrap();
    let mean = |v| {
        let (sum, count) = connected.ring(v).fold((own[v.index()], 1.0), |(sum, count): (f64, f64), h| {
            (sum + own[connected.head(h).index()], count + 1.0)
        });
        sum / count
    };
    if blurred { connected.vertex_ids().map(mean).collect() } else { own }
}

/// A plane of 3 × 2, vertices a little off the grid.
fn plane() -> TriMesh {
    let mut plane = shapes::grid(3.0, 2.0, 120, 80);
    let mut dice = dice(5);
    for p in plane.positions.iter_mut().filter(|p| p.x.abs() < 1.499 && p.y.abs() < 0.999) {
        *p += 0.0125 * DVec3::new(dice() - 0.5, dice() - 0.5, 0.0);
    }
    plane
}

/// Shares of what was measured in what is true of the source.
#[derive(Debug)]
struct Shares {
    variance: f64,
    /// Bands from an eighth of the wavelength to the wavelength.
    bands: [f64; 3],
    /// Dihedral angles across the weld.
    seam: f64,
}

/// Raises `smooth` by `heights` but for the faces `inside`, fills those again, and compares with the rest of the surface.
fn refilled(smooth: &TriMesh, heights: &[f64], round: bool, inside: impl Fn(DVec3) -> bool, wavelength: f64) -> Shares {
    let hole: Vec<bool> =
        smooth.faces.iter().map(|f| inside(centroid(f.map(|v| smooth.positions[v.index()])))).collect();
    let mut kept = vec![false; heights.len()];
    smooth
        .faces
        .iter()
        .zip(&hole)
        .filter(|(_, h)| !**h)
        .for_each(|(f, _)| f.iter().for_each(|v| kept[v.index()] = true));
    let raised = |all: bool| {
        let mut mesh = smooth.clone();
        for ((p, h), kept) in mesh.positions.iter_mut().zip(heights).zip(&kept) {
            let up = if round { p.normalize() } else { DVec3::Z };
            *p += if all || *kept { *h * up } else { DVec3::ZERO };
        }
        Connected::new(mesh).unwrap()
    };
    let (truth, mesh) = (raised(true), raised(false));
    let rest: FaceMap<bool> = hole.iter().map(|h| !h).collect::<Vec<_>>().into();
    let hole: FaceMap<bool> = hole.into();
    let params = Params { wavelength: Some(wavelength), ..Params::default() };
    let done = transfer(&mesh, &hole, &[Exemplar { mesh: &mesh, inside: &rest }], &params, &Watch::default()).unwrap();
    let filled = Connected::new(done.mesh).unwrap();
    let [source, before, after]: [Roughness; 3] =
        [(&truth, &rest), (&mesh, &hole), (&filled, &hole)].map(|(m, r)| roughness(m, r, wavelength / 8.0));
    assert!(before.variance < 0.6 * source.variance, "the hole was not smooth: {before:?}");
    let bands = [0, 1, 2].map(|k| after.bands[k] / source.bands[k]);
    let seam = bend_at_weld(&filled, &hole) / bend_at_weld(&truth, &hole);
    let shares = Shares { variance: after.variance / source.variance, bands, seam };
    println!("{shares:.2?} gains {:.2?} of the variance {:.2?}", done.gains, source.bands.map(|b| b / source.variance));
    shares
}

/// Root mean square dihedral angle over the edges of the region's boundary.
fn bend_at_weld(mesh: &Connected<TriMesh>, inside: &FaceMap<bool>) -> f64 {
    let halfedges = mesh.face_ids().filter(|&f| inside[f]).flat_map(FaceId::halfedges);
    let weld = halfedges.filter(|&h| mesh.twin(h).is_some_and(|t| !inside[t.face()]));
    let angles: Vec<f64> = weld.filter_map(|h| dihedral_angle(mesh, h)).collect();
    (angles.iter().map(|a| a * a).sum::<f64>() / angles.len() as f64).sqrt()
}

fn check(shares: &Shares, band: std::ops::Range<f64>) {
    assert!((0.8..1.2).contains(&shares.variance), "{shares:?}");
    assert!(shares.bands[1..].iter().all(|b| band.contains(b)), "{shares:?}");
    assert!(shares.seam < 1.2, "{shares:?}");
}

#[test]
fn a_noisy_plane_is_filled_as_rough_as_it_was() {
    let smooth = plane();
    let hole = |p: DVec3| p.length() < 0.5;
    for seed in [1, 2, 3] {
        let noise = waves(0.2, seed, true);
        let heights: Vec<f64> = smooth.positions.iter().map(|&p| 0.01 * noise(p)).collect();
        check(&refilled(&smooth, &heights, false, hole, 0.5), 0.6..1.3);
    }
    for blurred in [false, true] {
        let heights: Vec<f64> = white(&smooth, 3, blurred).iter().map(|h| 0.003 * h).collect();
        check(&refilled(&smooth, &heights, false, hole, 0.3), 0.8..1.2);
    }
}

#[test]
fn the_cap_of_a_noisy_ball_is_filled_as_rough_as_the_ball() {
    let smooth = shapes::icosphere(1.0, 5);
    let cap = |p: DVec3| p.z > 0.8;
    for seed in [1, 2, 3] {
        let noise = waves(0.25, seed, false);
        let heights: Vec<f64> = smooth.positions.iter().map(|&p| 0.012 * noise(p)).collect();
        check(&refilled(&smooth, &heights, true, cap, 0.5), 0.6..1.3);
    }
    for blurred in [false, true] {
        let heights: Vec<f64> = white(&smooth, 3, blurred).iter().map(|h| 0.004 * h).collect();
        check(&refilled(&smooth, &heights, true, cap, 0.5), 0.8..1.2);
    }
}
