//! Writes curves as OBJ lines.

use crate::number::{push_f64, push_u64};
use glam::DVec3;

/// Chains of points as an OBJ file of `l` elements, one for each chain. A closed chain comes back to its first point.
/// Positions print as the shortest decimals that read back bit for bit; chains of fewer than two points are left out.
///
/// ```
/// let triangle = ([glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y].to_vec(), true);
/// let text = String::from_utf8(mesh_io::lines_to_obj(&[triangle]))?;
/// assert_eq!(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1\n");
/// # Ok::<(), std::string::FromUtf8Error>(())
/// ```
pub fn lines_to_obj(chains: &[(Vec<DVec3>, bool)]) -> Vec<u8> {
    let chains = || chains.iter().filter(|c| c.0.len() > 1);
    let mut out = vec![];
    for p in chains().flat_map(|c| &c.0) {
        out.push(b'v');
        for x in p.to_array() {
            out.push(b' ');
            push_f64(&mut out, x);
        }
        out.push(b'\n');
    }
    let mut first = 1;
    for (points, closed) in chains() {
        let next = first + points.len() as u64;
        out.push(b'l');
        for number in (first..next).chain(closed.then_some(first)) {
            out.push(b' ');
            push_u64(&mut out, number);
        }
        out.push(b'\n');
        first = next;
    }
    out
}
