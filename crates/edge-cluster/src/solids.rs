//! Polyhedra for tests and fixtures: the regular and semiregular solids, and the models of \[EdgeCluster2019\] by their
//! combinatorics.

use glam::DVec3;
use mesh_core::{TriMesh, VertexId};
use std::f64::consts::TAU;

/// A polyhedron as its polygons, with the clusters its source names.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Corner points.
    pub positions: Vec<DVec3>,
    /// Convex polygons, counter-clockwise seen from outside.
    pub polygons: Vec<Vec<u32>>,
    /// Vertices of each cluster, where the source says; otherwise empty.
    pub clusters: Vec<Vec<u32>>,
}

impl Solid {
    /// Triangle fans over the polygons, and the polygon of each triangle.
    pub fn triangles(&self) -> (TriMesh, Vec<u32>) {
        let mut mesh = TriMesh { positions: self.positions.clone(), faces: vec![] };
        let mut of = vec![];
        for (p, polygon) in (0..).zip(&self.polygons) {
            for w in polygon[1..].windows(2) {
                mesh.faces.push([polygon[0], w[0], w[1]].map(VertexId));
                of.push(p);
            }
        }
        (mesh, of)
    }

    /// Quadrilaterals and caps between rings of `sides` points each, from the lowest up.
    fn stack(rings: &[Vec<DVec3>]) -> Self {
        let n = rings[0].len() as u32;
        let mut solid = Self { positions: rings.concat(), ..Self::default() };
        solid.polygons.push((0..n).rev().collect());
        for r in 0..rings.len() as u32 - 1 {
            for i in 0..n {
                let (a, b) = (r * n + i, r * n + (i + 1) % n);
                solid.polygons.push(vec![a, b, b + n, a + n]);
            }
        }
        let top = (rings.len() as u32 - 1) * n;
        solid.polygons.push((top..top + n).collect());
        solid
    }
}

fn ring(sides: usize, radius: f64, height: f64, turn: f64) -> Vec<DVec3> {
    let at = |i: usize| TAU * (i as f64 + turn) / sides as f64;
    (0..sides).map(|i| DVec3::new(radius * at(i).cos(), radius * at(i).sin(), height)).collect()
}

/// The body of a blood pressure meter: a hexahedron with a sloping top, and four {2+4} clusters along its upright edges
/// laid on their sides (example 1).
pub fn pressure_meter() -> Solid {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    // The top falls towards the front, where the display is; all six faces are planar.
    let positions = vec![
        p(-1.0, -1.2, 0.0),
        p(1.0, -1.2, 0.0),
        p(1.0, 1.2, 0.0),
        p(-1.0, 1.2, 0.0),
        p(-0.85, -1.0, 0.5),
        p(0.85, -1.0, 0.5),
        p(0.85, 1.0, 1.2),
        p(-0.85, 1.0, 1.2),
    ];
    // The side faces are trapezoids between parallel edges only at front and back; left and right are made planar by
    // choosing the tops' x on the planes through the bottom edges.
    let slope = |z: f64| 1.0 - 0.125 * z;
    let mut positions = positions;
    for v in &mut positions[4..] {
        v.x = v.x.signum() * slope(v.z);
    }
    let polygons = vec![
        vec![3, 2, 1, 0],
        vec![4, 5, 6, 7],
        vec![0, 1, 5, 4],
        vec![1, 2, 6, 5],
        vec![2, 3, 7, 6],
        vec![3, 0, 4, 7],
    ];
    Solid { positions, polygons, clusters: (0..4).map(|i| vec![i, i + 4]).collect() }
}

/// A seven-sided vase: seven {2+5} clusters of a three-edged base vertex and a four-edged waist vertex (example 3).
pub fn vase() -> Solid {
    let rings = [ring(7, 1.0, 0.0, 0.0), ring(7, 0.72, 1.0, 0.0), ring(7, 1.15, 2.3, 0.0)];
    let mut solid = Solid::stack(&rings);
    solid.clusters = (0..7).map(|i| vec![i, i + 7]).collect();
    solid
}

/// A flower pot: two pentagons and a decagon cut from a pentagon, at increasing height. Five {2+6} clusters of a
/// three-edged base vertex and a five-edged, convex-concave waist vertex; the rim is left sharp (example 4).
pub fn flower_pot() -> Solid {
    let (base, waist, rim) = (ring(5, 1.0, 0.0, 0.0), ring(5, 0.9, 1.1, 0.0), ring(5, 1.75, 2.2, 0.0));
    let mut positions = [base, waist].concat();
    for i in 0..5 {
        // Each sharp corner of the rim is cut away towards both of its neighbours.
        positions.push(rim[i].lerp(rim[(i + 4) % 5], 0.27));
        positions.push(rim[i].lerp(rim[(i + 1) % 5], 0.27));
    }
    let mut polygons = vec![(0..5).rev().collect::<Vec<u32>>(), (10..20).collect()];
    for i in 0..5 {
        let j = (i + 1) % 5;
        polygons.push(vec![i, j, j + 5, i + 5]);
        polygons.push(vec![i + 5, j + 5, 2 * j + 10, 2 * i + 11]);
        polygons.push(vec![i + 5, 2 * i + 11, 2 * i + 10]);
    }
    Solid { positions, polygons, clusters: (0..5).map(|i| vec![i, i + 5]).collect() }
}

/// A door knob: a square shaft that widens to a head. Four {2+6} clusters of two four-edged vertices each, neck and
/// head; shaft and front stay sharp. The paper's figure is lost: this is one polyhedron with its count of clusters and
/// of edges (example 5).
pub fn door_knob() -> Solid {
    let rings = [ring(4, 0.75, 0.0, 0.5), ring(4, 0.55, 0.9, 0.5), ring(4, 1.25, 1.7, 0.5), ring(4, 0.8, 2.6, 0.5)];
    let mut solid = Solid::stack(&rings);
    solid.clusters = (0..4).map(|i| vec![i + 4, i + 8]).collect();
    solid
}

/// A convex-concave polyhedron without symmetry: similar star-shaped polygons of random outline, size and height on top
/// of each other, the top one tilted if there are only two.
pub fn convex_concave(seed: u64) -> Solid {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut random = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let corners = 6 + 2 * (seed % 3) as usize;
    let outline: Vec<DVec3> = (0..corners)
        .map(|i| {
            let angle = TAU * (i as f64 + random(-0.1, 0.1)) / corners as f64;
            // Every other corner lies inside the line between its neighbours.
            let radius = if i % 2 == 1 { random(0.6, 0.9) * (TAU / corners as f64).cos() } else { random(0.95, 1.2) };
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        })
        .collect();
    let levels = 2 + (seed % 3) as usize;
    let tilt = if levels == 2 { [random(-0.2, 0.2), random(-0.2, 0.2)] } else { [0.0; 2] };
    let rings: Vec<Vec<DVec3>> = (0..levels)
        .map(|level| {
            let (size, top) = (if levels == 2 { 1.0 } else { random(0.6, 1.3) }, level + 1 == levels);
            let height = 0.9 * level as f64 + random(0.0, 0.2);
            let lift = |p: &DVec3| if top { tilt[0] * p.x + tilt[1] * p.y } else { 0.0 };
            outline.iter().map(|p| DVec3::new(size * p.x, size * p.y, height + lift(p))).collect()
        })
        .collect();
    let mut solid = Solid::stack(&rings);
    // The caps are not convex: triangles around a middle, which is in their plane and so no vertex of the polyhedron.
    let n = corners as u32;
    let caps = [solid.polygons.remove(0), solid.polygons.pop().unwrap_or_default()];
    for cap in caps {
        let ring: Vec<DVec3> = cap.iter().map(|&v| solid.positions[v as usize]).collect();
        let height = if cap.contains(&0) {
            ring[0].z
        } else {
            rings[levels - 1][0].z - tilt[0] * outline[0].x - tilt[1] * outline[0].y
        };
        solid.positions.push(DVec3::new(0.0, 0.0, height));
        let middle = solid.positions.len() as u32 - 1;
        solid.polygons.extend((0..n as usize).map(|i| vec![cap[i], cap[(i + 1) % cap.len()], middle]));
    }
    solid
}

/// The five Platonic and thirteen Archimedean solids, by name.
pub fn regular() -> Vec<(&'static str, Solid)> {
    let f = 0.5 * (1.0 + 5f64.sqrt());
    let (f2, f3, r2) = (f * f, f * f * f, 2f64.sqrt());
    // The real roots of t³ = t² + t + 1 and ξ³ = 2ξ + f.
    let t = newton(1.8, |t| (t * t * t - t * t - t - 1.0, 3.0 * t * t - 2.0 * t - 1.0));
    let x = newton(1.7, |x| (x * x * x - 2.0 * x - f, 3.0 * x * x - 2.0));
    let (a, b) = (x - 1.0 / x, x * f + f2 + f / x);
    let every = |triples: &[[f64; 3]]| points(triples, |_, _| true);
    let even = |triples: &[[f64; 3]]| points(triples, |even, _| even);
    let snub_dodecahedron = [
        [2.0 * a, 2.0, 2.0 * b],
        [a + b / f + f, -a * f + b + 1.0 / f, a / f + b * f - 1.0],
        [a + b / f - f, a * f - b + 1.0 / f, a / f + b * f + 1.0],
        [-a / f + b * f + 1.0, -a + b / f - f, a * f + b - 1.0 / f],
        [-a / f + b * f - 1.0, a - b / f - f, a * f + b + 1.0 / f],
    ];
    let all = [
        ("tetrahedron", points(&[[1.0; 3]], |_, minus| minus % 2 == 0)),
        ("cube", every(&[[1.0; 3]])),
        ("octahedron", every(&[[1.0, 0.0, 0.0]])),
        ("dodecahedron", [every(&[[1.0; 3]]), even(&[[0.0, 1.0 / f, f]])].concat()),
        ("icosahedron", even(&[[0.0, 1.0, f]])),
        ("truncated tetrahedron", points(&[[3.0, 1.0, 1.0]], |_, minus| minus % 2 == 0)),
        ("cuboctahedron", every(&[[1.0, 1.0, 0.0]])),
        ("truncated cube", every(&[[r2 - 1.0, 1.0, 1.0]])),
        ("truncated octahedron", every(&[[0.0, 1.0, 2.0]])),
        ("rhombicuboctahedron", every(&[[1.0, 1.0, 1.0 + r2]])),
        ("truncated cuboctahedron", every(&[[1.0, 1.0 + r2, 1.0 + 2.0 * r2]])),
        ("snub cube", points(&[[1.0, 1.0 / t, t]], |even, minus| even == (minus % 2 == 1))),
        ("icosidodecahedron", even(&[[0.0, 0.0, f], [0.5, 0.5 * f, 0.5 * f2]])),
        ("truncated dodecahedron", even(&[[0.0, 1.0 / f, 2.0 + f], [1.0 / f, f, 2.0 * f], [f, 2.0, f + 1.0]])),
        ("truncated icosahedron", even(&[[0.0, 1.0, 3.0 * f], [1.0, 2.0 + f, 2.0 * f], [f, 2.0, 2.0 * f + 1.0]])),
        ("rhombicosidodecahedron", even(&[[1.0, 1.0, f3], [f2, f, 2.0 * f], [2.0 + f, 0.0, f2]])),
        (
            "truncated icosidodecahedron",
            even(&[
                [1.0 / f, 1.0 / f, 3.0 + f],
                [2.0 / f, f, 1.0 + 2.0 * f],
                [1.0 / f, f2, 3.0 * f - 1.0],
                [2.0 * f - 1.0, 2.0, 2.0 + f],
                [f, 3.0, 2.0 * f],
            ]),
        ),
        ("snub dodecahedron", points(&snub_dodecahedron, |even, minus| even && minus % 2 == 1)),
    ];
    all.into_iter().map(|(name, positions)| (name, hull(positions))).collect()
}

fn newton(mut x: f64, value_and_slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    for _ in 0..40 {
        let (value, slope) = value_and_slope(x);
        x -= value / slope;
    }
    x
}

/// Permutations and changes of sign of some coordinates, each point once; `keep` is asked with whether the permutation
/// is even and how many signs are minus.
fn points(triples: &[[f64; 3]], keep: impl Fn(bool, u32) -> bool) -> Vec<DVec3> {
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let mut all: Vec<DVec3> = vec![];
    for triple in triples {
        for (i, order) in orders.iter().enumerate() {
            for signs in 0..8u32 {
                let sign = |axis: usize| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
                let p = DVec3::from([0, 1, 2].map(|axis| sign(axis) * triple[order[axis]]));
                if keep(i < 3, signs.count_ones()) && all.iter().all(|q| q.distance(p) > 1e-6) {
                    all.push(p);
                }
            }
        }
    }
    all
}

/// The convex hull of points that are all corners of it, around the origin: every plane through three of them that has
/// all others behind it. For a few hundred points.
fn hull(positions: Vec<DVec3>) -> Solid {
    let size = positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let mut polygons: Vec<Vec<u32>> = vec![];
    for i in 0..positions.len() {
        for j in i + 1..positions.len() {
            for k in j + 1..positions.len() {
                let normal = (positions[j] - positions[i]).cross(positions[k] - positions[i]).normalize_or_zero();
                let normal = if normal.dot(positions[i]) < 0.0 { -normal } else { normal };
                let height = |p: &DVec3| normal.dot(*p - positions[i]) / size;
                if normal == DVec3::ZERO || positions.iter().any(|p| height(p) > 1e-9) {
                    continue;
                }
                let mut face: Vec<u32> =
                    (0..).zip(&positions).filter(|(_, p)| height(p) > -1e-9).map(|(v, _)| v).collect();
                // Each face is met first by its three lowest corners.
                if face[..3] != [i as u32, j as u32, k as u32] {
                    continue;
                }
                let middle = face.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / face.len() as f64;
                let axis = (positions[i] - middle).normalize();
                let angle = |v: u32| {
                    let d = positions[v as usize] - middle;
                    normal.cross(axis).dot(d).atan2(axis.dot(d))
                };
                face.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
                polygons.push(face);
            }
        }
    }
    Solid { positions, polygons, clusters: vec![] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cluster, Polyhedron, PolyhedronParams, Turn};

    fn read(solid: &Solid) -> Polyhedron {
        let (mesh, of) = solid.triangles();
        Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap()
    }

    /// Vertices, edges and faces as every textbook lists them; all edges of one length.
    #[test]
    fn the_regular_solids_are_regular() {
        let counts = [
            (4, 6, 4),
            (8, 12, 6),
            (6, 12, 8),
            (20, 30, 12),
            (12, 30, 20),
            (12, 18, 8),
            (12, 24, 14),
            (24, 36, 14),
            (24, 36, 14),
            (24, 48, 26),
            (48, 72, 26),
            (24, 60, 38),
            (30, 60, 32),
            (60, 90, 32),
            (60, 90, 32),
            (60, 120, 62),
            (120, 180, 62),
            (60, 150, 92),
        ];
        for ((name, solid), counts) in regular().iter().zip(counts) {
            let solid = read(solid);
            assert_eq!((solid.vertices().count(), solid.halfedges.len() / 2, solid.faces.len()), counts, "{name}");
            let lengths: Vec<f64> = (0..solid.halfedges.len() as u32).map(|h| solid.length(h)).collect();
            assert!(lengths.iter().all(|l| (l / lengths[0] - 1.0).abs() < 1e-9), "{name}");
            assert!(solid.vertices().all(|v| solid.turn(v) == Turn::Convex));
        }
    }

    /// Triangles without polygons give the same faces.
    #[test]
    fn coplanar_triangles_are_merged() {
        for (_, solid) in &regular()[..8] {
            let (mesh, _) = solid.triangles();
            let merged = Polyhedron::new(&mesh, None, &PolyhedronParams::default()).unwrap();
            assert_eq!(merged.faces.len(), solid.polygons.len());
        }
    }

    #[test]
    fn the_papers_models_have_the_papers_clusters() {
        for (solid, count, name) in [
            (pressure_meter(), 4, "{2+4}"),
            (vase(), 7, "{2+5}"),
            (flower_pot(), 5, "{2+6}"),
            (door_knob(), 4, "{2+6}"),
        ] {
            let read = read(&solid);
            assert_eq!(solid.clusters.len(), count);
            for vertices in &solid.clusters {
                assert_eq!(Cluster::new(&read, vertices).unwrap().name(), name);
            }
        }
        let pot = read(&flower_pot());
        assert!((0..5).all(|v| pot.turn(v) == Turn::Convex && pot.turn(v + 5) == Turn::Mixed));
        assert_eq!((pot.ring(0).count(), pot.ring(5).count()), (3, 5));
    }
}
