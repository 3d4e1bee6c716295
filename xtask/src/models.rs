//! The models of fixtures/documents, from nothing: bodies of round cones that melt into each other, a bottle,
//! a ring of scales, and the parts of a teapot.

use crate::Fault;
use fusion::remeshing;
use glam::{DVec2, DVec3};
use lmc_tessellate::isosurface;
use mesh_core::{TriMesh, VertexId, Watch, closest_on_segment, shapes};
use mesh_io::{Format, Model};

/// A ball of changing radius drawn from one point to another, and how far it melts into those before it.
struct Cone {
    ends: [DVec3; 2],
    radii: [f64; 2],
    melt: f64,
}

const fn cone(a: [f64; 3], b: [f64; 3], ra: f64, rb: f64, melt: f64) -> Cone {
    Cone { ends: [DVec3::from_array(a), DVec3::from_array(b)], radii: [ra, rb], melt }
}

/// Every model by name.
pub fn all() -> Result<Vec<(&'static str, TriMesh)>, Fault> {
    let pot = shapes::closed_teapot(12);
    Ok(vec![
        ("dragon", grown(&with_skull(dragon()), 0.055, 0.075)?),
        ("bear", grown(&with_skull(bear()), 0.055, 0.075)?),
        ("bird", grown(&with_skull(bird()), 0.055, 0.075)?),
        ("body", grown(&body(), 0.12, 0.17)?),
        ("bottle", bottle()),
        ("capsule", shapes::capsule(1.0, 4.0, 40, 10, 13)),
        ("torus", shapes::torus(1.0, 0.35, 72, 28)),
        ("scales", scales()),
        ("pot", pot.body),
        ("spout", pot.spout),
        ("handle", pot.handle),
    ])
}

/// The solid's surface, in even triangles.
fn grown(cones: &[Cone], cell: f64, edge: f64) -> Result<TriMesh, Fault> {
    let radius = |c: &Cone| c.radii[0].max(c.radii[1]) + 3.0 * cell;
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for c in cones {
        for p in c.ends {
            (low, high) = (low.min(p - radius(c)), high.max(p + radius(c)));
        }
    }
    let counts = ((high - low) / cell).ceil().to_array().map(|n| n as usize + 1);
    let mut values = Vec::with_capacity(counts.iter().product());
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            values.extend((0..counts[0]).map(|x| depth(cones, low + cell * DVec3::new(x as f64, y as f64, z as f64))));
        }
    }
    let rough = Model::from(isosurface(&values, counts, low, cell));
    let params = remeshing::Params::new(edge, Format::Ply).with_features(180.0);
    Ok(fusion::remesh(&rough, &params, &Watch::default())?.model.mesh)
}

/// Signed distance, nearly: cones in order, each melting into what is there.
fn depth(cones: &[Cone], p: DVec3) -> f64 {
    cones.iter().fold(f64::INFINITY, |so_far, c| {
        let (t, axis) = closest_on_segment(p, c.ends);
        let own = p.distance(axis) - (c.radii[0] + t * (c.radii[1] - c.radii[0]));
        let overlap = (c.melt - (so_far - own).abs()).max(0.0) / c.melt;
        so_far.min(own) - 0.25 * c.melt * overlap * overlap
    })
}

/// The cones and their mirror images in x.
fn both_sides(cones: Vec<Cone>) -> Vec<Cone> {
    let image = |c: &Cone| Cone { ends: c.ends.map(|p| p * DVec3::new(-1.0, 1.0, 1.0)), ..*c };
    cones.into_iter().flat_map(|c| [image(&c), c]).collect()
}

/// A head that looks along z, its neck behind it.
fn with_skull(features: Vec<Cone>) -> Vec<Cone> {
    let skull = [
        cone([0.0, 0.05, -0.1], [0.0, 0.1, 0.25], 0.72, 0.62, 0.1),
        cone([0.0, 0.0, -0.2], [0.0, -0.1, -1.6], 0.62, 0.55, 0.3),
    ];
    skull.into_iter().chain(features).collect()
}

fn dragon() -> Vec<Cone> {
    let mut all = vec![
        cone([0.0, -0.1, 0.5], [0.0, -0.16, 1.3], 0.42, 0.27, 0.3),
        cone([0.0, -0.5, 0.3], [0.0, -0.56, 1.1], 0.26, 0.15, 0.06),
    ];
    all.extend(both_sides(vec![
        cone([0.3, 0.42, 0.5], [0.42, 0.38, 0.7], 0.2, 0.15, 0.15),
        cone([0.3, 0.6, 0.0], [0.62, 1.15, -0.5], 0.22, 0.07, 0.15),
        cone([0.12, 0.04, 1.36], [0.13, 0.06, 1.42], 0.11, 0.1, 0.1),
        cone([0.36, 0.38, 0.84], [0.36, 0.38, 0.86], 0.12, 0.12, 0.02),
    ]));
    all
}

fn bear() -> Vec<Cone> {
    let mut all = vec![
        cone([0.0, -0.2, 0.55], [0.0, -0.25, 0.95], 0.42, 0.34, 0.25),
        cone([0.0, -0.06, 1.24], [0.0, -0.06, 1.28], 0.15, 0.14, 0.05),
        cone([0.0, -0.5, 0.7], [0.0, -0.46, 1.0], 0.2, 0.16, 0.06),
    ];
    all.extend(both_sides(vec![
        cone([0.52, 0.66, 0.0], [0.56, 0.72, 0.0], 0.26, 0.25, 0.08),
        cone([0.27, 0.22, 0.76], [0.27, 0.22, 0.8], 0.12, 0.12, 0.02),
    ]));
    all
}

fn bird() -> Vec<Cone> {
    let mut all = vec![
        cone([0.0, -0.02, 0.6], [0.0, -0.28, 1.5], 0.34, 0.08, 0.2),
        cone([0.0, -0.36, 0.5], [0.0, -0.5, 1.2], 0.2, 0.07, 0.06),
        cone([0.0, 0.7, -0.1], [0.0, 1.15, -0.5], 0.22, 0.08, 0.2),
        cone([0.0, 0.66, 0.2], [0.0, 1.05, 0.0], 0.17, 0.08, 0.15),
    ];
    all.extend(both_sides(vec![
        cone([0.4, 0.22, 0.52], [0.44, 0.22, 0.58], 0.2, 0.2, 0.04),
        cone([0.5, 0.23, 0.72], [0.51, 0.23, 0.74], 0.1, 0.1, 0.02),
    ]));
    all
}

/// A beast of four legs that looks along z, its neck cut off high up.
fn body() -> Vec<Cone> {
    let mut all = vec![
        cone([0.0, 0.0, -0.6], [0.0, 0.1, 1.0], 1.25, 1.1, 0.1),
        cone([0.0, 0.2, 1.2], [0.0, 2.6, 2.1], 0.9, 0.55, 0.6),
        cone([0.0, 2.6, 2.1], [0.0, 4.4, 2.1], 0.55, 0.55, 0.5),
        cone([0.0, 0.0, -1.0], [0.0, -0.35, -3.0], 0.95, 0.45, 0.5),
        cone([0.0, -0.35, -3.0], [0.0, 0.15, -4.8], 0.45, 0.12, 0.3),
    ];
    all.extend(both_sides(vec![
        cone([0.75, -0.3, 0.95], [1.0, -1.3, 1.25], 0.55, 0.4, 0.35),
        cone([1.0, -1.3, 1.25], [1.0, -2.3, 1.1], 0.38, 0.3, 0.15),
        cone([1.0, -2.35, 1.15], [1.05, -2.4, 1.5], 0.34, 0.26, 0.12),
        cone([0.75, -0.2, -0.9], [1.1, -1.1, -0.7], 0.75, 0.48, 0.35),
        cone([1.1, -1.1, -0.7], [1.05, -2.3, -1.05], 0.42, 0.3, 0.15),
        cone([1.05, -2.35, -1.0], [1.1, -2.4, -0.6], 0.36, 0.26, 0.12),
    ]));
    all
}

/// A bottle that stands on the origin, its mouth closed.
fn bottle() -> TriMesh {
    const AROUND: u32 = 48;
    let outline: [[f64; 2]; 9] = [
        [0.0, 0.0],
        [0.75, 0.0],
        [0.9, 0.15],
        [0.9, 1.8],
        [0.82, 2.3],
        [0.5, 2.8],
        [0.42, 3.2],
        [0.42, 3.9],
        [0.0, 3.9],
    ];
    let mut profile: Vec<DVec2> = vec![];
    for w in outline.map(DVec2::from).windows(2) {
        let steps = (w[0].distance(w[1]) / 0.11).ceil();
        profile.extend((0..steps as u32).map(|i| w[0].lerp(w[1], f64::from(i) / steps)));
    }
    let rings = profile.len() as u32 - 1;
    let mut mesh = TriMesh { positions: vec![DVec3::ZERO], faces: vec![] };
    for p in &profile[1..] {
        for k in 0..AROUND {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
            mesh.positions.push(DVec3::new(p.x * cos, p.y, -p.x * sin));
        }
    }
    let top = VertexId::from(mesh.positions.len());
    mesh.positions.push(DVec3::new(0.0, outline[8][1], 0.0));
    let at = |ring: u32, k: u32| VertexId(1 + ring * AROUND + k % AROUND);
    for k in 0..AROUND {
        mesh.faces.push([VertexId(0), at(0, k + 1), at(0, k)]);
        mesh.faces.push([top, at(rings - 1, k), at(rings - 1, k + 1)]);
        for ring in 0..rings - 1 {
            mesh.faces.push([at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)]);
            mesh.faces.push([at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)]);
        }
    }
    mesh
}

/// A ring whose tube is covered with bumps, a source of detail.
fn scales() -> TriMesh {
    const AROUND: u32 = 120;
    const TUBE: u32 = 42;
    let angle = |k: u32, n: u32| std::f64::consts::TAU * f64::from(k) / f64::from(n);
    let mut mesh = TriMesh { positions: vec![], faces: vec![] };
    for (i, j) in (0..AROUND).flat_map(|i| (0..TUBE).map(move |j| (i, j))) {
        let (u, v) = (angle(i, AROUND), angle(j, TUBE));
        let height = 0.35 + 0.02 * (20.0 * u).sin() * (7.0 * v).sin();
        let reach = 1.0 + height * v.cos();
        mesh.positions.push(DVec3::new(reach * u.cos(), reach * u.sin(), height * v.sin()));
        let at = |i: u32, j: u32| VertexId(i % AROUND * TUBE + j % TUBE);
        mesh.faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        mesh.faces.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    mesh
}
