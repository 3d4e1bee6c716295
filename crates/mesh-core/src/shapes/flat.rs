//! Plane grids, subdivided boxes and the L-bracket.

use crate::ids::VertexId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// A rectangle in the plane z = 0, centred on the origin, facing +z, of `nx` × `ny` cells with alternating diagonals.
/// Open: one boundary loop. `2·nx·ny` triangles.
pub fn grid(width: f64, height: f64, nx: u32, ny: u32) -> TriMesh {
    let (nx, ny) = (nx.max(1), ny.max(1));
    let mut mesh = TriMesh::default();
    for j in 0..=ny {
        for i in 0..=nx {
            let share = DVec2::new(f64::from(i) / f64::from(nx), f64::from(j) / f64::from(ny)) - 0.5;
            mesh.positions.push((share * DVec2::new(width, height)).extend(0.0));
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let a = j * (nx + 1) + i;
            let [a, b, c, d] = [a, a + 1, a + nx + 2, a + nx + 1].map(VertexId);
            mesh.faces.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    mesh
}

/// A box of the given edge lengths, centred on the origin, its sides divided into `cells` along x, y and z.
pub fn cuboid_grid(size: DVec3, cells: [u32; 3]) -> TriMesh {
    let cells = cells.map(|n| n.max(1));
    prism_of_blocks([0.0; 3], size, cells, |_| true)
}

/// An L-shaped bracket: a plate of `size` (x, y, z) with the quarter above x and z of `thickness` taken away, its
/// lowest corner at the origin; `cells` divides its sides along x, y and z. It has one concave edge, along y.
///
/// The thickness is rounded to whole cells, at least one and at least one less than all.
pub fn bracket(size: DVec3, thickness: f64, cells: [u32; 3]) -> TriMesh {
    let cells = [cells[0].max(2), cells[1].max(1), cells[2].max(2)];
    let thick = |axis: usize| {
        let n = cells[axis];
        ((thickness / size[axis] * f64::from(n)).round() as u32).clamp(1, n - 1)
    };
    let (x, z) = (thick(0), thick(2));
    prism_of_blocks([0.5; 3], size, cells, |[i, _, k]| i < x || k < z)
}

/// The surface of the blocks that `filled` keeps of a grid of cells over a box around the origin shifted by `shift`
/// sizes. Blocks must not touch along an edge or at a corner alone.
fn prism_of_blocks(shift: [f64; 3], size: DVec3, cells: [u32; 3], filled: impl Fn([u32; 3]) -> bool) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut ids: HashMap<[u32; 3], VertexId> = HashMap::new();
    let mut vertex = |mesh: &mut TriMesh, at: [u32; 3]| {
        *ids.entry(at).or_insert_with(|| {
            let share = [0, 1, 2].map(|k| f64::from(at[k]) / f64::from(cells[k]) - 0.5 + shift[k]);
            mesh.positions.push(DVec3::from(share) * size);
            VertexId::from(mesh.positions.len() - 1)
        })
    };
    let solid = |at: [u32; 3]| (0..3).all(|k| at[k] < cells[k]) && filled(at);
    for cell in (0..cells[2]).flat_map(|k| (0..cells[1]).flat_map(move |j| (0..cells[0]).map(move |i| [i, j, k]))) {
        if !filled(cell) {
            continue;
        }
        for axis in 0..3 {
            for up in [false, true] {
                let mut beyond = cell;
                // Below zero wraps to a cell that is not there.
                beyond[axis] = if up { cell[axis] + 1 } else { cell[axis].wrapping_sub(1) };
                if solid(beyond) {
                    continue;
                }
                let corner = |u: u32, v: u32| {
                    let mut at = cell;
                    at[axis] += u32::from(up);
                    at[(axis + 1) % 3] += u;
                    at[(axis + 2) % 3] += v;
                    at
                };
                let mut q = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(|at| vertex(&mut mesh, at));
                if !up {
                    q.swap(1, 3);
                }
                mesh.faces.extend([[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
            }
        }
    }
    mesh
}
