//! glTF scenes and 3MF packages, built inline.

use glam::DVec3;
use mesh_core::Faces;
use mesh_io::{Format, Model, read, read_stream};
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

fn base64(bytes: &[u8]) -> String {
    // Bit by bit, unlike the reader.
    let bits: Vec<u8> = bytes.iter().flat_map(|b| (0..8).rev().map(move |i| b >> i & 1)).collect();
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digit =
        |six: &[u8]| char::from(digits[six.iter().chain([0; 6].iter()).take(6).fold(0, |d, b| 2 * d + *b as usize)]);
    let text: String = bits.chunks(6).map(digit).collect();
    format!("{text}{}", "=".repeat((4 - text.len() % 4) % 4))
}

/// A document with the points of the unit square as accessor 0 and the given indices as accessor 1.
fn document(indices: &[u16], mode: u32, rest: &str) -> String {
    let mut bytes: Vec<u8> = [[0f32, 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]]
        .iter()
        .flatten()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    let (length, n) = (bytes.len(), indices.len());
    format!(
        r#"{{"asset": {{"version": "2.0"}},
        "buffers": [{{"byteLength": {length}, "uri": "data:application/octet-stream;base64,{}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": {}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
                      {{"bufferView": 1, "componentType": 5123, "count": {n}, "type": "SCALAR"}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "mode": {mode}}}]}}],
        {rest}}}"#,
        base64(&bytes),
        2 * n,
    )
}

const ONE_NODE: &str = r#""nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0"#;

fn gltf(text: &str) -> Result<Model, String> {
    read_stream(text.as_bytes(), Format::Gltf).map_err(|error| error.to_string())
}

fn faces(model: &Model) -> Vec<[u32; 3]> {
    model.mesh.faces.iter().map(|c| c.map(|v| v.0)).collect()
}

#[test]
fn lists_strips_and_fans() {
    let of_mode = |indices: &[u16], mode| faces(&gltf(&document(indices, mode, ONE_NODE)).unwrap());
    assert_eq!(of_mode(&[0, 1, 2, 2, 1, 3], 4), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(of_mode(&[0, 1, 2, 3], 5), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(of_mode(&[0, 1, 3, 2], 6), [[0, 1, 3], [0, 3, 2]]);
    assert!(of_mode(&[0, 1], 1).is_empty());
    assert!(gltf(&document(&[0, 1, 4], 4, ONE_NODE)).unwrap_err().contains("accessors[1]: index 2 is 4, beyond 4"));
}

#[test]
fn nodes_place_and_mirror() {
    let text = document(
        &[0, 1, 2],
        4,
        r#""nodes": [{"children": [1, 2], "translation": [10, 0, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]},
                     {"mesh": 0, "scale": [2, 1, 1]}, {"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]}],
           "scenes": [{"nodes": [0]}]"#,
    );
    let model = gltf(&text).unwrap();
    // A quarter turn about z takes x to y and y to −x. Unused vertices stay.
    let expected = [
        [10., 0., 0.],
        [10., 2., 0.],
        [9., 0., 0.],
        [9., 2., 0.],
        [10., 0., 5.],
        [10., -1., 5.],
        [9., 0., 5.],
        [9., -1., 5.],
    ];
    for (p, q) in model.mesh.positions.iter().zip(expected) {
        assert!(p.distance(q.into()) < 1e-14, "{p} {q:?}");
    }
    assert_eq!(faces(&model), [[0, 1, 2], [4, 6, 5]]);
}

#[test]
fn sparse_and_quantized_values() {
    // Vertex 3 moved to (7, 8, 9): indices at byte 0 (value 3), values at 4.
    let extra: Vec<u8> = [3u32]
        .iter()
        .flat_map(|i| i.to_le_bytes())
        .chain([7f32, 8., 9.].iter().flat_map(|x| x.to_le_bytes()))
        .collect();
    let text = document(&[0, 1, 3], 4, ONE_NODE)
        .replace(
            r#""buffers": ["#,
            &format!(r#""buffers": [{{"byteLength": 16, "uri": "data:;base64,{}"}},"#, base64(&extra)),
        )
        .replace(r#""buffer": 0"#, r#""buffer": 1"#)
        .replace(r#""bufferViews": ["#, r#""bufferViews": [{"buffer": 0, "byteLength": 16},"#)
        .replace(r#""bufferView": 1"#, r#""bufferView": 2"#)
        .replace(r#""bufferView": 0"#, r#""bufferView": 1"#)
        .replace(
            r#""count": 4,"#,
            r#""count": 4, "sparse": {"count": 1, "indices": {"bufferView": 0, "componentType": 5125},
               "values": {"bufferView": 0, "byteOffset": 4}},"#,
        );
    let model = gltf(&text).unwrap();
    assert_eq!(model.mesh.positions[3], DVec3::new(7., 8., 9.));
    // The same bytes read as normalized shorts: 1.0f32 is 0x3f80_0000, whose upper half is 16256.
    let text = document(&[0, 1, 2], 4, ONE_NODE)
        .replace(r#""componentType": 5126, "count": 4"#, r#""componentType": 5122, "normalized": true, "count": 4"#);
    // Elements 0, 1 and 3 are then all zero and weld.
    assert_eq!(gltf(&text).unwrap().mesh.positions, [DVec3::ZERO, DVec3::new(0., 16256. / 32767., 0.)]);
}

#[test]
fn hostile_documents_are_refused() {
    for (rest, reason) in [
        (r#""nodes": [{"children": [1]}, {"children": [0], "mesh": 0}], "scenes": [{"nodes": [0]}]"#, "reached twice"),
        (r#""nodes": [{"mesh": 0}, {"children": [0, 0]}], "scenes": [{"nodes": [1]}]"#, "reached twice"),
        (r#""nodes": [{"mesh": 5}], "scenes": [{"nodes": [0]}]"#, "meshes: there is no item 5"),
        (r#""nodes": [{"children": [99]}], "scenes": [{"nodes": [0]}]"#, "node 99 does not exist"),
        (r#""nodes": [{"mesh": 0, "scale": [1e308, 1e308, 1e308], "translation": [1e308, 0, 0]}]"#, "not finite"),
        (r#""nodes": [{"mesh": "0"}]"#, "nodes[0].mesh: a whole number"),
    ] {
        let error = gltf(&document(&[0, 1, 2], 4, rest)).unwrap_err();
        assert!(error.contains(reason), "{rest}: {error}");
    }
    let plain = document(&[0, 1, 2], 4, ONE_NODE);
    for (from, to, reason) in [
        (r#""byteOffset": 48"#, r#""byteOffset": 4800"#, "of a buffer that has 54"),
        (r#""count": 4"#, r#""count": 4000000000"#, "do not fit a view"),
        (
            r#""bufferView": 0, "componentType": 5126, "count": 4"#,
            r#""componentType": 5126, "count": 4000000000"#,
            "more elements than",
        ),
        (r#""version": "2.0""#, r#""version": "1.0""#, "version"),
        (r#""asset""#, r#""extensionsRequired": ["KHR_draco_mesh_compression"], "asset""#, "decompress"),
        ("\"nodes\"", "nodes", "line 7: not valid JSON"),
    ] {
        let error = gltf(&plain.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(reason), "{to}: {error}");
    }
}

#[test]
fn references_stay_in_the_folder() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("inside");
    std::fs::create_dir_all(folder.join("sub dir")).unwrap();
    let bytes: Vec<u8> =
        [0f32, 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
    let bytes = [bytes, [0u16, 1, 2].iter().flat_map(|i| i.to_le_bytes()).collect()].concat();
    std::fs::write(folder.join("sub dir/a.bin"), &bytes).unwrap();
    std::fs::write(home.path().join("outside.bin"), &bytes).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../outside.bin", folder.join("link.bin")).unwrap();
    let plain = document(&[0, 1, 2], 4, ONE_NODE);
    let start = plain.find("data:").unwrap();
    let end = start + plain[start..].find('"').unwrap();
    let with = |uri: &str| {
        let path = folder.join("scene.gltf");
        std::fs::write(&path, format!("{}{uri}{}", &plain[..start], &plain[end..])).unwrap();
        read(&path).map_err(|error| error.to_string())
    };
    assert_eq!(with("sub%20dir/a.bin").unwrap().mesh.face_count(), 1);
    let absolute = home.path().join("outside.bin");
    for uri in [
        "../outside.bin",
        "sub dir/../../outside.bin",
        "..%2foutside.bin",
        "..\\\\outside.bin",
        absolute.to_str().unwrap(),
        "file:///etc/passwd",
        "https://example.org/a.bin",
        "link.bin",
    ] {
        let error = with(uri).unwrap_err();
        assert!(error.contains("leaves the file's folder"), "{uri}: {error}");
    }
    assert!(with("none.bin").unwrap_err().contains("the file is missing"));
}

fn package(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(vec![]));
    for (name, text) in parts {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn threemf(parts: &[(&str, &str)]) -> Result<Model, String> {
    read_stream(&package(parts), Format::ThreeMf).map_err(|error| error.to_string())
}

const TRIANGLE: &str =
    r#"<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="0.1" z="0"/></vertices>"#;

fn model_xml(resources: &str, build: &str) -> String {
    format!(
        r#"<?xml version="1.0"?><model unit="inch" xmlns:m="m" xmlns:p="p"><resources>{resources}</resources><build>{build}</build></model>"#
    )
}

#[test]
fn packages_place_components_and_colors() {
    let resources = format!(
        r##"<basematerials id="5"><base name="red &amp; hot" displaycolor="#FF0000"/><base name="b" displaycolor="#0000FF80"/></basematerials>
        <m:colorgroup id="6"><m:color color="#FF000000"/><m:color color="#00FF00"/></m:colorgroup>
        <object id="1" name="tri" pid="5" pindex="1">{TRIANGLE}<triangles><triangle v1="0" v2="1" v3="2"/>
        <triangle v1="0" v2="2" v3="1" p1="0"/><triangle v1="0" v2="1" v3="2" pid="6" p1="0" p2="1" p3="1"/></triangles></mesh></object>
        <object id="2"><components><component objectid="1"/><component objectid="9" p:path="/3D/other.model"
        transform="-1 0 0 0 1 0 0 0 1 5 6 7"/></components></object>"##
    );
    let root = model_xml(&resources, r#"<item objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 0"/>"#);
    let other = model_xml(
        &format!(r#"<object id="9">{TRIANGLE}<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>"#),
        "",
    );
    let rels = r#"<Relationships><Relationship Target="/3D/odd.model" Type="http://x/3dmodel"/></Relationships>"#;
    let model = threemf(&[("_rels/.rels", rels), ("3D/other.model", &other), ("3D/odd.model", &root)]).unwrap();
    assert_eq!(faces(&model), [[0, 1, 2], [0, 2, 1], [0, 1, 2], [3, 5, 4]]);
    assert_eq!(model.mesh.positions[2], DVec3::new(100., 0.1, 0.));
    assert_eq!(model.mesh.positions[4], DVec3::new(104., 6., 7.));
    let materials = model.materials.unwrap();
    let name = |f: usize| materials.list[materials.of_face.as_slice()[f] as usize].name.as_str();
    assert_eq!([0, 1, 2, 3].map(name), ["b", "red & hot", "", ""]);
    let colors = model.colors.unwrap();
    assert_eq!(colors.as_slice()[6..9], [[1., 0., 0., 0.], [0., 1., 0., 1.], [0., 1., 0., 1.]]);
    assert_eq!(model.groups.unwrap().names, ["tri", ""]);
    assert_eq!(model.unit, Some(mesh_io::Unit::Inch));
}

#[test]
fn hostile_packages_are_refused() {
    let object = |id: u32, parts: &str| format!(r#"<object id="{id}"><components>{parts}</components></object>"#);
    let looped = object(1, r#"<component objectid="1"/>"#);
    // Thirty levels of two: a billion visits if followed.
    let mut laughs = String::from(r#"<object id="0"/>"#);
    for i in 1..=30 {
        let twice = format!(r#"<component objectid="{}"/>"#, i - 1).repeat(2);
        let _ = write!(laughs, "{}", object(i, &twice));
    }
    let bad =
        format!(r#"<object id="1">{TRIANGLE}<triangles><triangle v1="0" v2="1" v3="3"/></triangles></mesh></object>"#);
    for (resources, item, reason) in [
        (&looped, 1, "in a loop"),
        (&laughs, 30, "in a loop"),
        (&looped, 3, "object 3 is built but not there"),
        (&bad, 1, "line 1: a triangle names vertex 3 of 3"),
    ] {
        let text = model_xml(resources, &format!(r#"<item objectid="{item}"/>"#));
        let error = threemf(&[("3D/3dmodel.model", &text)]).unwrap_err();
        assert!(error.contains(reason), "{error}");
    }
    let mut bomb = zip::ZipWriter::new(Cursor::new(vec![]));
    bomb.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    for _ in 0..80 {
        bomb.write_all(&vec![b' '; 1 << 20]).unwrap();
    }
    let bomb = bomb.finish().unwrap().into_inner();
    assert!(bomb.len() < 1 << 18);
    assert!(read_stream(&bomb, Format::ThreeMf).unwrap_err().to_string().contains("zip bomb"));
    assert!(threemf(&[("a.txt", "")]).unwrap_err().contains("holds no model"));
    assert!(read_stream(b"hello", Format::ThreeMf).unwrap_err().to_string().contains("not a 3MF file"));
}
