//! A result that is not sound.

use glam::DVec3;
use mesh_core::NotManifold;
use mesh_io::Format;

/// A result that is not sound.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the result is not valid{}: {reason}{}", .format.map_or(String::new(), hint), .at.map_or(String::new(), |p| format!(" near {p}")))]
pub struct Invalid {
    /// What is wrong.
    pub reason: String,
    /// A place, in model units.
    pub at: Option<DVec3>,
    /// The format whose rounding broke it, if that was the reason.
    pub format: Option<Format>,
}

fn hint(format: Format) -> String {
    format!(" in the 32-bit coordinates of {format} (write obj, ply or off, or move the model to the origin)")
}

impl From<NotManifold> for Invalid {
    fn from(source: NotManifold) -> Self {
        Self { at: source.place, reason: source.to_string(), format: None }
    }
}
