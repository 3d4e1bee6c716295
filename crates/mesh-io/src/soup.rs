//! From the polygons of a file to triangles that remember which corner and polygon they came from.

use crate::error::{Fault, Spot};
use crate::model::Polygons;
use crate::notes::Notes;
use crate::triangulate::{Cut, triangulate};
use mesh_core::{FaceMap, TriMesh, VertexId};
use rayon::prelude::*;

/// Polygons as a format's reader collects them.
#[derive(Default)]
pub(crate) struct Soup {
    /// Vertices of the file. `corners` must be below their number.
    pub positions: Vec<glam::DVec3>,
    /// Corner count of every polygon; `None` where all are triangles.
    pub sizes: Option<Vec<u32>>,
    /// Vertex of every corner of every polygon.
    pub corners: Vec<u32>,
}

/// The triangles of a soup.
pub(crate) struct Triangulated {
    pub mesh: TriMesh,
    pub polygons: Option<Polygons>,
    /// For each triangle, where its corners are in [`Soup::corners`]; `None` where they are simply in order.
    pub sources: Option<Vec<[u32; 3]>>,
    /// The polygon of the soup that each triangle came from; `None` where they are simply in order.
    pub polygon_of: Option<Vec<u32>>,
}

impl Triangulated {
    /// One value per triangle corner, from the soup's corner number.
    pub fn gather_corners<T: Send>(&self, value: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        match &self.sources {
            None => (0..3 * self.mesh.faces.len()).into_par_iter().map(value).collect(),
            Some(sources) => sources.par_iter().flat_map_iter(|c| c.map(|i| value(i as usize))).collect(),
        }
    }

    /// One value per triangle, from the soup's polygon number.
    pub fn gather_faces<T: Clone>(&self, values: &[T]) -> Vec<T> {
        match &self.polygon_of {
            None => values.to_vec(),
            Some(of) => of.iter().map(|&p| values[p as usize].clone()).collect(),
        }
    }
}

const CHUNK: usize = 1 << 14;

/// One chunk's triangles: corner numbers, and the polygon of each.
#[derive(Default)]
struct Piece {
    sources: Vec<[u32; 3]>,
    polygon_of: Vec<u32>,
    polygon_sizes: Vec<u32>,
    polygon_corners: Vec<VertexId>,
    cut: usize,
    folded: usize,
    dropped: usize,
}

impl Soup {
    /// Cuts polygons into triangles. Corners repeated in a row count once; a polygon left with fewer than three, and a
    /// triangle that uses a vertex twice, is dropped with a note. `locate` tells where a polygon is in the file.
    ///
    /// # Errors
    /// More vertices or corners than 32-bit ids can name.
    pub fn triangulate(self, notes: &mut Notes, locate: impl Fn(usize) -> Option<Spot>) -> Result<Triangulated, Fault> {
        if self.positions.len() >= u32::MAX as usize || self.corners.len() >= (u32::MAX / 3) as usize {
            return Err(Fault::whole("more vertices or face corners than 32-bit ids can name; split the file"));
        }
        if self.sizes.is_none() {
            let faces: Vec<[VertexId; 3]> =
                self.corners.par_chunks_exact(3).map(|c| [VertexId(c[0]), VertexId(c[1]), VertexId(c[2])]).collect();
            if !faces.par_iter().any(|&[a, b, c]| a == b || b == c || c == a) {
                let mesh = TriMesh { positions: self.positions, faces };
                return Ok(Triangulated { mesh, polygons: None, sources: None, polygon_of: None });
            }
        }
        let sizes = self.sizes.clone().unwrap_or_else(|| vec![3; self.corners.len() / 3]);
        let mut starts = Vec::with_capacity(sizes.len() + 1);
        starts.push(0u32);
        for &size in &sizes {
            starts.push(starts[starts.len() - 1] + size);
        }
        let ids: Vec<u32> = (0..sizes.len() as u32).collect();
        let pieces: Vec<Piece> = ids.par_chunks(CHUNK).map(|ids| self.cut(ids, &starts)).collect();
        Ok(self.join(&pieces, notes, locate))
    }

    fn cut(&self, ids: &[u32], starts: &[u32]) -> Piece {
        let mut piece = Piece::default();
        let (mut kept, mut points, mut triangles) = (vec![], vec![], vec![]);
        for &polygon in ids {
            let corners = starts[polygon as usize]..starts[polygon as usize + 1];
            let vertex = |i: u32| self.corners[i as usize];
            kept.clear();
            for i in corners {
                if kept.last().is_none_or(|&j| vertex(j) != vertex(i)) {
                    kept.push(i);
                }
            }
            while kept.len() > 1 && vertex(kept[0]) == vertex(kept[kept.len() - 1]) {
                kept.pop();
            }
            if kept.len() < 3 {
                piece.dropped += 1;
                continue;
            }
            points.clear();
            points.extend(kept.iter().map(|&i| self.positions[vertex(i) as usize]));
            triangles.clear();
            let cut = triangulate(&points, &mut triangles);
            piece.cut += usize::from(kept.len() > 3);
            piece.folded += usize::from(cut == Cut::Folded);
            let before = piece.sources.len();
            for corner in &triangles {
                let source = corner.map(|k| kept[k as usize]);
                let [a, b, c] = source.map(vertex);
                if a == b || b == c || c == a {
                    piece.dropped += 1;
                } else {
                    piece.sources.push(source);
                }
            }
            if piece.sources.len() > before {
                piece.polygon_of.resize(piece.sources.len(), polygon);
                piece.polygon_sizes.push(kept.len() as u32);
                piece.polygon_corners.extend(kept.iter().map(|&i| VertexId(vertex(i))));
            }
        }
        piece
    }

    fn join(self, pieces: &[Piece], notes: &mut Notes, locate: impl Fn(usize) -> Option<Spot>) -> Triangulated {
        let total = |count: fn(&Piece) -> usize| pieces.iter().map(count).sum::<usize>();
        let (cut, folded, dropped) = (total(|p| p.cut), total(|p| p.folded), total(|p| p.dropped));
        let first_large = self.sizes.as_ref().and_then(|s| s.iter().position(|&n| n > 3)).and_then(locate);
        notes.add("polygons split into triangles", cut, first_large);
        notes.add("polygons that cross themselves or have no area", folded, None);
        notes.add("degenerate faces dropped", dropped, None);
        let sources: Vec<[u32; 3]> = pieces.iter().flat_map(|p| &p.sources).copied().collect();
        let polygon_of: Vec<u32> = pieces.iter().flat_map(|p| &p.polygon_of).copied().collect();
        let faces = sources.iter().map(|c| c.map(|i| VertexId(self.corners[i as usize]))).collect();
        let polygons = (cut > 0).then(|| {
            let mut starts = vec![0u32];
            for size in pieces.iter().flat_map(|p| &p.polygon_sizes) {
                starts.push(starts[starts.len() - 1] + size);
            }
            let corners = pieces.iter().flat_map(|p| &p.polygon_corners).copied().collect();
            Polygons { starts, corners, of_face: renumbered(&polygon_of) }
        });
        let mesh = TriMesh { positions: self.positions, faces };
        Triangulated { mesh, polygons, sources: Some(sources), polygon_of: Some(polygon_of) }
    }
}

/// Ascending polygon numbers made gapless, since dropped polygons leave gaps.
fn renumbered(polygon_of: &[u32]) -> FaceMap<u32> {
    let (mut last, mut next) = (None, 0u32);
    polygon_of
        .iter()
        .map(|&p| {
            if last.is_some_and(|l| l != p) {
                next += 1;
            }
            last = Some(p);
            next
        })
        .collect::<Vec<_>>()
        .into()
}
