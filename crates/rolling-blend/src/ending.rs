//! Rails cut to length at the nodes: set back from corners, run out, or stopped at the surface ahead.

use crate::cap::Cap;
use crate::corner::{self, Corner, Setbacks};
use crate::network::{Kind, Network, Node};
use crate::profiles::Profiles;
use crate::stretch::{Ending, Outward, Stretch};
use crate::strip::{Fineness, profile_points};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, EdgeId, FaceId, Faces, HalfedgeId, Positions, SurfacePoint, TriMesh, VertexId, face_normal,
};
use mesh_query::TriBvh;
use spine::{BlendCurve, Rail, Sample};
use std::collections::HashSet;

/// The parts of a blend before it is cut into the mesh.
pub(crate) struct Layout {
    /// One for each curve that has a rail of its own.
    pub stretches: Vec<Option<Stretch>>,
    pub corners: Vec<Corner>,
    /// For each node of the network, its corner.
    pub corner_of: Vec<Option<usize>>,
}

/// What is needed to lay out the ends.
pub(crate) struct Ends<'a> {
    pub mesh: &'a Connected<TriMesh>,
    pub curves: &'a [BlendCurve],
    pub network: &'a Network,
    /// Of each curve.
    pub profiles: &'a [Profiles],
    pub fineness: Fineness,
}

/// Share of the base radius below which a ball that runs out is replaced by the tip.
const SMALLEST: f64 = 0.1;
/// How far from the node the tip is, as a share of the base radius.
const TIP_GAP: f64 = 0.05;
/// How far a flat cap leans, as a share of the radius: by that much the last profile stands before the section.
const LEANING: f64 = 0.05;
/// Least cosine between the normals of the surface ahead and that of its part at the node.
const GRAZING: f64 = 0.2;

impl Ends<'_> {
    /// Cuts every rail to length. A closed rail that is not among `kept` is left out.
    pub fn lay_out(&self, rails: &[Option<Rail>], kept: &[bool]) -> Result<Layout, Trouble> {
        let mut cuts: Vec<[Cut; 2]> = rails.iter().map(|_| [Cut::none(), Cut::none()]).collect();
        let mut setbacks: Vec<Option<Setbacks>> = Vec::with_capacity(self.network.nodes.len());
        let mut unstoppable = Vec::new();
        for (n, node) in self.network.nodes.iter().enumerate() {
            setbacks.push(None);
            let found = match &node.kind {
                Kind::Corner => {
                    let found = corner::set_back(self.mesh, node, rails, self.fineness.chord)?;
                    let cuts = found.cuts.iter().map(|(at, last)| Cut { at: *at, last: *last, ending: Ending::Corner });
                    let cuts = cuts.collect::<Vec<_>>();
                    setbacks[n] = Some(found);
                    cuts
                }
                Kind::RunOut { .. } => vec![self.run_out(node, rails)?],
                Kind::Cap(cap) => vec![self.cap(node, rails, cap)?],
                Kind::Stop { creases, beyond } => {
                    let Some(cut) = self.stop(node, rails, creases, beyond)? else {
                        unstoppable.push(n);
                        continue;
                    };
                    vec![cut]
                }
            };
            for (dart, cut) in node.darts.iter().zip(found) {
                cuts[dart.curve][dart.end] = cut;
            }
        }
        if !unstoppable.is_empty() {
            return Err(Trouble::NoStop(unstoppable));
        }
        let mut stretches = Vec::with_capacity(rails.len());
        for ((rail, cuts), keep) in rails.iter().zip(cuts).zip(kept) {
            stretches.push(match rail {
                Some(rail) if rail.closed => {
                    keep.then(|| Stretch { rail: rail.clone(), endings: [Ending::Joined, Ending::Joined] })
                }
                Some(rail) => Some(self.cut_to_length(rail, cuts)?),
                None => None,
            });
        }
        let (mut corners, mut corner_of) = (Vec::new(), vec![None; setbacks.len()]);
        for (n, (node, setbacks)) in self.network.nodes.iter().zip(&setbacks).enumerate() {
            if let Some(setbacks) = setbacks
                && let Some(corner) = corner::join(self.mesh, node, setbacks, &stretches, self.fineness.chord)
            {
                corner_of[n] = Some(corners.len());
                corners.push(corner);
            }
        }
        Ok(Layout { stretches, corners, corner_of })
    }

    fn cut_to_length(&self, rail: &Rail, cuts: [Cut; 2]) -> Result<Stretch, Trouble> {
        let n = rail.samples.len();
        let first = cuts[0].at;
        let last = (n - 1) as f64 - cuts[1].at;
        let view = Outward { rail, end: 0 };
        if let (Some(from), Some(to)) = (cuts[0].last, cuts[1].last)
            && last - first <= 1e-6
        {
            // The balls of both corners are all there is, if they have not passed each other.
            let middle = (0.5 * (first + last)).clamp(0.0, (n - 2) as f64) as usize;
            let along = rail.samples[middle + 1].center - rail.samples[middle].center;
            if (to.center - from.center).dot(along) > 0.0 {
                let [a, b] = cuts.map(|c| c.ending);
                return Ok(Stretch { rail: Rail { samples: vec![from, to], ..rail.clone() }, endings: [a, b] });
            }
        }
        if last - first <= 1e-6 {
            let middle = view.sample((0.5 * (first + last)).clamp(0.0, (n - 1) as f64)).center;
            return Err(Trouble::at("the blends at both ends of a curve leave no room between them", vec![middle]));
        }
        let mut samples = Vec::with_capacity(n);
        let exact = |at: f64| self.between(rail, at);
        samples.extend(cuts[0].last);
        samples.push(exact(first));
        // A share of a step away from the cuts, so that no sliver of a cell is left.
        let inner = (first + 0.3).ceil() as usize..=(last - 0.3).max(0.0).floor() as usize;
        samples.extend(inner.map(|i| rail.samples[i]));
        samples.push(exact(last));
        samples.extend(cuts[1].last);
        let [a, b] = cuts.map(|c| c.ending);
        Ok(Stretch { rail: Rail { samples, ..rail.clone() }, endings: [a, b] })
    }

    /// The ball at a place of a rail, its feet on the patches.
    fn between(&self, rail: &Rail, at: f64) -> Sample {
        let mut sample = Outward { rail, end: 0 }.sample(at);
        if at.fract() != 0.0 {
            for side in 0..2 {
                if let Some(foot) = rail.patches[side].closest(self.mesh, sample.feet[side].point) {
                    sample.feet[side] = foot;
                }
            }
        }
        sample
    }

    /// Ends a rail whose ball was made to vanish at the node.
    fn run_out(&self, node: &Node, rails: &[Option<Rail>]) -> Result<Cut, Trouble> {
        let place = self.mesh.position(node.vertex);
        let stuck = |at| Trouble::at("the ball cannot roll on", vec![at]);
        let dart = node.darts[0];
        let rail = rails[dart.curve].as_ref().ok_or_else(|| stuck(place))?;
        let view = Outward { rail, end: dart.end };
        let full = rail.samples.iter().map(|s| s.radius).fold(0.0, f64::max);
        let start = view.nearest(place).floor() as usize;
        let at = (start..view.len()).find(|&i| view.raw(i).radius >= SMALLEST * full).unwrap_or(start);
        if view.raw(at).radius > 0.5 * full {
            return Err(stuck(view.raw(at).center));
        }
        // Just short of the node, where another curve may run out too.
        let tip = dart.halfedge(self.mesh, self.curves).map_or(SurfacePoint::Vertex(node.vertex), |halfedge| {
            let length = self.mesh.position(self.mesh.head(halfedge)).distance(place);
            SurfacePoint::Edge { halfedge, t: (TIP_GAP * full / length.max(f64::MIN_POSITIVE)).min(0.3) }
        });
        Ok(Cut { at: at as f64, last: None, ending: Ending::Tip(tip) })
    }

    /// Ends a rail in a cross-section that is an edge chain of the mesh already.
    fn cap(&self, node: &Node, rails: &[Option<Rail>], cap: &Cap) -> Result<Cut, Trouble> {
        let dart = node.darts[0];
        let stuck = || Trouble::at("the ball cannot roll on", vec![self.mesh.position(node.vertex)]);
        let rail = rails[dart.curve].as_ref().ok_or_else(stuck)?;
        let view = Outward { rail, end: dart.end };
        let before = if cap.is_flat() { LEANING * view.raw(0).radius } else { 0.5 * self.fineness.chord };
        let at = view.advance(view.nearest(cap.centre), before);
        let ball = view.sample(at);
        let out = (view.sample(view.advance(at, before)).center - ball.center).normalize_or_zero();
        let mut points: Vec<_> = cap.end.iter().map(|&v| (SurfacePoint::Vertex(v), out)).collect();
        let left = ball.feet[0].point;
        let distance = |v: Option<&VertexId>| v.map_or(f64::INFINITY, |&v| self.mesh.position(v).distance(left));
        if distance(cap.end.last()) < distance(cap.end.first()) {
            points.reverse();
        }
        Ok(Cut { at, last: None, ending: Ending::Stop(points) })
    }

    /// Ends a rail at the surface ahead of the node: the last profile is pushed on along the spine until it lies there.
    /// `None` where it does not arrive.
    fn stop(
        &self,
        node: &Node,
        rails: &[Option<Rail>],
        creases: &[Vec<HalfedgeId>; 2],
        beyond: &[FaceId],
    ) -> Result<Option<Cut>, Trouble> {
        let (mesh, place) = (self.mesh, self.mesh.position(node.vertex));
        let dart = node.darts[0];
        let rail = rails[dart.curve].as_ref().ok_or_else(|| Trouble::at("the ball cannot roll on", vec![place]))?;
        let view = Outward { rail, end: dart.end };
        let radius = view.raw(0).radius;
        let surface = self.surface_ahead(place, creases, beyond, 6.0 * radius)?;
        let mut row = Vec::new();
        let mut at = view.nearest(place);
        for _ in 0..view.len() {
            let ball = self.between(rail, if dart.end == 0 { at } else { (view.len() - 1) as f64 - at });
            let along = view.sample(at).center - view.sample(view.advance(at, 0.5 * radius)).center;
            // Tangent to both sides, as the spine is not where the radius changes.
            let [a, b] = [0, 1].map(|side: usize| ball.center - ball.feet[side].point);
            let out = along.project_onto(a.cross(b)).normalize_or(along.normalize_or_zero());
            profile_points(&self.profiles[dart.curve], &ball, ball.feet.map(|f| f.point), self.fineness, &mut row);
            // Seen from behind the profile, so that points which are already through are noticed.
            let behind = 3.0 * radius;
            // The feet are on the edge of that surface, and are found there.
            let ahead: Option<Vec<_>> = row[1..row.len() - 1]
                .iter()
                .map(|&p| {
                    let hit = surface.ray_cast(mesh, p - behind * out, out, 8.0 * radius)?;
                    Some((hit.t - behind, SurfacePoint::Face { face: hit.face, barycentric: hit.barycentric }))
                })
                .collect();
            let clear = ahead.as_ref().is_some_and(|a| a.iter().all(|h| h.0 > 0.3 * self.fineness.chord));
            if let (true, Some(hits)) = (clear, ahead) {
                let side_of = |side: usize| {
                    let crease = &creases[usize::from(side != dart.end)];
                    let foot = row[if side == 0 { 0 } else { row.len() - 1 }];
                    let reach = hits.iter().map(|h| h.0).sum::<f64>() / hits.len() as f64;
                    on_crease(mesh, crease, foot, out, 4.0 * reach + radius)
                };
                let (Some(left), Some(right)) = (side_of(0), side_of(1)) else { break };
                let mut points = vec![(left, out)];
                points.extend(hits.iter().map(|h| (h.1, out)));
                points.push((right, out));
                return Ok(Some(Cut { at, last: None, ending: Ending::Stop(points) }));
            }
            let next = view.advance(at, 0.5 * self.fineness.chord);
            if next <= at {
                break;
            }
            at = next;
        }
        Ok(None)
    }

    /// The faces at which a blend stops, as far as it can reach them.
    fn surface_ahead(
        &self,
        place: DVec3,
        creases: &[Vec<HalfedgeId>; 2],
        beyond: &[FaceId],
        reach: f64,
    ) -> Result<TriBvh, Trouble> {
        let mesh = self.mesh;
        let curves = self.curves.iter().flat_map(|c| &c.halfedges);
        let walls: HashSet<EdgeId> = creases.iter().flatten().chain(curves).map(|&h| mesh.edge(h)).collect();
        let (mut faces, mut seen) = (beyond.to_vec(), beyond.iter().copied().collect::<HashSet<_>>());
        let mut next = 0;
        while let Some(&face) = faces.get(next) {
            next += 1;
            for corner in 0..3 {
                let h = HalfedgeId::new(face, corner);
                let Some(t) = mesh.twin(h).filter(|_| !walls.contains(&mesh.edge(h))) else { continue };
                let near =
                    mesh_query::closest_point_on_triangle(place, mesh.triangle(t.face())).0.distance(place) < reach;
                if near && seen.insert(t.face()) {
                    faces.push(t.face());
                }
            }
        }
        // Of all these, those that face the way of the ones at the node: a ray that grazes a side must not end there.
        let facing = beyond.iter().map(|&f| face_normal(mesh, f)).sum::<DVec3>().normalize_or_zero();
        faces.retain(|&f| face_normal(mesh, f).dot(facing) > GRAZING);
        TriBvh::build_subset(mesh, &faces).map_err(|e| Trouble::Spine(e.into()))
    }
}

/// Where a rail is cut, counted from that end.
struct Cut {
    at: f64,
    /// The ball after the cut, where it is known better.
    last: Option<Sample>,
    ending: Ending,
}

impl Cut {
    fn none() -> Self {
        Self { at: 0.0, last: None, ending: Ending::Joined }
    }
}

/// The point of a chain of edges nearest to the ray from `foot` along `out`.
fn on_crease(
    mesh: &Connected<TriMesh>,
    crease: &[HalfedgeId],
    foot: DVec3,
    out: DVec3,
    reach: f64,
) -> Option<SurfacePoint> {
    let ray = [foot - reach * out, foot + reach * out];
    let candidates = crease.iter().map(|&halfedge| {
        let ends = mesh.ends(halfedge);
        let (s, t) = corner::closest_between(ray, ends);
        let distance = ray[0].lerp(ray[1], s).distance(ends[0].lerp(ends[1], t));
        (distance, SurfacePoint::Edge { halfedge, t }, t)
    });
    let (distance, point, t) = candidates.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let SurfacePoint::Edge { halfedge, .. } = point else { return None };
    let point = if t <= 0.0 {
        SurfacePoint::Vertex(mesh.tail(halfedge))
    } else if t >= 1.0 {
        SurfacePoint::Vertex(mesh.head(halfedge))
    } else {
        point
    };
    (distance < 0.25 * reach).then_some(point)
}
