//! Regions of a surface by what their faces have in common.

use crate::Error;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, FaceMap, Faces, TriMesh};
use mesh_io::Model;
use mesh_query::TriBvh;

/// Some faces of a model.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// The faces within `radius` of the surface point nearest to `center` that hang together with it.
    Near {
        /// A point, in model units.
        center: DVec3,
        /// How far the region reaches, in model units, through space.
        radius: f64,
    },
    /// The faces of a named group.
    Group(String),
    /// The faces that a stage made. Formats with groups carry the stage's name as a group.
    Origin(String),
    /// These faces.
    Faces(Vec<FaceId>),
}

impl Region {
    /// One flag per face of the model.
    ///
    /// # Errors
    /// [`Error::Region`] for a region without faces, or with faces that are not there.
    pub fn select(&self, model: &Model, mesh: &Connected<TriMesh>) -> Result<FaceMap<bool>, Error> {
        let count = mesh.face_count();
        let mut inside = FaceMap::filled(count, false);
        match self {
            Self::Near { center, radius } => flood(mesh, *center, *radius, &mut inside),
            Self::Group(name) | Self::Origin(name) => {
                let groups = model.groups.as_ref();
                let Some(id) = groups.and_then(|g| g.names.iter().position(|n| n == name)) else {
                    let known = groups.map_or(String::from("it has no groups"), |g| format!("it has {:?}", g.names));
                    return Err(Error::Region(format!("the mesh has no faces of {name:?}: {known}")));
                };
                for f in mesh.face_ids() {
                    inside[f] = groups.is_some_and(|g| g.of_face[f] as usize == id);
                }
            }
            Self::Faces(faces) => {
                for &f in faces {
                    if f.index() >= count {
                        return Err(Error::Region(format!("the region names face {f}, but there are only {count}")));
                    }
                    inside[f] = true;
                }
            }
        }
        if inside.as_slice().contains(&true) {
            return Ok(inside);
        }
        Err(Error::Region("the region holds no face; give it a larger radius, or another place".into()))
    }
}

fn flood(mesh: &Connected<TriMesh>, center: DVec3, radius: f64, inside: &mut FaceMap<bool>) {
    let nearest = TriBvh::build(mesh).ok().and_then(|tree| tree.closest_point(mesh, center));
    let Some(start) = nearest else { return };
    let within = |f: FaceId| mesh.mesh().triangle(f).iter().all(|p| p.distance(start.point) <= radius);
    let mut stack = vec![start.face];
    while let Some(f) = stack.pop() {
        if inside[f] || !within(f) {
            continue;
        }
        inside[f] = true;
        stack.extend(mesh.neighbours(f));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{Bounds, shapes};
    use mesh_io::Groups;

    #[test]
    fn a_region_near_a_point_is_the_cap_around_it() {
        let model = Model::from(shapes::icosphere(1.0, 4));
        let mesh = Connected::new(model.mesh.clone()).unwrap();
        let cap = Region::Near { center: DVec3::Z * 2.0, radius: 0.5 }.select(&model, &mesh).unwrap();
        let corners = mesh.face_ids().filter(|&f| cap[f]).flat_map(|f| model.mesh.triangle(f));
        let (bounds, area) = corners.fold((Bounds::EMPTY, 0), |(b, n), p| (b.union(Bounds { min: p, max: p }), n + 1));
        assert!(bounds.min.z > 0.87 && bounds.max.z > 0.99 && area > 300, "{bounds:?} {area}");
        assert!(Region::Near { center: DVec3::Z, radius: 1e-6 }.select(&model, &mesh).is_err());
    }

    #[test]
    fn groups_are_found_by_name_and_faces_by_number() {
        let mut model = Model::from(shapes::cuboid(DVec3::ONE));
        let of_face: Vec<u32> = (0..12).map(|f| f / 4).collect();
        model.groups = Some(Groups { of_face: of_face.into(), names: ["a", "b", "blend"].map(String::from).into() });
        let mesh = Connected::new(model.mesh.clone()).unwrap();
        let b = Region::Group("b".into()).select(&model, &mesh).unwrap();
        assert_eq!(mesh.face_ids().filter(|&f| b[f]).collect::<Vec<_>>(), [4, 5, 6, 7].map(FaceId));
        assert!(Region::Origin("blend".into()).select(&model, &mesh).unwrap()[FaceId(11)]);
        let missing = Region::Group("c".into()).select(&model, &mesh).unwrap_err().to_string();
        assert!(missing.contains("\"blend\""), "{missing}");
        assert!(Region::Faces(vec![FaceId(12)]).select(&model, &mesh).is_err());
    }
}
