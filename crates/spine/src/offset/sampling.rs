//! Samples along a crossing of offset patches: evenly by arc length, halved where it bends (\[Liu2005\] §4.1).

use super::OffsetParams;
use crate::contact::Contact;
use crate::patch::Patch;
use crate::radius::RadiusField;
use glam::DVec3;
use mesh_core::{Adjacency, Positions};
use rayon::prelude::*;

/// A closed polyline of centres with their images on the left and the right patch.
pub(crate) struct Loop {
    points: Vec<[DVec3; 3]>,
    /// Arc length at each point, and in all.
    arc: Vec<f64>,
}

/// Halvings of an interval, after which a bend is a kink of the facets and not the spine's.
const HALVINGS: u32 = 4;

impl Loop {
    /// `points` must not be empty.
    pub fn new(mut points: Vec<[DVec3; 3]>) -> Self {
        points.push(points[0]);
        let mut total = 0.0;
        let lengths = points.windows(2).map(|w| w[0][0].distance(w[1][0]));
        let arc = std::iter::once(0.0)
            .chain(lengths.map(|l| {
                total += l;
                total
            }))
            .collect();
        Self { points, arc }
    }

    pub fn length(&self) -> f64 {
        self.arc[self.arc.len() - 1]
    }

    pub fn start(&self) -> DVec3 {
        self.points[0][0]
    }

    /// Balls along the loop no more than `step` apart.
    pub fn contacts<M: Adjacency + Positions + Sync>(
        &self,
        mesh: &M,
        patches: &[Patch; 2],
        radius: &RadiusField,
        step: f64,
        params: &OffsetParams,
    ) -> Vec<Contact> {
        self.parameters(step, params)
            .into_par_iter()
            .filter_map(|s| {
                let [center, left, right] = self.at(s);
                let feet = [patches[0].closest(mesh, left)?, patches[1].closest(mesh, right)?];
                let ball = Contact::probe(mesh, patches, radius, center, None)?;
                // Two points that follow each other have images in a common face, so a mean of images is an image.
                let feet = feet.map(|f| mesh_query::ClosestPoint { distance: f.point.distance(center), ..f });
                Some(Contact { feet, ..ball })
            })
            .collect()
    }

    /// Arc lengths of the samples, ascending.
    fn parameters(&self, step: f64, params: &OffsetParams) -> Vec<f64> {
        let total = self.length();
        let count = (total / step).ceil().max(f64::from(params.samples.max(4))).min(super::MOST_SAMPLES) as u32;
        let mut found = Vec::new();
        for k in 0..count {
            let ends = [k, k + 1].map(|k| total * f64::from(k) / f64::from(count));
            found.push(ends[0]);
            self.refine(ends, HALVINGS, params.bend, &mut found);
        }
        found
    }

    fn refine(&self, [from, to]: [f64; 2], halvings: u32, bend: f64, found: &mut Vec<f64>) {
        if halvings > 0 && self.bend(from, to) > bend {
            let middle = 0.5 * (from + to);
            self.refine([from, middle], halvings - 1, bend, found);
            found.push(middle);
            self.refine([middle, to], halvings - 1, bend, found);
        }
    }

    /// Chord height over chord length.
    fn bend(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (self.at(from)[0], self.at(to)[0]);
        let chord = b - a;
        let inner = self.arc.partition_point(|&s| s <= from)..self.arc.partition_point(|&s| s < to);
        let height = |p: DVec3| {
            let t = ((p - a).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
            p.distance(a + t * chord)
        };
        let heights = self.points.get(inner).unwrap_or_default().iter().map(|p| height(p[0]));
        heights.fold(0.0, f64::max) / chord.length()
    }

    /// Centre and feet at arc length `s`.
    fn at(&self, s: f64) -> [DVec3; 3] {
        let i = self.arc.partition_point(|&a| a <= s).clamp(1, self.arc.len() - 1);
        let (from, to) = (self.arc[i - 1], self.arc[i]);
        let t = if to > from { ((s - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        [0, 1, 2].map(|k| self.points[i - 1][k].lerp(self.points[i][k], t))
    }
}
