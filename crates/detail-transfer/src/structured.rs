//! Structured propagation: patch by patch along a governing curve (\[Lin2008\] §4.2).

use crate::error::Error;
use crate::rectangle::{Anchor, Rectangle, anchors, length};
use crate::relief::{Detail, Relief};
use glam::{DVec2, DVec3};
use mesh_core::{Watch, distance_to_segments, open_segments};
use rayon::prelude::*;

/// A governing curve and the band that follows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Ribbon {
    /// Points on or near the surface, joined by straight lines, from detail into the target and, if wanted, out of it again. Model units.
    pub curve: Vec<DVec3>,
    /// A curve on the source, for a source elsewhere. `None`: the same.
    pub source_curve: Option<Vec<DVec3>>,
    /// Width of the band across the curve, in model units. `None`: wide enough for the whole target.
    pub width: Option<f64>,
    /// Distance of anchors along the curve, in model units. `None`: a quarter of the width.
    pub spacing: Option<f64>,
}

impl Ribbon {
    /// A band along a curve that leads from the source into the target.
    pub fn along(curve: Vec<DVec3>) -> Self {
        Self { curve, source_curve: None, width: None, spacing: None }
    }
}

/// Outer rectangles are this much larger than inner ones (\[Lin2008\] §4.2): a buffer that takes the distortion of the map, and in which
/// source patches are shifted.
const OUTER: f64 = 1.5;
/// Places along the curve that a source patch is tried at, each way.
const SHIFTS: i32 = 4;

/// What a fill along a curve did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Banded {
    /// Patches filled.
    pub patches: usize,
    /// Vertices that got detail.
    pub vertices: usize,
    /// Root mean square difference of the details where patches overlap what was known, as a share of the sources' own.
    pub mismatch: f64,
}

/// Gives detail to those vertices of `target`, where `details` has none, that lie in the band along a curve. What lies beyond the band stays
/// without.
///
/// Patches are filled in the order of how much of them is known. For each, every patch along the curve on the sources, at nine shifts,
/// is laid on it, and the one that differs least where detail is known is copied, interpolated within the source's faces. `excluded` as in
/// [`crate::fill_unstructured`]. Time ∝ target patches · source patches · vertices of a patch.
///
/// # Errors
/// [`Error::NoCurve`], [`Error::Length`], [`Error::CurveMisses`], [`Error::Cancelled`].
pub fn fill_structured(
    target: &Relief,
    details: &mut [Option<Detail>],
    sources: &[(&Relief, Vec<bool>)],
    ribbon: &Ribbon,
    watch: &Watch,
) -> Result<Banded, Error> {
    let total = length(&ribbon.curve);
    if !(total > 0.0 && total.is_finite()) {
        return Err(Error::NoCurve);
    }
    let width = ribbon.width.unwrap_or_else(|| whole_width(target, details, &ribbon.curve));
    let spacing = ribbon.spacing.unwrap_or(0.25 * width);
    for (name, value) in [("width", width), ("spacing", spacing)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::Length { name, value });
        }
    }
    let inner = DVec2::new(spacing, 0.5 * width);
    watch.step("patches", 0.0)?;
    let lay = |relief: &Relief, anchors: Vec<Anchor>| -> Vec<Rectangle> {
        anchors.par_iter().filter_map(|a| Rectangle::new(relief, a, OUTER * inner)).collect()
    };
    let goals = lay(target, anchors(target, &ribbon.curve, spacing, width));
    let goals: Vec<Goal> = goals.into_iter().map(|plane| Goal::new(plane, inner)).collect();
    let empty = |g: &&Goal| g.inner.iter().any(|&k| details[g.plane.vertices[k as usize] as usize].is_none());
    let wanted = goals.iter().filter(empty).count();
    watch.step("patches", 0.3)?;
    let mut models = vec![];
    for (relief, excluded) in sources {
        let curve = ribbon.source_curve.as_ref().unwrap_or(&ribbon.curve);
        let in_region = |a: &Anchor| relief.inside()[a.face.index()];
        let anchors: Vec<Anchor> = anchors(relief, curve, spacing, width).into_iter().filter(in_region).collect();
        let planes = lay(relief, anchors);
        models.extend(planes.into_iter().map(|plane| Model::new(relief, plane, excluded)));
    }
    if wanted == 0 || models.is_empty() {
        return Err(Error::CurveMisses { sources: models.len(), targets: wanted, at: ribbon.curve[0] });
    }
    let mut state = State { target, details, inner, filled: Banded::default(), squares: [0.0; 2] };
    let mut left: Vec<&Goal> = goals.iter().collect();
    while let Some(at) = state.next(&left) {
        watch.step("fill", 1.0 - left.len() as f64 / goals.len() as f64)?;
        let goal = left.remove(at);
        state.fill(goal, &models);
    }
    let [differences, own] = state.squares;
    state.filled.mismatch = if own > 0.0 { (differences / own).sqrt() } else { 0.0 };
    Ok(state.filled)
}

/// Twice the greatest distance of a vertex without detail from the curve, and a little more.
fn whole_width(target: &Relief, details: &[Option<Detail>], curve: &[DVec3]) -> f64 {
    let distance = |p: DVec3| distance_to_segments(p, open_segments(curve));
    let places = target.base().mesh().positions.iter().zip(details).filter(|(_, d)| d.is_none());
    2.1 * places.map(|(&p, _)| distance(p)).fold(0.0, f64::max)
}

/// A rectangle to be filled.
struct Goal {
    plane: Rectangle,
    /// Vertices within the inner rectangle, by place in the plane's list.
    inner: Vec<u32>,
}

impl Goal {
    fn new(plane: Rectangle, half: DVec2) -> Self {
        let within = |k: &u32| plane.places[*k as usize].abs().cmple(half).all();
        let inner = (0..plane.vertices.len() as u32).filter(within).collect();
        Self { plane, inner }
    }
}

/// A rectangle to copy from.
struct Model {
    plane: Rectangle,
    /// Details in the plane's coordinates; none where they may not be used.
    details: Vec<Option<Detail>>,
}

impl Model {
    fn new(relief: &Relief, plane: Rectangle, excluded: &[bool]) -> Self {
        let mut usable = vec![false; relief.vertices().len()];
        relief.region_vertices(excluded).for_each(|v| usable[v as usize] = true);
        let one = |(k, &v): (usize, &u32)| usable[v as usize].then(|| plane.to_plane(k, &relief.details()[v as usize]));
        let details = plane.vertices.iter().enumerate().map(one).collect();
        Self { plane, details }
    }

    fn at(&self, place: DVec2) -> Option<Detail> {
        let (corners, weights) = self.plane.locate(place)?;
        let mut sum = Detail::default();
        for (&k, w) in corners.iter().zip(weights) {
            let d = self.details[k as usize].as_ref()?.scaled(w);
            sum = Detail { bend: sum.bend + d.bend, offset: sum.offset + d.offset };
        }
        Some(sum)
    }
}

struct State<'a> {
    target: &'a Relief,
    details: &'a mut [Option<Detail>],
    inner: DVec2,
    filled: Banded,
    squares: [f64; 2],
}

impl State<'_> {
    fn known(&self, goal: &Goal, k: u32) -> Option<Detail> {
        self.details[goal.plane.vertices[k as usize] as usize]
    }

    /// The goal of which most is known, if any has something unknown.
    fn next(&self, left: &[&Goal]) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for (at, goal) in left.iter().enumerate() {
            let known = goal.inner.iter().filter(|&&k| self.known(goal, k).is_some()).count();
            let share = known as f64 / goal.inner.len() as f64;
            if known < goal.inner.len() && best.is_none_or(|b| share > b.1) {
                best = Some((at, share));
            }
        }
        best.map(|b| b.0)
    }

    fn fill(&mut self, goal: &Goal, models: &[Model]) {
        let rim = self.target.rim();
        let usable = |k: &&u32| !rim[goal.plane.vertices[**k as usize] as usize];
        let known: Vec<(DVec2, DVec3)> = goal
            .inner
            .iter()
            .filter(usable)
            .filter_map(|&k| {
                let d = goal.plane.to_plane(k as usize, &self.known(goal, k)?);
                Some((goal.plane.places[k as usize], self.target.signal(&d)))
            })
            .collect();
        let unknown: Vec<u32> = goal.inner.iter().copied().filter(|&k| self.known(goal, k).is_none()).collect();
        let step = (OUTER - 1.0) * self.inner.x / f64::from(SHIFTS);
        let candidates: Vec<(usize, i32)> =
            (0..models.len()).flat_map(|m| (-SHIFTS..=SHIFTS).map(move |s| (m, s))).collect();
        let judge = |&(m, s): &(usize, i32)| {
            let (model, shift) = (&models[m], DVec2::X * (f64::from(s) * step));
            let covered =
                unknown.iter().filter(|&&k| model.at(goal.plane.places[k as usize] + shift).is_some()).count();
            let (mut squares, mut own, mut count) = (0.0, 0.0, 0usize);
            for (place, signal) in &known {
                let Some(d) = model.at(*place + shift) else { continue };
                squares += self.target.signal(&d).distance_squared(*signal);
                own += signal.length_squared();
                count += 1;
            }
            // What is known must be judged by at least half of it.
            let judged = 2 * count >= known.len();
            let error = if judged && count > 0 { squares / count as f64 } else { 0.0 };
            (covered, judged, error, squares, own)
        };
        let judged: Vec<_> = candidates.par_iter().map(judge).collect();
        let better = |a: usize, b: usize| {
            let (x, y) = (&judged[a], &judged[b]);
            y.0.cmp(&x.0).then(y.1.cmp(&x.1)).then(x.2.total_cmp(&y.2)).then(a.cmp(&b))
        };
        let Some(best) = (0..judged.len()).min_by(|&a, &b| better(a, b)).filter(|&b| judged[b].0 > 0) else { return };
        let (m, s) = candidates[best];
        let shift = DVec2::X * (f64::from(s) * step);
        for &k in &unknown {
            let Some(d) = models[m].at(goal.plane.places[k as usize] + shift) else { continue };
            self.details[goal.plane.vertices[k as usize] as usize] = Some(goal.plane.on_surface(k as usize, &d));
            self.filled.vertices += 1;
        }
        self.filled.patches += 1;
        self.squares[0] += judged[best].3;
        self.squares[1] += judged[best].4;
    }
}
