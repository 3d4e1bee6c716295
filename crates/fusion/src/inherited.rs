//! Where a result crosses itself because its inputs do.

use mesh_core::{Bounds, FaceId, FaceOrigin, Origins, TriMesh};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Places that are listed for each part, at most.
const PLACES: usize = 64;

/// Crossings of faces that an input brought along, or two inputs that cross each other.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Inherited {
    /// The input, counted from 0.
    pub part: usize,
    /// The other input, where faces of two inputs cross; `None` where the part crosses itself.
    pub with: Option<usize>,
    /// How many pairs of faces; a face without area counts as a pair.
    pub count: usize,
    /// Where the first of them cross, in model units; 64 at most.
    pub places: Vec<[f64; 3]>,
}

/// Pairs of crossing faces by the parts that they come from. New faces belong to the part of the face that they cross.
pub(crate) fn inherited(mesh: &TriMesh, pairs: &[[FaceId; 2]], origins: &Origins) -> Vec<Inherited> {
    let part_of = |f: FaceId| match origins.faces[f] {
        FaceOrigin::Input { part, .. } | FaceOrigin::Piece { part, .. } => Some(part as usize),
        FaceOrigin::New { .. } => None,
    };
    let mut parts: BTreeMap<(usize, Option<usize>), Inherited> = BTreeMap::new();
    for &[f, g] in pairs {
        let (one, other) = (part_of(f).or(part_of(g)).unwrap_or(0), part_of(g).or(part_of(f)).unwrap_or(0));
        let (part, with) = (one.min(other), (one != other).then_some(one.max(other)));
        let entry = parts.entry((part, with)).or_insert_with(|| Inherited { part, with, count: 0, places: vec![] });
        entry.count += 1;
        if entry.places.len() < PLACES {
            entry.places.push(place(mesh, f, g));
        }
    }
    parts.into_values().collect()
}

/// The centre of what two faces' boxes share: they cross within it.
fn place(mesh: &TriMesh, f: FaceId, g: FaceId) -> [f64; 3] {
    let [one, other] = [f, g].map(|f| Bounds::of(mesh.triangle(f)));
    (0.5 * (one.min.max(other.min) + one.max.min(other.max))).to_array()
}
