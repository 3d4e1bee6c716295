//! The symmetries of a polyhedron.

use crate::polyhedron::Polyhedron;
use glam::{DMat3, DVec3};

/// Larger polyhedra are taken to have none: the search is cubic.
const MOST_VERTICES: usize = 300;
/// Vertices this close, as a share of the diagonal, are images of each other.
const SAME: f64 = 1e-6;

/// The rotations and mirrorings that map the polyhedron onto itself, as the image of each vertex; the identity first.
pub fn symmetries(solid: &Polyhedron) -> Vec<Vec<u32>> {
    let identity: Vec<u32> = (0..solid.positions.len() as u32).collect();
    let vertices: Vec<u32> = solid.vertices().collect();
    if vertices.len() > MOST_VERTICES {
        return vec![identity];
    }
    let center = vertices.iter().map(|&v| solid.positions[v as usize]).sum::<DVec3>() / vertices.len().max(1) as f64;
    let arm = |v: u32| (solid.positions[v as usize] - center) / solid.size;
    let ends = |h: u32| [solid.halfedges[h as usize].tail, solid.halfedges[h as usize].head];
    // The edge whose triangle with the middle is largest fixes a map best.
    let area = |h: u32| arm(ends(h)[0]).cross(arm(ends(h)[1])).length();
    let Some(base) = (0..solid.halfedges.len() as u32).max_by(|&a, &b| area(a).total_cmp(&area(b))) else {
        return vec![identity];
    };
    let [a, b] = ends(base).map(arm);
    let frame = DMat3::from_cols(a, b, a.cross(b));
    if frame.determinant().abs() < SAME {
        return vec![identity];
    }
    let back = frame.inverse();
    let mut found = vec![identity];
    for h in 0..solid.halfedges.len() as u32 {
        let [c, d] = ends(h).map(arm);
        let alike = |x: f64, y: f64| (x - y).abs() < SAME;
        if !(alike(c.length(), a.length()) && alike(d.length(), b.length()) && alike(c.distance(d), a.distance(b))) {
            continue;
        }
        for side in [1.0, -1.0] {
            let map = DMat3::from_cols(c, d, side * c.cross(d)) * back;
            let image = |&v: &u32| {
                let goal = map * arm(v);
                vertices.iter().copied().find(|&w| arm(w).distance(goal) < SAME)
            };
            let images: Option<Vec<u32>> = vertices.iter().map(image).collect();
            if let Some(images) = images {
                let mut whole = found[0].clone();
                vertices.iter().zip(images).for_each(|(&v, w)| whole[v as usize] = w);
                if !found.contains(&whole) {
                    found.push(whole);
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PolyhedronParams, solids};

    #[test]
    fn orders_are_those_of_the_groups() {
        let order = |solid: &solids::Solid| {
            let (mesh, of) = solid.triangles();
            symmetries(&Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap()).len()
        };
        let all = solids::regular();
        let by_name = |name: &str| order(&all.iter().find(|(n, _)| *n == name).unwrap().1);
        assert_eq!((by_name("tetrahedron"), by_name("cube"), by_name("icosahedron")), (24, 48, 120));
        // The snub solids have no mirrors.
        assert_eq!((by_name("snub cube"), by_name("truncated octahedron")), (24, 48));
        assert_eq!(
            (order(&solids::pressure_meter()), order(&solids::flower_pot()), order(&solids::vase())),
            (2, 10, 14)
        );
    }
}
