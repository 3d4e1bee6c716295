//! Where every part stands.

use super::joins::split_loop;
use super::part_tables::{On, Primitive, Radius, Snap};
use super::placement::{Motion, Shape};
use super::snap::{face_to_face, opening_axis};
use super::values::Pose;
use super::{Error, Recipe};
use glam::{DQuat, DVec3};
use mesh_core::{Connected, Faces, Positions, TriMesh, boundary_loops};
use toml::Spanned;

/// Primitives and parts that stand on each other, deepest.
const DEEPEST: usize = 32;

/// A primitive in place.
#[derive(Clone, Copy)]
struct Placed {
    shape: Shape,
    motion: Motion,
}

/// The parts' meshes, as cut.
struct Stage<'a> {
    recipe: &'a Recipe,
    meshes: &'a [&'a TriMesh],
}

impl Recipe {
    /// Every part's pose, given the parts as cut.
    pub(super) fn poses(&self, meshes: &[&TriMesh]) -> Result<Vec<Pose>, Error> {
        let stage = Stage { recipe: self, meshes };
        (0..self.parts.len()).map(|i| stage.part(i, 0)).collect()
    }

    /// What can be known about places without the parts.
    pub(super) fn check_places(&self, names: &[&str]) -> Result<(), Error> {
        for (name, primitive) in &self.primitives {
            if names.contains(&name.as_str()) {
                let message = format!("`{name}` is a part, too; names must differ");
                return Err(self.error(primitive.shape.span(), message));
            }
            self.shape(primitive, Some(1.0))?;
            self.local(primitive)?;
            if let Some(opening) = &primitive.opening {
                self.part_of(opening)?;
            }
        }
        let places = self.parts.iter().filter_map(|p| p.on.as_ref());
        for on in places.chain(self.primitives.values().filter_map(|p| p.on.as_ref())) {
            self.check_on(on)?;
        }
        for snap in self.parts.iter().filter_map(|p| p.snap.as_ref()) {
            if !self.primitives.contains_key(snap.to.get_ref()) {
                self.part_of(&snap.to)?;
            }
            if let Some(gap) = &snap.gap {
                self.finite(gap)?;
            }
        }
        Ok(())
    }

    fn check_on(&self, on: &On) -> Result<(), Error> {
        if !self.primitives.contains_key(on.primitive.get_ref()) {
            let known: Vec<&str> = self.primitives.keys().map(String::as_str).collect();
            let message = format!("there is no [primitive.{}], only {}", on.primitive.get_ref(), known.join(", "));
            return Err(self.error(on.primitive.span(), message));
        }
        if !on.at.get_ref().iter().all(|x| x.is_finite()) {
            return Err(self.error(on.at.span(), "a place is two finite numbers"));
        }
        [&on.spin, &on.offset].into_iter().flatten().try_for_each(|number| self.finite(number))
    }

    fn finite(&self, number: &Spanned<f64>) -> Result<(), Error> {
        if number.get_ref().is_finite() { Ok(()) } else { Err(self.error(number.span(), "must be a finite number")) }
    }

    /// The part, and the number of one of its loops.
    fn part_of(&self, text: &Spanned<String>) -> Result<(usize, usize), Error> {
        let (name, number) = split_loop(text.get_ref()).unwrap_or_default();
        let part = self.parts.iter().position(|p| p.name.get_ref() == name);
        part.map(|p| (p, number.unwrap_or(0))).ok_or_else(|| {
            self.error(
                text.span(),
                "must name an opening of a part, such as \"body:0\", or a primitive where one can stand",
            )
        })
    }

    /// A primitive's shape; `ring` is the radius of the opening it stands on.
    fn shape(&self, primitive: &Primitive, ring: Option<f64>) -> Result<Shape, Error> {
        let span = primitive.shape.span();
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let missing = |what: &str| self.error(span.clone(), format!("needs {what}, above 0 and finite"));
        let radii = match primitive.radius.as_ref().map(|r| *r.get_ref()) {
            Some(Radius::One(r)) => Some([r; 2]),
            Some(Radius::Two(both)) => Some(both),
            None => ring.filter(|_| primitive.opening.is_some()).map(|r| [r; 2]),
        };
        let radii = radii.filter(|r| r.iter().all(|&r| r >= 0.0 && r.is_finite()) && r[0] + r[1] > 0.0);
        let height = primitive.height.as_ref().map(|h| *h.get_ref()).filter(|&h| positive(h));
        match primitive.shape.get_ref().as_str() {
            "sphere" => radii.map(|r| Shape::Sphere(r[0])).ok_or_else(|| missing("a radius")),
            "cylinder" | "cone" => {
                let radii = radii.ok_or_else(|| missing("a radius, or two for a cone"))?;
                Ok(Shape::Cone(radii, height.ok_or_else(|| missing("a height"))?))
            }
            "box" => {
                let size = primitive.size.as_ref().map(|s| DVec3::from(*s.get_ref()));
                let size = size.filter(|s| s.is_finite() && s.min_element() > 0.0);
                size.map(Shape::Box).ok_or_else(|| missing("a size, three numbers"))
            }
            _ => Err(self.error(span.clone(), "a shape is box, cylinder, sphere or cone")),
        }
    }

    /// A primitive's own motion, before what it stands on.
    fn local(&self, primitive: &Primitive) -> Result<Motion, Error> {
        let value = |s: &Option<Spanned<[f64; 3]>>| s.as_ref().map(|s| DVec3::from(*s.get_ref()));
        let base = value(&primitive.base).unwrap_or(DVec3::ZERO);
        let axis = value(&primitive.axis).unwrap_or(DVec3::Z).try_normalize().filter(|_| base.is_finite());
        axis.map(|axis| Motion::along(axis, base)).ok_or_else(|| {
            self.error(primitive.shape.span(), "a base needs finite numbers, an axis a direction other than 0, 0, 0")
        })
    }
}

impl Stage<'_> {
    /// A part's pose: its own, then the primitive it rides on, then what it snaps to.
    fn part(&self, i: usize, depth: usize) -> Result<Pose, Error> {
        let part = &self.recipe.parts[i];
        let mut pose = self.recipe.pose(part)?;
        if depth > DEEPEST {
            return Err(self.recipe.error(part.name.span(), "stands on itself, by way of others"));
        }
        if let Some(on) = &part.on {
            if let Some(opening) = on.opening {
                let (middle, axis, _) = axis_of(&self.rim(i, opening, on.primitive.span(), &pose)?, || {
                    self.recipe.error(on.primitive.span(), "the loop has no area to be set on a primitive")
                })?;
                let turn = DQuat::from_rotation_arc(axis, DVec3::NEG_Z);
                pose = pose.then(Motion { rotation: turn, translation: -(turn * middle) });
            }
            pose = pose.then(self.place(on, depth)?);
        }
        if let Some(snap) = &part.snap {
            pose = pose.then(self.snap(i, snap, &pose, depth)?);
        }
        Ok(pose)
    }

    /// The motion from a rider's coordinates to the model's.
    fn place(&self, on: &On, depth: usize) -> Result<Motion, Error> {
        let placed = self.primitive(on.primitive.get_ref(), depth + 1)?;
        let [u, v] = *on.at.get_ref();
        let number = |s: &Option<Spanned<f64>>| s.as_ref().map_or(0.0, |s| *s.get_ref());
        let spin = DQuat::from_rotation_z(number(&on.spin).to_radians());
        let own = Motion { rotation: spin, translation: number(&on.offset) * DVec3::Z };
        Ok(placed.motion.after(placed.shape.frame(u, v)).after(own))
    }

    fn primitive(&self, name: &str, depth: usize) -> Result<Placed, Error> {
        let Some(primitive) = self.recipe.primitives.get(name) else {
            return Err(self.recipe.error(0..0, format!("there is no [primitive.{name}]")));
        };
        if depth > DEEPEST {
            return Err(self.recipe.error(primitive.shape.span(), "stands on itself, by way of others"));
        }
        let (mut ground, mut ring) = (Motion::IDENTITY, None);
        if let Some(on) = &primitive.on {
            ground = self.place(on, depth)?;
        } else if let Some(opening) = &primitive.opening {
            let (part, number) = self.recipe.part_of(opening)?;
            let rim = self.rim(part, number, opening.span(), &self.part(part, depth + 1)?)?;
            let flat = || self.recipe.error(opening.span(), "the loop has no area to stand on");
            let (middle, axis, radius) = axis_of(&rim, flat)?;
            (ground, ring) = (Motion::along(axis, middle), Some(radius));
        }
        let shape = self.recipe.shape(primitive, ring)?;
        Ok(Placed { shape, motion: ground.after(self.recipe.local(primitive)?) })
    }

    /// The motion of an already posed part to what it snaps to.
    fn snap(&self, i: usize, snap: &Snap, pose: &Pose, depth: usize) -> Result<Motion, Error> {
        let own = self.rim(i, snap.opening.unwrap_or(0), snap.to.span(), pose)?;
        let flat = || self.recipe.error(snap.to.span(), "both loops need an area to face each other");
        let gap = snap.gap.as_ref().map(|g| *g.get_ref());
        if self.recipe.primitives.contains_key(snap.to.get_ref()) {
            let placed = self.primitive(snap.to.get_ref(), depth + 1)?;
            let (middle, axis, _) = axis_of(&own, flat)?;
            let local = placed.motion.rotation.inverse() * (middle - placed.motion.translation);
            let (u, v) = placed.shape.nearest(local);
            let frame = placed.motion.after(placed.shape.frame(u, v));
            let normal = frame.rotation * DVec3::Z;
            let turn = DQuat::from_rotation_arc(axis, -normal);
            let place = frame.translation + gap.unwrap_or(0.0) * normal;
            return Ok(Motion { rotation: turn, translation: place - turn * middle });
        }
        let (part, number) = self.recipe.part_of(&snap.to)?;
        if part == i {
            return Err(self.recipe.error(snap.to.span(), "a part cannot snap to itself"));
        }
        let target = self.rim(part, number, snap.to.span(), &self.part(part, depth + 1)?)?;
        let edge = (0..target.len()).map(|k| target[k].distance(target[(k + 1) % target.len()])).sum::<f64>();
        face_to_face(&own, &target, gap.unwrap_or(2.0 * edge / target.len() as f64)).ok_or_else(flat)
    }

    /// The places of a part's loop, in the pose given.
    fn rim(&self, part: usize, number: usize, span: std::ops::Range<usize>, pose: &Pose) -> Result<Vec<DVec3>, Error> {
        let name = self.recipe.parts[part].name.get_ref();
        let wrong = |what: String| self.recipe.error(span.clone(), what);
        let mesh = Connected::new(self.meshes[part]).map_err(|e| wrong(format!("part `{name}` is {e}")))?;
        let loops = boundary_loops(&mesh);
        let walk = loops.get(number).ok_or_else(|| {
            wrong(format!("part `{name}` has {} loops after its cuts, so there is no loop {number}", loops.len()))
        })?;
        Ok(walk.iter().map(|&h| pose.point(mesh.position(mesh.tail(h)))).collect())
    }
}

/// The middle of a loop, its direction outward, and its mean radius.
fn axis_of(rim: &[DVec3], flat: impl Fn() -> Error) -> Result<(DVec3, DVec3, f64), Error> {
    let (middle, axis) = opening_axis(rim).ok_or_else(flat)?;
    Ok((middle, axis, rim.iter().map(|p| p.distance(middle)).sum::<f64>() / rim.len() as f64))
}
