//! Which curves are swept and which are blended as a field, one after the other on the same mesh.

use crate::blended::Blended;
use crate::error::Error;
use crate::networks::{NEIGHBOURS, by_network};
use crate::params::{Overlap, Params, Surface};
use crate::so_far::SoFar;
use crate::stitch::{ROUNDS, attempt, explained};
use crate::trouble::Trouble;
use crate::zones::by_zones;
use crate::{envelope, field, measure};
use glam::DVec3;
use mesh_core::{Connected, Faces, TriMesh, VertexId, Watch};
use spine::{BlendCurve, Convexity};

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
            let (marked, failure) = (vec![true; curves.len()], Trouble::at("the blend fails as a field", vec![]));
            by_network(SoFar::new(mesh, curves, params.radius), &marked, failure, params, watch)
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
    let mut in_zones = params.overlap == Overlap::Full && envelope::serves(params) && !field::serves(curves, params);
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
                if in_zones {
                    in_zones = false;
                    match by_zones(mesh, curves, trouble.clone(), params, watch) {
                        Ok(made) => {
                            so_far.add(made, |_| true);
                            return Ok(so_far.blended);
                        }
                        Err(Trouble::Cancelled(c)) => return Err(c.into()),
                        Err(_) => {}
                    }
                }
                so_far.blended.fallbacks.extend(hand_over(mesh, curves, params, &trouble, &mut handed_over));
                refusal = Some(trouble);
            }
        }
    }
    if let Some(trouble) = refusal.take_if(|_| !field::serves(curves, params)) {
        return by_network(so_far, &handed_over, trouble, params, watch);
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
            return by_network(so_far, &handed_over, trouble, params, watch);
        }
        // Some of the curves alone may not tell two sides apart.
        handed_over.fill(true);
        let told = so_far.blended.fallbacks;
        so_far = SoFar::new(mesh, curves, params.radius);
        so_far.blended.fallbacks = told;
        refusal = Some(trouble);
    }
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
