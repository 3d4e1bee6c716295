//! Where a mesh is set: on primitives, and before openings.

use super::compose::LoopName;
use super::define::words;
use super::option_error::{Check, OptionError, ensure};
use crate::pose::placement::{Motion, Shape};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A turn about an axis through the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis, of any length.
    #[schemars(with = "[f64; 3]")]
    pub axis: DVec3,
    /// Degrees, counter-clockwise seen against the axis.
    pub angle: f64,
}

impl FromStr for Rotation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || String::from("a turn is an axis and degrees, such as 0,0,1,90");
        let (axis, angle) = text.rsplit_once(',').ok_or_else(wrong)?;
        let axis = super::point(axis).ok().filter(|axis| *axis != DVec3::ZERO).ok_or_else(wrong)?;
        let angle: f64 = angle.trim().parse().map_err(|_| wrong())?;
        if angle.is_finite() { Ok(Self { axis, angle }) } else { Err(wrong()) }
    }
}

/// A place on a primitive. What rides there has its origin at the place, its z axis out of the surface, and its x axis along
/// growing u.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct On {
    /// The primitive's name.
    pub primitive: String,
    /// u and v: u from 0 to 1 once round the axis; v from 0 at the base to 1 at the top, on to 2 over the top to its middle,
    /// down to −1 over the base. On a sphere v goes from pole to pole.
    pub at: [f64; 2],
    /// Turns about the surface's normal, in degrees.
    #[serde(default)]
    pub spin: f64,
    /// Moves out of the surface, in model units.
    #[serde(default)]
    pub offset: f64,
    /// Of a mesh: the loop whose middle comes to the place and which faces the surface.
    #[serde(rename = "loop", default, skip_serializing_if = "Option::is_none")]
    pub opening: Option<usize>,
}

impl On {
    pub(crate) fn check(&self, option: &'static str) -> Check {
        let numbers = [self.at[0], self.at[1], self.spin, self.offset];
        ensure(numbers.iter().all(|x| x.is_finite()), option, || {
            "a place, a spin and an offset are finite numbers".into()
        })
    }
}

/// An alignment of one opening with another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Snap {
    /// `"name:loop"`, or the name of a primitive.
    pub to: LoopName,
    /// Its own loop.
    #[serde(rename = "loop", default)]
    pub opening: usize,
    /// How far apart they are left; two edges of the other loop where left out, nothing on a primitive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
}

words! {
    /// The shape of a primitive.
    pub enum PrimitiveShape: "a shape" {
        /// Rises along its axis
        Box = "box",
        /// Rises along its axis
        Cylinder = "cylinder",
        /// About its base
        Sphere = "sphere",
        /// Rises along its axis, with a radius at the base and one at the top
        Cone = "cone",
    }
}

/// One radius, or one at the base and one at the top.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a radius is a number, or two: at the base and at the top")]
#[schemars(title = "number, or two of a cone")]
pub enum Radii {
    /// One all along.
    One(f64),
    /// At the base and at the top.
    Two([f64; 2]),
}

/// A body that meshes ride on, and that is not itself in the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Primitive {
    /// Its shape.
    pub shape: PrimitiveShape,
    /// The middle of its base, or of a sphere.
    #[serde(default)]
    #[schemars(with = "[f64; 3]")]
    pub base: DVec3,
    /// From base to top, of any length.
    #[serde(default = "up")]
    #[schemars(with = "[f64; 3]")]
    pub axis: DVec3,
    /// The radius; two for a cone, at the base and at the top; that of `loop` where left out. All shapes but a box need it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<Radii>,
    /// The height of a cylinder or cone, which need it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Extents of a box, which needs them; the last is along the axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f64; 3]>")]
    pub size: Option<DVec3>,
    /// The opening it stands on, `"name:loop"`: base and axis count from its middle, z out of it.
    #[serde(rename = "loop", default, skip_serializing_if = "Option::is_none")]
    pub opening: Option<LoopName>,
    /// The primitive it stands on: base and axis count from there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<On>,
}

fn up() -> DVec3 {
    DVec3::Z
}

impl Primitive {
    /// What can be known without the meshes.
    pub(crate) fn check(&self) -> Check {
        self.resolve(Some(1.0))?;
        self.motion()?;
        ensure(self.on.is_none() || self.opening.is_none(), "loop", || {
            "a primitive stands on an opening or on another primitive, not on both".into()
        })?;
        self.on.as_ref().map_or(Ok(()), |on| on.check("on"))
    }

    /// Its shape in its own coordinates; `ring` is the radius of the opening it stands on.
    pub(crate) fn resolve(&self, ring: Option<f64>) -> Result<Shape, OptionError> {
        let positive = |x: &f64| *x > 0.0 && x.is_finite();
        let radii = match self.radius {
            Some(Radii::One(r)) => Some([r; 2]),
            Some(Radii::Two(both)) => Some(both),
            None => ring.filter(|_| self.opening.is_some()).map(|r| [r; 2]),
        };
        let radii = radii.filter(|r| r.iter().all(|&r| r >= 0.0 && r.is_finite()) && r[0] + r[1] > 0.0);
        let missing = |option, what: &str| OptionError::new(option, format!("needs {what}, above 0 and finite"));
        match self.shape {
            PrimitiveShape::Sphere => radii.map(|r| Shape::Sphere(r[0])).ok_or_else(|| missing("radius", "a radius")),
            PrimitiveShape::Cylinder | PrimitiveShape::Cone => {
                let radii = radii.ok_or_else(|| missing("radius", "a radius, or two for a cone"))?;
                let height = self.height.filter(positive).ok_or_else(|| missing("height", "a height"))?;
                Ok(Shape::Cone(radii, height))
            }
            PrimitiveShape::Box => {
                let size = self.size.filter(|s| s.is_finite() && s.min_element() > 0.0);
                size.map(Shape::Box).ok_or_else(|| missing("size", "a size, three numbers"))
            }
        }
    }

    /// Its own motion, before what it stands on.
    pub(crate) fn motion(&self) -> Result<Motion, OptionError> {
        ensure(self.base.is_finite(), "base", || "a base is three finite numbers".into())?;
        let axis = self.axis.try_normalize();
        let axis = axis.ok_or_else(|| OptionError::new("axis", "an axis is a direction other than 0, 0, 0"))?;
        Ok(Motion::along(axis, self.base))
    }
}
