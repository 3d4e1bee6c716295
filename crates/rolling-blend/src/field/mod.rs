//! Blends that cannot fold: the ball as a field around two sides, instead of a sweep along a curve.
//!
//! Linkages are level sets of distance on the mesh, so they cannot cross themselves, and neighbouring seams, short seams
//! and crevices need no special case. The surface between them is the cut-out piece of the mesh itself, which has the
//! right topology already: it is drawn onto the balls that touch both sides, and settles as a thin plate where they
//! disagree with their neighbours.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages, and the smaller ball where the result meets itself |
//! | `sides.rs` | the two sides: distances and smoothed normals |
//! | `ball.rs` | the ball that touches both sides |
//! | `mark.rs` | what the ball sweeps over |
//! | `level.rs` | the loops around it |
//! | `piece.rs` | what lies between them, cut out and put back |
//! | `surface.rs` | that piece drawn onto the balls |
//! | `plate.rs` | the thin plate |
//! | `share.rs` | how much of the blend is on balls of the full radius |

mod ball;
mod level;
mod mark;
pub(crate) mod piece;
mod plate;
mod share;
mod sides;
mod surface;

use crate::blended::Blended;
use crate::error::Error;
use crate::linkage::Opened;
use crate::params::{Overlap, Params};
use crate::radii::Radii;
use crate::rolling::step_length;
use crate::sew::sew;
use crate::sketch::{Drawing, Page};
use crate::stitch::check;
use crate::trouble::Trouble;
use ball::touches_both;
use glam::DVec3;
use level::level_curves;
use mark::scalar;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId, VertexOrigin,
    Watch, centroid,
};
use piece::{CutOut, cut_out, kept_chords, put_back};
use profile_nurbs::Profile;
use rayon::prelude::*;
use share::full_share;
use sides::{Sides, between};
use spine::{BlendCurve, Convexity, Dip, RadiusField};
use surface::draw;
use tri_intersect::embed::{curve_edges, flood};
use tri_intersect::{EmbedError, EmbedParams, Embedded, embed};

/// How often the ball is made smaller where the result meets itself.
const ROUNDS: usize = 9;
/// In the first rounds the ball is made smaller by one step at a time.
const PATIENT: usize = 4;
/// Where that does not help, shares of the radius at which the curves are blended as a whole, and the rounds for each.
const SMALLER: [f64; 2] = [0.5, 0.25];
const FEWER: usize = 3;

/// Whether a field may take the place of a sweep: it can serve all curves, and something may give way.
pub(crate) fn serves(curves: &[BlendCurve], params: &Params) -> bool {
    params.overlap != Overlap::Error
        && is_arc(params)
        && params.radii == Radii::default()
        && curves.iter().all(|c| c.closed)
}

fn is_arc(params: &Params) -> bool {
    matches!(params.profile, Profile::Arc) && params.profile_at.is_empty() && params.reach.is_none()
}

/// At how many places of curves longer than so many radii a ball is looked for before anything else is done. Around shorter
/// ones the plate alone may serve.
const PLACES: usize = 256;
const LONG: f64 = 20.0;
/// Half the length over which linkages are evened out, and how far their points may be moved to spare slivers, in radii.
const FAIRED: f64 = 0.25;
const SNAP: f64 = 0.02;

/// Blends `curves`, all of one convexity, as a field.
///
/// # Errors
/// [`Error`]; what does not fit comes with a place.
pub(crate) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    convexity: Convexity,
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if curves.is_empty() {
        return Err(Error::NoCurves);
    }
    if curves.iter().any(|c| !c.closed) {
        return Err(Error::NotByField("use --surface stitch for open ones"));
    }
    if !is_arc(params) {
        return Err(Error::NotByField("use --surface stitch for other profiles"));
    }
    if params.radii != Radii::default() {
        return Err(Error::NotByField("use --surface stitch for radii that vary"));
    }
    let sides = Sides::new(mesh, curves, convexity).map_err(|t| t.into_error(params.radius))?;
    let refusal = match settle_on(&sides, curves, params, ROUNDS, watch) {
        Err(e @ Error::DoesNotFit { .. }) if params.overlap == Overlap::Shrink => e,
        other => return other,
    };
    for share in SMALLER {
        let smaller = Params { radius: share * params.radius, ..params.clone() };
        match settle_on(&sides, curves, &smaller, FEWER, watch) {
            Err(Error::DoesNotFit { .. }) => {}
            Err(other) => return Err(other),
            Ok(mut blended) => {
                blended.full_share = full_share(&sides, &blended, params.radius);
                if let Error::DoesNotFit { at, .. } = refusal {
                    blended.shrunk.insert(0, (at, smaller.radius));
                }
                return Ok(blended);
            }
        }
    }
    Err(refusal)
}

/// Blends with a ball of one radius, made smaller where the result meets itself.
fn settle_on(
    sides: &Sides<'_>,
    curves: &[BlendCurve],
    params: &Params,
    rounds: usize,
    watch: &Watch,
) -> Result<Blended, Error> {
    let mesh = sides.mesh;
    let edge = step_length(mesh, curves, params);
    let mut radius = RadiusField::constant(params.radius);
    let mut spots: Vec<(DVec3, usize)> = vec![];
    let mut tries = Tries { edge, ..Tries::default() };
    let length: f64 = curves.iter().map(|c| c.length(mesh)).sum();
    if length > LONG * params.radius && !touches(sides, curves, &radius) {
        return Err(
            Trouble::at("no ball touches both sides", places(mesh, curves).take(1).collect()).into_error(params.radius)
        );
    }
    params.sketch.begin(mesh, curves);
    let page = params.sketch.page(mesh, &curves[0]);
    let fine = refined(sides, radius.base).map_err(|t| t.into_error(params.radius))?;
    for round in 0.. {
        watch.step("blend", round as f64 / rounds as f64)?;
        let resigned_before = tries.sharp.len();
        tries.resigned = round >= PATIENT && params.overlap == Overlap::Shrink;
        let trouble = match attempt(sides, &fine, &radius, params, &mut tries, page, watch) {
            Ok(mut blended) => {
                let left = length_left_sharp(mesh, curves, &blended);
                blended.full_share = full_share(sides, &blended, params.radius) * (1.0 - left / length);
                blended.shrunk = radius.dips.iter().map(|d| (d.at, radius.at(d.at).0)).collect();
                let sharp: Vec<_> = sharp_places(mesh, curves, &blended).map(|at| (at, 0.0)).collect();
                blended.shrunk.extend(sharp);
                return Ok(blended);
            }
            Err(trouble) => trouble,
        };
        params.sketch.refusal(&trouble, params.radius);
        let places = match &trouble {
            Trouble::Places { places, .. } if round < rounds && params.overlap == Overlap::Shrink => places,
            _ => return Err(trouble.into_error(params.radius)),
        };
        if places.is_empty() {
            return Err(trouble.into_error(params.radius));
        }
        if !tries.resigned || tries.sharp.len() == resigned_before {
            shrink(&mut radius, &mut spots, places, round);
        }
    }
    Err(Error::NoCurves)
}

/// Whether there is a ball anywhere along the curves. In a plate far thinner than the ball there is none, however long it
/// is looked for.
fn touches(sides: &Sides<'_>, curves: &[BlendCurve], radius: &RadiusField) -> bool {
    let all: Vec<DVec3> = places(sides.mesh, curves).collect();
    let some = all.par_iter().step_by(all.len().div_ceil(PLACES).max(1));
    some.any(|&p| touches_both(sides, radius, p))
}

/// Middles of the curves' edges.
fn places<'a>(mesh: &'a Connected<TriMesh>, curves: &'a [BlendCurve]) -> impl Iterator<Item = DVec3> + 'a {
    curves.iter().flat_map(|c| &c.halfedges).map(|&h| {
        let [a, b] = mesh.ends(h);
        a.midpoint(b)
    })
}

/// Shares of the radius that are tried in turn where the ball does not fit. The last leaves a thread that is next to
/// sharp, so that one place cannot decide for the rest of a seam.
const SHARES: [f64; 5] = [0.7, 0.45, 0.25, 0.12, 0.06];

/// Makes the ball smaller around the places; in many rounds, by more at a time.
fn shrink(radius: &mut RadiusField, spots: &mut Vec<(DVec3, usize)>, places: &[DVec3], round: usize) {
    let mut fresh: Vec<usize> = vec![];
    for &place in places {
        let near = spots.iter().position(|s| s.0.distance(place) < radius.base);
        let spot = near.unwrap_or_else(|| {
            spots.push((place, 0));
            spots.len() - 1
        });
        if !fresh.contains(&spot) {
            fresh.push(spot);
            spots[spot].1 += if round < PATIENT { 1 } else { 2 };
        }
    }
    let base = radius.base;
    let dip = |&(at, count): &(DVec3, usize)| {
        let step = count.min(SHARES.len());
        Dip { at, factor: SHARES[step - 1], extent: base * (1.5 + 0.5 * step as f64) }
    };
    radius.dips = spots.iter().map(dip).collect();
}

/// A piece that was drawn in an earlier round: most stay the same where the ball is made smaller in one place.
#[derive(Clone)]
struct Drawn {
    from: Vec<DVec3>,
    radii: Vec<f64>,
    made: TriMesh,
}

impl Drawn {
    fn radii(piece: &CutOut, radius: &RadiusField) -> Vec<f64> {
        piece.mesh.positions.iter().map(|&p| radius.at(p).0).collect()
    }

    fn is_of(&self, piece: &CutOut, radius: &RadiusField) -> bool {
        self.from == piece.mesh.positions && self.radii == Self::radii(piece, radius)
    }
}

/// What the tries of one field share.
#[derive(Default)]
struct Tries {
    /// Length of the surface's edges, in model units.
    edge: f64,
    /// Pieces drawn in the last one.
    drawn: Vec<Drawn>,
    /// Places around which the curves stay sharp.
    sharp: Vec<DVec3>,
    /// Whether places of trouble are added to these.
    resigned: bool,
}

fn attempt(
    sides: &Sides<'_>,
    fine: &Fine,
    radius: &RadiusField,
    params: &Params,
    tries: &mut Tries,
    page: Page<'_>,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let mesh = sides.mesh;
    let Fine { mesh: fine, origins, of, seam } = fine;
    let value = scalar(fine, of, seam, sides, radius);
    let loops = level_curves(mesh, fine, origins, &value, FAIRED * radius.base);
    if loops.is_empty() {
        let at = seam.first().map(|&v| fine.position(v));
        return Err(Trouble::at("the ball touches all of the surface", at.into_iter().collect()));
    }
    let how = EmbedParams { snap: 0.15, reach: params.snap.max(SNAP) * radius.base };
    let embedded = embed(mesh, &loops, &how, watch).map_err(refusal)?;
    let chain = |c: &Vec<VertexId>| (c.iter().map(|&v| embedded.mesh.positions[v.index()]).collect(), true);
    page.draw_field("linkages", || Drawing::Lines(embedded.curves.iter().map(chain).collect()));
    let cut = Connected::new(&embedded.mesh).map_err(Trouble::not_manifold("the cut mesh is not a manifold"))?;
    let mut removed = enclosed(sides, &cut, &embedded)?;
    leave_sharp(&cut, &mut removed, &tries.sharp);
    if !removed.as_slice().contains(&true) {
        return Err(Trouble::at("the ball touches all of the surface", tries.sharp.iter().copied().take(1).collect()));
    }
    let pieces = cut_out(&embedded.mesh, &removed, &embedded.curves).pieces();
    let drawn: Vec<Result<Drawn, Trouble>> = pieces
        .par_iter()
        .map(|piece| {
            if let Some(same) = tries.drawn.iter().find(|d| d.is_of(piece, radius)) {
                return Ok(same.clone());
            }
            let taken = kept_chords(&cut, &removed, &piece.rim);
            let made = draw(piece, sides, radius, tries.edge, &taken, watch)?;
            Ok(Drawn { from: piece.mesh.positions.clone(), radii: Drawn::radii(piece, radius), made })
        })
        .collect();
    tries.drawn = drawn.into_iter().collect::<Result<_, _>>()?;
    page.draw_field("surface", || Drawing::Mesh(TriMesh::merged(tries.drawn.iter().map(|d| &d.made))));
    let mut first_new = embedded.mesh.vertex_count() as u32;
    let mut back = Vec::with_capacity(pieces.len());
    for (piece, drawn) in pieces.iter().zip(&tries.drawn) {
        back.push(put_back(&piece.rim, &drawn.made, first_new));
        first_new += (drawn.made.positions.len() - piece.rim.len()) as u32;
    }
    let opened = Opened { linkages: vec![], joints: vec![], stops: vec![], loops: vec![], embedded };
    let sewn = sew(&opened, &removed, &back);
    if let Err(trouble) = check(&sewn, watch) {
        if tries.resigned {
            tries.sharp.extend(centers_of_failing(&pieces, &tries.drawn, &trouble));
        }
        return Err(trouble);
    }
    Ok(Blended { fields: back.len(), ..Blended::new(sewn.mesh, sewn.origins, sewn.first_new_face) })
}

/// Gives back what is between no linkages, since the ball touches all of a component, and what is around the places of
/// `sharp`, vertices of the curves where nothing else has helped: there the curves stay sharp, and those elsewhere do
/// not depend on it.
fn leave_sharp(cut: &Connected<&TriMesh>, removed: &mut FaceMap<bool>, sharp: &[DVec3]) {
    let mut seen = vec![false; cut.face_count()];
    for start in cut.face_ids() {
        if !removed[start] || std::mem::replace(&mut seen[start.index()], true) {
            continue;
        }
        let (mut piece, mut at, mut bounded) = (vec![start], 0, false);
        while at < piece.len() {
            for t in piece[at].halfedges().into_iter().filter_map(|h| cut.twin(h)) {
                bounded |= !removed[t.face()];
                if removed[t.face()] && !std::mem::replace(&mut seen[t.face().index()], true) {
                    piece.push(t.face());
                }
            }
            at += 1;
        }
        if !bounded || piece.iter().any(|&f| cut.triangle(f).iter().any(|p| sharp.contains(p))) {
            for f in piece {
                removed[f] = false;
            }
        }
    }
}

/// A vertex of each piece whose drawn surface has a face at one of the places. Vertices of the mesh keep their
/// positions from round to round.
fn centers_of_failing(pieces: &[CutOut], drawn: &[Drawn], trouble: &Trouble) -> Vec<DVec3> {
    let Trouble::Places { places, .. } = trouble else { return vec![] };
    let fails = |d: &Drawn| d.made.face_ids().any(|f| places.contains(&centroid(d.made.triangle(f))));
    let inner = |p: &CutOut| p.mesh.positions.get(p.rim.len()).copied();
    pieces.iter().zip(drawn).filter(|(_, d)| fails(d)).filter_map(|(p, _)| inner(p)).collect()
}

/// The edges of the curves that are still edges of the result.
fn left_sharp<'a>(
    mesh: &'a Connected<TriMesh>,
    curves: &'a [BlendCurve],
    blended: &Blended,
) -> impl Iterator<Item = HalfedgeId> + 'a {
    let mut stays = vec![false; mesh.vertex_count()];
    for origin in blended.origins.vertices.as_slice() {
        if let VertexOrigin::Input { vertex, .. } = origin {
            stays[vertex.index()] = true;
        }
    }
    let all = curves.iter().flat_map(|c| c.halfedges.iter().copied());
    all.filter(move |&h| stays[mesh.tail(h).index()] && stays[mesh.head(h).index()])
}

fn length_left_sharp(mesh: &Connected<TriMesh>, curves: &[BlendCurve], blended: &Blended) -> f64 {
    left_sharp(mesh, curves, blended).map(|h| mesh.edge_length(h)).sum()
}

/// One place on every curve that is left sharp in part.
fn sharp_places<'a>(
    mesh: &'a Connected<TriMesh>,
    curves: &'a [BlendCurve],
    blended: &'a Blended,
) -> impl Iterator<Item = DVec3> + 'a {
    curves.iter().filter_map(move |c| {
        let h = left_sharp(mesh, std::slice::from_ref(c), blended).next()?;
        let [a, b] = mesh.ends(h);
        Some(a.midpoint(b))
    })
}

/// The mesh with edges near the seam short enough for the ball to be seen on them.
struct Fine {
    mesh: Connected<TriMesh>,
    origins: Origins,
    /// Its faces' sides.
    of: FaceMap<u8>,
    /// Its vertices between both.
    seam: Vec<VertexId>,
}

fn refined(sides: &Sides<'_>, r: f64) -> Result<Fine, Trouble> {
    // On one side, near the seam means near the other. Long edges may lead there from afar.
    let wanted = |p: DVec3| sides.distance(0, p).max(sides.distance(1, p)) - 2.0 * r;
    let failed = |_| Trouble::at("the surface near the seam cannot be refined", vec![]);
    let (fine, origins) = remesh::refine(sides.mesh, &wanted, 0.3 * r).map_err(failed)?;
    let mesh = Connected::new(fine).map_err(Trouble::not_manifold("the mesh is not a manifold"))?;
    let of = sides.of_origins(&origins);
    let seam = between(&mesh, &of);
    Ok(Fine { mesh, origins, of, seam })
}

fn refusal(error: EmbedError) -> Trouble {
    match error {
        EmbedError::Crossings(found) => Trouble::at("linkages cross", found.iter().map(|c| c.place).collect()),
        EmbedError::Apart { place, .. } | EmbedError::TooSmall { place, .. } => {
            Trouble::at("a linkage cannot be cut into the mesh", vec![place])
        }
        EmbedError::Cancelled(c) => Trouble::Cancelled(c),
        other => Trouble::Embed(other),
    }
}

/// The faces between the linkages; each linkage must have them on one side and others on the other.
fn enclosed(sides: &Sides<'_>, cut: &Connected<&TriMesh>, embedded: &Embedded) -> Result<FaceMap<bool>, Trouble> {
    // The seam is at vertices of the input, whose faces keep their side when they are cut.
    let of = sides.of_origins(&embedded.origins);
    let seeds: Vec<FaceId> = between(cut, &of).into_iter().flat_map(|v| cut.ring(v)).map(HalfedgeId::face).collect();
    let walls = embedded.curves.iter().flat_map(|c| curve_edges(c, true));
    let removed = flood(cut, walls, &seeds);
    for [a, b] in embedded.curves.iter().flat_map(|c| curve_edges(c, true)) {
        let faces = cut.halfedge(a, b).map(|h| [Some(h), cut.twin(h)].map(|h| h.map(|h| removed[h.face()])));
        if !matches!(faces, Some([Some(x), Some(y)]) if x != y) {
            return Err(Trouble::at("the linkages do not enclose the blend curve", vec![cut.position(a)]));
        }
    }
    Ok(removed)
}
