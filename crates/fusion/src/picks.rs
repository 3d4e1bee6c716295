//! Curves through picked points: the cheapest ways along edges between them, where sharp edges are cheap.

use crate::Error;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, dihedral_angle, shortest_path};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use spine::BlendCurve;
use std::collections::{HashMap, HashSet};

/// A curve as picked: points in model units, each standing for the vertex nearest to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Picked {
    /// The points in order.
    #[schemars(with = "Vec<[f64; 3]>")]
    pub points: Vec<DVec3>,
    /// Whether the last is joined to the first.
    #[serde(default)]
    pub closed: bool,
}

#[derive(Deserialize)]
struct File {
    curves: Vec<Entry>,
}

/// What `features -o` writes beside these keys is not looked at.
#[derive(Deserialize)]
struct Entry {
    points: Vec<[f64; 3]>,
    #[serde(default)]
    closed: bool,
}

/// Reads curves as JSON: `{"curves": [{"points": [[x, y, z], …], "closed": false}, …]}`, which is what `features -o`
/// writes.
///
/// # Errors
/// A sentence with line and column.
pub fn picked_from_text(text: &str) -> Result<Vec<Picked>, String> {
    let file: File = serde_json::from_str(text).map_err(|e| format!("no curves can be read: {e}"))?;
    let picked = |e: Entry| Picked { points: e.points.into_iter().map(DVec3::from).collect(), closed: e.closed };
    Ok(file.curves.into_iter().map(picked).collect())
}

/// What an edge that turns by 40 degrees or more costs, as a share of what it costs on a plane.
const SHARP: f64 = 0.02;
const FULL_TURN: f64 = 40.0;

/// The curves along the mesh's edges. Neighbouring picks are joined by the edge between them, or else by the cheapest
/// way, on which sharp edges count for little. O(vertices) for each curve at worst.
///
/// # Errors
/// [`Error::NoCurve`] with the place where picks cannot be joined.
pub(crate) fn trace(mesh: &Connected<TriMesh>, picked: &[Picked]) -> Result<Vec<BlendCurve>, Error> {
    if picked.is_empty() {
        return Ok(vec![]);
    }
    let bits = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let exact: HashMap<_, _> =
        (0..mesh.vertex_count() as u32).rev().map(VertexId).map(|v| (bits(mesh.position(v)), v)).collect();
    let nearest = |p: DVec3| {
        let by_distance = |v: &VertexId| mesh.position(*v).distance_squared(p);
        exact.get(&bits(p)).copied().or_else(|| {
            let all = (0..mesh.vertex_count() as u32).map(VertexId);
            all.min_by(|a, b| by_distance(a).total_cmp(&by_distance(b)))
        })
    };
    picked.iter().map(|p| trace_one(mesh, p, nearest)).collect()
}

fn trace_one(
    mesh: &Connected<TriMesh>,
    picked: &Picked,
    nearest: impl Fn(DVec3) -> Option<VertexId>,
) -> Result<BlendCurve, Error> {
    let mut vertices: Vec<VertexId> = picked.points.iter().filter_map(|&p| nearest(p)).collect();
    vertices.dedup();
    if picked.closed {
        vertices.extend(vertices.first().copied());
        vertices.dedup();
    }
    let start = picked.points.first().copied();
    if vertices.len() < 2 {
        return Err(Error::NoCurve("a picked curve needs points at two vertices at least".into(), start));
    }
    let cost = |h: HalfedgeId| {
        let length = mesh.edge_length(h);
        let turn = dihedral_angle(mesh, h).map_or(f64::NAN, |a| a.to_degrees().abs());
        length * (1.0 - turn / FULL_TURN).max(0.0).powi(2).max(SHARP)
    };
    let (mut halfedges, mut used) = (Vec::new(), HashSet::new());
    for pair in vertices.windows(2) {
        let at = mesh.position(pair[0]);
        let edge = mesh.halfedge(pair[0], pair[1]);
        let way = edge.map(|h| vec![h]).or_else(|| shortest_path(mesh, pair[0], pair[1], cost));
        let way = way.ok_or_else(|| {
            let to = mesh.position(pair[1]);
            Error::NoCurve(format!("no way along inner edges leads from the picked {at} to {to}"), Some(at))
        })?;
        if let Some(&h) = way.iter().find(|&&h| !used.insert(mesh.edge(h))) {
            let at = mesh.position(mesh.tail(h));
            return Err(Error::NoCurve(format!("the picked curve runs along one edge twice at {at}"), Some(at)));
        }
        halfedges.extend(way);
    }
    Ok(BlendCurve { halfedges, closed: picked.closed })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    /// Two opposite corners of a cylinder's rim: the way between them is half the rim, not a chord over the cap.
    #[test]
    fn ways_keep_to_sharp_edges() {
        let mesh = Connected::new(shapes::cylinder(1.0, 1.0, 32, 1)).unwrap();
        let top = mesh.mesh().positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
        let at = |x: f64| DVec3::new(x, 0.01, top);
        let found = trace(&mesh, &[Picked { points: vec![at(1.0), at(-1.0)], closed: false }]).unwrap();
        assert_eq!(found[0].halfedges.len(), 16);
        assert!(found[0].points(&mesh).iter().all(|p| (p.truncate().length() - 1.0).abs() < 1e-12));
        let ring =
            Picked { points: [0.0f64, 2.0, 4.0].map(|a| DVec3::new(a.cos(), a.sin(), top)).to_vec(), closed: true };
        assert_eq!(trace(&mesh, &[ring]).unwrap()[0].halfedges.len(), 32);
        let twice = Picked { points: vec![at(1.0), DVec3::new(0.7, 0.7, top), at(1.0)], closed: false };
        assert!(matches!(trace(&mesh, &[twice]), Err(Error::NoCurve(_, Some(_)))));
    }

    #[test]
    fn files_name_what_is_wrong() {
        let text = r#"{"version": 1, "curves": [{"id": 3, "closed": true, "points": [[0, 1, 2]]}]}"#;
        assert_eq!(picked_from_text(text), Ok(vec![Picked { points: vec![DVec3::new(0.0, 1.0, 2.0)], closed: true }]));
        assert!(picked_from_text("{\"curves\": [{}]}").is_err_and(|e| e.contains("points")));
    }
}
