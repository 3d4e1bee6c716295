//! The whole blend: laid out, meshed, and shortened where blends meet within a face.

use crate::error::Error;
use crate::layout::{Layout, Params, Spec};
use crate::polyhedron::Polyhedron;
use crate::weave::{Woven, weave};
use mesh_core::Watch;

/// A blended polyhedron with all that it was made from.
#[derive(Clone, Debug)]
pub struct Blend {
    /// Patches and strips.
    pub layout: Layout,
    /// The mesh.
    pub woven: Woven,
    /// For each halfedge, by what its reach was multiplied so that blends do not meet within a face; 1 where nothing had
    /// to be shortened.
    pub shrink: Vec<f64>,
}

/// How much reaches shorten at a time, and how often at most for one edge: a few times with care, then faster each time,
/// down to a thirtieth.
const SHORTER: f64 = 0.85;
const CAREFUL: i32 = 2;
const MOST: i32 = 7;
/// Least length of a strip, as a share of its edge.
const GAP: f64 = 0.1;
/// How much they shorten once more, when they fit.
const MARGIN: f64 = 0.85;

/// Blends clusters of a polyhedron into one watertight mesh with chords within `tolerance`, in model units. Where blends
/// meet within a planar face, all that reach into it are shortened. `shorten` multiplies every reach before.
///
/// # Errors
/// [`Error`]; [`Error::Crowded`] where shortening does not help.
pub fn blend(
    solid: &Polyhedron,
    specs: &[Spec],
    params: &Params,
    tolerance: f64,
    shorten: f64,
    watch: &Watch,
) -> Result<Blend, Error> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(Error::Range { name: "tolerance", value: tolerance, range: "(0, ∞)" });
    }
    // Finer than this, a mesh would have more triangles than ids.
    let tolerance = tolerance.max(1e-8 * solid.size);
    let mut shrink = vec![shorten; solid.halfedges.len()];
    let mut times = vec![0; shrink.len()];
    let (mut crowded, mut spaced) = (vec![], false);
    loop {
        let worst = times.iter().copied().max().unwrap_or(0);
        watch.step("layout", f64::from(worst) / f64::from(MOST))?;
        let layout = Layout::new(solid, specs, params, &shrink)?;
        let mut shorter = vec![false; shrink.len()];
        let mut shorten_edge = |h: u32| {
            shorter[h as usize] = true;
            shorter[solid.halfedges[h as usize].twin as usize] = true;
        };
        let passing: Vec<u32> = passing(solid, &layout).collect();
        if passing.is_empty() || worst >= MOST {
            let woven = weave(solid, &layout, tolerance, watch)?;
            if woven.crowded.is_empty() {
                if crowded.is_empty() || spaced {
                    return Ok(Blend { layout, woven, shrink });
                }
                // They fit now; leave some of the face between them.
                shrink.iter_mut().filter(|s| **s < shorten).for_each(|s| *s *= MARGIN);
                spaced = true;
                continue;
            }
            if worst >= MOST {
                let (face, at) = woven.crowded[0];
                return Err(Error::Crowded { face: face as usize, at });
            }
            crowded = woven.crowded;
            crowded.iter().flat_map(|&(face, _)| solid.face_halfedges(face)).for_each(&mut shorten_edge);
        }
        passing.into_iter().for_each(&mut shorten_edge);
        for ((reach, times), _) in shrink.iter_mut().zip(&mut times).zip(shorter).filter(|s| s.1) {
            *times += 1;
            *reach *= SHORTER.powi((*times - CAREFUL + 1).max(1));
        }
    }
}

/// The edges whose strips would run backwards: where the two patches, as they are cut off, pass each other or almost.
fn passing<'a>(solid: &'a Polyhedron, layout: &'a Layout) -> impl Iterator<Item = u32> + 'a {
    layout.strips.iter().filter_map(move |strip| {
        let h = layout.clusters[strip.ends[0].0].open[strip.ends[0].1];
        let edge = solid.vector(h);
        let at = [0.0, 0.25, 0.5, 0.75, 1.0];
        let [near, far] = [0.0, 1.0].map(|t| strip.points(&layout.patches, &at.map(|s| [s, t])));
        near.iter().zip(far).any(|(&a, b)| (b - a).dot(edge) < GAP * edge.length_squared()).then_some(h)
    })
}
