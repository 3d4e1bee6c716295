//! What is written is read by readers that share no code with this crate, and means the same to them.

use glam::{DVec2, DVec3, Vec3};
use mesh_core::{CornerMap, FaceId, Faces, HalfedgeId, Positions, TriMesh, shapes};
use mesh_io::{Format, Model, to_bytes};
use proptest::prelude::*;

fn bits(p: [f64; 3]) -> [u64; 3] {
    p.map(f64::to_bits)
}

/// The corners of every face in order, as bits: what remains when a reader numbers vertices its own way.
fn corners(mesh: &TriMesh) -> Vec<[u64; 3]> {
    mesh.face_ids().flat_map(|f| mesh.triangle(f)).map(|p| bits(p.to_array())).collect()
}

/// The three numbers at `index`.
fn triple(flat: &[f64], index: u32) -> [f64; 3] {
    let i = 3 * index as usize;
    [flat[i], flat[i + 1], flat[i + 2]]
}

fn read_by_tobj(model: &Model) -> Vec<tobj::Mesh> {
    let bytes = to_bytes(model, Format::Obj).unwrap();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &tobj::LoadOptions::default(), no_materials).unwrap();
    models.into_iter().map(|m| m.mesh).collect()
}

fn corners_by_tobj(meshes: &[tobj::Mesh]) -> Vec<[u64; 3]> {
    assert!(meshes.iter().all(|m| m.face_arities.is_empty()), "only triangles");
    meshes.iter().flat_map(|m| m.indices.iter().map(|&i| bits(triple(&m.positions, i)))).collect()
}

/// Any finite coordinates, down to subnormals, and faces with three different corners.
fn any_mesh() -> impl Strategy<Value = TriMesh> {
    let coordinate = prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -1e3..1e3];
    let positions = prop::collection::vec(prop::array::uniform3(coordinate), 3..30);
    (positions, prop::collection::vec(any::<u16>(), 1..40)).prop_map(|(positions, starts)| {
        let n = positions.len() as u32;
        let faces = starts.into_iter().map(|a| [0, 1, 2].map(|k| (u32::from(a) + k) % n));
        TriMesh::from_arrays(positions.into_iter().map(DVec3::from_array).collect(), faces.collect::<Vec<_>>())
    })
}

proptest! {
    #[test]
    fn tobj_reads_every_bit_of_our_obj(mesh in any_mesh()) {
        let model = Model::from(mesh);
        prop_assert_eq!(corners_by_tobj(&read_by_tobj(&model)), corners(&model.mesh));
    }
}

#[test]
fn tobj_reads_texture_coordinates_and_normals_of_our_obj() {
    let mut model = Model::from(shapes::icosphere(1.0, 2));
    let mesh = &model.mesh;
    let of_corner = |h: usize| mesh.triangle(FaceId::from(h / 3))[h % 3];
    let n = 3 * mesh.face_count();
    // A seam at every edge, so that no numbering can be right by chance.
    let uvs: Vec<[f64; 2]> = (0..n).map(|h| [h as f64 / 7.0, 1.0 / (1.0 + h as f64)]).collect();
    let normals: Vec<DVec3> = (0..n).map(|h| of_corner(h).normalize()).collect();
    model.uvs = Some(CornerMap::from(uvs.clone()));
    model.normals = Some(CornerMap::from(normals.clone()));
    let read = read_by_tobj(&model);
    assert_eq!(corners_by_tobj(&read), corners(&model.mesh));
    let read_uvs = read.iter().flat_map(|m| {
        m.texcoord_indices.iter().map(|&i| [m.texcoords[2 * i as usize], m.texcoords[2 * i as usize + 1]])
    });
    assert_eq!(read_uvs.collect::<Vec<_>>(), uvs);
    let read_normals =
        read.iter().flat_map(|m| m.normal_indices.iter().map(|&i| DVec3::from_array(triple(&m.normals, i))));
    assert_eq!(read_normals.collect::<Vec<_>>(), normals);
}

/// The only primitive of a file.
struct Primitive {
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
    uvs: Option<Vec<[f32; 2]>>,
}

fn read_by_gltf(model: &Model) -> Primitive {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&to_bytes(model, Format::Glb).unwrap()).unwrap();
    let blob = blob.expect("a GLB holds its buffer");
    let primitives: Vec<_> = document.meshes().flat_map(|m| m.primitives().collect::<Vec<_>>()).collect();
    let [primitive] = &primitives[..] else { panic!("{} primitives", primitives.len()) };
    assert_eq!(primitive.mode(), gltf::mesh::Mode::Triangles);
    let reader = primitive.reader(|_| Some(&blob));
    let positions: Vec<_> = reader.read_positions().unwrap().collect();
    // The format demands the exact box.
    let bounds = primitive.bounding_box();
    let fold = |f: fn(Vec3, Vec3) -> Vec3| positions.iter().map(|&p| Vec3::from(p)).reduce(f).unwrap().to_array();
    assert_eq!((bounds.min, bounds.max), (fold(Vec3::min), fold(Vec3::max)));
    let uvs = reader.read_tex_coords(0).map(|uvs| uvs.into_f32().collect());
    Primitive { indices: reader.read_indices().unwrap().into_u32().collect(), positions, uvs }
}

#[test]
fn gltf_reads_the_positions_and_indices_of_our_glb() {
    for mesh in [shapes::cuboid(DVec3::new(0.1, 2.0, 3e7)), shapes::icosphere(1.0 / 3.0, 3), shapes::teapot(4).body] {
        let Primitive { positions, indices, .. } = read_by_gltf(&Model::from(mesh.clone()));
        let expected: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.as_vec3().to_array()).collect();
        assert_eq!(positions, expected);
        assert_eq!(indices, mesh.faces.iter().flatten().map(|v| v.0).collect::<Vec<_>>());
    }
}

/// Vertices are split where texture coordinates part; the corners stay the same.
#[test]
fn gltf_reads_the_texture_coordinates_of_our_glb() {
    let mut model = Model::from(shapes::cuboid(DVec3::ONE));
    let uvs: Vec<[f64; 2]> = (0..36).map(|h| [f64::from(h % 5) / 4.0, f64::from(h % 7) / 8.0]).collect();
    model.uvs = Some(CornerMap::from(uvs.clone()));
    let Primitive { positions, indices, uvs: read } = read_by_gltf(&model);
    let read = read.expect("texture coordinates are written");
    assert_eq!(indices.len(), 36);
    for (h, &i) in indices.iter().enumerate() {
        let corner = model.mesh.corners(FaceId::from(h / 3))[HalfedgeId::from(h).corner()];
        assert_eq!(Vec3::from(positions[i as usize]).as_dvec3(), model.mesh.position(corner));
        // The format's origin is the upper left.
        let [u, v] = read[i as usize];
        assert_eq!(DVec2::new(f64::from(u), 1.0 - f64::from(v)), DVec2::from(uvs[h]));
    }
}
