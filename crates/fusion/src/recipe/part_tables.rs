//! What may stand in the table of a part, and in those of what parts stand on.

use super::values::{DVec3Array, Rotation};
use crate::operation::Cut;
use serde::Deserialize;
use std::path::PathBuf;
use toml::Spanned;

/// One input.
#[derive(Clone, Debug, Deserialize)]
pub struct Part {
    /// What other tables call it.
    pub name: Spanned<String>,
    /// Its file, relative to the recipe.
    pub mesh: PathBuf,
    /// Moves it, after turning.
    pub translate: Option<Spanned<DVec3Array>>,
    /// Turns it, after scaling.
    pub rotate: Option<Spanned<Rotation>>,
    /// Scales it about the origin.
    pub scale: Option<Spanned<f64>>,
    /// Sets it on a primitive, after its own pose.
    pub on: Option<On>,
    /// Moves it, last of all, so that one of its openings faces another or a primitive.
    pub snap: Option<Snap>,
    /// Cuts, in the file's own coordinates.
    #[serde(default)]
    pub cut: Vec<Spanned<Cut>>,
}

/// A place on a primitive. What rides there has its origin at the place, its z axis out of the surface, and its x axis along growing u.
#[derive(Clone, Debug, Deserialize)]
pub struct On {
    /// The primitive's name.
    pub primitive: Spanned<String>,
    /// u and v: u from 0 to 1 once round the axis; v from 0 at the base to 1 at the top, on to 2 over the top to its middle, down to −1 over
    /// the base. On a sphere v goes from pole to pole.
    pub at: Spanned<[f64; 2]>,
    /// Turns about the surface's normal, in degrees.
    pub spin: Option<Spanned<f64>>,
    /// Moves out of the surface, in model units.
    pub offset: Option<Spanned<f64>>,
    /// Of a part: the loop whose middle comes to the place and which faces the surface.
    #[serde(rename = "loop")]
    pub opening: Option<usize>,
}

/// A body that parts ride on, and that is not itself in the model.
#[derive(Clone, Debug, Deserialize)]
pub struct Primitive {
    /// `"box"`, `"cylinder"`, `"sphere"` or `"cone"`.
    pub shape: Spanned<String>,
    /// The middle of its base, or of a sphere. The origin where left out.
    pub base: Option<Spanned<DVec3Array>>,
    /// From base to top, of any length. Along z where left out.
    pub axis: Option<Spanned<DVec3Array>>,
    /// The radius; two for a cone, at the base and at the top. That of `loop` where left out.
    pub radius: Option<Spanned<Radius>>,
    /// The height of a cylinder or cone.
    pub height: Option<Spanned<f64>>,
    /// The extents of a box, the last along its axis.
    pub size: Option<Spanned<DVec3Array>>,
    /// Stands on this opening, `"part:loop"`: base and axis count from its middle, z out of it.
    #[serde(rename = "loop")]
    pub opening: Option<Spanned<String>>,
    /// Stands on another primitive: base and axis count from there.
    pub on: Option<On>,
}

/// One radius, or one at the base and one at the top.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub enum Radius {
    /// One all along.
    One(f64),
    /// At the base and at the top.
    Two([f64; 2]),
}

/// An alignment of one opening with another.
#[derive(Clone, Debug, Deserialize)]
pub struct Snap {
    /// The part's own loop; its first where left out.
    #[serde(rename = "loop")]
    pub opening: Option<usize>,
    /// `"part:loop"`, or the name of a primitive.
    pub to: Spanned<String>,
    /// How far apart they are left; two edges of the other loop where left out, nothing on a primitive.
    pub gap: Option<Spanned<f64>>,
}
