//! One stretch of an OBJ file, parsed without knowing what came before it.

use crate::error::Fault;
use crate::notes::Notes;
use crate::text::{Cursor, show};
use glam::DVec3;

/// A corner's reference: absolute from 0 below [`FIRST_RELATIVE`], or counted from the start of the chunk and offset by [`RELATIVE`].
pub(super) type Ref = u32;
/// A corner that names no element of this kind.
pub(super) const NO_REF: Ref = u32::MAX;
/// A reference to what no file of this size holds.
const NOWHERE: Ref = u32::MAX - 1;
const FIRST_RELATIVE: Ref = 1 << 31;
/// Marks references that need the number of elements before the chunk added.
const RELATIVE: i64 = 3 << 30;

/// Statements that hold for the faces after them.
pub(super) enum Mark {
    Group(String),
    Material(String),
}

/// What a stretch of an OBJ file holds, in file order.
#[derive(Default)]
pub(super) struct Chunk {
    pub positions: Vec<DVec3>,
    /// Empty, or one per position with NaN for none.
    pub colors: Vec<[f64; 4]>,
    pub uvs: Vec<[f64; 2]>,
    pub normals: Vec<DVec3>,
    /// Corner count of each face; empty while all are triangles.
    pub sizes: Vec<u32>,
    /// Where each face's line starts, in bytes from the chunk's start.
    pub face_offsets: Vec<u32>,
    pub vertex_refs: Vec<Ref>,
    /// Empty, or one per corner.
    pub uv_refs: Vec<Ref>,
    /// Empty, or one per corner.
    pub normal_refs: Vec<Ref>,
    /// Marks, each with the number of faces before it in the chunk.
    pub marks: Vec<(u32, Mark)>,
    pub libraries: Vec<String>,
    pub notes: Notes,
    pub unknown_lines: usize,
}

/// A reference made absolute, given how many elements come before the chunk; `None` before the first element and beyond two thousand million.
pub(super) fn resolve(r: Ref, before: usize) -> Option<usize> {
    match r {
        NO_REF | NOWHERE => None,
        0..FIRST_RELATIVE => Some(r as usize),
        _ => usize::try_from(i64::from(r) - RELATIVE + before.cast_signed() as i64).ok(),
    }
}

pub(super) fn parse(text: &[u8], base: usize) -> Result<Chunk, Fault> {
    let mut chunk = Chunk::default();
    let mut cursor = Cursor::joining_lines(text, base);
    loop {
        let start = cursor.offset();
        match cursor.token() {
            None => {}
            Some(b"v") => chunk.vertex(&mut cursor)?,
            Some(b"f" | b"fo") => chunk.face(&mut cursor, (start - base) as u32)?,
            Some(b"vt") => {
                let u = cursor.loose_number()?.ok_or_else(|| cursor.fault("a texture coordinate is missing"))?;
                let v = cursor.loose_number()?.unwrap_or(0.0);
                chunk.uvs.push(if (u + v).is_nan() { [f64::NAN; 2] } else { [u, v] });
            }
            Some(b"vn") => {
                let mut component =
                    || cursor.loose_number()?.ok_or_else(|| cursor.fault("a component of a normal is missing"));
                let n = DVec3::new(component()?, component()?, component()?);
                chunk.normals.push(if n.is_nan() { DVec3::NAN } else { n });
            }
            Some(b"g" | b"o") => chunk.mark(Mark::Group(name(&mut cursor))),
            Some(b"usemtl") => chunk.mark(Mark::Material(name(&mut cursor))),
            Some(b"mtllib") => chunk.libraries.push(name(&mut cursor)),
            Some(b"s") => chunk.notes.text("smoothing groups not kept", start),
            Some(b"l") => chunk.notes.text("lines not kept", start),
            Some(b"p") => chunk.notes.text("points not kept", start),
            Some(
                b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm" | b"trim"
                | b"hole" | b"scrv" | b"sp" | b"end" | b"con",
            ) => chunk.notes.text("free-form statements passed over", start),
            Some(
                b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"maplib" | b"usemap" | b"shadow_obj"
                | b"trace_obj" | b"ctech" | b"stech" | b"call" | b"csh",
            ) => chunk.notes.text("display statements passed over", start),
            Some(_) => {
                chunk.unknown_lines += 1;
                chunk.notes.text("lines that are not OBJ passed over", start);
            }
        }
        skip_joined(&mut cursor);
        if !cursor.next_line() {
            return Ok(chunk);
        }
    }
}

/// Passes the tokens left on a line, and with them the joins to further lines.
#[inline]
fn skip_joined(cursor: &mut Cursor) {
    while cursor.has_token() {
        cursor.token();
    }
}

fn name(cursor: &mut Cursor) -> String {
    String::from_utf8_lossy(cursor.rest_of_line()).into_owned()
}

impl Chunk {
    fn mark(&mut self, mark: Mark) {
        self.marks.push((self.face_offsets.len() as u32, mark));
    }

    #[inline]
    fn vertex(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        let mut coordinate = || cursor.expect_number("a coordinate");
        let p = DVec3::new(coordinate()?, coordinate()?, coordinate()?);
        if cursor.has_token() {
            self.extended_vertex(cursor)?;
        } else if !self.colors.is_empty() {
            self.colors.push([f64::NAN; 4]);
        }
        self.positions.push(p);
        Ok(())
    }

    /// What follows x y z: a weight, or a colour of three or four components.
    fn extended_vertex(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        let start = cursor.offset();
        let mut extra = [1.0; 4];
        let mut count = 0;
        while let Some(value) = cursor.number()? {
            if count < 4 {
                extra[count] = value;
            }
            count += 1;
        }
        if count == 3 || count == 4 {
            self.colors.resize(self.positions.len(), [f64::NAN; 4]);
            self.colors.push(extra);
            return Ok(());
        }
        if !self.colors.is_empty() {
            self.colors.push([f64::NAN; 4]);
        }
        if count != 1 {
            self.notes.text("vertices with surplus numbers", start);
        } else if extra[0] != 1.0 {
            self.notes.text("vertex weights not kept", start);
        }
        Ok(())
    }

    #[inline]
    fn face(&mut self, cursor: &mut Cursor, offset: u32) -> Result<(), Fault> {
        let first = self.vertex_refs.len();
        while cursor.has_token() {
            self.corner(cursor)?;
        }
        let size = self.vertex_refs.len() - first;
        if size != 3 && self.sizes.is_empty() {
            self.sizes.resize(self.face_offsets.len(), 3);
        }
        if size != 3 || !self.sizes.is_empty() {
            self.sizes.push(size as u32);
        }
        self.face_offsets.push(offset);
        if !self.uv_refs.is_empty() {
            self.uv_refs.resize(self.vertex_refs.len(), NO_REF);
        }
        if !self.normal_refs.is_empty() {
            self.normal_refs.resize(self.vertex_refs.len(), NO_REF);
        }
        Ok(())
    }

    /// One of `v`, `v/vt`, `v//vn`, `v/vt/vn`, where an index may count backwards from the last element.
    #[inline]
    fn corner(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        let start = cursor.offset();
        if let Some(v) = cursor.small_natural() {
            self.vertex_refs.push(v.checked_sub(1).ok_or_else(|| zero(start))?);
            return Ok(());
        }
        let token = cursor.token().unwrap_or_default();
        let bad = || Fault::text(start, format!("{} is not a face corner", show(token)));
        let (v, rest) = index(token).ok_or_else(bad)?;
        let v = v.ok_or_else(bad)?;
        self.vertex_refs.push(reference(v, self.positions.len()).ok_or_else(|| zero(start))?);
        let Some(rest) = rest else { return Ok(()) };
        let (vt, rest) = index(rest).ok_or_else(bad)?;
        if let Some(vt) = vt {
            self.uv_refs.resize(self.vertex_refs.len() - 1, NO_REF);
            self.uv_refs.push(reference(vt, self.uvs.len()).ok_or_else(|| zero(start))?);
        }
        let Some(rest) = rest else { return Ok(()) };
        let (vn, rest) = index(rest).ok_or_else(bad)?;
        if let Some(vn) = vn {
            self.normal_refs.resize(self.vertex_refs.len() - 1, NO_REF);
            self.normal_refs.push(reference(vn, self.normals.len()).ok_or_else(|| zero(start))?);
        }
        if rest.is_some() { Err(bad()) } else { Ok(()) }
    }
}

#[cold]
fn zero(start: usize) -> Fault {
    Fault::text(start, "a face corner has index 0; OBJ counts from 1")
}

fn reference(index: i64, count: usize) -> Option<Ref> {
    match index {
        0 => None,
        1.. => Some(u32::try_from(index - 1).ok().filter(|&r| r < FIRST_RELATIVE).unwrap_or(NOWHERE)),
        _ => {
            let r = u32::try_from(RELATIVE + count.cast_signed() as i64 + index);
            Some(r.ok().filter(|r| (FIRST_RELATIVE..NOWHERE).contains(r)).unwrap_or(NOWHERE))
        }
    }
}

/// The integer in front of a slash or the token's end (absent if empty), and what follows the slash.
#[inline]
fn index(token: &[u8]) -> Option<(Option<i64>, Option<&[u8]>)> {
    let (negative, mut at) = match token.first() {
        Some(b'-') => (true, 1),
        Some(b'+') => (false, 1),
        _ => (false, 0),
    };
    let (digits, mut value) = (at, 0i64);
    while let Some(&b) = token.get(at) {
        if !b.is_ascii_digit() {
            break;
        }
        if at - digits == 15 {
            return None;
        }
        value = 10 * value + i64::from(b - b'0');
        at += 1;
    }
    if at == digits && at > 0 {
        return None;
    }
    let value = (at > digits).then_some(if negative { -value } else { value });
    match token.get(at) {
        None => Some((value, None)),
        Some(b'/') => Some((value, Some(&token[at + 1..]))),
        Some(_) => None,
    }
}
