//! What has been done so far to make the blend fit: linkages smoothed, and the ball made smaller, place by place.

use crate::blended::Blended;
use crate::params::Overlap;
use glam::DVec3;
use spine::{Dip, RadiusField, Rail, Softening};

/// What has been done so far to make the blend fit.
pub(crate) struct Mends {
    /// The full radius, in model units.
    radius: f64,
    /// The field of each curve, without dips.
    fields: Vec<RadiusField>,
    dips: Vec<Dip>,
    pub softenings: Vec<Softening>,
    /// Places and how often each has been mended.
    spots: Vec<(DVec3, u32)>,
    /// Spots mended in this round.
    fresh: Vec<usize>,
}

impl Mends {
    pub fn new(radius: f64, fields: Vec<RadiusField>) -> Self {
        Self { radius, fields, dips: Vec::new(), softenings: Vec::new(), spots: Vec::new(), fresh: Vec::new() }
    }

    /// Mends each place: the first time by smoothing the linkages more, then by a smaller ball. False when a ball a
    /// tenth of the size has not helped.
    pub fn add(&mut self, places: &[DVec3], overlap: Overlap) -> bool {
        self.fresh.clear();
        let r = self.radius;
        for &place in places {
            let near = (0..self.spots.len()).find(|&i| self.spots[i].0.distance(place) < 2.0 * r);
            let spot = near.unwrap_or_else(|| {
                self.spots.push((place, 0));
                self.spots.len() - 1
            });
            if !self.fresh.contains(&spot) {
                self.fresh.push(spot);
                self.spots[spot].1 += 1;
            }
        }
        self.softenings.clear();
        self.dips.clear();
        for &(at, count) in &self.spots {
            let extent = r * (3.0 + 0.5 * f64::from(count));
            self.softenings.push(Softening { at, extent, extra: 0.3 * r * f64::from(count.min(3)) });
            if count > 1 && overlap == Overlap::Shrink {
                self.dips.push(Dip { at, factor: 0.7f64.powf(f64::from(count - 1)), extent });
            }
        }
        self.spots.iter().all(|s| s.1 < 8)
    }

    pub fn touches(&self, rail: &Rail) -> bool {
        self.fresh.iter().any(|&i| {
            let (at, count) = self.spots[i];
            let extent = self.radius * (3.0 + 0.5 * f64::from(count));
            rail.samples.iter().any(|s| s.center.distance(at) < extent)
        })
    }

    /// The field of a curve with all dips made so far.
    pub fn field(&self, curve: usize) -> RadiusField {
        RadiusField { dips: self.dips.clone(), ..self.fields[curve].clone() }
    }

    pub fn account_for(&self, rails: &[Option<Rail>], blended: &mut Blended) {
        let shrunk = |dip: &Dip| {
            let distance = |rail: &Option<Rail>| {
                rail.iter().flat_map(|r| &r.samples).map(|s| s.center.distance(dip.at)).fold(f64::INFINITY, f64::min)
            };
            let nearest = rails.iter().map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            (dip.at, nearest.map_or(self.radius, |(curve, _)| self.field(curve).at(dip.at).0))
        };
        blended.shrunk = self.dips.iter().map(shrunk).collect();
        let (mut full, mut total) = (0.0, 0.0);
        for (rail, field) in rails.iter().zip(&self.fields) {
            let Some(rail) = rail else { continue };
            let next = rail.samples.iter().skip(1).chain(rail.samples.first().filter(|_| rail.closed));
            for (s, next) in rail.samples.iter().zip(next) {
                let length = s.center.distance(next.center);
                total += length;
                if s.radius >= 0.999 * field.undipped(s.center).0 {
                    full += length;
                }
            }
        }
        blended.full_share = if total > 0.0 { full / total } else { 1.0 };
    }
}
