//! Where the region's two borders go on the linkages.

use super::refusal::Refusal;
use super::region::Region;
use super::target::Target;
use glam::DVec3;
use mesh_core::{Faces, Positions, VertexId};
use param_conformal::{CutRing, Outline};

/// Steps of Taubin's filter along the border, and its two factors (\[Taubin1995\]).
const TAUBIN: (usize, f64, f64) = (3, 0.5, -0.53);
/// Neighbours come no nearer along the linkage than this share of what the two gaps beside them average.
const LEAST_GAP: f64 = 0.15;
/// Rounds of plain averaging until that holds.
const ROUNDS: usize = 200;

/// Opens the region at its longest profile, and gives every border vertex its place on the rectangle.
///
/// The seam begins and ends at the border vertices next to the longest profile's feet, where the plane of that profile
/// cuts the linkages (\[Liu2005\] §5.1).
pub(super) fn outline(region: &Region, target: &Target) -> Result<(CutRing, Outline), Refusal> {
    let (local, ring) = (&region.local, &region.ring);
    // Loop 0, the bottom, runs along the right linkage, which is number 1.
    let end = |side: usize| {
        let foot: DVec3 = target.feet[1 - side][target.longest];
        let gap = |v: &VertexId| local.position(*v).distance_squared(foot);
        ring.loops()[side].iter().map(|&h| local.tail(h)).min_by(|a, b| gap(a).total_cmp(&gap(b)).then(a.cmp(b)))
    };
    let at = target.feet[0][target.longest];
    let map = |source| Refusal::Map { at, source };
    let (Some(from), Some(to)) = (end(0), end(1)) else { return Err(Refusal::Border { at }) };
    let seam = ring.seam(local, from, to).map_err(map)?;
    let cut = ring.cut(local, seam).map_err(map)?;
    let bottom = along(region, target, cut.bottom(), None)?;
    let top = along(region, target, cut.top(), Some(bottom[0]))?;
    let outline = Outline { bottom, top, period: target.period(), height: target.across };
    Ok((cut, outline))
}

/// The places of a loop's vertices along the linkage, strictly rising, the first within half a turn of `near`.
fn along(region: &Region, target: &Target, chain: &[VertexId], near: Option<f64>) -> Result<Vec<f64>, Refusal> {
    let period = target.period();
    let wrap = |d: f64| d - period * (d / period).round();
    let station = |v: VertexId| region.stations[v.index()];
    let mut t = near.map_or(station(chain[0]), |near| near + wrap(station(chain[0]) - near));
    let mut places = Vec::with_capacity(chain.len());
    for &v in chain {
        t += wrap(station(v) - t);
        places.push(t);
    }
    let turns = (t + wrap(station(chain[0]) - t) - places[0]) / period;
    let stuck = |i: usize| Refusal::Border { at: region.local.position(chain[i]) };
    if (turns - 1.0).abs() > 0.1 {
        return Err(stuck(0));
    }
    for step in 0..2 * TAUBIN.0 {
        let factor = if step % 2 == 0 { TAUBIN.1 } else { TAUBIN.2 };
        filter(&mut places, period, factor);
    }
    for _ in 0..ROUNDS {
        match crowded(&places, period) {
            None => return Ok(places),
            Some(_) => filter(&mut places, period, 0.5),
        }
    }
    Err(stuck(crowded(&places, period).unwrap_or(0)))
}

/// Moves every value by `factor` of the way to the middle of its neighbours, all at once.
fn filter(places: &mut [f64], period: f64, factor: f64) {
    let n = places.len();
    let (first, mut before) = (places[0], places[n - 1] - period);
    for i in 0..n {
        let here = places[i];
        let after = if i + 1 < n { places[i + 1] } else { first + period };
        places[i] += factor * (0.5 * (before + after) - here);
        before = here;
    }
}

/// A value that comes too close after the one before it.
fn crowded(places: &[f64], period: f64) -> Option<usize> {
    let n = places.len();
    let at = |i: usize| places[i % n] + period * (i / n) as f64;
    let gap = |i: usize| at(i + 1) - at(i);
    (0..n).find(|&i| gap(i + n) < LEAST_GAP * 0.5 * (gap(i + n - 1) + gap(i + n + 1)) || gap(i + n) <= 0.0)
}
