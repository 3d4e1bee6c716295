//! How finely an attribute varies: by vertex, by face, or by corner. Formats differ in which they can hold.

use glam::DVec3;
use mesh_core::{CornerMap, Faces, HalfedgeId, TriMesh};
use rayon::prelude::*;

/// Attribute values compared bit by bit, so that NaN (no value) equals itself.
pub(crate) trait Value: Copy + Send + Sync {
    const NONE: Self;
    fn bits(self) -> [u64; 4];
    fn is_none(self) -> bool;
}

impl Value for [f64; 2] {
    const NONE: Self = [f64::NAN; 2];
    fn bits(self) -> [u64; 4] {
        [self[0].to_bits(), self[1].to_bits(), 0, 0]
    }
    fn is_none(self) -> bool {
        self[0].is_nan()
    }
}

impl Value for DVec3 {
    const NONE: Self = DVec3::NAN;
    fn bits(self) -> [u64; 4] {
        [self.x.to_bits(), self.y.to_bits(), self.z.to_bits(), 0]
    }
    fn is_none(self) -> bool {
        self.x.is_nan()
    }
}

impl Value for [f64; 4] {
    const NONE: Self = [f64::NAN; 4];
    fn bits(self) -> [u64; 4] {
        self.map(f64::to_bits)
    }
    fn is_none(self) -> bool {
        self[0].is_nan()
    }
}

/// One value per vertex, if all corners at every vertex agree; [`Value::NONE`] at unreferenced vertices.
pub(crate) fn per_vertex<T: Value>(mesh: &TriMesh, map: &CornerMap<T>) -> Option<Vec<T>> {
    let mut values = vec![T::NONE; mesh.positions.len()];
    let mut seen = vec![false; mesh.positions.len()];
    for (v, &value) in mesh.faces.iter().flatten().zip(map.as_slice()) {
        if !seen[v.index()] {
            seen[v.index()] = true;
            values[v.index()] = value;
        } else if values[v.index()].bits() != value.bits() {
            return None;
        }
    }
    Some(values)
}

/// One colour per vertex: that of its corners, or the mean of those that have one; and at how many vertices they differ.
/// [`Value::NONE`] where no corner has one.
pub(crate) fn mean_per_vertex(mesh: &TriMesh, map: &CornerMap<[f64; 4]>) -> (Vec<[f64; 4]>, usize) {
    let corners = || mesh.faces.iter().flatten().zip(map.as_slice()).filter(|(_, color)| !color.is_none());
    let mut first = vec![<[f64; 4]>::NONE; mesh.positions.len()];
    let mut differs = vec![false; mesh.positions.len()];
    for (v, &color) in corners() {
        if first[v.index()].is_none() {
            first[v.index()] = color;
        }
        differs[v.index()] |= first[v.index()].bits() != color.bits();
    }
    let mut sums = vec![([0.0; 4], 0.0); mesh.positions.len()];
    for (v, &color) in corners().filter(|(v, _)| differs[v.index()]) {
        let (sum, count) = &mut sums[v.index()];
        *sum = [0, 1, 2, 3].map(|k| sum[k] + color[k]);
        *count += 1.0;
    }
    let mean = |v: usize| if differs[v] { sums[v].0.map(|x| x / sums[v].1) } else { first[v] };
    ((0..first.len()).map(mean).collect(), differs.iter().filter(|&&d| d).count())
}

/// One value per face, if the three corners of every face agree.
pub(crate) fn per_face<T: Value>(mesh: &TriMesh, map: &CornerMap<T>) -> Option<Vec<T>> {
    mesh.face_ids()
        .map(|f| {
            let [a, b, c] = [0, 1, 2].map(|k| map[HalfedgeId::new(f, k)]);
            (a.bits() == b.bits() && b.bits() == c.bits()).then_some(a)
        })
        .collect()
}

/// The corners of a mesh gathered so that those at one vertex with equal values share an entry.
pub(crate) struct Distinct {
    /// A corner (`3·face + k`) for each entry, ordered by vertex, then by first appearance.
    pub example: Vec<u32>,
    /// The entry of each corner.
    pub of_corner: Vec<u32>,
}

/// Gathers corners by vertex and by `bits`. O(n log d) for corners of degree d.
pub(crate) fn distinct<B: Ord + Copy + Send>(mesh: &TriMesh, bits: impl Fn(usize) -> B + Sync) -> Distinct {
    let (starts, corners) = corners_by_vertex(mesh);
    let of_vertex = |v: usize| -> Vec<(u32, u32)> {
        let group = &corners[starts[v] as usize..starts[v + 1] as usize];
        let Some((&first, rest)) = group.split_first() else { return vec![] };
        let value = bits(first as usize);
        if rest.iter().all(|&c| bits(c as usize) == value) {
            return group.iter().map(|&c| (first, c)).collect();
        }
        let mut sorted: Vec<(B, u32)> = group.iter().map(|&c| (bits(c as usize), c)).collect();
        sorted.sort_unstable();
        let mut pairs: Vec<(u32, u32)> =
            sorted.chunk_by(|a, b| a.0 == b.0).flat_map(|run| run.iter().map(|&(_, c)| (run[0].1, c))).collect();
        pairs.sort_unstable();
        pairs
    };
    let pieces: Vec<Vec<(u32, u32)>> = (0..mesh.positions.len())
        .into_par_iter()
        .fold_chunks(1 << 13, Vec::new, |mut all, v| {
            all.extend(of_vertex(v));
            all
        })
        .collect();
    let mut result = Distinct { example: vec![], of_corner: vec![0; corners.len()] };
    for (example, corner) in pieces.into_iter().flatten() {
        if result.example.last() != Some(&example) {
            result.example.push(example);
        }
        result.of_corner[corner as usize] = result.example.len() as u32 - 1;
    }
    result
}

/// Corners in order of their vertex, then of their number, with the start of each vertex's stretch.
fn corners_by_vertex(mesh: &TriMesh) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; mesh.positions.len() + 1];
    for v in mesh.faces.iter().flatten() {
        starts[v.index() + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut corners = vec![0u32; 3 * mesh.faces.len()];
    for (corner, v) in mesh.faces.iter().flatten().enumerate() {
        corners[next[v.index()] as usize] = corner as u32;
        next[v.index()] += 1;
    }
    (starts, corners)
}
