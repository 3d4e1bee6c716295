//! Where a pose takes a shape: primitives and openings as they are at that point.

use super::Error;
use super::parts::Named;
use super::shape::Shape;
use super::table::Places;
use crate::operation::{LoopName, On, Pose, Snap};
use crate::pose::face::{face_to_face, opening_axis};
use crate::pose::placement::{self, Motion};
use crate::pose::similarity::Similarity;
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;

/// What stands already.
pub(super) struct Ground<'a> {
    pub(super) text: &'a str,
    pub(super) primitives: &'a BTreeMap<String, Named>,
    pub(super) shapes: &'a BTreeMap<String, Shape>,
}

/// A primitive in place.
#[derive(Clone, Copy)]
struct Placed {
    shape: placement::Shape,
    motion: Motion,
}

impl Ground<'_> {
    /// Where a shape goes: its own pose, then the primitive it rides on, then what it faces, then what it is set down on.
    pub(super) fn pose(&self, pose: &Pose, name: &str, places: &Places) -> Result<Similarity, Error> {
        let wrong = |e| places.wrong(self.text, &e);
        let mut similarity = pose.own().map_err(wrong)?;
        if let Some(on) = &pose.on {
            let span = places.span("on");
            if let Some(opening) = on.opening {
                let own = LoopName { part: name.into(), index: Some(opening) };
                let (middle, axis, _) = self.axis_of(&moved(self.rim(&own, &span)?, &similarity), &span)?;
                let turn = DQuat::from_rotation_arc(axis, DVec3::NEG_Z);
                similarity = similarity.then(Motion { rotation: turn, translation: -(turn * middle) });
            }
            similarity = similarity.then(self.place(on)?);
        }
        if let Some(snap) = &pose.snap {
            similarity = similarity.then(self.snap(snap, name, &similarity, &places.span("snap"))?);
        }
        let Some(shape) = self.shapes.get(name) else { return Ok(similarity) };
        pose.dropped(similarity, &shape.model.mesh).map_err(wrong)
    }

    /// The motion from a rider's coordinates to the model's.
    fn place(&self, on: &On) -> Result<Motion, Error> {
        let placed = self.primitive(&on.primitive)?;
        let [u, v] = on.at;
        let own = Motion { rotation: DQuat::from_rotation_z(on.spin.to_radians()), translation: on.offset * DVec3::Z };
        Ok(placed.motion.after(placed.shape.frame(u, v)).after(own))
    }

    /// Circles have been refused before.
    fn primitive(&self, name: &str) -> Result<Placed, Error> {
        let Some(named) = self.primitives.get(name) else {
            return Err(Error::about(name, format!("there is no [primitive.{name}]")));
        };
        let (primitive, wrong) = (&named.primitive, |e| named.places.wrong(self.text, &e));
        let (mut ground, mut ring) = (Motion::IDENTITY, None);
        if let Some(on) = &primitive.on {
            ground = self.place(on)?;
        } else if let Some(opening) = &primitive.opening {
            let span = named.places.span("loop");
            let (middle, axis, radius) = self.axis_of(&self.rim(opening, &span)?, &span)?;
            (ground, ring) = (Motion::along(axis, middle), Some(radius));
        }
        let shape = primitive.resolve(ring).map_err(wrong)?;
        Ok(Placed { shape, motion: ground.after(primitive.motion().map_err(wrong)?) })
    }

    /// The motion of an already posed shape to what it faces.
    fn snap(&self, snap: &Snap, name: &str, pose: &Similarity, span: &Range<usize>) -> Result<Motion, Error> {
        let own = LoopName { part: name.into(), index: Some(snap.opening) };
        let own = moved(self.rim(&own, span)?, pose);
        if self.primitives.contains_key(&snap.to.part) {
            let placed = self.primitive(&snap.to.part)?;
            let (middle, axis, _) = self.axis_of(&own, span)?;
            let local = placed.motion.rotation.inverse() * (middle - placed.motion.translation);
            let (u, v) = placed.shape.nearest(local);
            let frame = placed.motion.after(placed.shape.frame(u, v));
            let normal = frame.rotation * DVec3::Z;
            let turn = DQuat::from_rotation_arc(axis, -normal);
            let place = frame.translation + snap.gap.unwrap_or(0.0) * normal;
            return Ok(Motion { rotation: turn, translation: place - turn * middle });
        }
        if snap.to.part == name {
            return Err(Error::at(self.text, span.clone(), "a shape cannot face itself"));
        }
        let target = self.rim(&snap.to, span)?;
        let edge = (0..target.len()).map(|k| target[k].distance(target[(k + 1) % target.len()])).sum::<f64>();
        let gap = snap.gap.unwrap_or(2.0 * edge / target.len() as f64);
        face_to_face(&own, &target, gap)
            .ok_or_else(|| Error::at(self.text, span.clone(), "both loops need an area to face each other"))
    }

    /// The places of a shape's loop; the first where none is named.
    fn rim(&self, name: &LoopName, span: &Range<usize>) -> Result<Vec<DVec3>, Error> {
        let wrong = |what: String| Error::at(self.text, span.clone(), what);
        let shape = self.shapes.get(&name.part).ok_or_else(|| wrong(format!("there is no shape `{}`", name.part)))?;
        let (loops, number) = (shape.loops(), name.index.unwrap_or(0));
        let rim = loops.get(number).ok_or_else(|| {
            let told =
                wrong(format!("`{}` has {} loops at this point, so there is no loop {number}", name.part, loops.len()));
            told.remedy("`cut` makes an opening")
        })?;
        Ok(rim.iter().map(|v| shape.model.mesh.positions[v.index()]).collect())
    }

    /// The middle of a loop, its direction outward, and its mean radius.
    fn axis_of(&self, rim: &[DVec3], span: &Range<usize>) -> Result<(DVec3, DVec3, f64), Error> {
        let flat = || Error::at(self.text, span.clone(), "the loop has no area to stand on");
        let (middle, axis) = opening_axis(rim).ok_or_else(flat)?;
        Ok((middle, axis, rim.iter().map(|p| p.distance(middle)).sum::<f64>() / rim.len() as f64))
    }
}

fn moved(rim: Vec<DVec3>, pose: &Similarity) -> Vec<DVec3> {
    rim.into_iter().map(|p| pose.point(p)).collect()
}
