//! Carries texture coordinates, normals, colours, groups and materials from the inputs of a job to its result.

use crate::spread::spread;
use glam::{DVec3, DVec4};
use mesh_core::{CornerMap, FaceId, FaceMap, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexOrigin};
use mesh_io::{Groups, Material, Materials, Model};

/// What the surface of a composition is called in origins and groups.
pub(crate) const TRANSITION: &str = "transition";

/// What the material of faces is called whose part has none.
const UNNAMED: &str = "unnamed";

/// `mesh` with the attributes that its origins lead to. O(n).
///
/// Corners of whole faces keep their values; corners of pieces get the parent face's values interpolated at their
/// place. New faces have no texture coordinates and normals (NaN), the colours around them, blended into each other, and a group and
/// a plain material named after the stage that made them. An attribute that no input has stays away. The unit is the first that an
/// input names.
pub fn carry(inputs: &[Model], mesh: TriMesh, origins: &Origins) -> Model {
    let corners = Corners { inputs, mesh: &mesh, origins };
    let uvs = inputs
        .iter()
        .any(|m| m.uvs.is_some())
        .then(|| corners.map(|m, h| m.uvs.as_ref().map(|a| DVec4::new(a[h][0], a[h][1], 0.0, 0.0)), |v| [v.x, v.y]));
    let normals = inputs
        .iter()
        .any(|m| m.normals.is_some())
        .then(|| corners.map(|m, h| m.normals.as_ref().map(|a| a[h].extend(0.0)), DVec4::truncate));
    let colors = inputs
        .iter()
        .any(|m| m.colors.is_some())
        .then(|| {
            corners.map(|m, h| m.colors.as_ref().map(|a| a[h].into()), |v| v.to_array().map(|x| x.clamp(0.0, 1.0)))
        })
        .map(|mut colors| {
            spread(&mesh, &mut colors, |f| matches!(origins.faces[f], FaceOrigin::New { .. }));
            colors
        });
    let groups = inputs.iter().any(|m| m.groups.is_some()).then(|| {
        let (of_face, names) = labels(origins, String::new(), |origin| match origin {
            Ok((part, face)) => inputs.get(part)?.groups.as_ref().map(|g| g.names[g.of_face[face] as usize].clone()),
            Err(stage) => Some(stage.to_string()),
        });
        Groups { of_face, names }
    });
    let materials = inputs.iter().any(|m| m.materials.is_some()).then(|| {
        let plain = |name: &str| Material { name: name.into(), ..Material::default() };
        let (of_face, list) = labels(origins, plain(UNNAMED), |origin| match origin {
            Ok((part, face)) => inputs.get(part)?.materials.as_ref().map(|m| m.list[m.of_face[face] as usize].clone()),
            Err(stage) => Some(plain(stage)),
        });
        Materials { of_face, list }
    });
    let unit = inputs.iter().find_map(|m| m.unit);
    Model { uvs, normals, colors, groups, materials, unit, mesh, ..Model::default() }
}

struct Corners<'a> {
    inputs: &'a [Model],
    mesh: &'a TriMesh,
    origins: &'a Origins,
}

impl Corners<'_> {
    /// One value per corner of the result: `get` reads an input's corner, `set` narrows the blended value.
    fn map<T>(&self, get: impl Fn(&Model, HalfedgeId) -> Option<DVec4>, set: impl Fn(DVec4) -> T) -> CornerMap<T> {
        let value = |f: FaceId, k: usize| {
            let (part, face) = parent(self.origins.faces[f]).ok()?;
            let model = self.inputs.get(part)?;
            let values = [0, 1, 2].map(|k| get(model, HalfedgeId::new(face, k)));
            let [Some(a), Some(b), Some(c)] = values else { return None };
            let [u, v, w] = self.place(f, k, model, part, face);
            // A weight of zero must not spread a neighbour's missing value.
            Some([(u, a), (v, b), (w, c)].iter().filter(|t| t.0 != 0.0).map(|&(t, x)| t * x).sum::<DVec4>())
        };
        let corners = self.mesh.face_ids().flat_map(|f| (0..3).map(move |k| (f, k)));
        corners.map(|(f, k)| set(value(f, k).unwrap_or(DVec4::NAN))).collect::<Vec<_>>().into()
    }

    /// Barycentric coordinates of a corner in its parent face; exact at the parent's own corners.
    fn place(&self, f: FaceId, k: usize, model: &Model, part: usize, face: FaceId) -> [f64; 3] {
        let v = self.mesh.corners(f)[k];
        if let VertexOrigin::Input { part: p, vertex } = self.origins.vertices[v]
            && p as usize == part
            && let Some(corner) = model.mesh.corners(face).iter().position(|&c| c == vertex)
        {
            return [0, 1, 2].map(|i| f64::from(u8::from(i == corner)));
        }
        let (at, corners) = (self.mesh.positions[v.index()], model.mesh.triangle(face));
        // A vertex that was merged into another one at its place.
        if let Some(corner) = corners.iter().position(|&p| p == at) {
            return [0, 1, 2].map(|i| f64::from(u8::from(i == corner)));
        }
        let weights = barycentric(at, corners);
        let clamped = weights.map(|t| t.clamp(0.0, 1.0));
        let sum: f64 = clamped.iter().sum();
        if sum > 0.0 { clamped.map(|t| t / sum) } else { [1.0, 0.0, 0.0] }
    }
}

/// The face's parent as part and face, or the stage that made it.
fn parent(origin: FaceOrigin) -> Result<(usize, FaceId), &'static str> {
    match origin {
        FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face } => Ok((part as usize, face)),
        FaceOrigin::New { stage } => Err(stage),
    }
}

/// Numbers the labels of all faces in order of first appearance. `missing` stands for faces without one.
fn labels<T: PartialEq>(
    origins: &Origins,
    missing: T,
    label: impl Fn(Result<(usize, FaceId), &'static str>) -> Option<T>,
) -> (FaceMap<u32>, Vec<T>) {
    let mut list: Vec<Option<T>> = vec![];
    let mut of_face = vec![];
    let mut last = 0;
    for &origin in origins.faces.as_slice() {
        let this = label(parent(origin));
        // Neighbouring faces mostly share their label, so the search is rare.
        if list.get(last) != Some(&this) {
            last = list.iter().position(|l| *l == this).unwrap_or(list.len());
            if last == list.len() {
                list.push(this);
            }
        }
        of_face.push(last as u32);
    }
    let mut missing = Some(missing);
    (of_face.into(), list.into_iter().filter_map(|l| l.or_else(|| missing.take())).collect())
}

/// Barycentric coordinates of a point in the plane of a triangle; the first corner where the triangle is flat.
fn barycentric(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    let v = (p - a).cross(c - a).dot(normal) / area;
    let w = (b - a).cross(p - a).dot(normal) / area;
    if v.is_finite() && w.is_finite() { [1.0 - v - w, v, w] } else { [1.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{VertexId, centroid, shapes};

    /// A box whose texture coordinates are a linear function of place, so that interpolation has one right answer.
    fn painted() -> Model {
        let mesh = shapes::cuboid(DVec3::ONE);
        let uvs: Vec<_> = mesh.faces.iter().flatten().map(|v| uv(mesh.positions[v.index()])).collect();
        let groups = Groups { of_face: vec![0; 12].into(), names: vec!["box".into()] };
        Model { uvs: Some(uvs.into()), groups: Some(groups), ..Model::from(mesh) }
    }

    fn uv(p: DVec3) -> [f64; 2] {
        [1.0 + p.x + 2.0 * p.y - p.z, p.x - p.y + 3.0 * p.z]
    }

    #[test]
    fn an_untouched_mesh_keeps_its_attributes_bit_for_bit() {
        let model = painted();
        let carried = carry(std::slice::from_ref(&model), model.mesh.clone(), &Origins::identity(0, 8, 12));
        assert_eq!((carried.uvs, carried.groups), (model.uvs, model.groups));
        assert!(carried.normals.is_none() && carried.colors.is_none() && carried.materials.is_none());
    }

    #[test]
    fn a_split_face_interpolates_and_a_new_face_is_named() {
        let model = painted();
        let mut mesh = model.mesh.clone();
        let mut origins = Origins::identity(0, 8, 12);
        // Face 0 gets a point in its middle; the last of its three pieces is made new.
        let middle = centroid(mesh.triangle(FaceId(0)));
        mesh.positions.push(middle);
        origins.vertices.push(VertexOrigin::Face { part: 0, face: FaceId(0), barycentric: [1.0 / 3.0; 3] });
        let [a, b, c] = mesh.faces[0];
        mesh.faces[0] = [a, b, VertexId(8)];
        mesh.faces.extend([[b, c, VertexId(8)], [c, a, VertexId(8)]]);
        origins.faces[FaceId(0)] = FaceOrigin::Piece { part: 0, face: FaceId(0) };
        origins.faces.push(FaceOrigin::Piece { part: 0, face: FaceId(0) });
        origins.faces.push(FaceOrigin::New { stage: "blend" });
        let carried = carry(&[model], mesh.clone(), &origins);
        let uvs = carried.uvs.unwrap();
        for f in mesh.face_ids().take(13) {
            for k in 0..3 {
                let (is, should) = (uvs[HalfedgeId::new(f, k)], uv(mesh.triangle(f)[k]));
                assert!((is[0] - should[0]).abs() + (is[1] - should[1]).abs() < 1e-12);
            }
        }
        assert!(uvs[HalfedgeId::new(FaceId(13), 0)][0].is_nan());
        let groups = carried.groups.unwrap();
        assert_eq!((groups.names, groups.of_face[FaceId(13)]), (vec!["box".to_string(), "blend".to_string()], 1));
    }

    #[test]
    fn parts_without_an_attribute_do_not_disturb_those_with_it() {
        let (painted, plain) = (painted(), Model::from(shapes::icosphere(1.0, 0)));
        let origins = Origins {
            vertices: vec![VertexOrigin::Input { part: 0, vertex: VertexId(0) }; 3].into(),
            faces: vec![FaceOrigin::Input { part: 1, face: FaceId(2) }].into(),
        };
        let carried = carry(&[painted, plain], TriMesh::from_arrays(vec![DVec3::ZERO; 3], [[0, 1, 2]]), &origins);
        assert!(carried.uvs.unwrap()[HalfedgeId(0)][0].is_nan());
        assert_eq!(carried.groups.unwrap().names, [""]);
    }

    /// Between a red part and a blue one the transition's colours run from one to the other.
    #[test]
    fn a_transition_blends_the_colours_of_its_parts() {
        let mesh = shapes::open_cylinder(1.0, 3.0, 16, 12);
        let mut model = Model::from(mesh.clone());
        let middle = |f: FaceId| mesh.triangle(f).iter().sum::<DVec3>().z / 3.0;
        let (low, high) = mesh.face_ids().map(middle).fold((f64::MAX, f64::MIN), |(a, b), z| (a.min(z), b.max(z)));
        let share = |z: f64| (z - low) / (high - low);
        let color = |f: FaceId| if share(middle(f)) < 0.5 { [1.0, 0.0, 0.0, 1.0] } else { [0.0, 0.0, 1.0, 1.0] };
        model.colors = Some(mesh.face_ids().flat_map(|f| [color(f); 3]).collect::<Vec<_>>().into());
        let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
        for f in mesh.face_ids().filter(|&f| (0.3..0.7).contains(&share(middle(f)))) {
            origins.faces[f] = FaceOrigin::New { stage: TRANSITION };
        }
        let colors = carry(&[model], mesh.clone(), &origins).colors.unwrap();
        for f in mesh.face_ids().filter(|&f| origins.faces[f] == FaceOrigin::New { stage: TRANSITION }) {
            let [red, green, blue, alpha] = colors[HalfedgeId::new(f, 0)];
            assert!((red + blue - 1.0).abs() < 1e-12 && green == 0.0 && (alpha - 1.0).abs() < 1e-12);
            assert!((blue - share(middle(f))).abs() < 0.45, "{blue} {}", share(middle(f)));
            let (above, below) = (share(middle(f)) > 0.6, share(middle(f)) < 0.4);
            assert!(if above { blue > 0.5 } else { !below || red > 0.5 });
        }
    }
}
