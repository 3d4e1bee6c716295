//! Cheapest paths along edges.

use crate::ids::{HalfedgeId, VertexId};
use crate::traits::Adjacency;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// The cheapest chain of halfedges from `from` to `to` by Dijkstra's algorithm, as seen by `cost` (per halfedge, at
/// least 0; NaN and negative forbid it). Empty when the ends are the same; `None` when there is no way.
///
/// Both directions of an interior edge may cost differently; a boundary edge is walked against its only halfedge at
/// the same cost, and then appears in the chain as that halfedge. Ties go to lower ids. Time and memory follow the
/// visited region.
///
/// ```
/// use mesh_core::{Connected, Faces, Positions, VertexId, shapes, shortest_path};
/// let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
/// let length = |h| cube.edge_length(h);
/// let path = shortest_path(&cube, VertexId(0), VertexId(7), length).unwrap();
/// assert_eq!(path.len(), 2); // a diagonal and an edge
/// # Ok::<(), mesh_core::NotManifold>(())
/// ```
pub fn shortest_path<M: Adjacency>(
    mesh: &M,
    from: VertexId,
    to: VertexId,
    cost: impl Fn(HalfedgeId) -> f64,
) -> Option<Vec<HalfedgeId>> {
    if from.index() >= mesh.vertex_count() || to.index() >= mesh.vertex_count() {
        return None;
    }
    // Best cost so far and the step that led there.
    let mut best: HashMap<VertexId, (f64, Option<(VertexId, HalfedgeId)>)> = HashMap::from([(from, (0.0, None))]);
    let mut front = BinaryHeap::from([Reverse((0, from))]);
    while let Some(Reverse((bits, v))) = front.pop() {
        let here = f64::from_bits(bits);
        if best[&v].0 < here {
            continue;
        }
        if v == to {
            let mut chain = vec![];
            let mut step = best[&v].1;
            while let Some((before, h)) = step {
                chain.push(h);
                step = best[&before].1;
            }
            chain.reverse();
            return Some(chain);
        }
        for h in mesh.ring(v) {
            let against = h.prev();
            let back = mesh.twin(against).is_none().then(|| (against, mesh.tail(against)));
            for (h, w) in [Some((h, mesh.head(h))), back].into_iter().flatten() {
                let price = cost(h);
                let total = here + price;
                if price >= 0.0 && best.get(&w).is_none_or(|old| total < old.0) {
                    best.insert(w, (total, Some((v, h))));
                    // Costs are not negative, so their bits order as they do.
                    front.push(Reverse((total.to_bits(), w)));
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, Faces, Positions, TriMesh, shapes};
    use proptest::prelude::*;

    proptest! {
        /// Against Bellman–Ford over all edges, with random costs.
        #[test]
        fn costs_are_the_least(weights in prop::collection::vec(0.0f64..1.0, 240), from in 0u32..42, to in 0u32..42) {
            let ball = Connected::new(shapes::icosphere(1.0, 1)).unwrap();
            let cost = |h: HalfedgeId| weights[h.index()];
            let mut best = vec![f64::INFINITY; ball.vertex_count()];
            best[from as usize] = 0.0;
            for _ in 0..ball.vertex_count() {
                for h in (0..240).map(HalfedgeId) {
                    let through = best[ball.tail(h).index()] + cost(h);
                    best[ball.head(h).index()] = best[ball.head(h).index()].min(through);
                }
            }
            let path = shortest_path(&ball, VertexId(from), VertexId(to), cost).unwrap();
            prop_assert!((path.iter().map(|&h| cost(h)).sum::<f64>() - best[to as usize]).abs() < 1e-12);
            prop_assert!(path.windows(2).all(|w| ball.head(w[0]) == ball.tail(w[1])));
            prop_assert_eq!(path.first().map_or(to, |&h| ball.tail(h).0), from);
        }
    }

    #[test]
    fn forbidden_and_boundary_edges() {
        let strip = Connected::new(shapes::grid(4.0, 1.0, 4, 1)).unwrap();
        let at = |x: f64, y: f64| {
            strip.vertex_ids().find(|&v| strip.position(v).distance(glam::DVec3::new(x, y, 0.0)) < 1e-9).unwrap()
        };
        for [a, b] in [[-2.0, 2.0], [2.0, -2.0]] {
            let along = shortest_path(&strip, at(a, -0.5), at(b, -0.5), |_| 1.0).unwrap();
            assert_eq!(along.len(), 4);
        }
        assert_eq!(shortest_path(&strip, at(2.0, 0.5), at(-2.0, 0.5), |_| f64::NAN), None);
        assert_eq!(shortest_path(&strip, VertexId(3), VertexId(3), |_| 1.0), Some(vec![]));
        assert_eq!(shortest_path(&strip, VertexId(99), VertexId(3), |_| 1.0), None);
        let lonely = Connected::new(TriMesh { faces: vec![], ..shapes::grid(1.0, 1.0, 1, 1) }).unwrap();
        assert_eq!(shortest_path(&lonely, VertexId(0), VertexId(1), |_| 1.0), None);
    }
}
