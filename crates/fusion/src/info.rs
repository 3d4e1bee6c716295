//! What a mesh is: counts, shape, measures, defects.

use mesh_core::{Cancelled, Connected, Faces, HalfedgeId, Positions, Report as Defects, TriMesh, VertexId, Watch};
use mesh_core::{area, boundary_loops, bounds, components, edge_lengths, topology, validate, volume};
use serde::Serialize;

/// Everything `info` tells. What only an oriented 2-manifold has is `None` on others.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Info {
    /// How many vertices, unused ones included.
    pub vertices: usize,
    /// How many triangles.
    pub faces: usize,
    /// How many undirected edges.
    pub edges: Option<usize>,
    /// Sets of faces that hang together through vertices.
    pub components: usize,
    /// The boundary loops; the id of each is its place in this list.
    pub boundary_loops: Option<Vec<Loop>>,
    /// Handles, summed over components.
    pub genus: Option<i64>,
    /// Lowest corner of the bounding box, in model units; `None` where nothing is finite.
    pub lowest: Option<[f64; 3]>,
    /// Its highest corner.
    pub highest: Option<[f64; 3]>,
    /// Its diagonal.
    pub diagonal: f64,
    /// Surface area, in square model units.
    pub area: f64,
    /// Signed volume, in cubic model units: positive where faces look outward. `None` unless closed.
    pub volume: Option<f64>,
    /// Shortest, mean and longest edge, in model units.
    pub edge_lengths: Option<[f64; 3]>,
    /// Whether it is an oriented 2-manifold, with or without boundary.
    pub manifold: bool,
    /// Whether it is one without boundary.
    pub closed: bool,
    /// Pairs of faces that meet where they should not; `None` where it cannot be decided, as with coordinates that are not finite.
    pub self_intersections: Option<usize>,
    /// What is wrong, by kind.
    pub defects: Vec<Defect>,
}

/// One boundary loop.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Loop {
    /// How many edges it has.
    pub edges: usize,
    /// Its length, in model units.
    pub length: f64,
    /// A point on it.
    pub at: [f64; 3],
}

/// One kind of defect.
#[derive(Clone, Debug, Serialize, PartialEq, Eq)]
pub struct Defect {
    /// What is wrong, in the plural: `"faces without area"`.
    pub kind: String,
    /// How many.
    pub count: usize,
    /// The first one: a vertex, a face, or an edge as two vertices.
    pub first: Vec<u32>,
}

impl Info {
    /// Measures `mesh`, whatever is in it. O(n log n), self-intersections included.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn of(mesh: &TriMesh, watch: &Watch) -> Result<Self, Cancelled> {
        let defects = validate(mesh);
        let bounds = bounds(mesh);
        // Faces that name a missing vertex cannot be measured.
        let sound = defects.out_of_range.is_empty();
        let connected = Connected::new(mesh).ok();
        let topology = connected.as_ref().map(topology);
        let self_intersections = match self_intersections(mesh, sound, watch) {
            Ok(pairs) => Some(pairs),
            Err(tri_intersect::Error::Cancelled(c)) => return Err(c),
            // The defects already say why it cannot be decided.
            Err(_) => None,
        };
        Ok(Self {
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
            edges: topology.map(|t| t.edges),
            components: if sound { components(mesh).len() } else { 0 },
            boundary_loops: connected.as_ref().map(loops),
            genus: topology.map(|t| t.genus()),
            lowest: (!bounds.is_empty()).then(|| bounds.min.to_array()),
            highest: (!bounds.is_empty()).then(|| bounds.max.to_array()),
            diagonal: bounds.diagonal(),
            area: if sound { area(mesh) } else { 0.0 },
            volume: defects.is_closed().then(|| volume(mesh)),
            edge_lengths: connected.as_ref().and_then(edge_lengths).map(|e| [e.min, e.mean, e.max]),
            manifold: defects.is_manifold(),
            closed: defects.is_closed() && mesh.face_count() > 0,
            self_intersections,
            defects: list(&defects),
        })
    }
}

fn self_intersections(mesh: &TriMesh, sound: bool, watch: &Watch) -> Result<usize, tri_intersect::Error> {
    if !sound {
        return Err(tri_intersect::Error::Empty("a face names a missing vertex"));
    }
    Ok(tri_intersect::self_intersections(mesh, watch)?.len())
}

fn loops(mesh: &Connected<&TriMesh>) -> Vec<Loop> {
    let length = |h: HalfedgeId| mesh.edge_length(h);
    let describe = |walk: Vec<HalfedgeId>| Loop {
        edges: walk.len(),
        length: walk.iter().map(|&h| length(h)).sum(),
        at: walk.first().map_or([0.0; 3], |&h| mesh.position(mesh.tail(h)).to_array()),
    };
    boundary_loops(mesh).into_iter().map(describe).collect()
}

fn list(report: &Defects) -> Vec<Defect> {
    let one = |v: &[VertexId]| v.first().map(|v| vec![v.0]);
    let face = |f: &[mesh_core::FaceId]| f.first().map(|f| vec![f.0]);
    let edge = |e: &[[VertexId; 2]]| e.first().map(|[a, b]| vec![a.0, b.0]);
    [
        ("vertices with a coordinate that is no finite number", report.non_finite.len(), one(&report.non_finite)),
        ("vertices that no face uses", report.unreferenced.len(), one(&report.unreferenced)),
        ("faces that name a missing vertex", report.out_of_range.len(), face(&report.out_of_range)),
        ("faces that use a vertex twice", report.repeated_corner.len(), face(&report.repeated_corner)),
        ("faces without area", report.zero_area.len(), face(&report.zero_area)),
        ("faces that repeat another", report.duplicate_faces.len(), face(&report.duplicate_faces)),
        ("edges with more than two faces", report.non_manifold_edges.len(), edge(&report.non_manifold_edges)),
        (
            "edges whose two faces disagree in orientation",
            report.misoriented_edges.len(),
            edge(&report.misoriented_edges),
        ),
        ("vertices where separate parts touch", report.non_manifold_vertices.len(), one(&report.non_manifold_vertices)),
    ]
    .into_iter()
    .filter_map(|(kind, count, first)| first.map(|first| Defect { kind: kind.into(), count, first }))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::shapes;

    fn info(mesh: &TriMesh) -> Info {
        Info::of(mesh, &Watch::default()).unwrap()
    }

    #[test]
    fn a_box_is_known_in_full() {
        let info = info(&shapes::cuboid(DVec3::new(1.0, 2.0, 2.0)));
        assert_eq!((info.vertices, info.faces, info.edges, info.components), (8, 12, Some(18), 1));
        assert_eq!((info.genus, info.boundary_loops, info.closed), (Some(0), Some(vec![]), true));
        assert_eq!((info.diagonal, info.area, info.volume), (3.0, 16.0, Some(4.0)));
        assert_eq!((info.lowest, info.highest), (Some([-0.5, -1.0, -1.0]), Some([0.5, 1.0, 1.0])));
        assert!(info.defects.is_empty() && info.self_intersections == Some(0));
    }

    #[test]
    fn a_torn_box_tells_its_loop() {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        mesh.faces.truncate(10);
        let info = info(&mesh);
        assert_eq!((info.closed, info.manifold, info.volume), (false, true, None));
        let loops = info.boundary_loops.unwrap();
        assert_eq!((loops.len(), loops[0].edges, loops[0].length), (1, 4, 4.0));
    }

    #[test]
    fn anything_can_be_measured() {
        assert_eq!(info(&TriMesh::default()).faces, 0);
        let broken = TriMesh::from_arrays(vec![DVec3::NAN, DVec3::ZERO], [[0, 1, 5], [0, 0, 1]]);
        let info = info(&broken);
        assert!(
            !info.manifold && info.self_intersections.is_none() && info.lowest == Some([0.0; 3]) && info.area == 0.0
        );
        let kinds: Vec<_> = info.defects.iter().map(|d| (d.kind.as_str(), d.count)).collect();
        assert!(
            kinds.contains(&("faces that name a missing vertex", 1))
                && kinds.contains(&("faces that use a vertex twice", 1))
        );
    }
}
