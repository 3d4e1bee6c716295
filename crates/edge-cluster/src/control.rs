//! Control points by index: which exist, which neighbour which, and which sides each belongs to.

use crate::error::Error;
use std::fmt;

/// The kind and degree of a patch.
///
/// Control points are numbered in the order of `Shape::index`: for a tensor-product patch b_{i,j} is number
/// i·(n2 + 1) + j; for an S-patch indices fall lexicographically from (n, 0, …, 0) to (0, …, 0, n).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Four-sided, of degree (n1, n2). Side 1 is v = 0, then counter-clockwise u = 1, v = 1, u = 0.
    Tensor([usize; 2]),
    /// An S-patch.
    Simplex {
        /// Its m ≥ 3 sides.
        sides: usize,
        /// Its degree n.
        degree: usize,
    },
}

/// More control points than this are refused.
const MOST_POINTS: usize = 1 << 16;

impl Shape {
    /// Checks the degree: at least 1, and not so high that the net could not be held.
    ///
    /// # Errors
    /// [`Error::Degree`].
    pub fn checked(self) -> Result<Self, Error> {
        let refuse = |why| Err(Error::Degree { degree: self.to_string(), why });
        let (low, high) = match self {
            Self::Tensor([a, b]) => (a.min(b), a.max(b)),
            Self::Simplex { degree, .. } => (degree, degree),
        };
        if low < 1 || high > 60 || self.sides() < 3 || self.sides() > 64 {
            return refuse("degrees are 1 to 60, for 3 to 64 sides");
        }
        if self.checked_count().is_none_or(|c| c > MOST_POINTS) {
            return refuse("the net would have more than 65536 control points; use smaller clusters or a lower degree");
        }
        Ok(self)
    }

    /// How many sides.
    pub fn sides(self) -> usize {
        match self {
            Self::Tensor(_) => 4,
            Self::Simplex { sides, .. } => sides,
        }
    }

    /// How many control points.
    pub fn count(self) -> usize {
        self.checked_count().unwrap_or(usize::MAX)
    }

    fn checked_count(self) -> Option<usize> {
        match self {
            Self::Tensor([a, b]) => (a + 1).checked_mul(b + 1),
            // C(n + m − 1, n), each partial product a binomial itself.
            Self::Simplex { sides, degree } => {
                (1..=degree).try_fold(1usize, |c, i| Some(c.checked_mul(sides + i - 1)? / i))
            }
        }
    }

    /// The indices of all control points in order.
    pub fn indices(self) -> Vec<Vec<u8>> {
        match self {
            Self::Tensor([a, b]) => (0..=a as u8).flat_map(|i| (0..=b as u8).map(move |j| vec![i, j])).collect(),
            Self::Simplex { sides, degree } => {
                let mut all = vec![];
                compositions(degree as u8, &mut vec![0; sides], 0, &mut all);
                all
            }
        }
    }

    /// The number of the control point with this index.
    pub fn number(self, index: &[u8]) -> Option<usize> {
        match self {
            Self::Tensor([a, b]) => match *index {
                [i, j] if usize::from(i) <= a && usize::from(j) <= b => Some(usize::from(i) * (b + 1) + usize::from(j)),
                _ => None,
            },
            Self::Simplex { sides, degree } => {
                let sum: usize = index.iter().map(|&i| usize::from(i)).sum();
                if index.len() != sides || sum != degree {
                    return None;
                }
                let (mut before, mut left) = (0, degree);
                for (k, &i) in index.iter().enumerate().take(sides - 1) {
                    // Those with a greater entry here come first.
                    for greater in usize::from(i) + 1..=left {
                        let rest = Self::Simplex { sides: sides - k - 1, degree: left - greater };
                        before += rest.count();
                    }
                    left -= usize::from(i);
                }
                Some(before)
            }
        }
    }

    /// The control points of the boundary curve of side k, counting from 0, in the order from corner k to corner k + 1.
    pub fn border(self, k: usize) -> Vec<usize> {
        match self {
            Self::Tensor([a, b]) => {
                let at = |i: usize, j: usize| i * (b + 1) + j;
                match k {
                    0 => (0..=a).map(|i| at(i, 0)).collect(),
                    1 => (0..=b).map(|j| at(a, j)).collect(),
                    2 => (0..=a).rev().map(|i| at(i, b)).collect(),
                    _ => (0..=b).rev().map(|j| at(0, j)).collect(),
                }
            }
            Self::Simplex { sides, degree } => (0..=degree)
                .filter_map(|i| {
                    let mut index = vec![0; sides];
                    index[k] = (degree - i) as u8;
                    index[(k + 1) % sides] += i as u8;
                    self.number(&index)
                })
                .collect(),
        }
    }

    /// How far a control point is from corner k, counting from 0: steps along side k, along side k − 1, and in other
    /// directions.
    pub fn steps_from(self, index: &[u8], k: usize) -> [usize; 3] {
        let at = |i: usize| usize::from(index[i]);
        match self {
            Self::Tensor([a, b]) => match k {
                0 => [at(0), at(1), 0],
                1 => [at(1), a - at(0), 0],
                2 => [a - at(0), b - at(1), 0],
                _ => [b - at(1), at(0), 0],
            },
            Self::Simplex { sides, degree } => {
                let (ahead, behind) = (at((k + 1) % sides), at((k + sides - 1) % sides));
                [ahead, behind, degree - at(k) - ahead - behind]
            }
        }
    }

    /// How many steps side k is long.
    pub fn side_degree(self, k: usize) -> usize {
        match self {
            Self::Tensor(degrees) => degrees[k % 2],
            Self::Simplex { degree, .. } => degree,
        }
    }

    /// Whether the control point with this index is in F_k for side k, counting from 0: whether it decides on contact of
    /// order `g` there (\[EdgeCluster2019\] §2, eq. 7).
    ///
    /// F_k of an S-patch is every index reached from one on side k by g free steps, hence i_k + i_{k+1} ≥ n − g.
    pub fn is_in_side(self, index: &[u8], k: usize, g: usize) -> bool {
        let at = |i: usize| usize::from(index[i]);
        match self {
            Self::Tensor([a, b]) => match k {
                0 => at(1) <= g,
                1 => at(0) + g >= a,
                2 => at(1) + g >= b,
                _ => at(0) <= g,
            },
            Self::Simplex { sides, degree } => at(k) + at((k + 1) % sides) + g >= degree,
        }
    }

    /// The sides whose F_k hold the control point, as bits.
    pub fn sides_of(self, index: &[u8], g: usize) -> u64 {
        (0..self.sides()).filter(|&k| self.is_in_side(index, k, g)).fold(0, |bits, k| bits | 1 << k)
    }

    /// Pairs of neighbouring control points, each once, by number: one step along u or v, or one unit moved between
    /// neighbouring entries, as the panels of an S-patch have it (\[LoopDeRose1989\]).
    pub fn neighbours(self) -> Vec<[u32; 2]> {
        let mut pairs = vec![];
        for (number, index) in self.indices().into_iter().enumerate() {
            let mut link = |other: &[u8]| {
                if let Some(n) = self.number(other).filter(|&n| n > number) {
                    pairs.push([number as u32, n as u32]);
                }
            };
            match self {
                Self::Tensor(_) => {
                    link(&[index[0] + 1, index[1]]);
                    link(&[index[0], index[1] + 1]);
                }
                Self::Simplex { sides, .. } => {
                    for k in 0..sides {
                        for l in [(k + 1) % sides, (k + sides - 1) % sides] {
                            if index[k] > 0 {
                                let mut other = index.clone();
                                other[k] -= 1;
                                other[l] += 1;
                                link(&other);
                            }
                        }
                    }
                }
            }
        }
        pairs
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tensor([a, b]) => write!(f, "{a},{b}"),
            Self::Simplex { degree, .. } => write!(f, "{degree}"),
        }
    }
}

/// Appends every way to write `left` as a sum over the entries from `k` on, the first entries greatest first.
pub(crate) fn compositions(left: u8, index: &mut Vec<u8>, k: usize, all: &mut Vec<Vec<u8>>) {
    if k + 1 == index.len() {
        index[k] = left;
        all.push(index.clone());
        return;
    }
    for i in (0..=left).rev() {
        index[k] = i;
        compositions(left - i, index, k + 1, all);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn shapes() -> Vec<Shape> {
        let simplices = (3..=7).flat_map(|sides| (1..=5).map(move |degree| Shape::Simplex { sides, degree }));
        simplices.chain([Shape::Tensor([4, 2]), Shape::Tensor([5, 5]), Shape::Tensor([3, 1])]).collect()
    }

    #[test]
    fn numbers_and_indices_are_inverse() {
        for shape in shapes() {
            let all = shape.indices();
            assert_eq!(all.len(), shape.count());
            assert!(all.iter().enumerate().all(|(n, i)| shape.number(i) == Some(n)), "{shape:?}");
        }
        assert_eq!(Shape::Simplex { sides: 6, degree: 3 }.count(), 56);
        assert!(Shape::Simplex { sides: 64, degree: 9 }.checked().is_err());
    }

    /// F_k as the paper defines it, generated: one of the side's indices of weight n − g, and g free unit steps.
    #[test]
    fn side_sets_are_those_of_the_definition() {
        for (sides, degree, g) in
            [(3, 2, 1), (5, 2, 1), (5, 3, 1), (6, 3, 1), (6, 5, 2), (4, 4, 2), (3, 7, 3), (7, 4, 3)]
        {
            let shape = Shape::Simplex { sides, degree };
            for k in 0..sides {
                let mut set = BTreeSet::new();
                for i in 0..=degree - g {
                    let mut index = vec![0u8; sides];
                    index[k] += i as u8;
                    index[(k + 1) % sides] += (degree - g - i) as u8;
                    set.insert(index);
                }
                for _ in 0..g {
                    set = set
                        .into_iter()
                        .flat_map(|i| {
                            (0..sides).map(move |l| {
                                let mut i = i.clone();
                                i[l] += 1;
                                i
                            })
                        })
                        .collect();
                }
                let ours: BTreeSet<_> = shape.indices().into_iter().filter(|i| shape.is_in_side(i, k, g)).collect();
                assert_eq!(ours, set, "{shape:?} {g} {k}");
            }
        }
    }

    /// Examples 1, 3 and 4 of \[EdgeCluster2019\] list what each side has for itself.
    #[test]
    fn the_papers_lists_come_out() {
        let own = |shape: Shape, k: usize| -> Vec<Vec<u8>> {
            shape.indices().into_iter().filter(|i| shape.sides_of(i, 1) == 1 << k).collect()
        };
        assert_eq!(own(Shape::Simplex { sides: 5, degree: 3 }, 0), [[1, 1, 0, 1, 0]]);
        assert_eq!(own(Shape::Simplex { sides: 6, degree: 3 }, 2), [[1, 0, 1, 1, 0, 0], [0, 0, 1, 1, 0, 1]]);
        let tensor = Shape::Tensor([4, 2]);
        assert_eq!(own(tensor, 0), [[2, 0]]);
        assert_eq!(own(tensor, 2), [[2, 2]]);
        assert_eq!(tensor.sides_of(&[0, 1], 1), 0b1101);
        assert_eq!(tensor.sides_of(&[2, 1], 1), 0b0101);
    }

    #[test]
    fn borders_run_from_corner_to_corner() {
        for shape in shapes() {
            let m = shape.sides();
            for k in 0..m {
                assert_eq!(shape.border(k).last(), shape.border((k + 1) % m).first());
            }
        }
    }
}
