//! The blend's surface: the cut-out piece of the mesh, drawn onto the balls and made fair.

use super::ball::target;
use super::piece::{CutOut, Evenness, even_out, split_chords};
use super::plate::Plate;
use super::sides::Sides;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, Watch, area_vector, boundary_loops,
};
use rayon::prelude::*;
use spine::RadiusField;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Length over which the plate may depart from the balls, in radii: they are followed closely where they are smooth.
const SIGMA: f64 = 0.2;
/// Distance from the plate, in radii, at which a ball begins to count as a stray.
const STRAY: f64 = 0.03;
/// How often the weights of the balls are revised.
const REVISIONS: usize = 3;
/// How often the piece is remeshed and drawn.
const PASSES: usize = 3;
/// How evenly it is remeshed each time.
const EVENNESS: Evenness = Evenness { rounds: 4, slope: 0.3, finest: 0.6 };
/// Window along a linkage over which normals and tangents are averaged, in radii.
const WINDOW: f64 = 0.25;

/// Distance from the linkages over which the plate fades into the balls, in radii.
const FADE: f64 = 0.4;
/// Balls farther from the plate than this, in radii, are not its own.
const ASTRAY: f64 = 0.15;
/// Cosine of the angle by which a face may turn when its corners are put onto balls.
const TILTED: f64 = 0.85;
/// How often corners of faces that turn more are put back.
const UNDONE: usize = 4;

/// Draws the piece onto the balls. Its topology stays, so it closes the hole whatever its shape.
pub(crate) fn draw(
    piece: &CutOut,
    sides: &Sides<'_>,
    radius: &RadiusField,
    edge: f64,
    taken: &BTreeSet<[VertexId; 2]>,
    watch: &Watch,
) -> Result<TriMesh, Trouble> {
    let at = || piece.mesh.positions.first().copied().into_iter().collect::<Vec<_>>();
    let mut mesh = piece.mesh.clone();
    for pass in 1..=PASSES {
        mesh = even_out(mesh, edge, EVENNESS, watch)?;
        split_chords(&mut mesh, piece.rim.len(), taken, 0.5 * edge);
        let connected =
            Connected::new(&mesh).map_err(|e| Trouble::at("the linkages touch", e.place.into_iter().collect()))?;
        let points = settle(&connected, sides, radius, edge, pass == PASSES);
        if points.iter().any(|p| !p.is_finite()) {
            return Err(Trouble::at("the blend does not settle", at()));
        }
        mesh.positions = points;
    }
    Ok(mesh)
}

/// One thin plate: drawn to the balls, strays left out, tangent to the kept surface at the linkages.
fn settle(mesh: &Connected<&TriMesh>, sides: &Sides<'_>, radius: &RadiusField, edge: f64, last: bool) -> Vec<DVec3> {
    let n = mesh.vertex_count();
    let found: Vec<Option<DVec3>> =
        mesh.mesh().positions.par_iter().with_min_len(16).map(|&p| target(sides, radius, p)).collect();
    let mut points = mesh.mesh().positions.clone();
    let mut faces: Vec<[u32; 3]> = mesh.mesh().faces.iter().map(|f| f.map(|v| v.0)).collect();
    let mut free = vec![true; n];
    for walk in boundary_loops(mesh) {
        let ghosts = skirt(mesh, sides, &walk, radius, edge);
        let first = points.len() as u32;
        points.extend(ghosts);
        for (i, &h) in walk.iter().enumerate() {
            let (a, b) = (mesh.tail(h).0, mesh.head(h).0);
            let (ga, gb) = (first + i as u32, first + ((i + 1) % walk.len()) as u32);
            faces.extend([[b, a, ga], [b, ga, gb]]);
            free[a as usize] = false;
        }
    }
    free.resize(points.len(), false);
    let plate = Plate::new(&points, &faces, n, free);
    let own = |v: usize| found.get(v).copied().flatten();
    let targets: Vec<DVec3> = (0..points.len()).map(|v| own(v).unwrap_or(points[v])).collect();
    let r = |v: usize| radius.at(points[v]).0;
    let mut pull: Vec<f64> =
        (0..points.len()).map(|v| if own(v).is_some() { (SIGMA * r(v)).powi(-4) } else { 0.0 }).collect();
    let mut x = points.clone();
    for v in 0..n {
        if plate.moves(v) {
            x[v] = targets[v];
        }
    }
    let revisions = if last { REVISIONS } else { 1 };
    for revision in 0..=revisions {
        plate.settle(&mut x, &targets, &pull, if last && revision == REVISIONS { 1e-4 } else { 1e-2 });
        if revision == revisions {
            break;
        }
        for v in 0..n {
            if own(v).is_some() {
                let stray = x[v].distance(targets[v]) / (STRAY * r(v));
                pull[v] = (SIGMA * r(v)).powi(-4) / (1.0 + stray * stray).powi(2);
            }
        }
    }
    if last {
        // What the plate's stiffness takes away is put on top of the targets once.
        let lifted: Vec<DVec3> = targets.iter().zip(&x).map(|(t, x)| 2.0 * *t - *x).collect();
        plate.settle(&mut x, &lifted, &pull, 1e-4);
    }
    x.truncate(n);
    if last {
        let movable: Vec<bool> = (0..n).map(|v| plate.moves(v)).collect();
        seat(mesh, sides, radius, &movable, &mut x);
    }
    x
}

/// Puts the points of the plate onto the balls they are next to, fading towards the linkages, where the plate leads over
/// to the surface as it is. Where that would fold faces, they stay on the plate.
fn seat(mesh: &Connected<&TriMesh>, sides: &Sides<'_>, radius: &RadiusField, movable: &[bool], x: &mut [DVec3]) {
    let r = |v: usize| radius.at(x[v]).0;
    let within = inward(mesh, movable, x);
    let step = |v: usize| {
        let share = (within[v] / (FADE * r(v))).min(1.0);
        let there = target(sides, radius, x[v]).filter(|t| t.distance(x[v]) < ASTRAY * r(v));
        there.map_or(DVec3::ZERO, |t| share * share * (3.0 - 2.0 * share) * (t - x[v]))
    };
    let steps: Vec<DVec3> =
        (0..x.len()).into_par_iter().with_min_len(16).map(|v| if movable[v] { step(v) } else { DVec3::ZERO }).collect();
    let mut taken = vec![true; x.len()];
    for _ in 0..UNDONE {
        let at = |v: VertexId| x[v.index()] + if taken[v.index()] { steps[v.index()] } else { DVec3::ZERO };
        let bends = |f: &&[VertexId; 3]| {
            let before = area_vector(f.map(|v| x[v.index()]));
            let after = area_vector(f.map(at));
            before.dot(after) < TILTED * before.length() * after.length()
        };
        let bent: Vec<VertexId> =
            mesh.mesh().faces.iter().filter(bends).flatten().copied().filter(|v| taken[v.index()]).collect();
        if bent.is_empty() {
            break;
        }
        for v in &bent {
            taken[v.index()] = false;
        }
    }
    for v in (0..x.len()).filter(|&v| taken[v]) {
        x[v] += steps[v];
    }
}

/// Distance of each vertex from those that do not move, along edges.
fn inward(mesh: &Connected<&TriMesh>, movable: &[bool], x: &[DVec3]) -> Vec<f64> {
    let mut best: Vec<f64> = movable.iter().map(|&m| if m { f64::INFINITY } else { 0.0 }).collect();
    // Non-negative floats are ordered as their bits are.
    let mut queue: BinaryHeap<Reverse<(u64, VertexId)>> =
        mesh.vertex_ids().filter(|v| !movable[v.index()]).map(|v| Reverse((0, v))).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let d = f64::from_bits(bits);
        if d > best[v.index()] {
            continue;
        }
        for w in mesh.ring(v).map(|h| mesh.head(h)) {
            let there = d + x[v.index()].distance(x[w.index()]);
            if there < best[w.index()] {
                best[w.index()] = there;
                queue.push(Reverse((there.to_bits(), w)));
            }
        }
    }
    best
}

/// Points beyond a boundary loop, one for each of its vertices, in the planes that the surface there is to be tangent to.
fn skirt(
    mesh: &Connected<&TriMesh>,
    sides: &Sides<'_>,
    walk: &[HalfedgeId],
    radius: &RadiusField,
    edge: f64,
) -> Vec<DVec3> {
    let n = walk.len();
    let points: Vec<DVec3> = walk.iter().map(|&h| mesh.position(mesh.tail(h))).collect();
    let lengths: Vec<f64> = (0..n).map(|i| points[i].distance(points[(i + 1) % n])).collect();
    let normals: Vec<DVec3> = points.iter().map(|&p| outward(sides, p)).collect();
    let fair = |i: usize| {
        let window = WINDOW * radius.at(points[i]).0;
        let (mut normal, mut tangent) = (DVec3::ZERO, DVec3::ZERO);
        let mut add = |j: usize, away: f64| {
            let fade = 1.0 - (away / window).powi(2);
            // Each vertex stands for half of both edges there; across a crease it says nothing.
            let share = lengths[j] + lengths[(j + n - 1) % n];
            if normals[j].dot(normals[i]) > 0.7 {
                normal += share * fade * fade * normals[j];
            }
            tangent += fade * fade * (points[(j + 1) % n] - points[(j + n - 1) % n]);
        };
        add(i, 0.0);
        let (mut there, mut back) = (0.0, 0.0);
        for k in 1..n / 2 {
            there += lengths[(i + k - 1) % n];
            back += lengths[(i + n - k) % n];
            if there < window {
                add((i + k) % n, there);
            }
            if back < window {
                add((i + n - k) % n, back);
            }
            if there >= window && back >= window {
                break;
            }
        }
        (normal.normalize_or(normals[i]), tangent.normalize_or_zero())
    };
    (0..n)
        .into_par_iter()
        .map(|i| {
            let (normal, tangent) = fair(i);
            let inward = normal.cross(tangent).normalize_or_zero();
            let length = (0.5 * (lengths[i] + lengths[(i + n - 1) % n])).clamp(0.3 * edge, edge);
            points[i] - length * inward
        })
        .collect()
}

/// The smoothed outward normal of the side nearer to `p`.
fn outward(sides: &Sides<'_>, p: DVec3) -> DVec3 {
    let seen = [sides.seen(0, p), sides.seen(1, p)];
    let nearer = seen.into_iter().flatten().min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
    nearer.map_or(DVec3::Z, |s| sides.sign * s.normal)
}
