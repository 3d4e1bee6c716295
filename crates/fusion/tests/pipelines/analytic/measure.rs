//! Runs a case and measures the result against the truth.

use super::cases::Case;
use fusion::blend::{Blended, Error, Params, blend};
use mesh_core::{Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Positions, TriMesh, VertexOrigin, Watch};
use spine::BlendCurve;
use std::time::Instant;
use tri_intersect::{Seam, boolean};

/// A boolean, its seams as blend curves, and the blend along all of them.
pub struct Run {
    pub joined: Connected<TriMesh>,
    pub curves: Vec<BlendCurve>,
    pub blended: Blended,
    /// Of the blend alone.
    pub milliseconds: f64,
}

/// The boolean of a case and its seams.
pub fn join(case: &Case) -> (Connected<TriMesh>, Vec<BlendCurve>) {
    let [a, b] = &case.parts;
    let made = boolean(a, b, case.operation, &tri_intersect::Params::default(), &Watch::default());
    let made = made.expect("clean solids");
    let joined = Connected::new(made.mesh).expect("a boolean is manifold");
    let curve = |s: &Seam| BlendCurve::from_vertices(&joined, &s.vertices).expect("seams run along edges");
    let curves = made.seams.iter().map(curve).collect();
    (joined, curves)
}

pub fn run(case: &Case, adjust: impl Fn(&mut Params)) -> Result<Run, Error> {
    let (joined, curves) = join(case);
    let mut params = Params::new(case.truth.radius);
    adjust(&mut params);
    let since = Instant::now();
    let blended = blend(&joined, &curves, &params, &Watch::default())?;
    let milliseconds = since.elapsed().as_secs_f64() * 1e3;
    Ok(Run { joined, curves, blended, milliseconds })
}

/// How far a result is from the truth.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Largest sagitta of the facets the ball comes near.
    pub sagitta: f64,
    /// Largest angle between two neighbouring ones.
    pub facet_angle: f64,
    /// Largest distance of a new vertex from the canal surface, and root mean square.
    pub inner: [f64; 2],
    /// Largest share of 2·sagitta/cos(φ/2) that a new vertex uses up.
    pub inner_share: f64,
    /// The same for the vertices between blend and kept faces.
    pub linkage: [f64; 2],
    pub linkage_share: f64,
    /// Largest distance of the linkage from where the exact feet are, along the surface.
    pub drift: f64,
    /// Largest angle between a blend face and a kept face at a linkage edge.
    pub kink: f64,
    /// The largest by which such an angle exceeds half the turn of the exact blend across the blend face, which is
    /// what a chord of an arc makes with its end.
    pub kink_beyond_chord: f64,
}

pub fn measure(case: &Case, run: &Run) -> Measured {
    let (mesh, truth) = (&run.blended.mesh, &case.truth);
    let coarse = [case.coarseness(0), case.coarseness(1)];
    let sagitta = coarse[0].0.max(coarse[1].0);
    let spread = |points: &[glam::DVec3]| {
        let (mut max, mut square, mut share) = (0.0f64, 0.0, 0.0f64);
        for &p in points {
            let near = truth.near(p);
            let error = (near.distance - truth.radius).abs();
            max = max.max(error);
            square += error * error;
            share = share.max(error * near.half_cosine() / (2.0 * sagitta));
        }
        ([max, (square / points.len().max(1) as f64).sqrt()], share)
    };
    let inner: Vec<_> = mesh
        .vertex_ids()
        .filter(|&v| matches!(run.blended.origins.vertices[v], VertexOrigin::New { .. }))
        .map(|v| mesh.position(v))
        .collect();
    let (inner, inner_share) = spread(&inner);

    let connected = Connected::new(mesh).expect("a blend is manifold");
    let first = run.blended.first_blend_face;
    let mut rim = Vec::new();
    let (mut kink, mut beyond, mut drift) = (0.0f64, f64::NEG_INFINITY, 0.0f64);
    for f in (first.0..mesh.face_count() as u32).map(FaceId) {
        for h in f.halfedges() {
            let Some(other) = connected.twin(h).map(HalfedgeId::face).filter(|&o| o < first) else { continue };
            let p = mesh.position(connected.tail(h));
            rim.push(p);
            let near = truth.near(p);
            drift = drift.max(
                near.to_feet.map(|foot| foot.angle_between(near.to_point)).into_iter().fold(f64::INFINITY, f64::min)
                    * truth.radius,
            );
            let angle = parent_normal(run, other).angle_between(normal(mesh, f));
            let turns = mesh.corners(f).map(|v| truth.near(mesh.position(v)).to_point);
            let turn = (0..3).map(|i| turns[i].angle_between(turns[(i + 1) % 3])).fold(0.0, f64::max);
            kink = kink.max(angle);
            beyond = beyond.max(angle - 0.5 * turn);
        }
    }
    let (linkage, linkage_share) = spread(&rim);
    Measured {
        sagitta,
        facet_angle: coarse[0].1.max(coarse[1].1),
        inner,
        inner_share,
        linkage,
        linkage_share,
        drift,
        kink,
        kink_beyond_chord: beyond,
    }
}

/// Normal of the face of the boolean that a kept face is a piece of: pieces may be too small to have a good one.
pub fn parent_normal(run: &Run, f: FaceId) -> glam::DVec3 {
    let (FaceOrigin::Input { face, .. } | FaceOrigin::Piece { face, .. }) = run.blended.origins.faces[f] else {
        unreachable!("kept faces come from the input")
    };
    normal(run.joined.mesh(), face)
}

pub fn normal(mesh: &TriMesh, f: FaceId) -> glam::DVec3 {
    let [a, b, c] = mesh.triangle(f);
    (b - a).cross(c - a).normalize_or_zero()
}
