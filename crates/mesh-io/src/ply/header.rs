//! The header of a PLY file: which elements follow, with which properties.

use crate::error::Fault;
use crate::text::show;

/// How the body is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A number's storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary body.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The value that stands for a full colour component.
    pub fn full(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::U16 => 65535.0,
            _ => 255.0,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    /// The type of a list's length; `None` for a plain number.
    pub length: Option<Scalar>,
    pub item: Scalar,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// The picture that a comment names.
    pub texture: Option<String>,
    /// Where the body starts.
    pub end: usize,
}

pub(super) fn parse(bytes: &[u8]) -> Result<Header, Fault> {
    let mut header = Header { encoding: Encoding::Text, elements: vec![], texture: None, end: 0 };
    let mut encoding = None;
    let mut first = true;
    loop {
        let start = header.end;
        let Some(line) = next_line(bytes, &mut header.end) else {
            let reason = if first { "not a PLY file: it does not begin with `ply`" } else { "the header has no end" };
            return Err(Fault::text(start, reason));
        };
        let fault = |reason: String| Err(Fault::text(start, reason));
        let mut words = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty());
        let keyword = words.next();
        if first {
            if keyword != Some(b"ply") {
                return fault("not a PLY file: it does not begin with `ply`".into());
            }
            first = false;
            continue;
        }
        let mut word = || words.next().unwrap_or_default();
        match keyword {
            None | Some(b"obj_info") => {}
            Some(b"comment") => {
                let rest = line.trim_ascii()[b"comment".len()..].trim_ascii();
                if let Some(name) = rest.strip_prefix(b"TextureFile ") {
                    header.texture = Some(String::from_utf8_lossy(name.trim_ascii()).into_owned());
                }
            }
            Some(b"format") => {
                encoding = match word() {
                    b"ascii" => Some(Encoding::Text),
                    b"binary_little_endian" => Some(Encoding::LittleEndian),
                    b"binary_big_endian" => Some(Encoding::BigEndian),
                    other => return fault(format!("{} is not a PLY encoding", show(other))),
                };
            }
            Some(b"element") => {
                let name = String::from_utf8_lossy(word()).into_owned();
                let count = word();
                let Some(count) = std::str::from_utf8(count).ok().and_then(|c| c.parse().ok()) else {
                    return fault(format!("{} is not an element count", show(count)));
                };
                header.elements.push(Element { name, count, properties: vec![] });
            }
            Some(b"property") => {
                let scalar = |word: &[u8]| {
                    Scalar::from_name(word).ok_or_else(|| Fault::text(start, format!("{} is not a type", show(word))))
                };
                let kind = word();
                let (length, item) =
                    if kind == b"list" { (Some(scalar(word())?), scalar(word())?) } else { (None, scalar(kind)?) };
                if matches!(length, Some(Scalar::F32 | Scalar::F64)) {
                    return fault("a list length must be an integer".into());
                }
                let name = String::from_utf8_lossy(word()).into_owned();
                let Some(element) = header.elements.last_mut() else {
                    return fault("a property before any element".into());
                };
                element.properties.push(Property { name, length, item });
            }
            Some(b"end_header") => break,
            Some(other) => return fault(format!("{} is not a PLY header statement", show(other))),
        }
    }
    header.encoding = encoding.ok_or_else(|| Fault::text(0, "the header names no format"))?;
    Ok(header)
}

/// The line at `at`, which moves behind its end: a line feed, a carriage return, or both.
fn next_line<'a>(bytes: &'a [u8], at: &mut usize) -> Option<&'a [u8]> {
    let rest = bytes.get(*at..).filter(|r| !r.is_empty())?;
    let length = rest.iter().position(|&b| b == b'\n' || b == b'\r')?;
    let end = if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
    *at += length + end;
    Some(&rest[..length])
}
