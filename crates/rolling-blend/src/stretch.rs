//! Rails cut to length: how each begins and ends.

use glam::DVec3;
use mesh_core::SurfacePoint;
use spine::{Convexity, Rail, Sample};

/// What lies beyond the last ball of a stretch.
#[derive(Clone, Debug)]
pub(crate) enum Ending {
    /// The first ball: the rail is closed.
    Joined,
    /// A corner patch.
    Corner,
    /// Points with normals of the surface at which the blend stops, from its left side to its right one.
    Stop(Vec<(SurfacePoint, DVec3)>),
    /// A point of the curve in which both linkages end.
    Tip(SurfacePoint),
}

/// A rail cut to length.
pub(crate) struct Stretch {
    pub rail: Rail,
    pub endings: [Ending; 2],
}

impl Stretch {
    /// How many profiles the strip has, those in the surfaces beyond included.
    pub fn stations(&self) -> usize {
        self.rail.samples.len() + self.before() + usize::from(self.has_station(1))
    }

    /// 1 if there is a station before the first ball.
    pub fn before(&self) -> usize {
        usize::from(self.has_station(0))
    }

    fn has_station(&self, end: usize) -> bool {
        matches!(self.endings[end], Ending::Stop(_) | Ending::Tip(_))
    }

    /// The ball at a station, or else how the stretch ends there: a stop or a tip.
    pub fn station(&self, k: usize) -> Result<&Sample, &Ending> {
        match k.checked_sub(self.before()) {
            None => Err(&self.endings[0]),
            Some(i) => self.rail.samples.get(i).ok_or(&self.endings[1]),
        }
    }

    /// Where a linkage is at a station, with a rough outward normal of the surface.
    pub fn foot<M: mesh_core::Faces>(&self, mesh: &M, side: usize, k: usize) -> (SurfacePoint, DVec3) {
        let radial = |s: &Sample| self.outwards() * (s.feet[side].point - s.center).normalize_or_zero();
        match self.station(k) {
            Ok(s) => (s.feet[side].surface_point(mesh), radial(s)),
            Err(Ending::Stop(points)) => points[if side == 0 { 0 } else { points.len() - 1 }],
            Err(Ending::Tip(point)) => (*point, radial(self.last_two(usize::from(k > 0)).0)),
            // Not a station; the last ball's foot is the nearest thing to one.
            Err(Ending::Joined | Ending::Corner) => {
                let last = self.last_two(usize::from(k > 0)).0;
                (last.feet[side].surface_point(mesh), radial(last))
            }
        }
    }

    /// The last ball at an end, and the one before it.
    pub fn last_two(&self, end: usize) -> (&Sample, &Sample) {
        let s = &self.rail.samples;
        if end == 0 { (&s[0], &s[1]) } else { (&s[s.len() - 1], &s[s.len() - 2]) }
    }

    /// 1 where the direction from ball to foot is the surface's outward normal, else −1.
    pub fn outwards(&self) -> f64 {
        match self.rail.convexity {
            Convexity::Convex => 1.0,
            Convexity::Concave => -1.0,
        }
    }
}

/// A rail as seen from one of its ends: places are sample numbers counted from there, with fractions.
pub(crate) struct Outward<'a> {
    pub rail: &'a Rail,
    pub end: usize,
}

impl Outward<'_> {
    pub fn len(&self) -> usize {
        self.rail.samples.len()
    }

    /// The `i`-th sample.
    pub fn raw(&self, i: usize) -> &Sample {
        &self.rail.samples[if self.end == 0 { i } else { self.len() - 1 - i }]
    }

    /// The ball at a place, between its neighbours; of its feet only the points are right.
    pub fn sample(&self, at: f64) -> Sample {
        let i = (at.max(0.0) as usize).min(self.len().saturating_sub(2));
        let t = (at - i as f64).clamp(0.0, 1.0);
        let (a, b) = (self.raw(i), self.raw((i + 1).min(self.len() - 1)));
        let mut mixed = *if t < 0.5 { a } else { b };
        mixed.center = a.center.lerp(b.center, t);
        mixed.radius = a.radius + t * (b.radius - a.radius);
        for s in 0..2 {
            mixed.feet[s].point = a.feet[s].point.lerp(b.feet[s].point, t);
            mixed.bends[s] = a.bends[s] + t * (b.bends[s] - a.bends[s]);
        }
        mixed
    }

    /// The place whose ball is nearest to a point.
    pub fn nearest(&self, p: DVec3) -> f64 {
        let mut best = (self.raw(0).center.distance(p), 0.0);
        for i in 1..self.len() {
            let (a, b) = (self.raw(i - 1).center, self.raw(i).center);
            let t = (p - a).dot(b - a) / (b - a).length_squared();
            let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
            let d = a.lerp(b, t).distance(p);
            if d < best.0 {
                best = (d, (i - 1) as f64 + t);
            }
        }
        best.1
    }

    /// The place `length` farther out along the spine.
    pub fn advance(&self, at: f64, mut length: f64) -> f64 {
        let mut here = at.max(0.0);
        while here < (self.len() - 1) as f64 {
            let next = (here.floor() + 1.0).min((self.len() - 1) as f64);
            let way = self.sample(here).center.distance(self.sample(next).center);
            if way >= length {
                return here + (next - here) * length / way.max(f64::MIN_POSITIVE);
            }
            length -= way;
            here = next;
        }
        here
    }

    /// How far short of `place` the rail ends, along its own direction there; negative if it goes beyond.
    pub fn before_end(&self, place: DVec3) -> f64 {
        let (first, second) = (self.raw(0).center, self.raw(1.min(self.len() - 1)).center);
        (place - first).dot((first - second).normalize_or_zero())
    }
}

/// A cubic Bézier curve.
pub(crate) fn bezier([a, b, c, d]: [DVec3; 4], t: f64) -> DVec3 {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
}
