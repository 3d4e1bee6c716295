//! The spectrum of detail: what is lost or gained where copied places meet, made good band by band
//! (\[HeegerBergen1995\]'s way with pictures).

use crate::error::Error;
use crate::operator::Diffusion;
use crate::relief::{Detail, Relief};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Bands that are matched: up to an eighth, a quarter, a half and the whole of the wavelength. What is longer is left as it is.
pub(crate) const BANDS: usize = 4;
/// No band is made stronger or weaker than by this factor.
const MOST: f64 = 2.0;
/// A target of fewer vertices says too little about its spectrum.
const FEWEST: usize = 64;

/// Bands overlap, so that what one factor does changes the others.
const ROUNDS: usize = 6;

/// What splits offsets into bands.
struct Filters<'a>(Vec<Diffusion<'a>>);

impl<'a> Filters<'a> {
    fn new(relief: &'a Relief) -> Result<Self, Error> {
        let at = relief.base().mesh().positions[0];
        let filter = |band: usize| {
            let radius = relief.wavelength() / TAU / f64::from(1 << (BANDS - 1 - band));
            Diffusion::new(relief.operator(), relief.rim(), 0.5 * radius * radius).ok_or(Error::Singular { at })
        };
        (0..BANDS).into_par_iter().map(filter).collect::<Result<_, _>>().map(Self)
    }

    /// Offsets by bands, from short waves to long, and the rest.
    fn split(&self, offsets: &[DVec3]) -> Vec<Vec<DVec3>> {
        let mut levels = vec![offsets.to_vec()];
        levels.par_extend(self.0.par_iter().map(|f| f.step(&f.step(offsets))));
        for k in 0..BANDS {
            let (finer, coarser) = levels.split_at_mut(k + 1);
            finer[k].iter_mut().zip(&coarser[0]).for_each(|(f, c)| *f -= *c);
        }
        levels
    }
}

/// Integral of each band's squared bend over some vertices, and their area.
fn squares(relief: &Relief, bands: &[Vec<DVec3>], on: impl Iterator<Item = u32>) -> ([f64; BANDS], f64) {
    let operator = relief.operator();
    let mut sums = [0.0; BANDS];
    let mut area = 0.0;
    for v in on.map(|v| v as usize) {
        area += operator.area(v);
        for (sum, band) in sums.iter_mut().zip(bands) {
            *sum += operator.area(v) * operator.laplacian(band, v).length_squared();
        }
    }
    (sums, area)
}

/// Gives `details` at the vertices `free` of the target the sources' strength in every band, as the surface of `offsets`, which they made, has lost or
/// gained some. Returns the factors. Neighbours that copied from different places want bends that are of no surface; least squares makes
/// them one by taking the mean, which is less than either.
pub(crate) fn match_bands(
    target: &Relief,
    free: &[bool],
    offsets: &[DVec3],
    sources: &[(&Relief, Vec<bool>)],
    details: &mut [Detail],
) -> Result<[f64; BANDS], Error> {
    let on = || (0..free.len() as u32).filter(|&v| free[v as usize]);
    if on().count() < FEWEST {
        return Ok([1.0; BANDS]);
    }
    let mut wanted = ([0.0; BANDS], 0.0);
    for (source, excluded) in sources {
        let parts = Filters::new(source)?.split(source.offsets());
        let (sums, area) = squares(source, &parts, source.region_vertices(excluded));
        wanted.0.iter_mut().zip(sums).for_each(|(w, s)| *w += s);
        wanted.1 += area;
    }
    let filters = Filters::new(target)?;
    let mut matched = offsets.to_vec();
    let mut gains = [1.0; BANDS];
    for _ in 0..ROUNDS {
        let parts = filters.split(&matched);
        let found = squares(target, &parts, on());
        for k in 0..BANDS {
            let gain = (wanted.0[k] / wanted.1 * found.1 / found.0[k]).sqrt();
            let all = (gain * gains[k]).clamp(MOST.recip(), MOST);
            let gain = if all.is_finite() { all / gains[k] } else { 1.0 };
            gains[k] *= gain;
            for v in on().map(|v| v as usize) {
                matched[v] += (gain - 1.0) * parts[k][v];
            }
        }
    }
    for v in on().map(|v| v as usize) {
        let local = |x: DVec3| target.frames()[v].local(x);
        details[v] = Detail { bend: local(target.operator().laplacian(&matched, v)), offset: local(matched[v]) };
    }
    Ok(gains)
}
