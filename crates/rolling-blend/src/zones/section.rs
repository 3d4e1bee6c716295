//! Cross-sections of the sharp mesh through the ball that touches both sides of a curve and nothing else.

use crate::envelope::Ground;
use glam::DVec3;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, HalfedgeId, Positions, SurfacePoint, TraceLimits, TriMesh, VertexId,
};
use mesh_query::TriBvh;
use spine::{BlendCurve, Convexity};
use tri_intersect::SurfaceCurve;

/// The ball's centre may lie off the plane across the curve by this share of the radius.
const SQUARE: f64 = 0.1;
/// How near other faces may be to the centre, and how far from the feet their nearest points then must be, in radii.
const CLEAR: f64 = 1.05;
const BESIDE: f64 = 0.5;
/// How near other curves may be, in radii: a cap must not be in the way of a ball on them.
const APART: f64 = 2.05;
/// How far along the same curve it does not count as another, in radii.
const ALONG: f64 = 3.5;
/// How far the section goes on beyond the feet, in radii.
const BEYOND: f64 = 0.35;

/// A ball across a curve.
#[derive(Clone, Debug)]
pub(super) struct CutBall {
    pub centre: DVec3,
    pub halfedge: HalfedgeId,
    t: f64,
    /// On the left and the right side.
    feet: [DVec3; 2],
}

/// What is asked for balls.
pub(crate) struct CutBalls<'a> {
    pub curves: &'a [BlendCurve],
    /// The surface as balls meet it from inside and from outside.
    pub grounds: [&'a Ground<'a>; 2],
    pub convexities: Vec<Convexity>,
    pub r: f64,
    segments: TriMesh,
    tree: TriBvh,
    /// Curve of each segment, and its place along it.
    owner: Vec<(usize, f64)>,
    lengths: Vec<f64>,
    /// The first segment of each curve.
    first_edge: Vec<usize>,
}

impl<'a> CutBalls<'a> {
    pub fn new(
        curves: &'a [BlendCurve],
        convexities: Vec<Convexity>,
        grounds: [&'a Ground<'a>; 2],
        r: f64,
    ) -> Option<Self> {
        let mesh = grounds[0].mesh;
        let mut segments = TriMesh::default();
        let (mut owner, mut lengths, mut first_edge) = (vec![], vec![], vec![]);
        for (c, curve) in curves.iter().enumerate() {
            let mut along = 0.0;
            first_edge.push(owner.len());
            for &h in &curve.halfedges {
                let first = VertexId::from(segments.positions.len());
                segments.positions.extend(mesh.ends(h));
                segments.faces.push([first, VertexId(first.0 + 1), first]);
                owner.push((c, along));
                along += mesh.edge_length(h);
            }
            lengths.push(along);
        }
        let tree = TriBvh::build(&segments).ok()?;
        Some(Self { curves, grounds, convexities, r, segments, tree, owner, lengths, first_edge })
    }

    pub fn ground_mesh(&self) -> &'a Connected<TriMesh> {
        self.grounds[0].mesh
    }

    fn ground(&self, curve: usize) -> &Ground<'a> {
        self.grounds[usize::from(self.convexities[curve] == Convexity::Concave)]
    }

    /// The ball across a curve at a share of one of its edges, if it touches the curve's two sides and no other curve is
    /// near.
    pub fn at(&self, c: usize, edge: usize, t: f64) -> Option<CutBall> {
        let (ground, r) = (self.ground(c), self.r);
        let mesh = ground.mesh;
        let halfedge = self.curves[c].halfedges[edge];
        let [a, b] = mesh.ends(halfedge);
        let (x, along) = (a.lerp(b, t), (b - a).normalize_or_zero());
        if !self.is_apart(c, edge, t, x) {
            return None;
        }
        let twin = mesh.twin(halfedge)?;
        let sides = [halfedge, twin].map(HalfedgeId::face);
        if ground.patches.join(sides[0], sides[1]) {
            return None;
        }
        let centre = ground.centre(x, r, halfedge.face())?;
        if (centre - x).dot(along).abs() > SQUARE * r {
            return None;
        }
        let foot = |side: FaceId| {
            let found = ground.tree.closest_point_where(mesh, centre, 1.02 * r, |f| ground.patches.join(f, side))?;
            Some(found.point)
        };
        let feet = [foot(sides[0])?, foot(sides[1])?];
        let near = |f: FaceId| {
            let (p, _) = mesh_query::closest_point_on_triangle(centre, mesh.triangle(f));
            p.distance(centre) < CLEAR * r && feet.iter().all(|q| q.distance(p) > BESIDE * r)
        };
        let mut around = vec![];
        ground.tree.faces_in_box(mesh, &Bounds::of([centre]).inflated(CLEAR * r), &mut around);
        (!around.into_iter().any(near)).then_some(CutBall { centre, halfedge, t, feet })
    }

    /// The points nearest to `x` on the edges of other curves within reach: curve, edge, and share of it.
    pub fn beside(&self, c: usize, x: DVec3) -> Vec<(usize, usize, f64)> {
        let mut around = vec![];
        self.tree.faces_in_box(&self.segments, &Bounds::of([x]).inflated(APART * self.r), &mut around);
        let on_edge = |f: FaceId| {
            let [a, b, _] = self.segments.triangle(f);
            let t = ((x - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            (self.owner[f.index()].0 != c && a.lerp(b, t).distance(x) < APART * self.r)
                .then(|| (self.owner[f.index()].0, f.index() - self.first_edge[self.owner[f.index()].0], t))
        };
        around.into_iter().filter_map(on_edge).collect()
    }

    /// Whether nothing but the stretch around it is near to a point of a curve.
    fn is_apart(&self, c: usize, edge: usize, t: f64, x: DVec3) -> bool {
        let here = {
            let [a, b] = self.ground_mesh().ends(self.curves[c].halfedges[edge]);
            self.owner[self.first_edge[c] + edge].1 + t * a.distance(b)
        };
        let other = |f: FaceId| {
            let (owner, along) = self.owner[f.index()];
            let [a, b, _] = self.segments.triangle(f);
            let gap = if along > here { along - here } else { (here - along - a.distance(b)).max(0.0) };
            let gap = if self.curves[c].closed { gap.min(self.lengths[c] - gap - a.distance(b)).max(0.0) } else { gap };
            owner != c || gap > ALONG * self.r
        };
        self.tree.closest_point_where(&self.segments, x, APART * self.r, other).is_none()
    }

    /// The cross-section through a ball as a curve on the mesh, and the places in it of the apex and of both feet.
    /// `turn` is the largest angle between its points as the centre sees them.
    pub fn section(&self, c: usize, ball: &CutBall, turn: f64) -> Option<(SurfaceCurve, [usize; 3])> {
        let ground = self.ground(c);
        let mesh = ground.mesh;
        let [a, b] = mesh.ends(ball.halfedge);
        let x = a.lerp(b, ball.t);
        let apex = SurfacePoint::Edge { halfedge: ball.halfedge, t: ball.t };
        let twin = mesh.twin(ball.halfedge)?;
        let sides = [ball.halfedge, twin].map(HalfedgeId::face);
        let on = |side: usize, p: DVec3| {
            let found = ground.tree.closest_point_where(mesh, p, self.r, |f| ground.patches.join(f, sides[side]))?;
            Some((found.surface_point(mesh), ground.patches.face_normal(found.face)))
        };
        // From the foot to the apex, both left out; the ball's points between are met by rays from the centre.
        let half = |side: usize| {
            let (from, to) = (ball.feet[side] - ball.centre, x - ball.centre);
            let pieces = (from.angle_between(to) / turn).ceil().max(1.0) as usize;
            (1..pieces).map(move |k| (from, to, k as f64 / pieces as f64)).collect::<Vec<_>>()
        };
        let ray = |side: usize, (from, to, s): (DVec3, DVec3, f64)| {
            let angle = from.angle_between(to);
            let (f, g) = (((1.0 - s) * angle).sin(), (s * angle).sin());
            let direction = (f * from.normalize() + g * to.normalize()).normalize_or_zero();
            // Where the ray meets the chord from foot to apex, and from there to the surface.
            let chord = to - from;
            let across = direction.cross(chord);
            let reach = from.cross(chord).dot(across) / across.length_squared();
            on(side, ball.centre + reach * direction)
        };
        let far = |side: usize| on(side, ball.feet[side] + BEYOND * self.r * (ball.feet[side] - x).normalize_or_zero());
        let mut samples = vec![far(0)?, on(0, ball.feet[0])?];
        for step in half(0) {
            samples.push(ray(0, step)?);
        }
        let place = samples.len();
        let normal = (samples[1].1 + on(1, ball.feet[1])?.1).normalize_or_zero();
        samples.push((apex, normal));
        for step in half(1).into_iter().rev() {
            samples.push(ray(1, step)?);
        }
        samples.extend([on(1, ball.feet[1])?, far(1)?]);
        let (curve, at) = SurfaceCurve::through(mesh, &samples, false, &TraceLimits::default()).ok()?;
        Some((curve, [at[place], at[1], at[at.len() - 2]]))
    }
}
