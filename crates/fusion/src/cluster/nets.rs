//! Control nets as JSON.

use edge_cluster::{Blend, Polyhedron, Shape, contact_slopes};
use serde_json::{Value, json};

/// Every patch with its control points, planes and sides, and every strip.
pub fn to_json(solid: &Polyhedron, made: &Blend) -> String {
    let layout = &made.layout;
    let patch = |p: usize| -> Value {
        let (net, cluster) = (&layout.nets[p], &layout.clusters[p]);
        let indices = net.shape.indices();
        let sides_of = |index: &Vec<u8>| -> Vec<usize> {
            (0..net.shape.sides()).filter(|&k| net.shape.is_in_side(index, k, net.continuity)).map(|k| k + 1).collect()
        };
        let open = cluster.open.iter().map(|&h| solid.halfedges[h as usize]);
        json!({
            "name": cluster.name(),
            "vertices": cluster.vertices,
            "open_edges": open.map(|h| [h.tail, h.head]).collect::<Vec<_>>(),
            "kind": match net.shape { Shape::Tensor(_) => "tensor", Shape::Simplex { .. } => "s-patch" },
            "sides": net.shape.sides(),
            "degree": match net.shape { Shape::Tensor(d) => json!(d), Shape::Simplex { degree, .. } => json!(degree) },
            "continuity": net.continuity,
            "planes": net.planes.iter().map(|p| [p.normal.x, p.normal.y, p.normal.z, p.offset]).collect::<Vec<_>>(),
            "contact_slopes": contact_slopes(net, &layout.patches[p]),
            "in_sides": indices.iter().map(sides_of).collect::<Vec<_>>(),
            "indices": indices,
            "points": net.points.iter().map(glam::DVec3::to_array).collect::<Vec<_>>(),
        })
    };
    let strip = |s: &edge_cluster::Strip| -> Value {
        json!({
            "patches": s.ends.map(|e| e.0),
            "corners": s.ends.map(|e| e.1 + 1),
            "mu": s.params.balance,
            "order": s.params.order,
            "cut": s.params.cut,
            "follow": s.params.follow,
        })
    };
    let patches: Vec<Value> = (0..layout.nets.len()).map(patch).collect();
    let strips: Vec<Value> = layout.strips.iter().map(strip).collect();
    format!("{:#}\n", json!({ "version": 1, "patches": patches, "strips": strips }))
}
