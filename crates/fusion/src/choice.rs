//! Which curves of a mesh are blended: by number, by place, by file, by the seams of an earlier boolean, and by filters.

use crate::diagnostic::Diagnostic;
use crate::features::{self, Convexity, FeatureCurve, feature_curves, nearest};
use crate::picks::{self, Picked};
use crate::{Error, blend};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, area_vector, bounds, dihedral_angle,
};
use mesh_query::TriBvh;
use rayon::prelude::*;
use spine::BlendCurve;
use std::collections::{BTreeMap, BTreeSet};

pub use crate::choice_refusal::Refusal;

/// Which curves are blended. Those named by `ids`, `near`, `picked` and `seams` together; all feature curves where none of
/// these is given. Filters then keep those that pass all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// Feature curves by their places in the list of [`feature_curves`] at the same angle.
    pub ids: Vec<usize>,
    /// Points in model units, each naming the feature curve nearest to it.
    pub near: Vec<Near>,
    /// Curves through picked points.
    pub picked: Vec<Picked>,
    /// The part each face of the mesh comes from, as the origins of a boolean tell: the curves between different parts.
    pub seams: Option<Vec<Option<u32>>>,
    /// Whether feature curves that continue a named one are taken, too: of the same convexity, from its end, turning by no
    /// more than [`CHAIN_ANGLE`].
    pub chain: bool,
    /// Only curves longer than this, in model units.
    pub longer: Option<f64>,
    /// Only curves whose every edge is parallel to one of these directions, within [`ALONG_ANGLE`].
    pub along: Vec<DVec3>,
    /// Only curves inside or on this closed solid.
    pub within: Option<TriMesh>,
    /// Only ridges, or only valleys.
    pub convexity: Option<Convexity>,
}

/// A point that names the curve nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// The point, in model units.
    pub at: DVec3,
    /// The radius of that curve, in model units, if it is its own.
    pub radius: Option<f64>,
}

impl From<DVec3> for Near {
    fn from(at: DVec3) -> Self {
        Self { at, radius: None }
    }
}

/// The largest angle between a curve and one that continues it, in degrees.
pub const CHAIN_ANGLE: f64 = 25.0;
/// The largest angle between an edge and a direction that it follows, in degrees.
pub const ALONG_ANGLE: f64 = 5.0;
/// A curve farther from the point that names it than this share of the box's diagonal is worth a warning.
pub const FAR: f64 = 0.01;

/// What a chosen curve was named by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// A feature curve; its number is its id.
    Feature,
    /// A curve of a file, numbered in its order.
    Picked,
    /// A seam of a boolean, numbered from 0.
    Seam,
}

/// One chosen curve.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    pub source: Source,
    pub id: usize,
    pub curve: BlendCurve,
    pub convexity: Convexity,
    /// The radius of this curve alone.
    pub radius: Option<f64>,
}

/// The curves that a choice names, and what is to be told of it.
///
/// # Errors
/// [`Error::Choice`], [`Error::NoCurve`].
pub(crate) fn choose(
    mesh: &Connected<TriMesh>,
    features: &features::Params,
    choice: &Choice,
) -> Result<(Vec<Chosen>, Vec<Diagnostic>), Error> {
    let picked = picks::trace(mesh, &choice.picked)?;
    let seams = choice.seams.as_ref().map_or(Ok(vec![]), |parts| seam_curves(mesh, parts))?;
    let all = feature_curves(mesh, features);
    let others = !picked.is_empty() || !seams.is_empty();
    let named = others || !choice.ids.is_empty() || !choice.near.is_empty();
    if all.is_empty() && (!others || !choice.near.is_empty()) {
        return Err(Refusal::NoEdges { angle: features.angle, sharpest: sharpest(mesh) }.into());
    }
    let mut told = vec![];
    let mut radii: BTreeMap<usize, Option<f64>> = BTreeMap::new();
    for &id in &choice.ids {
        if id >= all.len() {
            return Err(Refusal::NoSuchCurve { id, count: all.len() }.into());
        }
        radii.insert(id, None);
    }
    let far = FAR * bounds(mesh).diagonal();
    for near in &choice.near {
        let curves = all.iter().map(|c| &c.halfedges[..]);
        let Some((id, place, distance)) = nearest(mesh, curves, near.at) else { continue };
        told.push(Diagnostic::curve_taken(near.at, "feature curve", id, place, distance, far));
        let radius = radii.entry(id).or_default();
        *radius = near.radius.or(*radius);
    }
    if !named {
        radii.extend((0..all.len()).map(|id| (id, None)));
    }
    if choice.chain {
        follow_chains(mesh, &all, &mut radii);
    }
    let feature = |(&id, &radius): (&usize, &Option<f64>)| Chosen {
        source: Source::Feature,
        id,
        curve: BlendCurve { halfedges: all[id].halfedges.clone(), closed: all[id].closed },
        convexity: all[id].convexity,
        radius,
    };
    let mut chosen: Vec<Chosen> = radii.iter().map(feature).collect();
    for (source, curves) in [(Source::Picked, picked), (Source::Seam, seams)] {
        for (id, curve) in curves.into_iter().enumerate() {
            let convexity = match curve.convexity(mesh).map_err(blend::Error::from)? {
                spine::Convexity::Convex => Convexity::Convex,
                spine::Convexity::Concave => Convexity::Concave,
            };
            chosen.push(Chosen { source, id, curve, convexity, radius: None });
        }
    }
    let (count, longest) = (chosen.len(), chosen.iter().map(|c| c.curve.length(mesh)).fold(0.0, f64::max));
    filter(mesh, choice, &mut chosen)?;
    if chosen.is_empty() {
        return Err(Refusal::NothingPasses { count, longest }.into());
    }
    Ok((chosen, told))
}

/// Keeps the curves that pass every filter.
fn filter(mesh: &Connected<TriMesh>, choice: &Choice, chosen: &mut Vec<Chosen>) -> Result<(), Error> {
    if let Some(convexity) = choice.convexity {
        chosen.retain(|c| c.convexity == convexity);
    }
    if let Some(length) = choice.longer {
        chosen.retain(|c| c.curve.length(mesh) > length);
    }
    if !choice.along.is_empty() {
        let least = ALONG_ANGLE.to_radians().cos();
        let follows = |direction: &DVec3, h: HalfedgeId| {
            let [a, b] = mesh.ends(h);
            (b - a).normalize_or_zero().dot(direction.normalize_or_zero()).abs() >= least
        };
        chosen.retain(|c| choice.along.iter().any(|d| c.curve.halfedges.iter().all(|&h| follows(d, h))));
    }
    if let Some(solid) = &choice.within {
        let inside = Inside::of(solid)?;
        chosen.retain(|c| {
            let points = c.curve.halfedges.iter().map(|&h| mesh.ends(h));
            points.into_iter().all(|[a, b]| [a, b, a.midpoint(b)].iter().all(|&p| inside.holds(p)))
        });
    }
    Ok(())
}

/// A closed solid that is asked for points.
struct Inside<'a> {
    solid: &'a TriMesh,
    tree: TriBvh,
    /// How near to its surface a point counts as inside.
    margin: f64,
}

impl<'a> Inside<'a> {
    fn of(solid: &'a TriMesh) -> Result<Self, Refusal> {
        let open = |at| Refusal::Open { at };
        let connected = Connected::new(solid).map_err(|e| open(e.place))?;
        if let Some(h) = mesh_core::boundary_loops(&connected).iter().flatten().next() {
            return Err(open(Some(connected.position(connected.tail(*h)))));
        }
        let tree = TriBvh::build(solid).map_err(|_| open(None))?;
        // Rounding of a point computed on the surface.
        let margin = 1e-9 * bounds(solid).diagonal();
        Ok(Self { solid, tree, margin })
    }

    /// Whether a point is inside or on the surface: two of three rays leave through the back of a face.
    fn holds(&self, p: DVec3) -> bool {
        if self.tree.closest_point_within(self.solid, p, self.margin).is_some() {
            return true;
        }
        let rays = [DVec3::new(0.31, 0.52, 0.79), DVec3::new(-0.67, 0.41, 0.62), DVec3::new(0.23, -0.83, -0.51)];
        let leaves = |d: &&DVec3| {
            let hit = self.tree.ray_cast(self.solid, p, **d, f64::INFINITY);
            hit.is_some_and(|hit| area_vector(self.solid.triangle(hit.face)).dot(**d) > 0.0)
        };
        rays.iter().filter(leaves).count() >= 2
    }
}

/// The largest dihedral angle of the mesh, in degrees.
fn sharpest(mesh: &Connected<TriMesh>) -> f64 {
    let all = (0..3 * mesh.face_count()).into_par_iter().map(HalfedgeId::from);
    all.filter_map(|h| dihedral_angle(mesh, h)).map(f64::abs).reduce(|| 0.0, f64::max).to_degrees()
}

/// Adds the feature curves that continue those already chosen, and what continues those; each takes over the radius.
fn follow_chains(mesh: &Connected<TriMesh>, all: &[FeatureCurve], chosen: &mut BTreeMap<usize, Option<f64>>) {
    let ends = |id: usize| {
        let curve = &all[id];
        let (first, last) = (curve.halfedges.first(), curve.halfedges.last());
        let both = first.zip(last).filter(|_| !curve.closed).map(|(&f, &l)| {
            let [[a, b], [c, d]] = [mesh.ends(f), mesh.ends(l)];
            // Each end with the direction in which the curve leaves it inward.
            [(mesh.tail(f), (b - a).normalize_or_zero()), (mesh.head(l), (c - d).normalize_or_zero())]
        });
        both.into_iter().flatten()
    };
    let mut at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    for id in 0..all.len() {
        ends(id).for_each(|(v, _)| at.entry(v).or_default().push(id));
    }
    let least = CHAIN_ANGLE.to_radians().cos();
    let mut waiting: Vec<usize> = chosen.keys().copied().collect();
    while let Some(id) = waiting.pop() {
        let radius = chosen.get(&id).copied().flatten();
        for (vertex, inward) in ends(id) {
            for &next in at.get(&vertex).into_iter().flatten() {
                let continues = ends(next).any(|(v, onward)| v == vertex && onward.dot(-inward) >= least);
                if next != id && all[next].convexity == all[id].convexity && continues && !chosen.contains_key(&next) {
                    chosen.insert(next, radius);
                    waiting.push(next);
                }
            }
        }
    }
}

/// The curves between faces of different parts, in order of their lowest halfedge; they end where not just two of their
/// edges meet. `parts` holds the part of every face, where it has one.
///
/// ```
/// use fusion::mesh_core::{Connected, shapes};
/// let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
/// let seams = fusion::choice::seam_curves(&cube, &[vec![Some(0); 2], vec![Some(1); 10]].concat())?;
/// assert_eq!((seams.len(), seams[0].halfedges.len(), seams[0].closed), (1, 4, true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Refusal`]: as many parts as faces are needed, and one edge between different ones.
pub fn seam_curves(mesh: &Connected<TriMesh>, parts: &[Option<u32>]) -> Result<Vec<BlendCurve>, Error> {
    if parts.len() != mesh.face_count() {
        return Err(Refusal::OriginsOfAnother { faces: mesh.face_count(), entries: parts.len() }.into());
    }
    let between = |h: HalfedgeId| {
        let twin = mesh.twin(h)?;
        let [own, other] = [h, twin].map(|h| parts[h.face().index()]);
        (own? < other?).then_some(h)
    };
    // Each edge once, with the lower part on its left, so that seams run one way round.
    let edges: Vec<HalfedgeId> = mesh.halfedge_ids().filter_map(between).collect();
    let (mut from, mut meeting): (BTreeMap<_, Vec<_>>, BTreeMap<VertexId, u32>) = Default::default();
    for &h in &edges {
        from.entry(mesh.tail(h)).or_default().push(h);
        for v in [mesh.tail(h), mesh.head(h)] {
            *meeting.entry(v).or_default() += 1;
        }
    }
    let mut left: BTreeSet<HalfedgeId> = edges.iter().copied().collect();
    let mut curves = vec![];
    let inner = |v: VertexId| meeting[&v] == 2 && from.get(&v).is_some_and(|f| f.len() == 1);
    let starts = edges.iter().filter(|&&h| !inner(mesh.tail(h))).chain(&edges);
    for &start in starts {
        let mut halfedges = vec![];
        let mut here = Some(start);
        while let Some(h) = here.filter(|h| left.remove(h)) {
            halfedges.push(h);
            here = Some(mesh.head(h)).filter(|&v| inner(v)).map(|v| from[&v][0]);
        }
        if let (Some(&first), Some(&last)) = (halfedges.first(), halfedges.last()) {
            let closed = mesh.tail(first) == mesh.head(last);
            curves.push(BlendCurve { halfedges, closed });
        }
    }
    if curves.is_empty() { Err(Refusal::NoSeams.into()) } else { Ok(curves) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    fn chosen(mesh: &Connected<TriMesh>, choice: &Choice) -> Result<Vec<Chosen>, Error> {
        choose(mesh, &features::Params::default(), choice).map(|c| c.0)
    }

    #[test]
    fn filters_keep_what_passes_all() {
        let cube = Connected::new(shapes::cuboid(DVec3::new(1.0, 2.0, 3.0))).unwrap();
        let count = |choice: Choice| chosen(&cube, &choice).map_or(0, |c| c.len());
        let plain = Choice::default();
        assert_eq!(count(plain.clone()), 12);
        assert_eq!(count(Choice { along: vec![DVec3::X], ..plain.clone() }), 4);
        assert_eq!(count(Choice { longer: Some(1.5), ..plain.clone() }), 8);
        assert_eq!(count(Choice { longer: Some(1.5), along: vec![DVec3::X, DVec3::Y], ..plain.clone() }), 4);
        assert_eq!(count(Choice { convexity: Some(Convexity::Concave), ..plain.clone() }), 0);
        let top = shapes::posed(shapes::cuboid(DVec3::splat(4.0)), glam::DQuat::IDENTITY, DVec3::Z * 3.5);
        assert_eq!(count(Choice { within: Some(top.clone()), ..plain.clone() }), 4);
        let open = TriMesh { faces: top.faces[..10].to_vec(), ..top };
        let refusal = chosen(&cube, &Choice { within: Some(open), ..plain.clone() });
        assert!(matches!(refusal, Err(Error::Choice(Refusal::Open { at: Some(_) }))));
        assert!(matches!(
            chosen(&cube, &Choice { ids: vec![12], ..plain }),
            Err(Error::Choice(Refusal::NoSuchCurve { id: 12, count: 12 }))
        ));
    }

    /// The point that a list prints names its curve, though curves share their ends.
    #[test]
    fn points_within_name_their_curves() {
        let mesh = Connected::new(shapes::bracket(DVec3::new(2.0, 1.0, 1.5), 0.3, [3, 2, 2])).unwrap();
        for (id, curve) in feature_curves(&mesh, &features::Params::default()).iter().enumerate() {
            let near = vec![features::point_within(&mesh, curve).into()];
            let found = chosen(&mesh, &Choice { near, ..Choice::default() }).unwrap();
            assert_eq!(found.iter().map(|c| c.id).collect::<Vec<_>>(), [id]);
        }
    }
}
