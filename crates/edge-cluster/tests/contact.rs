//! Contact of every admissible net with its planes, and refusal of every other.

use edge_cluster::{
    Cluster, Error, Net, NetParams, Patch, Polyhedron, PolyhedronParams, Shape, contact_slopes, solids::Solid,
};
use glam::{DVec3, I64Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Mul, Sub};

/// Twice the precision of f64: the unevaluated sum of two.
#[derive(Clone, Copy)]
struct Dd(f64, f64);

impl Dd {
    fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Self(s, (a - (s - t)) + (b - t))
    }
    fn over(self, o: Self) -> Self {
        let q = self.0 / o.0;
        let r = self - Self(q, 0.0) * o;
        Self::sum(q, (r.0 + r.1) / o.0)
    }
}

impl Add for Dd {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let s = Self::sum(self.0, o.0);
        Self::sum(s.0, s.1 + self.1 + o.1)
    }
}

impl Sub for Dd {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + Self(-o.0, -o.1)
    }
}

impl Mul for Dd {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = self.0 * o.0;
        Self::sum(p, self.0.mul_add(o.0, -p) + self.0 * o.1 + self.1 * o.0)
    }
}

/// Small numbers without pattern.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, faces: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33).cast_signed() % faces
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll(1 << 20) as f64 / f64::from(1 << 20)
    }
}

/// A cluster in exact integers: planes n·x = c around one or two vertices.
struct Exact {
    vertices: Vec<I64Vec3>,
    planes: Vec<(I64Vec3, i64)>,
}

impl Exact {
    /// One vertex and `m` planes around it.
    fn single(m: usize, dice: &mut Dice) -> Self {
        let normal = |k: usize, dice: &mut Dice| {
            let angle = TAU * k as f64 / m as f64;
            I64Vec3::new((9.0 * angle.cos()) as i64, (9.0 * angle.sin()) as i64, 5 + dice.roll(3))
                + I64Vec3::new(dice.roll(2), dice.roll(2), 0)
        };
        Self { vertices: vec![I64Vec3::ZERO], planes: (0..m).map(|k| (normal(k, dice), 0)).collect() }
    }

    /// Two vertices along x: plane 0 and plane `first` hold both, those between belong to the second and first vertex.
    fn pair(m: usize, first: usize, dice: &mut Dice) -> Self {
        let far = I64Vec3::new(40, 0, 0);
        let mut planes = vec![];
        for k in 0..m {
            let (angle, both) = if k < first {
                (-FRAC_PI_2 + PI * k as f64 / first as f64, k == 0)
            } else {
                (FRAC_PI_2 + PI * (k - first) as f64 / (m - first) as f64, k == first)
            };
            let x = if both { 0 } else { (9.0 * angle.cos()).round() as i64 };
            let n = I64Vec3::new(x, (9.0 * angle.sin()).round() as i64, 6 + dice.roll(3));
            planes.push((n, if !both && k < first { n.dot(far) } else { 0 }));
        }
        Self { vertices: vec![I64Vec3::ZERO, far], planes }
    }

    /// A random point in all the planes named by `sides`, or `None` if no vertex and no line through one is in all.
    fn place(&self, sides: u64, dice: &mut Dice) -> Option<I64Vec3> {
        let through: Vec<_> = (0..self.planes.len()).filter(|k| sides >> k & 1 == 1).map(|k| self.planes[k]).collect();
        let on = |p: I64Vec3| through.iter().all(|(n, c)| n.dot(p) == *c);
        let base = *self.vertices.iter().find(|v| on(**v))?;
        let mut any = || I64Vec3::new(dice.roll(19) - 9, dice.roll(19) - 9, dice.roll(19) - 9);
        let step = match through[..] {
            [] => any(),
            [(n, _)] => n.cross(any()),
            [(a, _), (b, _), ..] => a.cross(b) * (any().x),
        };
        Some(if on(base + step) { base + step } else { base })
    }

    /// The heights of a random net over each plane, or `None` if some control point has no place.
    fn heights(&self, shape: Shape, g: usize, dice: &mut Dice) -> Option<Vec<Vec<f64>>> {
        let points: Option<Vec<_>> = shape.indices().iter().map(|i| self.place(shape.sides_of(i, g), dice)).collect();
        let points = points?;
        Some(self.planes.iter().map(|(n, c)| points.iter().map(|p| (n.dot(*p) - c) as f64).collect()).collect())
    }
}

/// The height of a patch, straight from the definition in double-double, on a polygon whose corners are taken as exact.
fn height(shape: Shape, heights: &[f64], side: usize, along: f64, inside: f64) -> f64 {
    let power = |x: Dd, n: u8| (0..n).fold(Dd(1.0, 0.0), |p, _| p * x);
    let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
    let mut sum = Dd(0.0, 0.0);
    match shape {
        Shape::Simplex { sides: m, degree } => {
            let corner = |k: usize| {
                let angle = TAU * (k % m) as f64 / m as f64;
                [Dd(angle.cos(), 0.0), Dd(angle.sin(), 0.0)]
            };
            // Towards the middle, which is the origin.
            let p: Vec<Dd> = (0..2)
                .map(|axis| {
                    let (a, b) = (corner(side)[axis], corner(side + 1)[axis]);
                    (a + Dd(along, 0.0) * (b - a)) * (Dd(1.0, 0.0) - Dd(inside, 0.0))
                })
                .collect();
            let sigma: Vec<Dd> = (0..m)
                .map(|k| {
                    let (a, b) = (corner(k), corner(k + 1));
                    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
                })
                .collect();
            let pi: Vec<Dd> = (0..m).map(|k| (1..m - 1).fold(Dd(1.0, 0.0), |q, i| q * sigma[(k + i) % m])).collect();
            let whole = pi.iter().fold(Dd(0.0, 0.0), |a, &b| a + b);
            let l: Vec<Dd> = pi.iter().map(|&x| x.over(whole)).collect();
            for (index, h) in shape.indices().iter().zip(heights) {
                let count = factorial(degree) / index.iter().map(|&i| factorial(i.into())).product::<f64>();
                sum = sum + index.iter().zip(&l).fold(Dd(count * h, 0.0), |b, (&i, &l)| b * power(l, i));
            }
        }
        Shape::Tensor([a, b]) => {
            let inside = Dd(inside, 0.0);
            let (one, along) = (Dd(1.0, 0.0), Dd(along, 0.0));
            let [u, v] =
                [[along, inside], [one - inside, along], [one - along, one - inside], [inside, one - along]][side];
            let bernstein = |n: usize, i: u8, t: Dd| {
                let count = factorial(n) / factorial(i.into()) / factorial(n - usize::from(i));
                Dd(count, 0.0) * power(t, i) * power(one - t, n as u8 - i)
            };
            for (index, h) in shape.indices().iter().zip(heights) {
                sum = sum + Dd(*h, 0.0) * bernstein(a, index[0], u) * bernstein(b, index[1], v);
            }
        }
    }
    sum.0.abs()
}

fn least_slope(shape: Shape, heights: &[Vec<f64>]) -> f64 {
    let mut least = f64::INFINITY;
    for (side, heights) in heights.iter().enumerate() {
        // The greatest of some places: at a single one the leading term may vanish.
        let greatest = |inside: f64| {
            [0.23, 0.5, 0.71].map(|along| height(shape, heights, side, along, inside)).into_iter().fold(0.0, f64::max)
        };
        let [far, near] = [2f64.powi(-12), 2f64.powi(-13)].map(greatest);
        if near > 0.0 {
            least = least.min((far / near).log2());
        }
    }
    least
}

/// Every admissible net has contact of its order: for each number of sides and order, random integer planes and random
/// control points in them. Single vertices work at n = 2g already.
#[test]
fn heights_fall_with_the_promised_power() {
    let mut dice = Dice(11);
    let mut checked = 0;
    for g in 1..=3 {
        for m in 3..=8 {
            // The largest net of all has 3432 points; it is measured once.
            for degree in 2 * g..=2 * g + usize::from(g < 3 || m < 8) {
                let shape = Shape::Simplex { sides: m, degree };
                let heights = Exact::single(m, &mut dice).heights(shape, g, &mut dice).unwrap();
                let slope = least_slope(shape, &heights);
                assert!(slope >= g as f64 + 0.95, "single, m {m}, n {degree}, g {g}: {slope}");
                checked += 1;
            }
            for first in (2..m - 1).filter(|_| m > 3) {
                let (exact, shape) = (Exact::pair(m, first, &mut dice), Shape::Simplex { sides: m, degree: 2 * g + 1 });
                assert!(exact.heights(Shape::Simplex { sides: m, degree: 2 * g }, g, &mut dice).is_none());
                if g < 3 || m < 7 {
                    let slope = least_slope(shape, &exact.heights(shape, g, &mut dice).unwrap());
                    assert!(slope >= g as f64 + 0.95, "pair, m {m}, g {g}: {slope}");
                    checked += 1;
                }
            }
        }
        // Theorem 1 (a) and (b): degrees (n1, n2) with n1 > 2g and n2 > g, the long way along the backbone.
        for shape in
            [Shape::Tensor([2 * g + 2, g + 1]), Shape::Tensor([2 * g + 1; 2]), Shape::Tensor([2 * g + 3, 2 * g])]
        {
            let heights = Exact::pair(4, 2, &mut dice).heights(shape, g, &mut dice).unwrap();
            let slope = least_slope(shape, &heights);
            assert!(slope >= g as f64 + 0.95, "{shape:?}, g {g}: {slope}");
            assert!(Exact::pair(4, 2, &mut dice).heights(Shape::Tensor([2 * g, 2 * g]), g, &mut dice).is_none());
            checked += 1;
        }
    }
    assert!(checked > 60, "{checked}");
}

/// A random convex polyhedron with one cluster of one or two vertices and `m` open edges over a flat base.
fn roof(m: usize, two: bool, dice: &mut Dice) -> (Polyhedron, Cluster) {
    let half = if two { 0.5 } else { 0.0 };
    let ridge = [DVec3::new(-half, 0.0, 1.0), DVec3::new(half, 0.0, 1.0)];
    // Planes by azimuth; with two vertices the first and another in the middle hold both.
    let back = if two { 2 + dice.roll(i64::try_from(m).unwrap() - 3) as usize } else { m };
    let mut planes = vec![];
    for k in 0..m {
        let angle = match (two, k < back) {
            (false, _) => TAU * (k as f64 + dice.between(-0.2, 0.2)) / m as f64,
            (true, true) => -FRAC_PI_2 + PI * k as f64 / back as f64,
            (true, false) => FRAC_PI_2 + PI * (k - back) as f64 / (m - back) as f64,
        };
        let both = two && (k == 0 || k == back);
        let normal = DVec3::new(if both { 0.0 } else { angle.cos() }, angle.sin(), dice.between(0.7, 0.9));
        let at = ridge[usize::from(two && k < back)];
        planes.push((normal, normal.dot(at)));
    }
    let corner = |k: usize| {
        let ((a, p), (b, q)) = (planes[k], planes[(k + 1) % m]);
        let d = a.x * b.y - a.y * b.x;
        DVec3::new((p * b.y - q * a.y) / d, (a.x * q - b.x * p) / d, 0.0)
    };
    let mut positions: Vec<DVec3> = (0..m).map(corner).collect();
    positions.push(ridge[0]);
    let (first, second) = (m as u32, m as u32 + u32::from(two));
    if two {
        positions.push(ridge[1]);
    }
    let mut polygons = vec![(0..m as u32).rev().collect::<Vec<_>>()];
    for k in 0..m {
        let (a, b) = (((k + m - 1) % m) as u32, k as u32);
        polygons.push(match (two, k == 0, k == back) {
            (true, true, _) => vec![a, b, second, first],
            (true, _, true) => vec![a, b, first, second],
            _ => vec![a, b, if k < back { second } else { first }],
        });
    }
    let solid = Solid { positions, polygons, clusters: vec![] };
    let (mesh, of) = solid.triangles();
    let solid = Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap();
    let mut vertices = vec![first, second];
    vertices.dedup();
    let cluster = Cluster::new(&solid, &vertices).unwrap();
    (solid, cluster)
}

fn net(solid: &Polyhedron, cluster: &Cluster, shape: Shape, g: usize) -> Result<Net, Error> {
    let reach = cluster.open.iter().map(|&h| 0.6 * solid.length(h)).collect();
    Net::new(solid, cluster, &NetParams { continuity: g, shape, reach, bulge: 0.0, moves: vec![] })
}

/// The nets that are laid out for random polyhedra, measured on the patches themselves.
#[test]
fn laid_out_nets_have_contact() {
    let mut dice = Dice(5);
    for g in 1..=3 {
        for m in 3..=8 {
            for two in [false, true].into_iter().filter(|two| m > 3 || !two) {
                let (solid, cluster) = roof(m, two, &mut dice);
                assert_eq!(cluster.sides(), m);
                let simplex = |degree| Shape::Simplex { sides: m, degree };
                let mut shapes = vec![simplex(2 * g + 1)];
                if !two {
                    shapes.push(simplex(2 * g));
                } else if m == 4 {
                    shapes.extend([Shape::Tensor([2 * g + 2, g + 1]), Shape::Tensor([2 * g + 1; 2])]);
                }
                for shape in shapes.into_iter().filter(|s| s.count() < 2000) {
                    let net = net(&solid, &cluster, shape, g).unwrap();
                    assert!(net.residual() < 1e-14, "{}", net.residual());
                    let slopes = contact_slopes(&net, &Patch::new(&net).unwrap());
                    assert!(slopes.iter().all(|s| *s >= g as f64 + 0.95), "{shape:?} g {g} two {two}: {slopes:?}");
                }
            }
        }
    }
}

/// Where a control point would have to be in two places, the error says which and what degree works.
#[test]
fn conflicts_are_refused_with_a_degree_that_works() {
    let mut dice = Dice(3);
    for g in 1..=3 {
        for m in 4..=7 {
            let (solid, cluster) = roof(m, true, &mut dice);
            let low = Shape::Simplex { sides: m, degree: 2 * g };
            match net(&solid, &cluster, low, g) {
                Err(Error::Conflict { works, sides, .. }) => {
                    assert_eq!(works, Some((2 * g + 1).to_string()));
                    assert!(sides.len() >= 3, "{sides:?}");
                }
                other => panic!("{other:?}"),
            }
        }
        let (solid, cluster) = roof(4, true, &mut dice);
        for degrees in [[2 * g, 2 * g], [2 * g, g + 1]] {
            assert!(matches!(
                net(&solid, &cluster, Shape::Tensor(degrees), g),
                Err(Error::Conflict { works: Some(_), .. })
            ));
        }
        let (solid, cluster) = roof(5, false, &mut dice);
        assert!(net(&solid, &cluster, Shape::Simplex { sides: 5, degree: g }, g).is_err());
    }
}
