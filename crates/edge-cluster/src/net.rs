//! Control nets: every control point in the planes its contact asks for, and in a fair place there.

use crate::cluster::Cluster;
use crate::control::Shape;
use crate::error::Error;
use crate::fair::settle;
use crate::plane::{Flat, Plane};
use crate::polyhedron::Polyhedron;
use glam::DVec3;

/// A control net with contact of order g to the planes around it.
#[derive(Clone, Debug)]
pub struct Net {
    /// Kind and degree.
    pub shape: Shape,
    /// Order of contact, g.
    pub continuity: usize,
    /// The plane of each side.
    pub planes: Vec<Plane>,
    /// The control points, numbered as [`Shape`] says, in model units.
    pub points: Vec<DVec3>,
    /// Where each control point may be moved without losing contact.
    pub flats: Vec<Flat>,
}

/// How a net is laid out.
#[derive(Clone, Debug)]
pub struct Params {
    /// Order of contact with the faces, g ≥ 1.
    pub continuity: usize,
    /// Kind and degree; sides as many as the cluster has.
    pub shape: Shape,
    /// Distance of the patch's corner along each open edge, in model units.
    pub reach: Vec<f64>,
    /// 0 for the fairest net; towards 1 the net is pulled into the polyhedron's vertices, so that the blend is sharper.
    pub bulge: f64,
    /// Control points moved on request, by index.
    pub moves: Vec<Move>,
}

/// A control point moved by hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// Its index: (i, j) of a tensor-product patch, (i_1, …, i_m) of an S-patch.
    pub index: Vec<u8>,
    /// By how much, in model units. What would lead out of the point's planes is left out.
    pub by: DVec3,
}

/// Distances below this share of the polyhedron are rounding.
const ROUNDING: f64 = 1e-9;

impl Net {
    /// The net around a cluster.
    ///
    /// # Errors
    /// [`Error::Conflict`] where a control point has no place, naming a degree that works; [`Error::Degree`],
    /// [`Error::NoControlPoint`].
    pub fn new(solid: &Polyhedron, cluster: &Cluster, params: &Params) -> Result<Self, Error> {
        let shape = params.shape.checked()?;
        let g = params.continuity;
        let m = cluster.sides();
        if g == 0 || g > 20 {
            return Err(Error::Range { name: "continuity", value: g as f64, range: "1 to 20" });
        }
        if shape.sides() != m || params.reach.len() != m {
            return Err(Error::Degree { degree: shape.to_string(), why: "its sides are not those of the cluster" });
        }
        let planes: Vec<Plane> = cluster.open.iter().map(|&h| solid.plane(h)).collect();
        let (mut flats, anchors) = flats(solid, cluster, shape, g, &planes).map_err(|(index, sides)| {
            let sides = (0..m).filter(|k| sides >> k & 1 == 1).map(|k| k + 1).collect();
            let at = solid.positions[cluster.vertices[0] as usize];
            let works = lowest_degree(solid, cluster, shape, g, &planes).map(|s| s.to_string());
            Error::Conflict { degree: shape.to_string(), continuity: g, at, index, sides, works }
        })?;
        let held = flats.clone();
        for (k, (&h, reach)) in cluster.open.iter().zip(&params.reach).enumerate() {
            let tail = solid.positions[solid.halfedges[h as usize].tail as usize];
            flats[shape.border(k)[0]] = Flat::point(tail + *reach * solid.vector(h).normalize_or_zero());
        }
        let bulge = params.bulge.clamp(0.0, 0.99);
        let mut anchors: Vec<(DVec3, f64)> = anchors.into_iter().map(|a| (a, bulge / (1.0 - bulge))).collect();
        for k in (0..m).filter(|&k| cluster.is_hollow(solid, k)) {
            hold_hollow(solid, cluster, params, k, &mut anchors);
        }
        let mut points = settle(&flats, &shape.neighbours(), &anchors);
        for step in &params.moves {
            let missing = || Error::NoControlPoint { index: step.index.clone(), degree: shape.to_string() };
            let number = shape.number(&step.index).ok_or_else(missing)?;
            points[number] = held[number].nearest(points[number] + step.by);
        }
        Ok(Self { shape, continuity: g, planes, points, flats: held })
    }

    /// Largest distance of a control point from a plane of whose contact it decides, in model units.
    pub fn residual(&self) -> f64 {
        let off = |(index, &p): (Vec<u8>, &DVec3)| {
            let sides = (0..self.planes.len()).filter(|&k| self.shape.is_in_side(&index, k, self.continuity));
            sides.map(|k| self.planes[k].height(p).abs()).fold(0.0, f64::max)
        };
        self.shape.indices().into_iter().zip(&self.points).map(off).fold(0.0, f64::max)
    }
}

/// How stiffly the edges of a hollow side are held, beside the springs.
const HOLD: f64 = 20.0;

/// Places for the control points on the open edges beside a face that is reflex at the cluster, such as the notch of a
/// star. There the blend must leave the face away from the cluster's vertex, not towards it, or it would fold over the
/// face: so the face's own boundary comes close to the vertex, and the rows behind it stay far out on the edges.
fn hold_hollow(solid: &Polyhedron, cluster: &Cluster, params: &Params, side: usize, anchors: &mut [(DVec3, f64)]) {
    let (m, shape) = (cluster.sides(), params.shape);
    for (k, ahead) in [(side, 0), ((side + 1) % m, 1)] {
        let h = cluster.open[k];
        let tail = solid.positions[solid.halfedges[h as usize].tail as usize];
        let arm = params.reach[k] * solid.vector(h).normalize_or_zero();
        let unit = 2.0 / (shape.side_degree(side).max(3) - 1) as f64;
        for (index, anchor) in shape.indices().iter().zip(anchors.iter_mut()) {
            let on_edge = shape.is_in_side(index, k, params.continuity)
                && shape.is_in_side(index, (k + m - 1) % m, params.continuity);
            if on_edge {
                let steps = shape.steps_from(index, k);
                let (along, others) = (steps[ahead], steps[1 - ahead] + steps[2]);
                // Along the face's boundary down to the vertex and a little beyond; behind it, not half as far.
                let behind = (others as f64 / params.continuity as f64).min(1.0);
                let share = 1.0 - unit * (0.3 * others as f64 + along as f64 * (1.05 - 0.65 * behind));
                *anchor = (tail + share * arm, HOLD);
            }
        }
    }
}

type Places = (Vec<Flat>, Vec<DVec3>);

/// Where each control point may be, and the vertex it belongs to; or the index and sides of one that has no place.
fn flats(
    solid: &Polyhedron,
    cluster: &Cluster,
    shape: Shape,
    g: usize,
    planes: &[Plane],
) -> Result<Places, (Vec<u8>, u64)> {
    let m = shape.sides();
    let tail = |k: usize| solid.positions[solid.halfedges[cluster.open[k % m] as usize].tail as usize];
    let anchor = |index: &[u8]| match shape {
        Shape::Tensor([a, b]) => {
            let (u, v) = (f64::from(index[0]) / a as f64, f64::from(index[1]) / b as f64);
            tail(0).lerp(tail(1), u).lerp(tail(3).lerp(tail(2), u), v)
        }
        Shape::Simplex { degree, .. } => {
            index.iter().enumerate().map(|(k, &i)| f64::from(i) / degree as f64 * tail(k)).sum()
        }
    };
    let corners: Vec<usize> = (0..m).map(|k| shape.border(k)[0]).collect();
    let mut known: Vec<(u64, Option<Flat>)> = vec![];
    let (mut flats, mut anchors) = (vec![], vec![]);
    for index in shape.indices() {
        let (sides, near) = (shape.sides_of(&index, g), anchor(&index));
        let known_flat = known.iter().find(|k| k.0 == sides).map(|k| k.1);
        let met = known_flat.unwrap_or_else(|| {
            let through: Vec<Plane> = (0..m).filter(|k| sides >> k & 1 == 1).map(|k| planes[k]).collect();
            let flat = Flat::meet(&through, near, ROUNDING.mul_add(solid.size, 4.0 * solid.flatness));
            known.push((sides, flat));
            flat
        });
        // A corner must be free to move along its open edge.
        let pinned = corners.contains(&flats.len()) && met.is_some_and(|f| f.dimension == 0);
        flats.push(met.filter(|_| !pinned).ok_or((index, sides))?);
        anchors.push(near);
    }
    Ok((flats, anchors))
}

/// The lowest degree at which every control point has a place.
fn lowest_degree(solid: &Polyhedron, cluster: &Cluster, shape: Shape, g: usize, planes: &[Plane]) -> Option<Shape> {
    let raised = |n: usize| match shape {
        Shape::Tensor(_) => Shape::Tensor([n.max(2 * g + 1), n]),
        Shape::Simplex { sides, .. } => Shape::Simplex { sides, degree: n },
    };
    (1..=2 * g + 1).map(raised).find(|s| s.checked().is_ok() && flats(solid, cluster, *s, g, planes).is_ok())
}
