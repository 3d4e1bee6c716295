//! Points from coarse to fine, each with the nearest of those before it.

use crate::neighbours::Cells;
use glam::DVec3;
use rayon::prelude::*;

/// Points in an order in which each batch is about half as far apart as the one before (\[Schafer2021\] §4).
pub(crate) struct CoarseToFine {
    /// The points, coarse first.
    pub(crate) order: Vec<u32>,
    /// For each place in the order, up to `most` nearer points among those before it; flat, ends in `ends`.
    pub(crate) before: Vec<u32>,
    /// Where each place's neighbours end in `before`.
    pub(crate) ends: Vec<usize>,
}

impl CoarseToFine {
    /// Orders `chosen` of the points. O(n log n) for points spread over a surface or a volume.
    pub(crate) fn new(points: &[DVec3], chosen: &[u32], most: usize) -> Self {
        let mut out = Self { order: vec![], before: vec![], ends: vec![] };
        let satellites = satellites(points, chosen);
        let mut waiting: Vec<u32> =
            chosen.iter().copied().filter(|&i| satellites.binary_search_by_key(&i, |s| s.1).is_err()).collect();
        let mut by_host = satellites.clone();
        by_host.sort_unstable();
        let mut spacing = 1.0;
        while !waiting.is_empty() {
            let first = out.order.len();
            let mut cells = Cells::new(spacing);
            for &i in &out.order {
                cells.insert(i as usize, points[i as usize]);
            }
            let mut rest = vec![];
            for &i in &waiting {
                let p = points[i as usize];
                if cells.around(p, spacing).all(|j| points[j].distance_squared(p) > spacing * spacing) {
                    cells.insert(i as usize, p);
                    out.order.push(i);
                    let from = by_host.partition_point(|s| s.0 < i);
                    for &(_, follower) in by_host[from..].iter().take_while(|s| s.0 == i) {
                        cells.insert(follower as usize, points[follower as usize]);
                        out.order.push(follower);
                    }
                } else {
                    rest.push(i);
                }
            }
            waiting = rest;
            out.find_neighbours(points, first, most, spacing);
            spacing *= 0.5;
        }
        out
    }

    /// Finds the neighbours of the batch from `first` on, whose points are `spacing` or more apart.
    fn find_neighbours(&mut self, points: &[DVec3], first: usize, most: usize, spacing: f64) {
        // On a surface a disc of two spacings holds about a dozen points, so this radius finds enough at once.
        let reach = spacing * (most as f64 / 2.0).sqrt();
        let mut cells = Cells::new(0.5 * reach);
        let mut rank = vec![u32::MAX; points.len()];
        for (at, &i) in self.order.iter().enumerate() {
            cells.insert(i as usize, points[i as usize]);
            rank[i as usize] = at as u32;
        }
        let order = &self.order;
        let found: Vec<Vec<u32>> = (first..order.len())
            .into_par_iter()
            .map(|at| {
                let p = points[order[at] as usize];
                let mut near: Vec<(f64, u32)> = cells
                    .around(p, reach)
                    .filter(|&j| (rank[j] as usize) < at)
                    .map(|j| (points[j].distance_squared(p), rank[j]))
                    .collect();
                if near.len() > most {
                    near.select_nth_unstable_by(most, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                    near.truncate(most);
                }
                near.sort_unstable_by_key(|n| n.1);
                near.into_iter().map(|n| order[n.1 as usize]).collect()
            })
            .collect();
        for near in found {
            self.before.extend(near);
            self.ends.push(self.before.len());
        }
    }

    /// Each place's point and its neighbours.
    pub(crate) fn neighbours(&self, at: usize) -> &[u32] {
        &self.before[if at == 0 { 0 } else { self.ends[at - 1] }..self.ends[at]]
    }
}

/// Points much nearer to an earlier point than points are to each other around, as off-surface constraints are; each after its host,
/// in order of followers.
fn satellites(points: &[DVec3], chosen: &[u32]) -> Vec<(u32, u32)> {
    // Spacing from the count: a surface in a box of width one.
    let size = (6.0 / chosen.len() as f64).sqrt();
    let mut cells = Cells::new(size);
    for &i in chosen {
        cells.insert(i as usize, points[i as usize]);
    }
    let mut pairs: Vec<(u32, u32)> = chosen
        .par_iter()
        .filter_map(|&i| {
            let p = points[i as usize];
            let mut reach = size;
            let mut near: Vec<(f64, u32)> = vec![];
            while near.len() < 9.min(chosen.len()) && reach < 4.0 {
                near = cells.around(p, reach).map(|j| (points[j].distance_squared(p), j as u32)).collect();
                near.retain(|n| n.0 <= reach * reach);
                reach *= 2.0;
            }
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let typical = near.get(8)?.0;
            let host = near[1..4].iter().filter(|n| n.0 < 0.04 * typical).map(|n| n.1).min()?;
            (host < i).then_some((host, i))
        })
        .collect();
    // A follower is no host. Hosts come before their followers, so one pass decides.
    let mut follows = vec![false; points.len()];
    pairs.retain(|&(host, i)| {
        follows[i as usize] = !follows[host as usize];
        follows[i as usize]
    });
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Clusters, repeats and lone points: every point once, its neighbours all before it.
        #[test]
        fn every_point_comes_once_with_its_nearest_before(
            centres in prop::collection::vec(prop::array::uniform3(-0.5..0.5f64), 1..12),
            steps in prop::collection::vec((0usize..12, prop::array::uniform3(-1.0..1.0f64), 0i32..12), 1..150),
        ) {
            let points: Vec<DVec3> = steps
                .iter()
                .map(|&(c, d, shrink)| DVec3::from(centres[c % centres.len()]) + DVec3::from(d) * 0.5f64.powi(1 + shrink))
                .collect();
            let chosen: Vec<u32> = (0..points.len() as u32).collect();
            let ordered = CoarseToFine::new(&points, &chosen, 8);
            let mut seen = ordered.order.clone();
            seen.sort_unstable();
            prop_assert_eq!(seen, chosen);
            for at in 0..points.len() {
                let before = &ordered.order[..at];
                let near = ordered.neighbours(at);
                prop_assert!(near.len() <= 8 && near.iter().all(|n| before.contains(n)));
            }
        }
    }
}
