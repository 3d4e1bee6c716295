//! How far a finished blend is from the ball that was asked for, measured on the result alone.
//!
//! At a vertex p of the blend with normal n, the ball of radius r through p has its centre at p + r·n (valleys) or p − r·n
//! (ridges), and rests on the sharp surface where its distance to that is r.

use crate::blended::Blended;
use glam::{DVec3, I64Vec3};
use mesh_core::{
    Bounds, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, VertexOrigin, area_vector,
};
use mesh_query::TriBvh;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// A blend is full where the ball error is no larger than this.
const FULL: f64 = 0.05;
/// Shares of the area at which errors are told.
const QUANTILES: [f64; 3] = [0.5, 0.9, 0.99];
/// Faces around a vertex that turn from each other by more than this, as a cosine (40 degrees), are not one surface: at the end of a
/// strip, blend and end face.
const ONE_SURFACE: f64 = 0.766;
/// Length of the pieces into which a curve is divided, in radii, and the most pieces.
const PIECE: f64 = 0.5;
const MOST_PIECES: usize = 10_000;
/// Cells of the neighbourhood in which distances are exact, in radii.
const CELL: f64 = 2.0;
/// A face that overlaps more cells than this is in the neighbourhood without a look at each.
const MOST_CELLS: i64 = 64;

/// One curve whose blend is measured.
pub struct Curve<'a> {
    /// Its edges in order.
    pub halfedges: &'a [HalfedgeId],
    /// The radius asked for, in model units.
    pub radius: f64,
}

/// What was found along one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Ball error that 50, 90 and 99% of the blend's area keep; `None` where the blend has no vertex of its own there.
    pub ball_error: Option<[f64; 3]>,
    /// Share of the length with an error of at most [`FULL`], of what is blended; `None` as above.
    pub full_share: Option<f64>,
    /// Share of the length whose edges are gone.
    pub blended_share: f64,
}

/// Measures the blend of `curves` of `mesh`, and the ball error over all of them. Cost grows with the blend's vertices,
/// beside two passes over the faces of both meshes.
pub fn measure(
    mesh: &Connected<TriMesh>,
    curves: &[Curve<'_>],
    blended: &Blended,
) -> (Vec<Measured>, Option<[f64; 3]>) {
    let along = Along::new(mesh, curves);
    let samples = along.samples(mesh, curves, blended);
    let overall = quantiles(samples.iter().map(|s| (s.error, s.weight)).collect());
    let mut own: Vec<Vec<Sample>> = curves.iter().map(|_| vec![]).collect();
    for sample in samples {
        own[sample.curve].push(sample);
    }
    let sharp = edges_left(mesh, curves, blended);
    let measured = own.into_par_iter().enumerate().map(|(i, own)| along.sum_up(mesh, &curves[i], i, &own, &sharp));
    (measured.collect(), overall)
}

/// A vertex of the blend.
struct Sample {
    curve: usize,
    /// Where along the curve it is, in model units.
    at: f64,
    error: f64,
    /// The error of the smooth surface around the vertex that fits the ball best: the same but on creases.
    smooth_error: f64,
    weight: f64,
    /// Whether the ball reaches into the surface at which its curve stops: within a radius of there, it says nothing.
    at_stop: bool,
}

/// Edges of all curves as faces without width, for the nearest of them.
struct Along {
    edges: TriMesh,
    tree: Option<TriBvh>,
    /// For each edge: its curve, and its start along the curve.
    of: Vec<(usize, f64)>,
    lengths: Vec<f64>,
}

impl Along {
    fn new(mesh: &Connected<TriMesh>, curves: &[Curve<'_>]) -> Self {
        let (mut edges, mut of, mut lengths) = (TriMesh::default(), vec![], vec![]);
        for (i, curve) in curves.iter().enumerate() {
            let mut length = 0.0;
            for &h in curve.halfedges {
                let first = VertexId::from(edges.positions.len());
                let second = VertexId(first.0 + 1);
                edges.positions.extend(mesh.ends(h));
                edges.faces.push([first, second, second]);
                of.push((i, length));
                length += mesh.edge_length(h);
            }
            lengths.push(length);
        }
        Self { tree: TriBvh::build(&edges).ok(), edges, of, lengths }
    }

    /// The vertices of the blend that have no vertex of the input beside them, each with its curve and error.
    fn samples(&self, mesh: &Connected<TriMesh>, curves: &[Curve<'_>], blended: &Blended) -> Vec<Sample> {
        let (result, origins) = (&blended.mesh, &blended.origins.vertices);
        let is_new = |v: VertexId| !matches!(origins[v], VertexOrigin::Input { .. });
        let mut inside: Vec<bool> = result.vertex_ids().map(is_new).collect();
        let mut normals = vec![DVec3::ZERO; inside.len()];
        let mut areas = vec![0.0; inside.len()];
        let mut made = vec![];
        for f in result.face_ids() {
            let corners = result.corners(f);
            let new = corners.map(is_new);
            if new == [true; 3] {
                let vector = area_vector(result.triangle(f));
                made.push((corners, vector));
                for v in corners {
                    normals[v.index()] += vector;
                    areas[v.index()] += vector.length() / 3.0;
                }
            } else if new != [false; 3] {
                for v in corners {
                    inside[v.index()] = false;
                }
            }
        }
        let creased = on_creases(&made, &normals, &inside);
        let Some(tree) = &self.tree else { return vec![] };
        let nearest = |v: usize| {
            let p = result.positions[v];
            let found = tree.closest_point(&self.edges, p)?;
            let (curve, start) = self.of[found.face.index()];
            let [a, ..] = self.edges.triangle(found.face);
            Some((v, curve, start + a.distance(found.point), normals[v].normalize_or_zero()))
        };
        let placed: Vec<_> =
            (0..inside.len()).into_par_iter().filter(|&v| inside[v] && areas[v] > 0.0).filter_map(nearest).collect();
        let centers = |&(v, curve, _, n): &(usize, usize, f64, DVec3)| {
            [1.0, -1.0].map(|side| result.positions[v] + side * curves[curve].radius * n)
        };
        let reach = CELL * curves.iter().map(|c| c.radius).fold(0.0, f64::max);
        let Some(surface) = neighbourhood(mesh, placed.iter().flat_map(centers), reach) else { return vec![] };
        let sample = |place: &(usize, usize, f64, DVec3)| {
            let &(v, curve, at, _) = place;
            let r = curves[curve].radius;
            let miss =
                |c: DVec3| surface.closest_point(mesh, c).map_or(f64::INFINITY, |near| (near.distance - r).abs() / r);
            let error = centers(place).map(miss).into_iter().fold(f64::INFINITY, f64::min);
            let smooth = creased.get(&v).into_iter().flatten();
            let smooth = smooth.flat_map(|&n| centers(&(v, curve, at, n))).map(miss).fold(error, f64::min);
            let ahead = self.ahead(mesh, &curves[curve], curve, at);
            let stops = |c: DVec3| {
                let near = surface.closest_point(mesh, c)?;
                Some(near.distance < r && (near.point - c).dot(ahead?) > 0.5 * near.distance)
            };
            let at_stop = smooth > FULL && centers(place).into_iter().any(|c| stops(c) == Some(true));
            Sample { curve, at, error, smooth_error: smooth, weight: areas[v], at_stop }
        };
        placed.par_iter().map(sample).collect()
    }

    /// The direction in which an open curve runs into its nearer end, within a radius and a half of that.
    fn ahead(&self, mesh: &Connected<TriMesh>, curve: &Curve<'_>, index: usize, at: f64) -> Option<DVec3> {
        let (&first, &last) = (curve.halfedges.first()?, curve.halfedges.last()?);
        let (reach, length) = (1.5 * curve.radius, self.lengths[index]);
        let along = |h: HalfedgeId| {
            let [a, b] = mesh.ends(h);
            (b - a).normalize_or_zero()
        };
        if mesh.tail(first) == mesh.head(last) || at.min(length - at) > reach {
            return None;
        }
        Some(if at < 0.5 * length { -along(first) } else { along(last) })
    }

    fn sum_up(
        &self,
        mesh: &Connected<TriMesh>,
        curve: &Curve<'_>,
        index: usize,
        own: &[Sample],
        sharp: &HashSet<[VertexId; 2]>,
    ) -> Measured {
        let length = self.lengths[index];
        if length <= 0.0 {
            return Measured { ball_error: None, full_share: None, blended_share: 1.0 };
        }
        let pieces = ((length / (PIECE * curve.radius)).ceil() as usize).clamp(1, MOST_PIECES);
        let piece_of = |at: f64| ((at / length * pieces as f64) as usize).min(pieces - 1);
        let mut weights = vec![[0.0; 2]; pieces];
        for s in own.iter().filter(|s| !s.at_stop) {
            let [full, all] = &mut weights[piece_of(s.at)];
            *all += s.weight;
            *full += if s.smooth_error <= FULL { s.weight } else { 0.0 };
        }
        let mut left = vec![0.0; pieces];
        let mut at = 0.0;
        for &h in curve.halfedges {
            let edge = mesh.edge_length(h);
            if sharp.contains(&key(mesh.tail(h), mesh.head(h))) {
                // A long edge is shared out over the pieces it spans.
                let (first, last) = (piece_of(at), piece_of(at + edge));
                (first..=last).for_each(|i| left[i] += edge / (last - first + 1) as f64);
            }
            at += edge;
        }
        let sharp_length: f64 = left.iter().sum();
        let piece = length / pieces as f64;
        let known: Vec<usize> = (0..pieces).filter(|&i| weights[i][1] > 0.0).collect();
        let share = |i: usize| weights[i][0] / weights[i][1];
        // Long triangles leave pieces without vertices: such a piece is as the worse of the nearest ones on both sides.
        let of = |i: usize| {
            let after = known.partition_point(|&k| k < i);
            if known.get(after) == Some(&i) {
                return share(i);
            }
            let sides = known[after.saturating_sub(1)..].iter().take(if after == 0 { 1 } else { 2 });
            sides.map(|&k| share(k)).fold(1.0, f64::min)
        };
        // What is missing, since this is exactly 0 where nothing is.
        let missing: f64 = (0..pieces).map(|i| piece - of(i) * (piece - left[i]).max(0.0)).sum();
        Measured {
            ball_error: quantiles(own.iter().map(|s| (s.error, s.weight)).collect()),
            full_share: (!known.is_empty()).then(|| (1.0 - missing / length).clamp(0.0, 1.0)),
            blended_share: (1.0 - sharp_length / length).clamp(0.0, 1.0),
        }
    }
}

/// The inner vertices on creases, each with the normals of the smooth surfaces that meet there: one for each face around, of all
/// faces that turn from it by little.
fn on_creases(made: &[([VertexId; 3], DVec3)], normals: &[DVec3], inside: &[bool]) -> HashMap<usize, Vec<DVec3>> {
    let unit: Vec<DVec3> = made.par_iter().map(|m| m.1.normalize_or_zero()).collect();
    let mut found: HashMap<usize, Vec<DVec3>> = HashMap::new();
    for ((corners, _), unit) in made.iter().zip(&unit) {
        for v in corners.iter().map(|v| v.index()).filter(|&v| inside[v]) {
            if unit.dot(normals[v].normalize_or_zero()) < ONE_SURFACE {
                found.entry(v).or_default();
            }
        }
    }
    let mut around: HashMap<usize, Vec<DVec3>> = HashMap::new();
    for (corners, vector) in made {
        for v in corners.iter().map(|v| v.index()).filter(|v| found.contains_key(v)) {
            around.entry(v).or_default().push(*vector);
        }
    }
    for (v, vectors) in around {
        let alike = |a: DVec3, b: DVec3| a.normalize_or_zero().dot(b.normalize_or_zero()) >= ONE_SURFACE;
        let mean = |&a: &DVec3| vectors.iter().filter(|&&b| alike(a, b)).sum::<DVec3>().normalize_or_zero();
        found.insert(v, vectors.iter().map(mean).collect());
    }
    found
}

/// The errors at [`QUANTILES`] of the weight.
fn quantiles(mut errors: Vec<(f64, f64)>) -> Option<[f64; 3]> {
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = errors.iter().map(|e| e.1).sum();
    let (last, mut sum) = (errors.last()?.0, 0.0);
    let sums: Vec<f64> = errors.iter().map(|e| (sum += e.1, sum / total).1).collect();
    Some(QUANTILES.map(|q| errors.get(sums.partition_point(|&s| s < q)).map_or(last, |e| e.0)))
}

fn key(a: VertexId, b: VertexId) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

/// Edges of the curves that the result still has.
fn edges_left(mesh: &Connected<TriMesh>, curves: &[Curve<'_>], blended: &Blended) -> HashSet<[VertexId; 2]> {
    let mut on_curve = vec![false; mesh.vertex_count()];
    let halfedges = || curves.iter().flat_map(|c| c.halfedges);
    let all: HashSet<[VertexId; 2]> = halfedges().map(|&h| key(mesh.tail(h), mesh.head(h))).collect();
    all.iter().flatten().for_each(|v| on_curve[v.index()] = true);
    let input = |v: VertexId| match blended.origins.vertices[v] {
        VertexOrigin::Input { vertex, .. } if on_curve[vertex.index()] => Some(vertex),
        _ => None,
    };
    let mut left = HashSet::new();
    for f in blended.mesh.face_ids() {
        let corners = blended.mesh.corners(f).map(input);
        for k in 0..3 {
            if let (Some(a), Some(b)) = (corners[k], corners[(k + 1) % 3])
                && all.contains(&key(a, b))
            {
                left.insert(key(a, b));
            }
        }
    }
    left
}

/// A tree of the faces of `mesh` within `reach` of any of some points, at least.
fn neighbourhood(mesh: &Connected<TriMesh>, points: impl Iterator<Item = DVec3>, reach: f64) -> Option<TriBvh> {
    // Far from the origin, or with a tiny radius, cells run together: more faces than needed are taken then.
    let cell = |p: DVec3| (p / reach).floor().clamp(DVec3::splat(-1e15), DVec3::splat(1e15)).as_i64vec3();
    let (mut cells, mut around) = (HashSet::new(), Bounds::EMPTY);
    for p in points {
        around = around.union(Bounds::of([p]));
        cells.insert(cell(p));
    }
    let around = around.inflated(reach);
    let offsets = (0..27).map(|i| I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    let near: HashSet<I64Vec3> = offsets.flat_map(|o| cells.iter().map(move |&c| c + o)).collect();
    let touches = |f: &FaceId| {
        let own = Bounds::of(mesh.triangle(*f));
        if !around.overlaps(&own) {
            return false;
        }
        let (low, high) = (cell(own.min.max(around.min)), cell(own.max.min(around.max)));
        let count = high - low + I64Vec3::ONE;
        if count.x.saturating_mul(count.y).saturating_mul(count.z) > MOST_CELLS {
            return true;
        }
        (low.x..=high.x)
            .any(|x| (low.y..=high.y).any(|y| (low.z..=high.z).any(|z| near.contains(&I64Vec3::new(x, y, z)))))
    };
    let faces: Vec<FaceId> = (0..mesh.face_count()).into_par_iter().map(FaceId::from).filter(touches).collect();
    TriBvh::build_subset(mesh, &faces).ok().filter(|t| t.face_count() > 0)
}
