//! What is written reads back: bit for bit where the format allows.

use glam::DVec3;
use mesh_core::{CornerMap, FaceMap, Faces, TriMesh, VertexId, shapes};
use mesh_io::{
    Format, Groups, Material, Materials, Model, Polygons, Texture, TextureSource, Unit, as_written, read, read_stream,
    to_bytes, weld_exact, weld_within, write,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn bits(model: &Model) -> Vec<[u64; 3]> {
    model.mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

fn through(model: &Model, format: Format) -> Model {
    read_stream(&to_bytes(model, format).unwrap(), format).unwrap()
}

/// Any finite coordinates, and faces with three different corners.
fn any_mesh() -> impl Strategy<Value = TriMesh> {
    let coordinate =
        prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -1e3..1e3, (-99i32..99).prop_map(f64::from)];
    let positions = prop::collection::vec(prop::array::uniform3(coordinate), 3..40);
    (positions, prop::collection::vec(any::<[u16; 3]>(), 0..60)).prop_map(|(positions, faces)| {
        let n = positions.len() as u32;
        let distinct = |c: [u16; 3]| {
            let a = u32::from(c[0]) % n;
            let b = (a + 1 + u32::from(c[1]) % (n - 1)) % n;
            let rest: Vec<u32> = (0..n).filter(|&v| v != a && v != b).collect();
            [a, b, rest[c[2] as usize % rest.len()]]
        };
        TriMesh::from_arrays(positions.into_iter().map(DVec3::from_array).collect(), faces.into_iter().map(distinct))
    })
}

/// A mesh in f32 numbers with no two vertices alike, all of them used: what STL and glTF give back whole.
fn single_mesh() -> impl Strategy<Value = TriMesh> {
    (prop::collection::btree_set(any::<[i16; 3]>(), 3..40), prop::collection::vec(any::<[u16; 2]>(), 0..60)).prop_map(
        |(places, more)| {
            let positions: Vec<DVec3> =
                places.iter().map(|p| DVec3::from_array(p.map(|x| f64::from(x) / 64.0))).collect();
            let n = positions.len() as u32;
            let fan = (0..n - 2).map(|i| [i, i + 1, i + 2]);
            let more = more.into_iter().map(|[a, b]| {
                let a = u32::from(a) % (n - 2);
                [a + 1, a, a + 2 + u32::from(b) % (n - a - 2)]
            });
            TriMesh::from_arrays(positions, fan.chain(more).collect::<Vec<_>>())
        },
    )
}

proptest! {
    #[test]
    fn lossless_formats_keep_every_bit(mesh in any_mesh()) {
        let model = Model::from(mesh);
        for format in [Format::Obj, Format::Ply, Format::Off, Format::ThreeMf] {
            let back = through(&model, format);
            prop_assert_eq!(bits(&back), bits(&model), "{}", format);
            prop_assert_eq!(&back.mesh.faces, &model.mesh.faces, "{}", format);
            prop_assert_eq!(as_written(&model, format), None);
        }
    }

    #[test]
    fn float_formats_keep_every_float(mesh in single_mesh()) {
        let model = Model::from(mesh);
        for format in [Format::Stl, Format::Glb, Format::Gltf] {
            let back = through(&model, format);
            prop_assert_eq!(as_written(&model, format).unwrap(), model.mesh.clone());
            prop_assert_eq!(back.mesh, model.mesh.clone(), "{}", format);
        }
    }

    #[test]
    fn corner_attributes_survive(mesh in single_mesh(), seed: u32) {
        let corners = 3 * mesh.face_count();
        let share = |i: usize| f64::from((i as u32).wrapping_mul(2_654_435_761).wrapping_add(seed) >> 30) / 4.0;
        let uvs: CornerMap<[f64; 2]> = (0..corners).map(|i| [share(i), share(i + 7)]).collect::<Vec<_>>().into();
        let normals: CornerMap<DVec3> = (0..corners).map(|i| [DVec3::X, -DVec3::Y][usize::from(share(i) > 0.5)]).collect::<Vec<_>>().into();
        let groups: FaceMap<u32> = (0..mesh.face_count()).map(|f| u32::from(share(f) > 0.4)).collect::<Vec<_>>().into();
        let groups = Groups { of_face: groups, names: vec!["a b".into(), "<é&\">".into()] };
        let material = |name: &str, r| Material { name: name.into(), base_color: [r, 0.2, 1.0, 0.4], ..Material::default() };
        let materials = Materials {
            of_face: (0..mesh.face_count()).map(|f| u32::from(share(f + 3) > 0.4)).collect::<Vec<_>>().into(),
            list: vec![material("m 1", 0.0), material("m&2", 1.0)],
        };
        let model = Model { uvs: Some(uvs), normals: Some(normals), groups: Some(groups), materials: Some(materials), ..mesh.into() };
        let face_key = |m: &Model, f: usize| {
            let g = m.groups.as_ref().unwrap();
            let s = m.materials.as_ref().unwrap();
            let look = &s.list[s.of_face.as_slice()[f] as usize];
            (g.names[g.of_face.as_slice()[f] as usize].clone(), look.name.clone())
        };
        let obj = through(&model, Format::Obj);
        prop_assert_eq!((&obj.mesh, &obj.uvs, &obj.normals), (&model.mesh, &model.uvs, &model.normals));
        for f in 0..model.mesh.face_count() {
            prop_assert_eq!(face_key(&obj, f), face_key(&model, f));
        }
        let ply = through(&model, Format::Ply);
        prop_assert_eq!((&ply.mesh, &ply.uvs), (&model.mesh, &model.uvs));
        // glTF sorts faces by material and group: compare as sets of faces with all they carry.
        let everything = |m: &Model| -> BTreeSet<String> {
            let corner = |c: usize| (m.uvs.as_ref().unwrap().as_slice()[c], m.normals.as_ref().unwrap().as_slice()[c]);
            (0..m.mesh.face_count())
                .map(|f| format!("{:?} {:?} {:?}", m.mesh.triangle(mesh_core::FaceId(f as u32)), [0, 1, 2].map(|k| corner(3 * f + k)), face_key(m, f)))
                .collect()
        };
        for format in [Format::Glb, Format::Gltf] {
            let back = through(&model, format);
            prop_assert_eq!(&back.mesh.positions, &model.mesh.positions);
            prop_assert_eq!(everything(&back), everything(&model));
            prop_assert_eq!(back.materials.unwrap().list[0].base_color[3], 0.4);
        }
    }

    #[test]
    fn colors_survive_where_they_fit(mesh in single_mesh(), by_vertex: bool) {
        let color = |i: usize| [(i % 256) as f64 / 255.0, (i / 256) as f64 / 255.0, 1.0, 1.0];
        let colors: Vec<[f64; 4]> = mesh.faces.iter().enumerate()
            .flat_map(|(f, c)| c.map(|v| color(if by_vertex { v.index() } else { f })))
            .collect();
        let model = Model { colors: Some(colors.into()), ..mesh.into() };
        let formats: &[Format] =
            if by_vertex { &[Format::Obj, Format::Ply, Format::Off, Format::ThreeMf] } else { &[Format::Ply, Format::Off, Format::ThreeMf] };
        for &format in formats {
            prop_assert_eq!(through(&model, format).colors, model.colors.clone(), "{}", format);
        }
        let rounded = |m: &Model| m.colors.clone().unwrap().into_vec().into_iter().map(|c| c.map(|x| x as f32)).collect::<Vec<_>>();
        prop_assert_eq!(rounded(&through(&model, Format::Glb)), rounded(&model));
    }

    /// Against the definition: the first vertex at the same place.
    #[test]
    fn welding_merges_equal_places(places in prop::collection::vec(prop::array::uniform3(-2i32..2), 0..60), flip: u64) {
        let signed = |i: usize, x: i32| if x == 0 && flip >> (i % 64) & 1 == 1 { -0.0 } else { f64::from(x) };
        let positions: Vec<DVec3> = places.iter().enumerate().map(|(i, p)| DVec3::from_array(p.map(|x| signed(i, x)))).collect();
        let faces = (2..positions.len() as u32).map(|i| [i - 2, i - 1, i]);
        let mut model = Model::from(TriMesh::from_arrays(positions.clone(), faces.clone().collect::<Vec<_>>()));
        let welded = weld_exact(&mut model);
        let unique: BTreeSet<_> = places.iter().collect();
        prop_assert_eq!(model.mesh.vertex_count(), unique.len());
        prop_assert_eq!(welded.merged, places.len() - unique.len());
        for (v, p) in positions.iter().enumerate() {
            prop_assert_eq!(model.mesh.positions[welded.vertex_of[VertexId(v as u32)].index()], *p);
        }
        let kept = faces.filter(|c| { let [a, b, c] = c.map(|v| places[v as usize]); a != b && b != c && c != a }).count();
        prop_assert_eq!(model.mesh.face_count(), kept);
    }

    /// Against the quadratic definition: the first kept vertex within reach.
    #[test]
    fn welding_within_a_tolerance(places in prop::collection::vec(prop::array::uniform3(-2.0..2.0), 0..60), tolerance in 0.01..1.0) {
        let positions: Vec<DVec3> = places.into_iter().map(DVec3::from_array).collect();
        let mut model = Model::from(TriMesh::from_arrays(positions.clone(), []));
        let welded = weld_within(&mut model, tolerance);
        let mut kept: Vec<DVec3> = vec![];
        for (v, p) in positions.iter().enumerate() {
            let near = kept.iter().position(|q| q.distance(*p) <= tolerance);
            let expected = near.unwrap_or(kept.len());
            if near.is_none() {
                kept.push(*p);
            }
            prop_assert_eq!(welded.vertex_of[VertexId(v as u32)].index(), expected);
        }
        prop_assert_eq!(model.mesh.positions, kept);
    }
}

#[test]
fn polygons_survive() {
    let mut quads = through(
        &read_stream(
            b"v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nf 1 2 3 4 5 6\nf 1 2 7\nf 1 6 5 7\n",
            Format::Obj,
        )
        .unwrap(),
        Format::Obj,
    );
    assert_eq!(quads.mesh.face_count(), 7);
    for format in [Format::Obj, Format::Off] {
        let back = through(&quads, format);
        assert_eq!((&back.mesh, &back.polygons), (&quads.mesh, &quads.polygons), "{format}");
    }
    let even =
        read_stream(b"OFF 6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 1\n0 0 1\n4 0 1 2 3\n4 1 0 5 4", Format::Off).unwrap();
    assert_eq!(even.polygons.as_ref().unwrap().len(), 2);
    assert_eq!(through(&even, Format::Ply).polygons, even.polygons);
    assert_eq!(through(&quads, Format::Ply).mesh, quads.mesh);
    // Polygons that no longer describe the mesh are not written.
    quads.mesh.faces.swap(0, 6);
    assert_eq!(through(&quads, Format::Obj).mesh, quads.mesh);
    quads.polygons = Some(Polygons::default());
    assert_eq!(through(&quads, Format::Off).mesh, quads.mesh);
}

#[test]
fn as_written_shows_what_rounding_folds() {
    let mut mesh = shapes::cuboid(DVec3::ONE);
    let v = mesh.positions.len();
    mesh.positions.push(mesh.positions[0] + DVec3::splat(1e-12));
    mesh.faces[0][0] = VertexId::from(v);
    let model = Model::from(mesh);
    assert_eq!(as_written(&model, Format::Stl).unwrap().vertex_count(), 8);
    assert_eq!(as_written(&model, Format::Glb).unwrap().vertex_count(), 9);
    let huge = Model::from(TriMesh::from_arrays(vec![DVec3::splat(1e39)], []));
    let error = to_bytes(&huge, Format::Glb).unwrap_err().to_string();
    assert!(error.contains("vertex 0 at 1e39, 1e39, 1e39") && error.contains("obj, ply or off"), "{error}");
    let mut broken = Model::from(shapes::cuboid(DVec3::ONE));
    broken.mesh.faces[3][1] = VertexId(99);
    assert!(to_bytes(&broken, Format::Off).is_err());
}

/// A vertex between faces of two colours has their mean; faces without colour do not take that of their neighbours.
#[test]
fn colours_that_vary_at_a_vertex_are_averaged() {
    let mesh = shapes::cuboid(DVec3::ONE);
    let (red, blue, none) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [f64::NAN; 4]);
    // Corner by corner, so that no face is of one colour; vertex 0 has both, vertex 1 red or nothing.
    let of = |c: usize, v: VertexId| match v.0 {
        0 => [red, blue][c % 2],
        1 => [red, none][c % 2],
        _ => blue,
    };
    let colors: Vec<_> = mesh.faces.iter().flatten().enumerate().map(|(c, &v)| of(c, v)).collect();
    let own: Vec<_> = mesh.faces.iter().flatten().zip(&colors).filter(|(v, _)| v.0 == 0).map(|(_, c)| *c).collect();
    let mean = own.iter().map(|c| c[0]).sum::<f64>() / own.len() as f64;
    assert!(mean > 0.0 && mean < 1.0);
    let model = Model { colors: Some(colors.into()), ..Model::from(mesh) };
    for (format, tolerance) in [(Format::Obj, 1e-12), (Format::Ply, 0.5 / 255.0)] {
        let back = through(&model, format);
        for (&v, color) in back.mesh.faces.iter().flatten().zip(back.colors.unwrap().as_slice()) {
            let wanted = [mean, 1.0, 0.0][v.index().min(2)];
            assert!(
                (color[0] - wanted).abs() <= tolerance && (color[2] - (1.0 - wanted)).abs() <= tolerance,
                "{format}"
            );
        }
    }
}

/// No file names a material with nothing.
#[test]
fn materials_have_names() {
    let mesh = shapes::cuboid(DVec3::ONE);
    let list = vec![Material { name: "m".into(), ..Material::default() }, Material::default()];
    for of_face in [vec![0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1], vec![1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0]] {
        let leads = of_face[0] == 1;
        let materials = Materials { of_face: of_face.into(), list: list.clone() };
        let model = Model { materials: Some(materials), ..Model::from(mesh.clone()) };
        let text = String::from_utf8(to_bytes(&model, Format::Obj).unwrap()).unwrap();
        assert!(text.lines().all(|line| line.trim() != "usemtl"), "{text}");
        let names = |format| through(&model, format).materials.unwrap().list.into_iter().map(|m| m.name);
        // At the start of an OBJ file faces need no material.
        assert_eq!(names(Format::Obj).any(|name| name.is_empty()), leads);
        assert!(names(Format::ThreeMf).all(|name| !name.is_empty()));
        assert!(!String::from_utf8_lossy(&to_bytes(&model, Format::Glb).unwrap()).contains("\"name\":\"\""));
    }
}

/// A model in inches stays one.
#[test]
fn units_survive_3mf() {
    let model = Model { unit: Some(Unit::Inch), ..Model::from(shapes::cuboid(DVec3::ONE)) };
    let back = through(&model, Format::ThreeMf);
    assert_eq!((back.unit, bits(&back)), (Some(Unit::Inch), bits(&model)));
    assert_eq!(through(&Model { unit: None, ..model }, Format::ThreeMf).unit, Some(Unit::Millimeter));
}

fn textured() -> Model {
    let mesh = shapes::cuboid(DVec3::ONE);
    let (corners, faces) = (3 * mesh.face_count(), mesh.face_count());
    let texture =
        Texture { name: "wood grain.png".into(), source: TextureSource::Embedded(b"\x89PNG...".as_slice().into()) };
    let material = Material { name: "wood".into(), texture: Some(texture), ..Material::default() };
    let uvs = (0..corners).map(|c| [(c % 3) as f64 / 2.0, 0.25]).collect::<Vec<_>>();
    Model {
        uvs: Some(uvs.into()),
        materials: Some(Materials { of_face: FaceMap::filled(faces, 0), list: vec![material] }),
        ..mesh.into()
    }
}

fn listing(folder: &std::path::Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    names.collect::<BTreeSet<_>>().into_iter().collect()
}

#[test]
fn side_files_go_beside() {
    let folder = tempfile::tempdir().unwrap();
    let model = textured();
    for (name, files) in [
        ("box.obj", vec!["box_wood grain.png", "box.mtl", "box.obj"]),
        ("box.gltf", vec!["box_wood grain.png", "box.bin", "box.gltf"]),
        ("box.glb", vec!["box.glb"]),
    ] {
        let written = write(&model, &folder.path().join(name)).unwrap();
        let names: Vec<_> = written.files.iter().map(|f| f.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, files);
        assert_eq!(written.bytes, written.files.iter().map(|f| f.metadata().unwrap().len()).sum::<u64>());
        let back = read(&folder.path().join(name)).unwrap();
        assert_eq!((&back.mesh, &back.uvs), (&model.mesh, &model.uvs));
        let texture = back.materials.unwrap().list.remove(0).texture.unwrap();
        let bytes = match texture.source {
            TextureSource::File(path) => std::fs::read(path).unwrap(),
            TextureSource::Embedded(bytes) => bytes.to_vec(),
            TextureSource::Missing => vec![],
        };
        assert_eq!(bytes, b"\x89PNG...");
    }
    assert_eq!(listing(folder.path()), ["box.bin", "box.glb", "box.gltf", "box.mtl", "box.obj", "box_wood grain.png"]);
    // Read from disk and written elsewhere, the picture goes along.
    let elsewhere = tempfile::tempdir().unwrap();
    let copy = read(&folder.path().join("box.obj")).unwrap();
    write(&copy, &elsewhere.path().join("new.obj")).unwrap();
    assert_eq!(listing(elsewhere.path()), ["new.mtl", "new.obj", "new_box_wood grain.png"]);
    // Over itself, it stays as it is.
    write(&copy, &folder.path().join("box.obj")).unwrap();
    assert_eq!(listing(folder.path()).len(), 6);
}

#[test]
fn failures_leave_everything_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    std::fs::write(&path, "old").unwrap();
    std::fs::write(folder.path().join("a.mtl"), "old library").unwrap();
    let mut broken = textured();
    broken.mesh.positions[0].x = f64::NAN;
    assert!(write(&broken, &path).is_err());
    // A side file that cannot be put in place.
    std::fs::create_dir(folder.path().join("a_wood grain.png")).unwrap();
    assert!(write(&textured(), &path).unwrap_err().to_string().contains("a_wood grain.png"));
    assert_eq!(listing(folder.path()), ["a.mtl", "a.obj", "a_wood grain.png"]);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(std::fs::read_to_string(folder.path().join("a.mtl")).unwrap(), "old library");
    assert!(write(&textured(), &folder.path().join("none/a.obj")).is_err());
    assert!(write(&textured(), &folder.path().join("a.xyz")).unwrap_err().to_string().contains("a.xyz"));
}

/// Two writes give the same bytes, whatever the number of threads.
#[test]
fn bytes_do_not_depend_on_threads() {
    let model = textured();
    for format in Format::ALL {
        let of = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| to_bytes(&model, format).unwrap())
        };
        assert_eq!(of(1), of(3), "{format}");
    }
}
