//! The closed curves along which kept pieces of the two parts meet.

use mesh_core::VertexId;
use std::collections::HashMap;

/// A curve along which faces of two parts meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Vertices of the result in order, each joined to the next by an edge. Walking along with the surface normal up,
    /// the lower-numbered part (a) is on the left.
    pub vertices: Vec<VertexId>,
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
}

/// Directed seam edges of a result: where a piece of a meets a piece of b, as a's piece runs along it. In order.
/// `a` and `b` are the kept pieces.
pub(crate) fn seam_edges(a: &[[VertexId; 3]], b: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let sides = |faces: &[[VertexId; 3]]| {
        let mut sides: Vec<[VertexId; 2]> =
            faces.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
        sides.sort_unstable();
        sides
    };
    let (mut mine, theirs) = (sides(a), sides(b));
    let own = mine.clone();
    // An edge on which a also meets itself was a contact, and was divided between the sheets.
    mine.retain(|&[u, v]| theirs.binary_search(&[v, u]).is_ok() && own.binary_search(&[v, u]).is_err());
    mine
}

/// Chains directed edges, in order, into simple cycles; chains that do not close come out open.
pub(crate) fn chain(edges: &[[VertexId; 2]]) -> Vec<Seam> {
    let mut used = vec![false; edges.len()];
    let mut seams = vec![];
    let mut entering: HashMap<VertexId, i64> = HashMap::new();
    for e in edges {
        *entering.entry(e[1]).or_default() += 1;
        *entering.entry(e[0]).or_default() -= 1;
    }
    // Open chains first, from their starts; what is left closes.
    let starts = (0..edges.len()).filter(|&i| entering.get(&edges[i][0]).is_some_and(|&n| n < 0));
    for first in starts.chain(0..edges.len()) {
        if !used[first] {
            follow(edges, &mut used, first, &mut seams);
        }
    }
    seams
}

fn follow(edges: &[[VertexId; 2]], used: &mut [bool], first: usize, seams: &mut Vec<Seam>) {
    let mut path = vec![edges[first][0]];
    let mut place: HashMap<VertexId, usize> = HashMap::from([(path[0], 0)]);
    let mut next = Some(first);
    while let Some(i) = next {
        used[i] = true;
        let v = edges[i][1];
        if let Some(&start) = place.get(&v) {
            let cycle: Vec<VertexId> = path.drain(start..).collect();
            for u in &cycle {
                place.remove(u);
            }
            seams.push(Seam { vertices: cycle, closed: true });
        }
        place.insert(v, path.len());
        path.push(v);
        let from = edges.partition_point(|e| e[0] < v);
        next = (from..edges.len()).take_while(|&j| edges[j][0] == v).find(|&j| !used[j]);
    }
    if path.len() > 1 {
        seams.push(Seam { vertices: path, closed: false });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_a_figure_of_eight_into_two_cycles_and_keeps_an_open_end() {
        let mut edges: Vec<[VertexId; 2]> = [[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0], [7, 8], [8, 6]]
            .map(|e: [u32; 2]| e.map(VertexId))
            .to_vec();
        edges.sort_unstable();
        let mut seams = chain(&edges);
        seams.sort_by_key(|s| (s.closed, s.vertices.clone()));
        let ids = |s: &Seam| s.vertices.iter().map(|v| v.0).collect::<Vec<_>>();
        assert_eq!(seams.len(), 3);
        assert_eq!((ids(&seams[0]), seams[0].closed), (vec![7, 8, 6], false));
        assert!(seams[1].closed && seams[2].closed);
        assert_eq!(seams[1].vertices.len() + seams[2].vertices.len(), 6);
    }
}
