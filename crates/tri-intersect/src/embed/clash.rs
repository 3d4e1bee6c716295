//! Places on embedded curves, and two of them that meet and should not.

use glam::DVec3;
use mesh_core::FaceId;

/// A node of a chain; names also the piece of curve that begins there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Site {
    pub curve: usize,
    pub node: usize,
}

/// Two things that meet and should not. A site is `None` where it is no curve but a corner or side of the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clash {
    pub place: DVec3,
    pub face: FaceId,
    pub sites: [Option<Site>; 2],
}
