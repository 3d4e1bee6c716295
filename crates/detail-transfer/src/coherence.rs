//! Copying on: the source place beside the one that a neighbour copied.

use crate::fan::BRANCHES;
use crate::relief::{Detail, Frame, Relief};
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, Faces, Positions, VertexId};
use std::f64::consts::TAU;

/// Where on a source a target vertex copied from. Neighbours that copied on from one another keep their distances on the source, so their
/// bends are those of one surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub source: usize,
    /// The nearest vertex, whose detail is taken.
    pub vertex: VertexId,
    /// The angle from the target's frame to the source vertex's, in radians.
    pub angle: f64,
    /// From that vertex to the place itself, in the vertex's frame and model units.
    rest: DVec2,
}

impl Place {
    /// A source vertex itself, turned by eighths.
    pub fn at(source: usize, vertex: VertexId, turn: u8) -> Self {
        Self { source, vertex, angle: TAU * f64::from(turn) / BRANCHES as f64, rest: DVec2::ZERO }
    }

    /// The nearest eighth of a turn.
    pub fn turn(&self) -> u8 {
        let eighths = (self.angle / TAU * BRANCHES as f64).round();
        eighths.rem_euclid(BRANCHES as f64) as u8
    }

    /// The source's detail as seen from the target. That of the nearest vertex, not a mean of several: means are smoother than what they are of.
    pub fn detail(&self, source: &Relief) -> Detail {
        let back = DVec2::from_angle(-self.angle);
        let turn = |v: DVec3| back.rotate(v.truncate()).extend(v.z);
        let Detail { bend, offset } = source.details()[self.vertex.index()];
        Detail { bend: turn(bend), offset: turn(offset) }
    }

    /// As far from here on the source as `to` is from `from`, which copied from here, on the target. `None` beyond the edge of the source.
    pub fn beside(&self, target: &Relief, from: VertexId, to: VertexId, source: &Relief) -> Option<Self> {
        let (here, there) = (target.frames()[from.index()], target.frames()[to.index()]);
        let way = target.base().position(to) - target.base().position(from);
        let flat = here.local(way).truncate().try_normalize()? * way.length();
        let flat = DVec2::from_angle(self.angle).rotate(flat) + self.rest;
        let own = source.frames()[self.vertex.index()];
        let (place, base) = (source.base().position(self.vertex) + own.world(flat.extend(0.0)), source.base());
        let mut vertex = self.vertex;
        let mut nearest = base.position(vertex).distance_squared(place);
        loop {
            let before = vertex;
            for h in base.ring(before) {
                for w in [base.head(h), base.tail(h.prev())] {
                    let distance = base.position(w).distance_squared(place);
                    if distance < nearest {
                        (vertex, nearest) = (w, distance);
                    }
                }
            }
            if vertex == before {
                break;
            }
        }
        if source.rim()[vertex.index()] {
            return None;
        }
        let reached = source.frames()[vertex.index()];
        let angle = self.angle + turned(&here, &there) - turned(&own, &reached);
        let rest = reached.local(place - base.position(vertex)).truncate();
        Some(Self { source: self.source, vertex, angle, rest })
    }
}

/// The angle from one frame's tangent to its neighbour's, about the normal.
fn turned(here: &Frame, there: &Frame) -> f64 {
    let tangent = here.local(there.carried(here.normal).tangent);
    tangent.y.atan2(tangent.x)
}
