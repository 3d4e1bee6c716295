//! Reads OFF in its text dialects, and hands binary ones on.

use crate::error::{Fault, Spot};
use crate::model::Model;
use crate::notes::Notes;
use crate::soup::Soup;
use crate::text::{Cursor, show};
use crate::vary::Value;
use glam::DVec3;

/// What a header's prefix letters promise of every vertex, and of the file.
#[derive(Clone, Copy, Default)]
#[allow(clippy::struct_excessive_bools)] // one per prefix letter, all independent
pub(super) struct Dialect {
    pub uvs: bool,
    pub colors: bool,
    pub normals: bool,
    pub homogeneous: bool,
    pub dimensions: usize,
    binary: bool,
}

/// Vertices of a file, with what its dialect adds.
#[derive(Default)]
struct Vertices {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    colors: Vec<[f64; 4]>,
    uvs: Vec<[f64; 2]>,
}

/// Reads `[ST][C][N][4][n]OFF`. Vertices keep their order and number. O(n).
pub(crate) fn read(bytes: &[u8], notes: &mut Notes) -> Result<Model, Fault> {
    let mut cursor = Cursor::new(bytes, 0);
    let dialect = header(&mut cursor)?;
    if dialect.binary {
        let line =
            bytes[cursor.offset()..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |n| cursor.offset() + n + 1);
        return super::binary::read(bytes, line, dialect, notes);
    }
    let (vertex_count, face_count) = counts(&mut cursor)?;
    let vertices = read_vertices(&mut cursor, vertex_count, dialect, notes)?;

    let mut soup = Soup { positions: vertices.positions, ..Soup::default() };
    let (mut sizes, mut offsets) = (Vec::with_capacity(face_count), Vec::with_capacity(face_count));
    let mut face_colors: Vec<[f64; 4]> = vec![];
    for face in 0..face_count {
        if !cursor.seek_token() {
            return Err(cursor.fault(format!("the file ends after {face} of {face_count} faces")));
        }
        let start = cursor.offset();
        let size = integer(&mut cursor, "a corner count")?;
        // Each corner takes two bytes at least.
        if size > cursor.remaining() {
            return Err(Fault::text(start, format!("a face with {size} corners is larger than the file")));
        }
        for _ in 0..size {
            cursor.seek_token();
            let at = cursor.offset();
            let v = integer(&mut cursor, "a corner")?;
            if v >= vertex_count {
                return Err(Fault::text(at, format!("a face names vertex {v} of {vertex_count} (counted from 0)")));
            }
            soup.corners.push(v as u32);
        }
        if let Some(color) = face_color(&mut cursor, notes)? {
            face_colors.resize(face, <[f64; 4]>::NONE);
            face_colors.push(color);
        }
        sizes.push(size as u32);
        offsets.push(start);
        cursor.next_line();
    }
    if cursor.seek_token() {
        notes.text("texts after the last face ignored", cursor.offset());
    }
    if !face_colors.is_empty() {
        face_colors.resize(face_count, <[f64; 4]>::NONE);
    }

    soup.sizes = sizes.iter().any(|&n| n != 3).then_some(sizes);
    let cut = soup.triangulate(notes, |i| Some(Spot::Text(offsets[i])))?;
    let corner_vertices = cut.mesh.faces.as_flattened();
    let colors: Option<Vec<[f64; 4]>> = if !vertices.colors.is_empty() {
        Some(corner_vertices.iter().map(|v| vertices.colors[v.index()]).collect())
    } else if face_colors.is_empty() {
        None
    } else {
        Some(cut.gather_faces(&face_colors).into_iter().flat_map(|c| [c; 3]).collect())
    };
    let by_vertex = |v: &mesh_core::VertexId| v.index();
    Ok(Model {
        uvs: (!vertices.uvs.is_empty())
            .then(|| corner_vertices.iter().map(|v| vertices.uvs[by_vertex(v)]).collect::<Vec<_>>().into()),
        normals: (!vertices.normals.is_empty())
            .then(|| corner_vertices.iter().map(|v| vertices.normals[by_vertex(v)]).collect::<Vec<_>>().into()),
        colors: colors.map(Into::into),
        polygons: cut.polygons,
        mesh: cut.mesh,
        ..Model::default()
    })
}

/// The first word, which may be missing. Without it the file begins with its counts.
fn header(cursor: &mut Cursor) -> Result<Dialect, Fault> {
    if !cursor.seek_token() {
        return Err(Fault::whole("not an OFF file: it is empty"));
    }
    let mut dialect = Dialect { dimensions: 3, ..Dialect::default() };
    let mut peek = cursor.clone();
    let word = peek.token().unwrap_or_default();
    if word.first().is_some_and(u8::is_ascii_digit) && !word.ends_with(b"OFF") {
        return Ok(dialect);
    }
    let start = cursor.offset();
    let unknown = || Fault::text(start, format!("{} is not an OFF header", show(word)));
    let mut letters = word.strip_suffix(b"OFF").or_else(|| word.strip_suffix(b"off")).ok_or_else(unknown)?;
    let mut take = |letter: &[u8]| {
        let found = letters.starts_with(letter);
        if found {
            letters = &letters[letter.len()..];
        }
        found
    };
    dialect.uvs = take(b"ST");
    dialect.colors = take(b"C");
    dialect.normals = take(b"N");
    dialect.homogeneous = take(b"4");
    let has_dimension = take(b"n");
    if !letters.is_empty() {
        return Err(unknown());
    }
    *cursor = peek;
    let mut peek = cursor.clone();
    dialect.binary = peek.token().is_some_and(|word| word.eq_ignore_ascii_case(b"binary"));
    if dialect.binary && has_dimension {
        return Err(Fault::text(start, "binary OFF of other than three dimensions is not supported"));
    }
    if has_dimension {
        cursor.seek_token();
        let at = cursor.offset();
        dialect.dimensions = integer(cursor, "the dimension")?;
        if dialect.dimensions > 3 {
            return Err(Fault::text(at, format!("points of {} dimensions; at most 3 make a mesh", dialect.dimensions)));
        }
    }
    Ok(dialect)
}

/// Vertex and face counts. The edge count is often wrong or missing, and not needed.
fn counts(cursor: &mut Cursor) -> Result<(usize, usize), Fault> {
    cursor.seek_token();
    let start = cursor.offset();
    let vertices = integer(cursor, "the vertex count")?;
    cursor.seek_token();
    let faces = integer(cursor, "the face count")?;
    while cursor.token().is_some() {}
    cursor.next_line();
    // A vertex or a face takes two bytes at least.
    if vertices.saturating_add(faces) / 2 > cursor.remaining() {
        let reason = format!("{vertices} vertices and {faces} faces are more than the file can hold");
        return Err(Fault::text(start, reason));
    }
    Ok((vertices, faces))
}

fn read_vertices(cursor: &mut Cursor, count: usize, dialect: Dialect, notes: &mut Notes) -> Result<Vertices, Fault> {
    let mut vertices = Vertices { positions: Vec::with_capacity(count), ..Vertices::default() };
    let mut byte_colors = false;
    for vertex in 0..count {
        if !cursor.seek_token() {
            return Err(cursor.fault(format!("the file ends after {vertex} of {count} vertices")));
        }
        let start = cursor.offset();
        let mut number = || {
            cursor.seek_token();
            cursor.expect_number("a number of a vertex")
        };
        let mut xyzw = [0.0, 0.0, 0.0, 1.0];
        for x in &mut xyzw[..dialect.dimensions] {
            *x = number()?;
        }
        if dialect.homogeneous {
            xyzw[3] = number()?;
        }
        let p = DVec3::new(xyzw[0], xyzw[1], xyzw[2]);
        let p = if dialect.homogeneous { p / xyzw[3] } else { p };
        if !p.is_finite() {
            return Err(Fault::text(start, "a vertex at infinity"));
        }
        vertices.positions.push(p);
        if dialect.normals {
            vertices.normals.push(DVec3::new(number()?, number()?, number()?));
        }
        if dialect.colors {
            let mut rgba = [number()?, number()?, number()?, f64::NAN];
            // Alpha is there if another number follows on the line besides texture coordinates.
            if count_ahead(cursor) != if dialect.uvs { 2 } else { 0 } {
                cursor.seek_token();
                rgba[3] = cursor.expect_number("a colour component")?;
            }
            byte_colors |= rgba.iter().any(|&x| x > 1.0);
            vertices.colors.push(rgba);
        }
        if dialect.uvs {
            let mut number = || {
                cursor.seek_token();
                cursor.expect_number("a texture coordinate")
            };
            vertices.uvs.push([number()?, number()?]);
        }
        if cursor.has_token() {
            notes.text("vertices with surplus numbers", start);
            while cursor.token().is_some() {}
        }
        cursor.next_line();
    }
    let scale = if byte_colors { 1.0 / 255.0 } else { 1.0 };
    for [r, g, b, a] in &mut vertices.colors {
        *a = if a.is_nan() { 1.0 } else { *a * scale };
        (*r, *g, *b) = (*r * scale, *g * scale, *b * scale);
    }
    Ok(vertices)
}

/// How many tokens are left on the line.
fn count_ahead(cursor: &Cursor) -> usize {
    let mut peek = cursor.clone();
    std::iter::from_fn(|| peek.token()).count()
}

/// The rest of a face's line: nothing, a colour-map index, or three or four components, integers up to 255 or
/// fractions up to 1.
fn face_color(cursor: &mut Cursor, notes: &mut Notes) -> Result<Option<[f64; 4]>, Fault> {
    if !cursor.has_token() {
        return Ok(None);
    }
    let start = cursor.offset();
    let (mut rgba, mut count, mut fractions) = ([f64::NAN; 4], 0, false);
    let mut peek = cursor.clone();
    while let Some(token) = peek.token() {
        fractions |= token.iter().any(|b| matches!(b, b'.' | b'e' | b'E'));
    }
    while cursor.has_token() {
        let value = cursor.expect_number("a colour component")?;
        if count < 4 {
            rgba[count] = value;
        }
        count += 1;
    }
    if !(3..=4).contains(&count) {
        notes.text("face colours that are no RGB or RGBA, not kept", start);
        return Ok(None);
    }
    let scale = if fractions { 1.0 } else { 1.0 / 255.0 };
    let alpha = if count == 4 { rgba[3] * scale } else { 1.0 };
    Ok(Some([rgba[0] * scale, rgba[1] * scale, rgba[2] * scale, alpha]))
}

fn integer(cursor: &mut Cursor, what: &str) -> Result<usize, Fault> {
    let start = cursor.offset();
    let token = cursor.token().ok_or_else(|| cursor.fault(format!("{what} is missing")))?;
    let text = std::str::from_utf8(token).unwrap_or_default();
    text.parse().map_err(|_| Fault::text(start, format!("{} is not {what}", show(token))))
}
