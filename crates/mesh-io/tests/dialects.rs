//! Every dialect of the text and binary formats, on inline files.

use glam::DVec3;
use mesh_core::{FaceId, Faces, HalfedgeId, VertexId};
use mesh_io::{Error, Format, Model, read_stream};
use std::fmt::Write as _;

fn read(text: &str, format: Format) -> Model {
    read_stream(text.as_bytes(), format).unwrap()
}

fn refuse(text: impl AsRef<[u8]>, format: Format) -> String {
    match read_stream(text.as_ref(), format) {
        Err(error @ Error::Malformed { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

fn faces(model: &Model) -> Vec<[u32; 3]> {
    model.mesh.faces.iter().map(|c| c.map(|v| v.0)).collect()
}

fn notes(model: &Model) -> Vec<String> {
    model.notes.iter().map(ToString::to_string).collect()
}

mod obj {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn quads_stay_polygons() {
        let model = read(&format!("{SQUARE}f 1 2 3 4\nf 1 2 3\n"), Format::Obj);
        assert_eq!(model.mesh.face_count(), 3);
        let polygons = model.polygons.unwrap();
        assert_eq!(polygons.corners(0), [0, 1, 2, 3].map(VertexId));
        assert_eq!(polygons.of_face.as_slice(), [0, 0, 1]);
    }

    #[test]
    fn line_ends_and_joins_do_not_matter() {
        let plain = read(&format!("{SQUARE}f 1 2 3\nf 1 3 4"), Format::Obj);
        for text in [
            format!("{SQUARE}f 1 2 3\nf 1 3 4\n").replace('\n', "\r\n"),
            format!("{SQUARE}f 1 2 3\nf 1 3 4\n").replace('\n', "\r"),
            format!("\u{feff}{SQUARE}\n\n  f 1\t2 \\\n 3\nf 1 \\\r\n 3 4 # comment \\\n#"),
            format!("{SQUARE}f -4 -3 -2#\nf -4 -2 -1"),
            "v 0 0 0\nf 1 2 3\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 3 4".into(),
        ] {
            assert_eq!(read(&text, Format::Obj).mesh, plain.mesh, "{text:?}");
        }
    }

    #[test]
    fn corners_name_attributes() {
        let text =
            format!("{SQUARE}vt 0 0.25\nvt 1 0.5 0\nvn 0 0 1\nf 1/1 2/2 3/-1\nf 1//1 3//-1 4//1\nf 1/2/1 3 4/1/1\n");
        let model = read(&text, Format::Obj);
        let (uvs, normals) = (model.uvs.unwrap(), model.normals.unwrap());
        let corner = |f, k| HalfedgeId::new(FaceId(f), k);
        assert_eq!([0, 1, 2].map(|k| uvs[corner(0, k)]), [[0.0, 0.25], [1.0, 0.5], [1.0, 0.5]]);
        assert!(uvs[corner(1, 0)][0].is_nan() && normals[corner(0, 0)].is_nan());
        assert_eq!(normals[corner(1, 1)], DVec3::Z);
        assert!(uvs[corner(2, 1)][0].is_nan() && normals[corner(2, 1)].is_nan());
        assert_eq!(uvs[corner(2, 2)], [0.0, 0.25]);
    }

    #[test]
    fn vertex_colors_and_weights() {
        let model = read("v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n", Format::Obj);
        let colors = model.colors.unwrap();
        assert_eq!(colors.as_slice()[0], [1.0, 0.5, 0.0, 1.0]);
        assert!(colors.as_slice()[2][0].is_nan());
        let bytes = read("v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 51\nf 1 2 3\n", Format::Obj);
        assert_eq!(bytes.colors.unwrap().as_slice()[2], [0.0, 0.0, 0.2, 1.0]);
        let weighted = read("v 0 0 0 1\nv 1 0 0 2\nv 0 1 0 1\nf 1 2 3\n", Format::Obj);
        assert_eq!(
            (notes(&weighted), weighted.colors),
            (vec!["vertex weights not kept: 1 (first at line 2)".into()], None)
        );
    }

    #[test]
    fn groups_and_materials() {
        let text =
            format!("{SQUARE}f 1 2 3\no all\ng left side\nusemtl red\nf 1 2 4\ng none\ng\nusemtl blue\nf 1 3 4\n");
        let model = read(&text, Format::Obj);
        let (groups, materials) = (model.groups.unwrap(), model.materials.unwrap());
        assert_eq!(
            (groups.names, groups.of_face.as_slice()),
            (vec![String::new(), "left side".into()], &[0, 1, 0][..])
        );
        let names: Vec<_> = materials.list.iter().map(|m| m.name.as_str()).collect();
        assert_eq!((names, materials.of_face.as_slice()), (vec!["", "red", "blue"], &[0, 1, 2][..]));
    }

    #[test]
    fn what_is_no_mesh_is_noted() {
        let model = read(&format!("{SQUARE}l 1 2\nl 2 3\np 1\ns off\ncurv 0 1 1 2\nwhat\nf 1 1 2\n"), Format::Obj);
        assert_eq!(
            notes(&model),
            [
                "lines not kept: 2 (first at line 5)",
                "points not kept: 1 (first at line 7)",
                "smoothing groups not kept: 1 (first at line 8)",
                "free-form statements passed over: 1 (first at line 9)",
                "lines that are not OBJ passed over: 1 (first at line 10)",
                "degenerate faces dropped: 1",
            ]
        );
        assert_eq!((model.mesh.vertex_count(), model.mesh.face_count()), (4, 0));
        assert_eq!(read("", Format::Obj).mesh.vertex_count(), 0);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, line, reason) in [
            (format!("{SQUARE}f 1 2 5\n"), 5, "a vertex that is not among the file's 4"),
            (format!("{SQUARE}\nf 1 2 -5\n"), 6, "not among"),
            (format!("{SQUARE}f 1 0 2\n"), 5, "counts from 1"),
            (format!("{SQUARE}f 1 2x 3\n"), 5, "\"2x\""),
            (format!("{SQUARE}f 1 2/1/1/1 3\n"), 5, "\"2/1/1/1\""),
            ("v 0 0\n".into(), 1, "a coordinate is missing"),
            ("\n\nv 0 1e400 0".into(), 3, "not a finite number"),
            ("v 0 inf 0".into(), 1, "not a finite number"),
            ("v 0 0x1 0".into(), 1, "not a number"),
        ] {
            let message = refuse(&text, Format::Obj);
            assert!(message.contains(&format!("line {line}: ")) && message.contains(reason), "{text:?}: {message}");
        }
        assert!(refuse("<html>\n", Format::Obj).contains("not an OBJ file"));
    }

    /// Chunk borders must not show: a file of several chunks, whose indices count backwards across them.
    #[test]
    fn many_chunks_read_as_one() {
        let (mut relative, mut absolute) = (String::new(), String::new());
        for i in 0..40_000u32 {
            for text in [&mut relative, &mut absolute] {
                let _ = write!(text, "v {i} {} 0.5\nvt 0.{i} 1\n", i * i % 97);
            }
            if i >= 2 {
                relative.push_str("f -1/-1 -2/-2 \\\n -3/-3\n");
                let _ = writeln!(absolute, "f {0}/{0} {1}/{1} {2}/{2}", i + 1, i, i - 1);
            }
        }
        let (relative, absolute) = (read(&relative, Format::Obj), read(&absolute, Format::Obj));
        assert_eq!(relative.mesh.face_count(), 39_998);
        assert_eq!((relative.mesh, relative.uvs), (absolute.mesh, absolute.uvs));
    }
}

mod off {
    use super::*;

    #[test]
    fn dialects_agree() {
        let plain = read("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", Format::Off).mesh;
        for text in [
            "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
            "OFF 3 1 0\n# comment\n0 0 0\n\n1 0 0 # here\n0 1 0\n3  0 1 2",
            "OFF\r\n3 1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
            "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n",
            "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
            "COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n",
            "STCNOFF\n3 1 0\n0 0 0 0 0 1 9 9 9 255 0 0\n1 0 0 0 0 1 9 9 9 255 1 0\n0 1 0 0 0 1 9 9 9 255 0 1\n3 0 1 2\n",
            "4OFF\n3 1 0\n0 0 0 2\n2 0 0 2\n0 -1 0 -1\n3 0 1 2\n",
            "nOFF 2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2 255 0 0\n",
        ] {
            assert_eq!(read(text, Format::Off).mesh, plain, "{text:?}");
        }
    }

    /// Both byte orders, with and without a count of colours behind each face.
    #[test]
    fn binary() {
        let floats = [0f32, 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.];
        for (big, colors) in [(true, true), (true, false), (false, true), (false, false)] {
            let mut words = vec![4u32, 2, 0];
            words.extend(floats.iter().map(|x| x.to_bits()));
            for face in [[0, 1, 2], [2, 1, 3]] {
                words.push(3);
                words.extend(face);
                words.extend(if colors { vec![1, 0] } else { vec![] });
            }
            let body = words.iter().flat_map(|w| if big { w.to_be_bytes() } else { w.to_le_bytes() });
            let bytes: Vec<u8> = b"OFF BINARY\n".iter().copied().chain(body).collect();
            let model = read_stream(&bytes, Format::Off).unwrap();
            assert_eq!(faces(&model), [[0, 1, 2], [2, 1, 3]]);
            assert_eq!(model.mesh.positions[3], DVec3::new(1., 1., 0.));
            assert!(refuse(&bytes[..bytes.len() - 4], Format::Off).contains("fit neither byte order"));
        }
    }

    #[test]
    fn attributes() {
        let text = "STCNOFF\n3 1 0\n0 0 0 0 0 1 0 0 51 255 0 0.5\n1 0 0 0 0 1 9 9 9 255 1 0\n0 1 0 0 0 1 9 9 9 255 0 1\n3 0 1 2\n";
        let model = read(text, Format::Off);
        assert_eq!(model.uvs.unwrap().as_slice()[0], [0.0, 0.5]);
        assert_eq!(model.normals.unwrap().as_slice()[2], DVec3::Z);
        assert_eq!(model.colors.unwrap().as_slice()[0], [0.0, 0.0, 0.2, 1.0]);
        for (color, rgba) in [("255 0 51", [1.0, 0.0, 0.2, 1.0]), ("1.0 0.5 0 0.25", [1.0, 0.5, 0.0, 0.25])] {
            let model = read(&format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 {color}\n"), Format::Off);
            assert_eq!(model.colors.unwrap().as_slice(), [rgba; 3]);
        }
        assert_eq!(read("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7\n", Format::Off).colors, None);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, place) in [
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6: a face names vertex 3 of 3"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 6: \"-1\""),
            ("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "line 4: \"nan\""),
            ("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "the file ends after 1 of 2 faces"),
            ("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n", "the file ends after 3 of 4 vertices"),
            ("OFF\n99999999999 1 0\n0 0 0\n", "line 2: 99999999999 vertices"),
            ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999999 0 1 2\n", "line 6"),
            ("4OFF\n1 0 0\n0 0 0 0\n", "line 3: a vertex at infinity"),
            ("5nOFF\n", "line 1"),
            ("nOFF 4\n1 0 0\n0 0 0 0\n", "4 dimensions"),
            ("hello", "not an OFF header"),
            ("", "empty"),
        ] {
            let message = refuse(text, Format::Off);
            assert!(message.contains(place), "{text:?}: {message}");
        }
    }
}

mod stl {
    use super::*;

    const TEXT: &str = "solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
        endsolid one\nSOLID two \u{e9}\n FACET NORMAL nan -nan(ind) 0\nOUTER LOOP\nVERTEX 1 0 0\nVERTEX 1 1 0\n\
        VERTEX -0 1.0e0 0\nENDLOOP\nENDFACET\nENDSOLID\n";

    fn binary(header: &[u8], count: u32, facets: usize) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        for i in 0..facets {
            for x in [0.0, 0.0, 1.0, i as f32, 0.0, 0.0, i as f32 + 1.0, 0.0, 0.0, i as f32, 1.0, 0.0] {
                bytes.extend(x.to_le_bytes());
            }
            bytes.extend([0, 0]);
        }
        bytes
    }

    #[test]
    fn solids_become_groups_and_corners_meet() {
        let model = read(TEXT, Format::Stl);
        assert_eq!(faces(&model), [[0, 1, 2], [1, 3, 2]]);
        let groups = model.groups.unwrap();
        assert_eq!((groups.names, groups.of_face.as_slice()), (vec!["one".into(), "two \u{e9}".into()], &[0, 1][..]));
        let mut latin = TEXT.as_bytes().to_vec();
        latin.splice(6..9, [0xe9, 0xff, 0xe9]);
        assert_eq!(read_stream(&latin, Format::Stl).unwrap().mesh.face_count(), 2);
    }

    #[test]
    fn binary_headers_may_lie() {
        for (header, count) in [(&b"any"[..], 3), (b"solid x", 3), (b"any", u32::MAX), (b"any", 0)] {
            let model = read_stream(&binary(header, count, 3), Format::Stl).unwrap();
            assert_eq!((model.mesh.vertex_count(), model.mesh.face_count()), (7, 3), "{count}");
        }
        let short = refuse(binary(b"any", 5, 3), Format::Stl);
        assert!(short.contains("byte 234: the header promises 5 facets of 50 bytes, the file ends after 3"), "{short}");
        let mut cut = binary(b"any", 3, 3);
        cut.truncate(200);
        assert!(refuse(cut, Format::Stl).contains("the file ends after 2"));
        let mut infinite = binary(b"any", 1, 1);
        infinite[100..104].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(refuse(infinite, Format::Stl).contains("byte 96: a coordinate of facet 0 is not finite"));
        assert_eq!(read_stream(&binary(b"", 0, 0), Format::Stl).unwrap().mesh.face_count(), 0);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, place) in [
            (TEXT.replace("vertex 1 0 0\n", "vertex 1 blah 0\n"), "line 5: \"blah\""),
            (TEXT.replace("endloop\n", "endlop\n"), "line 7: \"endlop\""),
            (TEXT.replacen("vertex 1 0 0\n", "", 1), "line 7: a facet with 2 corners"),
            (TEXT[..53].into(), "the file ends inside a facet"),
            ("solid x\nhello\n".into(), "line 2: \"hello\""),
            ("hello".into(), "not an STL file"),
            (String::new(), "not an STL file"),
        ] {
            let message = refuse(&text, Format::Stl);
            assert!(message.contains(place), "{text:?}: {message}");
        }
    }
}

mod ply {
    use super::*;

    /// Numbers of a body in each encoding.
    struct Bodies {
        text: String,
        little: Vec<u8>,
        big: Vec<u8>,
    }

    impl Bodies {
        fn new() -> Self {
            Self { text: String::new(), little: vec![], big: vec![] }
        }
        fn put<const N: usize>(&mut self, text: impl std::fmt::Display, little: [u8; N], big: [u8; N]) {
            let _ = write!(self.text, "{text} ");
            self.little.extend(little);
            self.big.extend(big);
        }
        fn f32(&mut self, x: f32) {
            self.put(x, x.to_le_bytes(), x.to_be_bytes());
        }
        fn f64(&mut self, x: f64) {
            self.put(x, x.to_le_bytes(), x.to_be_bytes());
        }
        fn u8(&mut self, x: u8) {
            self.put(x, [x], [x]);
        }
        fn i16(&mut self, x: i16) {
            self.put(x, x.to_le_bytes(), x.to_be_bytes());
        }
        fn u32(&mut self, x: u32) {
            self.put(x, x.to_le_bytes(), x.to_be_bytes());
        }
        fn end(&mut self) {
            self.text.push('\n');
        }
    }

    #[test]
    fn encodings_agree_on_mixed_types() {
        let header = "ply\nformat ENCODING 1.0\ncomment hello\nobj_info x\nelement vertex 4\nproperty double x\nproperty float y\n\
            property short z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty list uchar short junk\n\
            element sensor 1\nproperty float heat\nelement face 2\nproperty uchar flag\nproperty list uchar uint vertex_indices\n\
            element edge 0\nproperty int vertex1\nend_header\n";
        let mut bodies = Bodies::new();
        for i in 0..4u8 {
            bodies.f64(0.1 + f64::from(i / 2));
            bodies.f32(f32::from(i % 2) + f32::from(i / 2) * 0.25);
            bodies.i16(-i16::from(i));
            for c in [255, 51, i] {
                bodies.u8(c);
            }
            bodies.u8(i);
            for j in 0..i {
                bodies.i16(i16::from(j));
            }
            bodies.end();
        }
        bodies.f32(36.6);
        bodies.end();
        for face in [&[0, 2, 1][..], &[1, 2, 3]] {
            bodies.u8(7);
            bodies.u8(3);
            for &v in face {
                bodies.u32(v);
            }
            bodies.end();
        }
        let file = |encoding: &str, body: &[u8]| [header.replace("ENCODING", encoding).as_bytes(), body].concat();
        let read = |bytes: Vec<u8>| read_stream(&bytes, Format::Ply).unwrap();
        let text = read(file("ascii", bodies.text.as_bytes()));
        assert_eq!(text.mesh.positions[3], DVec3::new(1.1, 1.25, -3.0));
        assert_eq!(faces(&text), [[0, 2, 1], [1, 2, 3]]);
        assert_eq!(text.colors.as_ref().unwrap().as_slice()[1], [1.0, 0.2, 2.0 / 255.0, 1.0]);
        for (encoding, body) in [("binary_little_endian", &bodies.little), ("binary_big_endian", &bodies.big)] {
            let binary = read(file(encoding, body));
            assert_eq!((&binary.mesh, &binary.colors), (&text.mesh, &text.colors));
            let cut = file(encoding, &body[..body.len() - 1]);
            assert!(refuse(cut, Format::Ply).contains("byte "));
        }
        let crlf =
            [header.replace("ENCODING", "binary_little_endian").replace('\n', "\r\n").as_bytes(), &bodies.little]
                .concat();
        assert_eq!(read(crlf).mesh, text.mesh);
        let carriage = header.replace("ENCODING", "ascii").replace('\n', "\r") + &bodies.text.replace('\n', "\r");
        assert_eq!(read(carriage.into_bytes()).mesh, text.mesh);
    }

    fn text(vertex: &str, elements: &str, body: &str) -> String {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n{vertex}{elements}end_header\n{body}"
        )
    }

    #[test]
    fn texture_coordinates_of_vertices_and_corners() {
        let faces = "element face 1\nproperty list uchar int vertex_index\n";
        let body = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 0.5\n";
        for names in [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]] {
            let uv = format!("property float {}\nproperty float {}\n", names[0], names[1]);
            let model = read(&text(&uv, faces, &format!("{body}3 0 2 3\n")), Format::Ply);
            assert_eq!(model.uvs.unwrap().as_slice(), [[0.0, 0.0], [1.0, 1.0], [0.0, 0.5]]);
        }
        let faces = format!("{faces}property list uchar float texcoord\n");
        let body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n";
        let model = read(&text("", &faces, body), Format::Ply);
        for (v, uv) in model.mesh.faces.iter().flatten().zip(model.uvs.unwrap().as_slice()) {
            assert_eq!(*uv, model.mesh.positions[v.index()].truncate().to_array());
        }
    }

    #[test]
    fn strips_and_face_colors() {
        let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
        let body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n8 0 1 2 3 -1 3 2 1\n";
        assert_eq!(faces(&read(&text("", strips, body), Format::Ply)), [[0, 1, 2], [2, 1, 3], [3, 2, 1]]);
        let colored = "element face 1\nproperty list uchar int vertex_index\nproperty float red\nproperty float green\nproperty float blue\nproperty float alpha\n";
        let model = read(&text("", colored, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 1 0.5 0 0.25\n"), Format::Ply);
        assert_eq!(model.colors.unwrap().as_slice(), [[1.0, 0.5, 0.0, 0.25]; 3]);
    }

    #[test]
    fn errors_name_the_line() {
        let faces = "element face 1\nproperty list uchar int vertex_index\n";
        let points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
        for (file, place) in [
            (text("", faces, &format!("{points}3 0 1 4\n")), "line 14: a face names vertex 4 of 4"),
            (text("", faces, &format!("{points}3 0 1 -1\n")), "line 14: -1 is not a vertex number"),
            (text("", faces, &format!("{points}3 0 1\n")), "line 14: the value of `vertex_index` is missing"),
            (text("", faces, &format!("{points}9 0 1\n")), "line 14"),
            (text("", faces, &format!("{points}\n\n")), "the file ends after 0 of 1 `face` elements"),
            (text("", faces, &points.replace("1 1 0", "1 nan 0")), "line 12: a coordinate of vertex 2 is not finite"),
            (
                text("", "element face 999999999999\nproperty list uchar int vertex_index\n", points),
                "promises 999999999999",
            ),
            (text("property float32 w q\nproperty half y\n", faces, points), "line 8: \"half\" is not a type"),
            ("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n".into(), "no x, y and z"),
            ("ply\nformat ascii 1.0\nelement vertex 1\n".into(), "the header has no end"),
            ("ply\nelement vertex 0\nend_header\n".into(), "names no format"),
            ("plywood\n".into(), "not a PLY file"),
            (String::new(), "not a PLY file"),
        ] {
            let message = refuse(&file, Format::Ply);
            assert!(message.contains(place), "{file:?}: {message}");
        }
    }
}
