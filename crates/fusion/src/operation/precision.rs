//! What a result must survive.

use super::define::words;
use mesh_io::Format;

words! {
    /// The coordinates in which a result must be sound.
    pub enum Precision: "a precision" {
        /// As it is, in 64 bits
        F64 = "f64",
        /// Rounded to 32 bits, with vertices merged that become equal: what every format can hold
        F32 = "f32",
    }
}

impl From<Precision> for Format {
    /// A format that holds coordinates in this manner.
    fn from(precision: Precision) -> Self {
        match precision {
            Precision::F64 => Self::Ply,
            Precision::F32 => Self::Stl,
        }
    }
}
