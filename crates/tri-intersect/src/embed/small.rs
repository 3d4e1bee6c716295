//! Small faces without a general triangulation: the face is divided along its chains, and each part gets the triangulation
//! whose worst triangle is best.
//!
//! No crossing is looked for. Triangles that are all positive cover the inside of the face's outline once and nothing else, so
//! a triangulation by addresses alone is sound as soon as the exact predicate finds every triangle positive.

/// Largest part that is worth the cubic cost.
const MOST: usize = 12;

/// Divides the cycle `0..boundary` along the chains made up by `ends`; `None` unless every chain runs from boundary to
/// boundary and no two interleave.
pub(super) fn divide(boundary: usize, ends: &[[usize; 2]]) -> Option<Vec<Vec<usize>>> {
    if boundary + ends.len() > 3 * MOST {
        return None;
    }
    let mut parts = vec![(0..boundary).collect::<Vec<_>>()];
    let mut used = 0;
    for start in ends.iter().filter(|e| e[0] < boundary) {
        let mut chain = start.to_vec();
        used += 1;
        while let Some(&last) = chain.last()
            && last >= boundary
        {
            chain.push(ends.iter().find(|e| e[0] == last)?[1]);
            used += 1;
            if used > ends.len() {
                return None;
            }
        }
        let (from, to) = (chain[0], chain[chain.len() - 1]);
        let (which, i, j) = parts.iter().enumerate().find_map(|(which, part)| {
            let at = |v| part.iter().position(|&w| w == v);
            Some((which, at(from)?, at(to)?))
        })?;
        if i == j {
            return None;
        }
        // One side keeps the cycle from `to` to `from` and closes along the chain, the other the rest against it.
        let inner = &chain[1..chain.len() - 1];
        let part = parts.swap_remove(which);
        let arc = |i: usize, j: usize| {
            let count = if i <= j { j - i } else { j + part.len() - i };
            (0..=count).map(|k| part[(i + k) % part.len()]).collect::<Vec<_>>()
        };
        let (mut left, mut right) = (arc(j, i), arc(i, j));
        left.extend(inner);
        right.extend(inner.iter().rev());
        parts.extend([left, right]);
    }
    (used == ends.len() && parts.iter().all(|p| (3..=MOST).contains(&p.len()))).then_some(parts)
}

/// Adds the triangulation of a polygon whose smallest `score` is largest; scores of 0 are refused. `None` if there is none.
/// O(n³) for n ≤ 12 corners.
pub(super) fn triangulate(
    polygon: &[usize],
    score: impl Fn([usize; 3]) -> f64,
    triangles: &mut Vec<[usize; 3]>,
) -> Option<()> {
    let n = polygon.len();
    // For each diagonal (i, j): the worst score of the best triangulation of corners i..=j, and the apex on it.
    let mut best = [[(f64::INFINITY, 0usize); MOST]; MOST];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            best[i][j] = (0.0, 0);
            for k in i + 1..j {
                let sides = best[i][k].0.min(best[k][j].0);
                if sides > best[i][j].0 {
                    let worst = sides.min(score([polygon[i], polygon[k], polygon[j]]));
                    if worst > best[i][j].0 {
                        best[i][j] = (worst, k);
                    }
                }
            }
        }
    }
    let mut stack = vec![(0, n - 1)];
    while let Some((i, j)) = stack.pop() {
        if j > i + 1 {
            let (worst, k) = best[i][j];
            if worst <= 0.0 {
                return None;
            }
            triangles.push([polygon[i], polygon[k], polygon[j]]);
            stack.extend([(i, k), (k, j)]);
        }
    }
    Some(())
}
