//! Why a file could not be read or written, and where in it.

use crate::format::Format;
use glam::DVec3;
use mesh_core::VertexId;
use std::fmt;
use std::path::PathBuf;

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(n) => write!(f, "line {n}"),
            Self::Byte(n) => write!(f, "byte {n}"),
        }
    }
}

/// Why a mesh could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The contents break the rules of the format, or use a part of it that is not supported.
    #[error("{file}: {}{reason}", place(*at))]
    Malformed {
        /// The file, or the format's name for a stream.
        file: String,
        /// Where, if it is at one place.
        at: Option<At>,
        /// What is wrong there.
        reason: String,
    },
    /// No format goes by this name or extension.
    #[error("no mesh format is called {name:?}; use one of obj, stl, ply, off, glb, gltf, 3mf")]
    UnknownFormat {
        /// The name or extension.
        name: String,
    },
    /// A coordinate has no finite value in the format.
    #[error(
        "vertex {vertex} at {:?}, {:?}, {:?} cannot be written as {format}: {reason}; scale the model, or write obj, ply or off",
        place.x, place.y, place.z
    )]
    Unrepresentable {
        /// The vertex.
        vertex: VertexId,
        /// Where it is, in model units.
        place: DVec3,
        /// The format asked for.
        format: Format,
        /// What the format cannot hold.
        reason: &'static str,
    },
    /// The model contradicts itself: an attribute has the wrong length or an id is out of range.
    #[error("the model to write is inconsistent: a face or attribute refers to an element that is not there")]
    Inconsistent,
    /// The file cannot be written. Existing files are as they were.
    #[error("cannot write {}: {source}", path.display())]
    Unwritable {
        /// The file concerned, which may be a side file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

fn place(at: Option<At>) -> String {
    at.map_or(String::new(), |at| format!("{at}: "))
}

/// A parser's complaint, before anyone knows the file's name or has counted its lines.
#[derive(Debug)]
pub(crate) struct Fault {
    pub at: Option<Spot>,
    pub reason: String,
}

/// A byte offset, to be told as it is or as the line that holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spot {
    Text(usize),
    Binary(usize),
}

impl Fault {
    pub fn text(offset: usize, reason: impl Into<String>) -> Self {
        Self { at: Some(Spot::Text(offset)), reason: reason.into() }
    }

    pub fn binary(offset: usize, reason: impl Into<String>) -> Self {
        Self { at: Some(Spot::Binary(offset)), reason: reason.into() }
    }

    pub fn whole(reason: impl Into<String>) -> Self {
        Self { at: None, reason: reason.into() }
    }

    pub fn into_error(self, file: String, bytes: &[u8]) -> Error {
        Error::Malformed { file, at: self.at.map(|spot| spot.resolve(bytes)), reason: self.reason }
    }
}

impl Spot {
    pub fn resolve(self, bytes: &[u8]) -> At {
        match self {
            Self::Binary(offset) => At::Byte(offset as u64),
            Self::Text(offset) => {
                let before = &bytes[..offset.min(bytes.len())];
                At::Line(before.split(|&b| b == b'\n').count() as u64)
            }
        }
    }
}
