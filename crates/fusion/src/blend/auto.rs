//! Which curves are swept and which are blended as a field, one after the other on the same mesh.

use super::corner::closest_between;
use super::trouble::Trouble;
use super::{
    Blended, CurveBlend, Error, LeftSharp, Method, Overlap, Params, ROUNDS, Surface, attempt, envelope, explained,
    field, measure,
};
use glam::DVec3;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, Faces, HalfedgeId, Origins, Positions, Stage, TriMesh, VertexId,
    VertexOrigin, Watch,
};
use rayon::prelude::*;
use spine::{BlendCurve, Convexity};
use std::collections::BTreeMap;

/// Curves nearer to each other than this, in radii, are blended in the same way: their blends may meet.
const NEIGHBOURS: f64 = 5.0;

/// Sweeps all curves, or with [`Surface::Field`] none. Those near a place where that fails are blended as a field if they
/// are closed, or else by the ball's envelope.
///
/// # Errors
/// That of the sweep where nothing else can serve, or where that fails too.
pub(crate) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if curves.is_empty() {
        return Err(Error::NoCurves);
    }
    if params.surface == Surface::Auto && params.overlap == Overlap::Full && field::serves(curves, params) {
        return seams(mesh, curves, params, watch);
    }
    by_stages(mesh, curves, params, watch)
}

/// A sweep with a smaller ball here and there is good enough if this share of its length has the full one.
const GOOD: f64 = 0.95;

/// Blends closed seams: swept with the full ball; where that fails, swept with a smaller one here and there or drawn as a
/// field, whichever has the full ball along more of the seams, as measured on the result.
fn seams(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params, watch: &Watch) -> Result<Blended, Error> {
    let taken = |made: Blended| {
        let mut so_far = SoFar::new(mesh, curves, params.radius);
        so_far.add(made, |_| true);
        so_far.blended
    };
    let shrinking = Params { overlap: Overlap::Shrink, ..params.clone() };
    let mut swept = None;
    for how in [params, &shrinking] {
        match attempt(mesh, curves, how, ROUNDS, watch) {
            Ok(made) if how.overlap == Overlap::Full => return Ok(taken(made)),
            Ok(made) => {
                let share = full_share(mesh, curves, &made, params.radius);
                if share >= GOOD {
                    return Ok(taken(made));
                }
                swept = Some((share, made));
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(_) => {}
        }
    }
    let field = Params { surface: Surface::Field, ..shrinking };
    let drawn = match by_stages(mesh, curves, &field, watch) {
        Err(Error::Cancelled(c)) => return Err(c.into()),
        other => other.ok(),
    };
    match (swept, drawn) {
        (Some((share, _)), Some(drawn)) if share < full_share(mesh, curves, &drawn, params.radius) => Ok(drawn),
        (Some((_, made)), _) => Ok(taken(made)),
        (None, Some(drawn)) => Ok(drawn),
        (None, None) => {
            let marked = vec![true; curves.len()];
            by_network(SoFar::new(mesh, curves, params.radius), &marked, params, watch)
        }
    }
}

/// Share of the curves' length whose blend is on balls of the radius asked for.
fn full_share(mesh: &Connected<TriMesh>, curves: &[BlendCurve], blended: &Blended, radius: f64) -> f64 {
    let asked: Vec<_> = curves.iter().map(|c| measure::Curve { halfedges: &c.halfedges, radius }).collect();
    let (found, _) = measure::measure(mesh, &asked, blended);
    let lengths = curves.iter().map(|c| c.length(mesh));
    let full = found.iter().zip(lengths.clone()).map(|(m, l)| l * m.blended_share * m.full_share.unwrap_or(0.0));
    full.sum::<f64>() / lengths.sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Sweeps all curves, or with [`Surface::Field`] none; what fails is handed over.
fn by_stages(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    let as_asked = params.surface == Surface::Field;
    let mut so_far = SoFar::new(mesh, curves, params.radius);
    let mut handed_over = vec![as_asked; curves.len()];
    let mut refusal = None;
    while handed_over.contains(&false) {
        let chosen: Vec<BlendCurve> = so_far.curves(|i| !handed_over[i])?;
        match attempt(mesh, &chosen, params, ROUNDS, watch) {
            Ok(swept) => {
                so_far.add(swept, |i| !handed_over[i]);
                break;
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(trouble) if !field::serves(curves, params) && !envelope::serves(params) => {
                return explained(mesh, curves, params, trouble, watch);
            }
            Err(trouble) => {
                so_far.blended.fallbacks.extend(hand_over(mesh, curves, params, &trouble, &mut handed_over));
                refusal = Some(trouble);
            }
        }
    }
    if refusal.is_some() && !field::serves(curves, params) {
        return by_network(so_far, &handed_over, params, watch);
    }
    loop {
        let failure = match add_fields(&mut so_far, &handed_over, params, watch) {
            Ok(()) => return Ok(so_far.blended),
            Err(failure) => failure,
        };
        let Some(trouble) = refusal.take_if(|_| !matches!(failure, Error::Cancelled(_))) else { return Err(failure) };
        if !handed_over.contains(&false) {
            if params.overlap == Overlap::Error {
                return explained(mesh, curves, params, trouble, watch);
            }
            let told = so_far.blended.fallbacks;
            so_far = SoFar::new(mesh, curves, params.radius);
            so_far.blended.fallbacks = told;
            return by_network(so_far, &handed_over, params, watch);
        }
        // Some of the curves alone may not tell two sides apart.
        handed_over.fill(true);
        let told = so_far.blended.fallbacks;
        so_far = SoFar::new(mesh, curves, params.radius);
        so_far.blended.fallbacks = told;
        refusal = Some(trouble);
    }
}

/// Blends the marked curves network by network: by the envelope of the full ball, or where that fails swept with a smaller
/// ball here and there. Curves for which no ball is found stay sharp.
fn by_network(mut so_far: SoFar<'_>, marked: &[bool], params: &Params, watch: &Watch) -> Result<Blended, Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    let mut refusal = None;
    for (group, first) in groups(mesh, curves, marked, params.radius) {
        let before = so_far.clone();
        let length: f64 = (0..curves.len()).filter(|&i| group[i]).map(|i| curves[i].length(mesh)).sum();
        // The envelope of a whole scan would fill its dents, too.
        let closed = group.iter().zip(curves).all(|(own, curve)| !own || curve.closed);
        let mut made = Err(Trouble::at("the blend fails as a field", vec![]));
        let own: Vec<&BlendCurve> = curves.iter().zip(&group).filter(|c| *c.1).map(|c| c.0).collect();
        if let Some(at) = envelope::sharp_end(mesh, &own, &envelope::halfedges_of(mesh, curves)) {
            made = Err(Trouble::at("the curve ends at edges that stay sharp", vec![at]));
        } else if !(closed && field::serves(curves, params)) {
            // At corners of both kinds the order matters little; where one fails, the other may not.
            for first in [first, first.opposite()] {
                so_far = before.clone();
                made = by_envelope(&mut so_far, &group, first, params, watch);
                let again = length <= SHORT * params.radius && is_mixed(mesh, curves, &group);
                if made.is_ok() || matches!(made, Err(Trouble::Cancelled(_))) || !again {
                    break;
                }
            }
        }
        let failure = match made {
            Ok(()) => continue,
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(trouble) => trouble,
        };
        so_far = before;
        if params.overlap == Overlap::Error {
            return explained(mesh, curves, params, failure, watch);
        }
        let mut left = None;
        for (share, omissions) in SHARES {
            let smaller = Params { radius: share * params.radius, overlap: Overlap::Shrink, ..params.clone() };
            left = swept_in_part(&mut so_far, &group, &smaller, (params.radius, omissions), watch)?;
            if left.is_some() {
                break;
            }
        }
        let at = failure.place().unwrap_or_else(|| start_of(mesh, &curves[0]));
        let all = || (0..curves.len()).filter(|&i| group[i]).map(|i| (i, at, failure.what())).collect();
        let left = left.unwrap_or_else(all);
        for (i, at, what) in left {
            so_far.leave(|j| j == i, at, what);
        }
        refusal = Some(failure);
    }
    match refusal {
        Some(trouble) if so_far.blended.mesh.faces.is_empty() => explained(mesh, curves, params, trouble, watch),
        _ => Ok(so_far.blended),
    }
}

/// Whether a network has ridges and valleys.
fn is_mixed(mesh: &Connected<TriMesh>, curves: &[BlendCurve], group: &[bool]) -> bool {
    let mut kinds = (0..curves.len()).filter(|&i| group[i]).map(|i| curves[i].convexity(mesh).ok());
    kinds.next().is_some_and(|first| kinds.any(|kind| kind != first))
}

/// Blends a network by the envelope, one convexity after the other.
fn by_envelope(
    so_far: &mut SoFar<'_>,
    group: &[bool],
    first: Convexity,
    params: &Params,
    watch: &Watch,
) -> Result<(), Trouble> {
    let (mesh, curves) = (so_far.input, so_far.all);
    for convexity in [first, first.opposite()] {
        let own = |i: usize| group[i] && curves[i].convexity(mesh).unwrap_or(Convexity::Concave) == convexity;
        if !(0..curves.len()).any(own) {
            continue;
        }
        so_far.connect().map_err(|_| Trouble::at("the blend pinches", vec![]))?;
        let chosen = so_far.pieces(own);
        if !chosen.is_empty() {
            let present = so_far.mesh.as_ref().unwrap_or(mesh);
            let mut made = envelope::blend(present, &chosen, convexity, params, watch)?;
            let by_ball = |i: usize| CurveBlend::made(Method::Envelope, params.radius, curves[i].length(mesh), 1.0);
            made.curves = (0..curves.len()).filter(|&i| own(i)).map(by_ball).collect();
            so_far.add(made, own);
        }
    }
    Ok(())
}

/// Networks longer than this, in radii, are not tried in the other order.
const SHORT: f64 = 300.0;
/// Shares of the radius at which a network is swept where the envelope of the full ball fails, and how often curves are left
/// out at each.
const SHARES: [(f64, usize); 3] = [(1.0, 4), (0.5, 1), (0.25, 1)];
/// A curve that stays sharp, a place where the ball fails and why.
type Omitted = (usize, DVec3, &'static str);
/// Sweeps a network with a ball that is made smaller where it does not fit; curves near places where that fails are left
/// out. Gives for each of these a place and what failed there; `None` if nothing could be swept.
fn swept_in_part(
    so_far: &mut SoFar<'_>,
    group: &[bool],
    params: &Params,
    (full, omissions): (f64, usize),
    watch: &Watch,
) -> Result<Option<Vec<Omitted>>, Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    let (mut kept, mut left) = (group.to_vec(), vec![]);
    for _ in 0..=omissions {
        so_far.connect()?;
        if !kept.contains(&true) {
            break;
        }
        let Ok(chosen) = so_far.curves(|i| kept[i]) else { break };
        let present = so_far.mesh.as_ref().unwrap_or(mesh);
        let (what, places) = match attempt(present, &chosen, params, ROUNDS / 2, watch) {
            Ok(mut made) => {
                if params.radius < full {
                    made.full_share = 0.0;
                    made.shrunk.push((start_of(present, &chosen[0]), params.radius));
                }
                so_far.add(made, |i| kept[i]);
                return Ok(Some(left));
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(Trouble::Places { what, places }) => (what, places),
            Err(_) => break,
        };
        let before = left.len();
        for place in places {
            let distance = |i: usize| {
                let edges = curves[i].halfedges.iter().map(|&h| mesh.ends(h));
                edges.map(|e| envelope::to_segment(place, e)).fold(f64::INFINITY, f64::min)
            };
            let nearest = (0..curves.len()).filter(|&i| group[i]).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
            if let Some(i) = nearest.filter(|&i| kept[i]) {
                kept[i] = false;
                left.push((i, place, what));
            }
        }
        if left.len() == before {
            break;
        }
    }
    Ok(None)
}

fn start_of(mesh: &Connected<TriMesh>, curve: &BlendCurve) -> DVec3 {
    curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)))
}

/// The marked curves in networks that are blended together, each with the convexity that is blended first: where ridges and
/// valleys meet, the lone one of a corner comes first and the others roll over it, as CAD kernels do.
fn groups(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    marked: &[bool],
    radius: f64,
) -> Vec<(Vec<bool>, Convexity)> {
    let mut at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    for i in (0..curves.len()).filter(|&i| marked[i]) {
        for &h in &curves[i].halfedges {
            for v in [mesh.tail(h), mesh.head(h)] {
                let here = at.entry(v).or_default();
                if here.last() != Some(&i) {
                    here.push(i);
                }
            }
        }
    }
    let convex = |i: usize| curves[i].convexity(mesh).unwrap_or(Convexity::Concave) == Convexity::Convex;
    let near = neighbours(mesh, curves, marked, NEIGHBOURS * radius);
    let mut seen = vec![false; curves.len()];
    let mut found = vec![];
    for start in (0..curves.len()).filter(|&i| marked[i]) {
        if seen[start] {
            continue;
        }
        let mut group = vec![false; curves.len()];
        let (mut stack, mut votes) = (vec![start], 0i64);
        while let Some(i) = stack.pop() {
            if std::mem::replace(&mut group[i], true) {
                continue;
            }
            seen[i] = true;
            stack.extend(near[i].iter().filter(|&&j| !group[j]));
        }
        for here in at.values().filter(|here| group[here[0]] && here.len() > 2) {
            let ridges = here.iter().filter(|&&i| convex(i)).count();
            let valleys = here.len() - ridges;
            if ridges > 0 && valleys > 0 {
                votes += (ridges as i64 - valleys as i64).signum();
            }
        }
        found.push((group, if votes >= 0 { Convexity::Concave } else { Convexity::Convex }));
    }
    found
}

/// For each marked curve, the others that come within `reach` of it.
fn neighbours(mesh: &Connected<TriMesh>, curves: &[BlendCurve], marked: &[bool], reach: f64) -> Vec<Vec<usize>> {
    let edges = |i: usize| curves[i].halfedges.iter().map(|&h| mesh.ends(h));
    let boxes: Vec<Bounds> = (0..curves.len()).map(|i| Bounds::of(edges(i).flatten()).inflated(0.5 * reach)).collect();
    let close = |i: usize, j: usize| {
        boxes[i].overlaps(&boxes[j])
            && edges(i).any(|e| {
                edges(j).any(|f| {
                    let (s, t) = closest_between(e, f);
                    e[0].lerp(e[1], s).distance(f[0].lerp(f[1], t)) < reach
                })
            })
    };
    let others = |i: usize| (0..curves.len()).filter(|&j| j != i && marked[i] && marked[j] && close(i, j)).collect();
    (0..curves.len()).into_par_iter().map(others).collect()
}

/// Blends the marked curves as fields, one for valleys and one for ridges.
fn add_fields(so_far: &mut SoFar<'_>, by_field: &[bool], params: &Params, watch: &Watch) -> Result<(), Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    // A field has nothing better than a smaller ball for the places where the full one fails.
    let overlap = if params.overlap == Overlap::Full { Overlap::Shrink } else { params.overlap };
    let params = &Params { overlap, ..params.clone() };
    for convexity in [Convexity::Concave, Convexity::Convex] {
        let own = |i: usize| by_field[i] && curves[i].convexity(mesh).unwrap_or(Convexity::Concave) == convexity;
        if !(0..curves.len()).any(own) {
            continue;
        }
        so_far.connect()?;
        let chosen = so_far.curves(own)?;
        let made = match &so_far.mesh {
            Some(changed) => field::blend(changed, &chosen, convexity, params, watch),
            None => field::blend(mesh, &chosen, convexity, params, watch),
        };
        so_far.add(made?, own);
    }
    Ok(())
}

/// Marks the curves around the places where sweeping fails; all of them if no place is near one. Returns for each such
/// group of curves a place and what fails there.
fn hand_over(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    trouble: &Trouble,
    by_field: &mut [bool],
) -> Vec<(DVec3, &'static str)> {
    let (what, places) = match trouble {
        Trouble::Places { what, places } => (*what, &places[..]),
        _ => ("the swept strip fails", &[][..]),
    };
    let points: Vec<Vec<DVec3>> = curves.iter().map(|c| c.points(mesh)).collect();
    let distance = |a: &[DVec3], b: &[DVec3]| {
        let pairs = a.iter().flat_map(|p| b.iter().map(move |q| p.distance_squared(*q)));
        pairs.fold(f64::INFINITY, f64::min).sqrt()
    };
    let ends: Vec<Vec<VertexId>> = curves.iter().map(|c| end_vertices(mesh, c)).collect();
    let mut told = vec![];
    for &place in places {
        let near = (0..curves.len()).filter(|&i| !points[i].is_empty());
        let Some(nearest) =
            near.min_by(|&i, &j| distance(&points[i], &[place]).total_cmp(&distance(&points[j], &[place])))
        else {
            break;
        };
        if by_field[nearest] {
            continue;
        }
        told.push((place, what));
        // The curve, its neighbours, and theirs.
        let mut stack = vec![nearest];
        while let Some(i) = stack.pop() {
            if std::mem::replace(&mut by_field[i], true) {
                continue;
            }
            let reach = NEIGHBOURS * params.radius;
            let meets = |j: usize| ends[i].iter().any(|v| ends[j].contains(v));
            stack.extend(
                (0..curves.len()).filter(|&j| !by_field[j] && (meets(j) || distance(&points[i], &points[j]) < reach)),
            );
        }
    }
    if told.is_empty() {
        by_field.fill(true);
        let at = places.first().or_else(|| points.iter().flatten().next()).copied().unwrap_or(DVec3::ZERO);
        told.push((at, what));
    }
    told
}

/// Both ends of an open curve.
fn end_vertices(mesh: &Connected<TriMesh>, curve: &BlendCurve) -> Vec<VertexId> {
    match (curve.closed, curve.halfedges.first(), curve.halfedges.last()) {
        (false, Some(&first), Some(&last)) => vec![mesh.tail(first), mesh.head(last)],
        _ => vec![],
    }
}

/// The mesh as it is after some curves have been blended.
#[derive(Clone)]
struct SoFar<'a> {
    input: &'a Connected<TriMesh>,
    all: &'a [BlendCurve],
    radius: f64,
    /// The present mesh; `None` while it is the input, or until [`SoFar::connect`].
    mesh: Option<Connected<TriMesh>>,
    blended: Blended,
    /// Length of the curves blended so far.
    length: f64,
}

impl<'a> SoFar<'a> {
    fn new(input: &'a Connected<TriMesh>, all: &'a [BlendCurve], radius: f64) -> Self {
        let mut blended = Blended::new(TriMesh::default(), Origins::default(), FaceId(0));
        blended.curves = all.iter().map(|c| CurveBlend::sharp(c.length(input), None)).collect();
        Self { input, all, radius, mesh: None, blended, length: 0.0 }
    }

    /// Makes ready for more curves to be blended.
    fn connect(&mut self) -> Result<(), Error> {
        if self.mesh.is_none() && !self.blended.mesh.faces.is_empty() {
            self.mesh = Some(Connected::new(self.blended.mesh.clone())?);
        }
        Ok(())
    }

    /// Some of the curves, as curves of the present mesh.
    fn curves(&self, chosen: impl Fn(usize) -> bool) -> Result<Vec<BlendCurve>, Error> {
        let chosen = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| &self.all[i]);
        let Some(mesh) = &self.mesh else { return Ok(chosen.cloned().collect()) };
        let mut now = vec![None; self.input.vertex_count()];
        for (v, origin) in (0u32..).zip(self.blended.origins.vertices.as_slice()) {
            if let VertexOrigin::Input { vertex, .. } = origin {
                now[vertex.index()] = Some(VertexId(v));
            }
        }
        let moved = |curve: &BlendCurve| {
            let halfedge = |h| {
                let ends = [self.input.tail(h), self.input.head(h)];
                let [a, b] = [now[ends[0].index()]?, now[ends[1].index()]?];
                mesh.halfedge(a, b)
            };
            let halfedges: Option<Vec<_>> = curve.halfedges.iter().map(|&h| halfedge(h)).collect();
            let at = || curve.halfedges.first().map_or(DVec3::ZERO, |&h| self.input.position(self.input.tail(h)));
            let lost = || Trouble::at("a strip covers a neighbouring curve", vec![at()]).into_error(f64::NAN);
            Ok(BlendCurve { halfedges: halfedges.ok_or_else(lost)?, closed: curve.closed })
        };
        chosen.map(moved).collect()
    }

    /// What is left of some of the curves on the present mesh: along each of their edges the pieces of it that are edges
    /// still. One that was covered in part gives several.
    fn pieces(&self, chosen: impl Fn(usize) -> bool) -> Vec<BlendCurve> {
        let chosen = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| &self.all[i]);
        let Some(mesh) = &self.mesh else { return chosen.cloned().collect() };
        let mut now = vec![None; self.input.vertex_count()];
        let mut splits: BTreeMap<[VertexId; 2], Vec<(f64, VertexId)>> = BTreeMap::new();
        for (v, origin) in (0u32..).map(VertexId).zip(self.blended.origins.vertices.as_slice()) {
            match *origin {
                VertexOrigin::Input { vertex, .. } => now[vertex.index()] = Some(v),
                VertexOrigin::Edge { ends: [a, b], t, .. } if a < b => splits.entry([a, b]).or_default().push((t, v)),
                VertexOrigin::Edge { ends: [a, b], t, .. } => splits.entry([b, a]).or_default().push((1.0 - t, v)),
                _ => {}
            }
        }
        splits.values_mut().for_each(|s| s.sort_by(|a, b| a.0.total_cmp(&b.0)));
        let mut found = vec![];
        for curve in chosen {
            let mut chain: Vec<Option<VertexId>> = vec![];
            for &h in &curve.halfedges {
                let (a, b) = (self.input.tail(h), self.input.head(h));
                chain.push(now[a.index()]);
                let mut within: Vec<VertexId> =
                    splits.get(&[a.min(b), a.max(b)]).into_iter().flatten().map(|s| s.1).collect();
                if b < a {
                    within.reverse();
                }
                chain.extend(within.into_iter().map(Some));
            }
            chain.extend(curve.halfedges.last().map(|&h| now[self.input.head(h).index()]));
            let mut halfedges = vec![];
            let mut whole = curve.closed;
            let mut close = |halfedges: &mut Vec<HalfedgeId>, closed| {
                if !halfedges.is_empty() {
                    found.push(BlendCurve { halfedges: std::mem::take(halfedges), closed });
                }
            };
            for w in chain.windows(2) {
                match w[0].zip(w[1]).and_then(|(a, b)| mesh.halfedge(a, b)) {
                    Some(h) => halfedges.push(h),
                    None => {
                        whole = false;
                        close(&mut halfedges, false);
                    }
                }
            }
            close(&mut halfedges, whole);
        }
        found
    }

    /// Notes that some of the curves stay sharp, and why.
    fn leave(&mut self, chosen: impl Fn(usize) -> bool, at: DVec3, what: &'static str) {
        let own = (0..self.all.len()).filter(|&i| chosen(i));
        let length: f64 = own.clone().map(|i| self.all[i].length(self.input)).sum();
        for i in own {
            let why = Some((at, LeftSharp::Stage(what)));
            self.blended.curves[i] = CurveBlend::sharp(self.blended.curves[i].length, why);
        }
        let so_far = &mut self.blended;
        so_far.full_share *= self.length / (self.length + length).max(f64::MIN_POSITIVE);
        self.length += length;
    }

    /// Takes over what became of the present mesh, and the account of it.
    fn add(&mut self, made: Blended, chosen: impl Fn(usize) -> bool) {
        let own: f64 = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| self.all[i].length(self.input)).sum();
        let so_far = &mut self.blended;
        for (k, i) in (0..self.all.len()).filter(|&i| chosen(i)).enumerate() {
            let by_field = || {
                let least = made.shrunk.iter().map(|s| s.1).fold(self.radius, f64::min);
                CurveBlend::made(Method::Field, least, so_far.curves[i].length, made.full_share)
            };
            so_far.curves[i] = made.curves.get(k).copied().unwrap_or_else(by_field);
        }
        let before = self.mesh.take();
        so_far.origins = match &before {
            Some(before) => {
                let stage = Stage { origins: &so_far.origins, faces: before };
                made.origins.compose(&[stage], &[self.input as &dyn Faces])
            }
            None => made.origins,
        };
        if before.is_none() {
            so_far.first_blend_face = made.first_blend_face;
        }
        so_far.strips += made.strips;
        so_far.fields += made.fields;
        so_far.corners += made.corners;
        so_far.residual = so_far.residual.max(made.residual);
        so_far.bridged += made.bridged;
        so_far.shrunk.extend(made.shrunk);
        so_far.run_outs.extend(made.run_outs);
        so_far.levels = so_far.levels.max(made.levels);
        so_far.full_share =
            (so_far.full_share * self.length + made.full_share * own) / (self.length + own).max(f64::MIN_POSITIVE);
        self.length += own;
        so_far.mesh = made.mesh;
    }
}
