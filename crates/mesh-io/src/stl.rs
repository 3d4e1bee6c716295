//! STL, text and binary.

use crate::encode::{Encoded, in_pieces};
use crate::error::{Fault, Spot};
use crate::model::{Groups, Model};
use crate::notes::Notes;
use crate::soup::Soup;
use crate::text::{Cursor, show};
use crate::weld::weld_exact;
use glam::{DVec3, Vec3};
use mesh_core::{FaceId, TriMesh};
use rayon::prelude::*;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// Reads either kind of STL and merges equal positions. Facet normals follow from the corners and are not kept. O(n).
pub(crate) fn read(bytes: &[u8], notes: &mut Notes) -> Result<Model, Fault> {
    let mut model = if is_binary(bytes) { read_binary(bytes, notes)? } else { read_text(bytes, notes)? };
    let welded = weld_exact(&mut model);
    notes.add("degenerate faces dropped", welded.dropped, None);
    Ok(model)
}

/// Binary files may begin with `solid` too: a facet count that explains the length decides, and then the first words.
fn is_binary(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let solid = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let exact = promised(bytes).is_some_and(|count| count.checked_mul(RECORD) == Some(bytes.len() - HEADER));
    if !solid || exact {
        return exact || !(solid || bytes.trim_ascii().is_empty());
    }
    // Text has a keyword after the name; a binary body is soon full of bytes that no text holds.
    bytes.iter().take(1 << 12).any(|&b| b == 0)
}

fn promised(bytes: &[u8]) -> Option<usize> {
    Some(u32::from_le_bytes(bytes.get(80..HEADER)?.try_into().ok()?) as usize)
}

fn read_binary(bytes: &[u8], notes: &mut Notes) -> Result<Model, Fault> {
    let count = promised(bytes).ok_or_else(|| {
        Fault::binary(bytes.len(), "not an STL file: neither `solid` nor room for a binary header of 84 bytes")
    })?;
    let body = &bytes[HEADER..];
    let (whole, rest) = (body.len() / RECORD, body.len() % RECORD);
    let count = if count <= whole {
        // Exporters that stream leave the count at 0.
        if count == 0 && rest == 0 && whole > 0 {
            notes.add("facets beyond the header's count of 0", whole, Some(Spot::Binary(80)));
            whole
        } else {
            notes.add("bytes after the last facet ignored", body.len() - count * RECORD, None);
            count
        }
    } else if count == u32::MAX as usize && rest == 0 {
        notes.add("facets, where the header's count is a mere placeholder", whole, Some(Spot::Binary(80)));
        whole
    } else {
        let reason = format!("the header promises {count} facets of 50 bytes, the file ends after {whole}");
        return Err(Fault::binary(bytes.len(), reason));
    };
    let records = &body[..count * RECORD];
    let float = |record: &[u8], i: usize| {
        let at = 12 + 4 * i;
        f64::from(f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]))
    };
    let positions: Vec<DVec3> = records
        .par_chunks_exact(RECORD)
        .flat_map_iter(|r| [0, 3, 6].map(|i| DVec3::new(float(r, i), float(r, i + 1), float(r, i + 2))))
        .collect();
    if let Some(bad) = positions.par_iter().position_first(|p| !p.is_finite()) {
        let offset = HEADER + bad / 3 * RECORD + 12 + bad % 3 * 12;
        return Err(Fault::binary(offset, format!("a coordinate of facet {} is not finite", bad / 3)));
    }
    let flagged = records.par_chunks_exact(RECORD).filter(|r| r[48..50] != [0, 0]).count();
    notes.add("facets with attribute bytes, not kept", flagged, None);
    let faces = (0..count as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]);
    if positions.len() >= u32::MAX as usize {
        return Err(Fault::whole("more facets than 32-bit ids can name; split the file"));
    }
    Ok(TriMesh::from_arrays(positions, faces).into())
}

fn read_text(bytes: &[u8], notes: &mut Notes) -> Result<Model, Fault> {
    let mut cursor = Cursor::new(bytes, 0);
    let mut soup = Soup::default();
    let (mut sizes, mut group_of, mut names) = (vec![], vec![], vec![]);
    let mut facets_at = vec![];
    let mut inside = false;
    while let Some((word, start)) = next_word(&mut cursor) {
        if is(word, b"solid") {
            names.push(String::from_utf8_lossy(cursor.rest_of_line()).into_owned());
            inside = true;
        } else if is(word, b"facet") && inside {
            let size = facet(&mut cursor, &mut soup.positions)?;
            sizes.push(size);
            group_of.push(names.len() as u32 - 1);
            facets_at.push(start);
        } else if is(word, b"endsolid") {
            cursor.rest_of_line();
            inside = false;
        } else if is(word, b"color") {
            cursor.rest_of_line();
            notes.text("colour statements passed over", start);
        } else {
            let wanted = if inside { "`facet` or `endsolid`" } else { "`solid`" };
            return Err(Fault::text(start, format!("{} where {wanted} should stand", show(word))));
        }
    }
    if inside {
        notes.text("solids without `endsolid`", bytes.len());
    }
    if names.is_empty() {
        return Err(Fault::whole("not an STL file: it is empty"));
    }
    soup.corners = (0..soup.positions.len() as u32).collect();
    soup.sizes = sizes.iter().any(|&n| n != 3).then_some(sizes);
    let cut = soup.triangulate(notes, |i| facets_at.get(i).map(|&at| Spot::Text(at)))?;
    let groups = (names.len() > 1 || names.iter().any(|n| !n.is_empty()))
        .then(|| Groups { of_face: cut.gather_faces(&group_of).into(), names });
    Ok(Model { groups, polygons: cut.polygons, mesh: cut.mesh, ..Model::default() })
}

fn is(word: &[u8], keyword: &[u8]) -> bool {
    word.eq_ignore_ascii_case(keyword)
}

fn next_word<'a>(cursor: &mut Cursor<'a>) -> Option<(&'a [u8], usize)> {
    if !cursor.seek_token() {
        return None;
    }
    let start = cursor.offset();
    cursor.token().map(|word| (word, start))
}

/// What follows `facet`, up to `endfacet`. Returns how many corners it has.
fn facet(cursor: &mut Cursor, positions: &mut Vec<DVec3>) -> Result<u32, Fault> {
    let first = positions.len();
    // The normal may be anything, NaN included: it is not used.
    loop {
        let Some((word, start)) = next_word(cursor) else { return Err(unfinished(cursor)) };
        if is(word, b"vertex") {
            let mut coordinate = || {
                cursor.seek_token();
                cursor.expect_number("a coordinate")
            };
            positions.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
        } else if is(word, b"normal") {
            for _ in 0..3 {
                cursor.token();
            }
        } else if is(word, b"endfacet") {
            break;
        } else if !(is(word, b"outer") || is(word, b"loop") || is(word, b"endloop")) {
            return Err(Fault::text(start, format!("{} inside a facet", show(word))));
        }
    }
    let size = positions.len() - first;
    if size < 3 {
        return Err(cursor.fault(format!("a facet with {size} corners")));
    }
    Ok(size as u32)
}

fn unfinished(cursor: &Cursor) -> Fault {
    cursor.fault("the file ends inside a facet")
}

/// The bytes of a binary STL. The caller has checked that positions fit f32.
pub(crate) fn encode(model: &Model) -> Encoded {
    let mesh = &model.mesh;
    let mut head = vec![0u8; 80];
    // Must not begin with `solid`, which readers take for text.
    head[..10].copy_from_slice(b"binary STL");
    head.extend((mesh.faces.len() as u32).to_le_bytes());
    let mut encoded = Encoded { body: vec![head], ..Encoded::default() };
    encoded.body.extend(in_pieces(mesh.faces.len(), |f, out| {
        let corners = mesh.triangle(FaceId(f as u32)).map(DVec3::as_vec3);
        // From f64, so that the normal of a thin facet is not all rounding.
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        for p in [normal, corners[0], corners[1], corners[2]] {
            for x in p.to_array() {
                out.extend(x.to_le_bytes());
            }
        }
        out.extend([0, 0]);
    }));
    let dropped = [model.uvs.is_some(), model.normals.is_some(), model.colors.is_some(), model.materials.is_some()];
    if dropped.contains(&true) {
        encoded.notes.add("attributes dropped, since STL holds none", dropped.iter().filter(|&&d| d).count(), None);
    }
    encoded
}
