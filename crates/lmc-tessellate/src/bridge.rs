//! Optimal triangulations between given closed curves: a strip between two, a polygon for anything else.
//!
//! Curves are sequences of vertices with the wanted surface on the left. Costs add up over triangles; infinite forbids.

use glam::DVec3;

/// How far a triangle is from equilateral: |2√3·r/l − 1| of its inradius r and longest side l (\[Lin2008\] eq. 3), in
/// [0, 1]; 1 without area.
pub(crate) fn irregularity([a, b, c]: [DVec3; 3]) -> f64 {
    let (u, v, w) = (a.distance(b), b.distance(c), c.distance(a));
    let (longest, perimeter) = (u.max(v).max(w), u + v + w);
    // r = 2·area / perimeter.
    let quality = 2.0 * 3f64.sqrt() * (b - a).cross(c - a).length() / (perimeter * longest);
    if quality.is_finite() { (1.0 - quality).abs() } else { 1.0 }
}

/// The cheapest strip between two closed curves whose first vertices are joined. `None` if every one is forbidden.
///
/// Dynamic programming over the last bridge; O(m·n) time, one byte for each pair.
pub(crate) fn strip(p: &[u32], q: &[u32], cost: &impl Fn([u32; 3]) -> f64) -> Option<(f64, Vec<[u32; 3]>)> {
    let mut forbidden: Vec<[u32; 3]> = vec![];
    for _ in 0..p.len() + q.len() {
        let allowed = |t: [u32; 3]| if forbidden.contains(&t) { f64::INFINITY } else { cost(t) };
        let (total, faces) = cheapest_strip(p, q, &allowed)?;
        match face_in_full_turn(p, q, &faces) {
            None => return Some((total, faces)),
            Some(middle) => forbidden.push(middle),
        }
    }
    None
}

fn cheapest_strip(p: &[u32], q: &[u32], cost: &impl Fn([u32; 3]) -> f64) -> Option<(f64, Vec<[u32; 3]>)> {
    let (m, n) = (p.len(), q.len());
    // The second curve runs the other way round, seen from the strip.
    let along = |a: usize, b: usize| [p[a % m], p[(a + 1) % m], q[(n - b % n) % n]];
    let against = |a: usize, b: usize| [q[(n - (b + 1)) % n], q[(n - b % n) % n], p[a % m]];
    let mut from = vec![0u8; (m + 1) * (n + 1)];
    let mut row = vec![f64::INFINITY; n + 1];
    for a in 0..=m {
        for b in 0..=n {
            let step_p = if a > 0 { row[b] + cost(along(a - 1, b)) } else { f64::INFINITY };
            let step_q = if b > 0 { row[b - 1] + cost(against(a, b - 1)) } else { f64::INFINITY };
            row[b] = if a + b == 0 { 0.0 } else { step_p.min(step_q) };
            from[a * (n + 1) + b] = u8::from(step_p <= step_q);
        }
    }
    if !row[n].is_finite() {
        return None;
    }
    let (mut a, mut b, mut faces) = (m, n, Vec::with_capacity(m + n));
    while a + b > 0 {
        if from[a * (n + 1) + b] == 1 {
            a -= 1;
            faces.push(along(a, b));
        } else {
            b -= 1;
            faces.push(against(a, b));
        }
    }
    faces.reverse();
    Some((row[n], faces))
}

/// A strip that goes all the way round one curve at a single vertex of the other uses a bridge twice: the face in the
/// middle of such a turn.
fn face_in_full_turn(p: &[u32], q: &[u32], faces: &[[u32; 3]]) -> Option<[u32; 3]> {
    // Faces along `p` start with two of its vertices. Once round, kinds change in pairs; one pair only means that all
    // of each kind are consecutive.
    let mut on_p: Vec<u32> = p.to_vec();
    on_p.sort_unstable();
    let kinds: Vec<bool> = faces.iter().map(|t| on_p.binary_search(&t[0]).is_ok()).collect();
    let k = kinds.len();
    let changes = (0..k).filter(|&i| kinds[i] != kinds[(i + 1) % k]).count();
    let fewer = p.len() <= q.len();
    let start = (0..k).find(|&i| kinds[(i + k - 1) % k] != kinds[i] && kinds[i] == fewer)?;
    (changes == 2).then(|| faces[(start + p.len().min(q.len()) / 2) % k])
}

/// How many triangles a polygon's triangulation may be sought among: some seconds. A thousand openings in one gap would
/// take hours.
const MOST: usize = 400_000_000;

/// The cheapest triangulation of a closed polygon by its own diagonals, of which `may_join` (by place in the polygon)
/// names the admissible ones. `None` if there is none, or if it were sought among more than 4·10⁸ triangles.
///
/// Interval dynamic programming; O(d·k) time for d admissible diagonals, k at each vertex.
///
/// ```
/// // Of a square's two diagonals the cost decides.
/// let dear = |t: [u32; 3]| if t.contains(&0) && t.contains(&2) { 2.0 } else { 1.0 };
/// let faces = lmc_tessellate::polygon(&[0, 1, 2, 3], |_, _| true, &dear).unwrap();
/// assert!(faces.iter().all(|f| f.contains(&1) && f.contains(&3)));
/// ```
pub fn polygon(
    corners: &[u32],
    may_join: impl Fn(usize, usize) -> bool,
    cost: &impl Fn([u32; 3]) -> f64,
) -> Option<Vec<[u32; 3]>> {
    struct Span {
        end: usize,
        cost: f64,
        apex: usize,
    }
    let n = corners.len();
    if n < 3 {
        return None;
    }
    let is_side = |i: usize, j: usize| j == i + 1 || (i == 0 && j == n - 1);
    let mut spans: Vec<Vec<Span>> = (0..n)
        .map(|i| {
            let ends = (i + 1..n).filter(|&j| is_side(i, j) || (corners[i] != corners[j] && may_join(i, j)));
            ends.map(|end| Span { end, cost: if end == i + 1 { 0.0 } else { f64::INFINITY }, apex: i }).collect()
        })
        .collect();
    if spans.iter().map(|s| s.len() * s.len()).sum::<usize>() > MOST {
        return None;
    }
    // Later starts first: the parts of a span start at it or after it, and end before it.
    for i in (0..n).rev() {
        for s in 0..spans[i].len() {
            let end = spans[i][s].end;
            if end == i + 1 {
                continue;
            }
            let (mut best, mut apex) = (f64::INFINITY, i);
            for first in &spans[i][..s] {
                let k = first.end;
                let Ok(place) = spans[k].binary_search_by_key(&end, |x| x.end) else { continue };
                let parts = first.cost + spans[k][place].cost;
                if parts < best {
                    let whole = parts + cost([corners[i], corners[k], corners[end]]);
                    if whole < best {
                        (best, apex) = (whole, k);
                    }
                }
            }
            (spans[i][s].cost, spans[i][s].apex) = (best, apex);
        }
    }
    let (mut stack, mut faces) = (vec![(0, n - 1)], Vec::with_capacity(n - 2));
    while let Some((i, j)) = stack.pop() {
        if j > i + 1 {
            let span = &spans[i][spans[i].binary_search_by_key(&j, |x| x.end).ok()?];
            if !span.cost.is_finite() {
                return None;
            }
            faces.push([corners[i], corners[span.apex], corners[j]]);
            stack.extend([(i, span.apex), (span.apex, j)]);
        }
    }
    Some(faces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn circle(n: usize, z: f64, turn: f64) -> Vec<DVec3> {
        (0..n)
            .map(|i| DVec3::new((turn * TAU * i as f64 / n as f64).cos(), (turn * TAU * i as f64 / n as f64).sin(), z))
            .collect()
    }

    /// Between two equal circles at the height of equilateral triangles the antiprism is best, and it is known.
    #[test]
    fn a_strip_between_equal_circles_is_an_antiprism() {
        let n = 24;
        let side = 2.0 * (TAU / 48.0).sin();
        let mut points = circle(n, 0.0, 1.0);
        let turned = glam::DQuat::from_rotation_z(TAU / 48.0);
        points.extend(circle(n, 0.866 * side, -1.0).into_iter().map(|p| turned * p));
        let ids: Vec<u32> = (0..2 * n as u32).collect();
        let cost = |t: [u32; 3]| irregularity(t.map(|v| points[v as usize]));
        let (total, faces) = strip(&ids[..n], &ids[n..], &cost).unwrap();
        assert_eq!(faces.len(), 2 * n);
        assert!(total < 0.02 * n as f64, "{total}");
        assert!(faces.iter().all(|t| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            (b - a).cross(c - a).dot((a + b + c).with_z(0.0)) > 0.0
        }));
    }

    fn brute(corners: &[u32], cost: &impl Fn([u32; 3]) -> f64) -> f64 {
        let n = corners.len();
        if n < 3 {
            return 0.0;
        }
        (1..n - 1)
            .map(|k| {
                cost([corners[0], corners[k], corners[n - 1]])
                    + brute(&corners[..=k], cost)
                    + brute(&corners[k..], cost)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn polygons_are_as_cheap_as_the_cheapest_of_all() {
        let cost =
            |t: [u32; 3]| f64::from(t.iter().fold(7u32, |h, v| h.wrapping_mul(31).wrapping_add(v * v * 17)) % 101);
        for n in 3..10 {
            let corners: Vec<u32> = (0..n).collect();
            let faces = polygon(&corners, |_, _| true, &cost).unwrap();
            assert_eq!(faces.len(), corners.len() - 2);
            assert_eq!(faces.iter().map(|&t| cost(t)).sum::<f64>(), brute(&corners, &cost));
        }
        assert_eq!(polygon(&[0, 1, 2, 3], |_, _| false, &cost), None);
    }

    /// Soups of a thousand openings took hours.
    #[test]
    fn polygons_that_would_take_hours_are_left_alone() {
        let corners: Vec<u32> = (0..2000).collect();
        assert_eq!(polygon(&corners, |_, _| true, &|_| panic!("begun")), None);
    }
}
