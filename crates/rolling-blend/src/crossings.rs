//! Meshes that meet themselves beside a curve, told before anything is built.

use crate::error::Error;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, HalfedgeId, Positions, TriMesh, Watch, centroid};
use spine::BlendCurve;

/// A place where a face beside one of the `curves` meets another face that it should not meet, if there is one. Faces without area
/// are none of these. A look at every face, and time for those beside the curves.
pub(crate) fn beside(mesh: &Connected<TriMesh>, curves: &[BlendCurve], watch: &Watch) -> Result<Option<DVec3>, Error> {
    let halfedges = curves.iter().flat_map(|c| &c.halfedges);
    let faces: Vec<FaceId> = halfedges.flat_map(|&h| [Some(h), mesh.twin(h)]).flatten().map(HalfedgeId::face).collect();
    let met = match tri_intersect::self_intersections_among(mesh, &faces, watch) {
        Ok(met) => met,
        Err(tri_intersect::Error::Cancelled(c)) => return Err(c.into()),
        // What cannot be looked at is told by what comes next.
        Err(_) => vec![],
    };
    Ok(met.iter().find(|[a, b]| a != b).map(|&[a, _]| centroid(mesh.triangle(a))))
}

#[cfg(test)]
mod tests {
    use super::super::{Error, Params, blend};
    use crate::features::{self, feature_curves};
    use glam::DVec3;
    use mesh_core::{Connected, Watch, shapes};

    /// A cube and a smaller one at one of its edges or far from all, in one mesh.
    fn with_another(at: DVec3) -> Result<usize, Error> {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        let mut other = shapes::cuboid(DVec3::splat(0.3));
        other.positions.iter_mut().for_each(|p| *p += at);
        mesh.append(&other);
        let mesh = Connected::new(mesh).unwrap();
        let all = feature_curves(&mesh, &features::Params::default());
        let first = all.into_iter().find(|c| c.vertices(&mesh).iter().all(|v| v.index() < 8)).unwrap();
        blend(&mesh, &[first.into()], &Params::new(0.05), &Watch::default()).map(|b| b.strips)
    }

    #[test]
    fn a_mesh_that_meets_itself_is_told_from_a_radius_that_does_not_fit() {
        assert!(matches!(with_another(DVec3::splat(3.0)), Ok(1)));
        let all = [0.5, -0.5];
        let edges = all.iter().flat_map(|&x| all.iter().map(move |&y| [x, y]));
        let refusals = edges.flat_map(|[x, y]| [[x, y, 0.1], [x, 0.1, y], [0.1, x, y]]).map(|p| with_another(p.into()));
        let told =
            |r: &Result<usize, Error>| matches!(r, Err(Error::MeetsItself { at }) if at.abs().max_element() > 0.1);
        assert_eq!(refusals.filter(told).count(), 1, "the edge that the other one cuts");
    }
}
