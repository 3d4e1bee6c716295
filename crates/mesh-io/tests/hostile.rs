//! Broken input never panics and never allocates by what it claims: random changes and cuts to valid files.

use glam::DVec3;
use mesh_core::{Faces, shapes};
use mesh_io::{Format, Groups, Material, Materials, Model, read_stream, to_bytes};
use proptest::prelude::*;
use std::sync::OnceLock;

/// A valid file of every format, with all attributes it can hold.
fn samples() -> &'static [(Format, Vec<u8>)] {
    static SAMPLES: OnceLock<Vec<(Format, Vec<u8>)>> = OnceLock::new();
    SAMPLES.get_or_init(|| {
        let mesh = shapes::cuboid(DVec3::new(1.0, 0.3, 2.5));
        let faces = mesh.face_count();
        let uvs: Vec<_> = (0..3 * faces).map(|c| [(c % 4) as f64 / 3.0, 0.1]).collect();
        let colors: Vec<_> = mesh.faces.iter().flatten().map(|v| [v.index() as f64 / 255.0, 0.0, 1.0, 1.0]).collect();
        let labels: Vec<u32> = (0..faces as u32).map(|f| f / 6).collect();
        let model = Model {
            uvs: Some(uvs.into()),
            normals: Some(vec![DVec3::Z; 3 * faces].into()),
            colors: Some(colors.into()),
            groups: Some(Groups { of_face: labels.clone().into(), names: vec!["one".into(), "two".into()] }),
            materials: Some(Materials { of_face: labels.into(), list: vec![Material::default(), Material { name: "m".into(), ..Material::default() }] }),
            ..mesh.into()
        };
        let mut samples: Vec<_> = Format::ALL.into_iter().map(|f| (f, to_bytes(&model, f).unwrap())).collect();
        let quad = b"v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 9\ng x\nf 1/-1 2 3 4 5 \\\n 1\nvt 0 1\nusemtl y\nl 1 2\n";
        samples.push((Format::Obj, quad.to_vec()));
        samples.push((Format::Stl, b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e-3 0\nendloop\nendfacet\nendsolid x\n".to_vec()));
        samples.push((Format::Off, b"STCN4OFF\n4 1 0\n0 0 0 1 0 0 1 1 0 0 1 0 0\n1 0 0 1 0 0 1 1 0 0 1 0 0\n1 1 0 1 0 0 1 1 0 0 1 0 0\n0 1 0 2 0 0 1 1 0 0 1 0 0\n4 0 1 2 3 255 0 0\n".to_vec()));
        samples.push((Format::Ply, b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n4 0 1 2 -1\n".to_vec()));
        samples
    })
}

/// Reading must return; a model that comes out must be writable or refused, not panic.
fn survive(bytes: &[u8], format: Format) {
    if let Ok(model) = read_stream(bytes, format) {
        assert!(model.mesh.faces.iter().flatten().all(|v| v.index() < model.mesh.vertex_count()));
        assert!(model.mesh.positions.iter().all(|p| p.is_finite()));
        for format in Format::ALL {
            let _ = to_bytes(&model, format);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn mutations(sample in 0..11usize, edits in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![any::<u8>(), Just(b'9'), Just(b' '), Just(b'-'), Just(0xff)]), 1..6)) {
        let (format, mut bytes) = samples()[sample].clone();
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        survive(&bytes, format);
    }

    #[test]
    fn splices(sample in 0..11usize, from: prop::sample::Index, to: prop::sample::Index, length in 0..60usize) {
        let (format, mut bytes) = samples()[sample].clone();
        let from = from.index(bytes.len());
        let piece = bytes[from..(from + length).min(bytes.len())].to_vec();
        let to = to.index(bytes.len());
        bytes.splice(to..to, piece);
        survive(&bytes, format);
    }

    #[test]
    fn noise(format in 0..7usize, bytes: Vec<u8>) {
        survive(&bytes, Format::ALL[format]);
    }
}

#[test]
fn every_cut() {
    for (format, bytes) in samples() {
        for end in 0..bytes.len() {
            survive(&bytes[..end], *format);
        }
    }
}

#[test]
fn every_single_byte_of_binary_headers() {
    for (format, bytes) in samples() {
        for at in 0..bytes.len().min(400) {
            for byte in [0, 0x7f, 0xff] {
                let mut changed = bytes.clone();
                changed[at] = byte;
                survive(&changed, *format);
            }
        }
    }
}

/// Found by fuzzing: an attribute of which one number is infinite was written as a word that no reader takes.
#[test]
fn attributes_that_are_not_finite_are_none() {
    const MARK: f64 = 0.34375;
    let mesh = shapes::cuboid(DVec3::ONE);
    let corners = 3 * mesh.face_count();
    let model = Model {
        uvs: Some(vec![[MARK, 0.5]; corners].into()),
        normals: Some(vec![DVec3::new(0.0, MARK, 1.0); corners].into()),
        colors: Some(vec![[1.0, 1.0, MARK, 1.0]; corners].into()),
        ..mesh.into()
    };
    let mut glb = to_bytes(&model, Format::Glb).unwrap();
    let mark = (MARK as f32).to_le_bytes();
    let places: Vec<usize> = (0..glb.len() - 4).filter(|&i| glb[i..i + 4] == mark).collect();
    assert!(!places.is_empty());
    for at in places {
        glb[at..at + 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    }
    let read = read_stream(&glb, Format::Glb).unwrap();
    assert!(read.colors.iter().flat_map(mesh_core::IdMap::as_slice).flatten().all(|x| x.is_nan()));
    for format in Format::ALL {
        let again = read_stream(&to_bytes(&read, format).unwrap(), format).unwrap();
        assert_eq!(again.mesh.face_count(), 12, "{format}");
    }
}

/// Found by fuzzing: vertices in two elements, of which one alone has attributes, left fewer attributes than vertices.
#[test]
fn vertices_in_two_elements_share_what_attributes_they_have() {
    let plain = "property float x\nproperty float y\nproperty float z\n";
    let rich = &format!(
        "{plain}property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    );
    let (rows, rich_row) = ("0 0 0\n1 0 0\n", "0 1 0 0 0 1 0.5 0.25 255 0 0\n");
    for [first, second, bodies] in
        [[("2", plain), ("1", rich.as_str()), (rows, rich_row)], [("1", rich.as_str()), ("2", plain), (rich_row, rows)]]
    {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{}element vertex {}\n{}element face 1\nproperty list uchar int vertex_indices\nend_header\n{}{}3 0 1 2\n",
            first.0, first.1, second.0, second.1, bodies.0, bodies.1
        );
        let model = read_stream(text.as_bytes(), Format::Ply).unwrap();
        let there = |known: &[bool]| known.iter().filter(|&&k| k).count();
        let normals: Vec<bool> = model.normals.unwrap().as_slice().iter().map(|n| *n == DVec3::Z).collect();
        let uvs: Vec<bool> = model.uvs.unwrap().as_slice().iter().map(|uv| *uv == [0.5, 0.25]).collect();
        let colors: Vec<bool> = model.colors.unwrap().as_slice().iter().map(|c| *c == [1.0, 0.0, 0.0, 1.0]).collect();
        assert_eq!([there(&normals), there(&uvs), there(&colors)], [1; 3]);
        let rich_corner = usize::from(first.1 == plain) * 2;
        assert!(normals[rich_corner] && uvs[rich_corner] && colors[rich_corner]);
    }
}
