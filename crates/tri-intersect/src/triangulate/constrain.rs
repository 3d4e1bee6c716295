//! Edges that a triangulation must have, put in by flipping what crosses them \[Sloan1993\].

use super::{Conflict, NONE, Triangulator};

impl Triangulator {
    /// Makes the edge between two points exist and fixes it.
    pub(super) fn constrain(&mut self, [p, q]: [u32; 2]) -> Result<(), Conflict> {
        if !self.fix(p, q) {
            self.collect_crossed(p, q)?;
            let mut crossed = std::mem::take(&mut self.crossed);
            let (mut head, limit) = (0, crossed.len() * crossed.len() * 4 + 64);
            while head < crossed.len() {
                let [u, v] = crossed[head];
                head += 1;
                if head > limit {
                    return Err(self.clash([p, q], [u, v]));
                }
                let Some((t, i)) = self.find(u, v) else { continue };
                if self.triangles[t as usize].fixed[i] {
                    return Err(self.clash([p, q], [u, v]));
                }
                if self.quad(t, i).is_none() {
                    crossed.push([u, v]);
                    continue;
                }
                let [w, x] = self.flip(t, i);
                let apart = |a: u32| a != p && a != q;
                if apart(w) && apart(x) && self.turn(p, q, w) * self.turn(p, q, x) < 0 {
                    crossed.push([w, x]);
                }
            }
            self.crossed = crossed;
            if !self.fix(p, q) {
                return Err(Conflict::Crossing(p));
            }
        }
        Ok(())
    }

    /// Fixes an edge if it exists.
    fn fix(&mut self, p: u32, q: u32) -> bool {
        let mut found = false;
        for (a, b) in [(p, q), (q, p)] {
            if let Some((t, i)) = self.find(a, b) {
                self.triangles[t as usize].fixed[i] = true;
                found = true;
            }
        }
        found
    }

    /// The edges that the open segment from `p` to `q` crosses, in order.
    fn collect_crossed(&mut self, p: u32, q: u32) -> Result<(), Conflict> {
        self.crossed.clear();
        let ahead = self.around(p, |tri, i| {
            let (r, l) = (tri.v[(i + 1) % 3], tri.v[(i + 2) % 3]);
            let (sr, sl) = (self.turn(p, q, r), self.turn(p, q, l));
            (sr <= 0 && sl >= 0 && self.turn(r, l, q) < 0 && (sr < 0 || sl > 0)).then_some((r, l))
        });
        let Some((mut t, (mut r, mut l))) = ahead else { return Err(Conflict::Crossing(p)) };
        loop {
            for v in [r, l] {
                if self.turn(p, q, v) == 0 {
                    return Err(self.conflict(&[([p, q], v)]));
                }
            }
            self.crossed.push([r, l]);
            let tri = &self.triangles[t as usize];
            let Some(i) = (0..3).find(|&i| tri.v[i] == r && tri.v[(i + 1) % 3] == l) else {
                return Err(self.clash([p, q], [r, l]));
            };
            t = tri.next[i];
            if t == NONE || tri.fixed[i] {
                return Err(self.clash([p, q], [r, l]));
            }
            let Some(&x) = self.triangles[t as usize].v.iter().find(|&&x| x != r && x != l) else {
                return Err(Conflict::Crossing(p));
            };
            if x == q {
                return Ok(());
            }
            if self.turn(p, q, x) > 0 { l = x } else { r = x }
        }
    }
}
