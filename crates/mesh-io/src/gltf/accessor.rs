//! Typed numbers in buffers: strided, normalized, sparse.

use super::buffers::Buffers;
use super::json::Node;
use crate::error::Fault;

/// How one number is stored.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(node: &Node) -> Result<Self, Fault> {
        Ok(match node.get("componentType").expect_index()? {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            other => return Err(node.fault(&format!("{other} is not a component type"))),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number that stands for 1 where integers are normalized.
    fn full(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 => f64::from(u32::MAX),
            Self::F32 => 1.0,
        }
    }

    /// `raw` has the component's size.
    fn read(self, raw: &[u8]) -> f64 {
        match self {
            Self::I8 => f64::from(raw[0].cast_signed()),
            Self::U8 => f64::from(raw[0]),
            Self::I16 => f64::from(i16::from_le_bytes([raw[0], raw[1]])),
            Self::U16 => f64::from(u16::from_le_bytes([raw[0], raw[1]])),
            Self::U32 => f64::from(u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]])),
            Self::F32 => f64::from(f32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]])),
        }
    }
}

/// An accessor's numbers, `width` for each element.
pub(super) struct Values {
    pub width: usize,
    pub numbers: Vec<f64>,
}

impl Values {
    pub fn len(&self) -> usize {
        self.numbers.len() / self.width
    }

    pub fn row(&self, i: usize) -> &[f64] {
        &self.numbers[i * self.width..(i + 1) * self.width]
    }
}

/// Reads an accessor of scalars or vectors. O(count); what it allocates is bounded by the bytes behind it, or for
/// sparse accessors without any by `most`.
pub(super) fn values(accessor: &Node, buffers: &mut Buffers, most: usize) -> Result<Values, Fault> {
    let width = match accessor.get("type").text() {
        Some("SCALAR") => 1,
        Some("VEC2") => 2,
        Some("VEC3") => 3,
        Some("VEC4") => 4,
        _ => return Err(accessor.fault("not of type SCALAR, VEC2, VEC3 or VEC4")),
    };
    let component = Component::of(accessor)?;
    let count = accessor.get("count").expect_index()?;
    let start = accessor.get("byteOffset").index()?.unwrap_or(0);
    let mut numbers = match accessor.get("bufferView").index()? {
        Some(view) => strided(accessor, buffers, view, start, count, width, component)?,
        None if count > most => return Err(accessor.fault("more elements than the file has bytes")),
        None => vec![0.0; count * width],
    };
    let sparse = accessor.get("sparse");
    if !sparse.is_absent() {
        let (places, replacements) = (sparse.get("indices"), sparse.get("values"));
        let changed = sparse.get("count").expect_index()?;
        let at = |node: &Node| node.get("byteOffset").index().map(|o| o.unwrap_or(0));
        let view = |node: &Node| node.get("bufferView").expect_index();
        let kind = Component::of(&places)?;
        let indices = strided(&places, buffers, view(&places)?, at(&places)?, changed, 1, kind)?;
        let new = strided(&replacements, buffers, view(&replacements)?, at(&replacements)?, changed, width, component)?;
        for (&index, new) in indices.iter().zip(new.chunks_exact(width)) {
            let row = numbers.chunks_exact_mut(width).nth(index as usize);
            row.ok_or_else(|| places.fault(&format!("{index} is beyond {count} elements")))?.copy_from_slice(new);
        }
    }
    if accessor.get("normalized").value.as_bool() == Some(true) {
        let full = component.full();
        for x in &mut numbers {
            *x = (*x / full).max(-1.0);
        }
    }
    Ok(Values { width, numbers })
}

fn strided(
    owner: &Node,
    buffers: &mut Buffers,
    view: usize,
    start: usize,
    count: usize,
    width: usize,
    component: Component,
) -> Result<Vec<f64>, Fault> {
    let (bytes, view) = buffers.view(view)?;
    let size = component.size();
    let stride = view.get("byteStride").index()?.filter(|&s| s > 0).unwrap_or(size * width);
    let last = count.checked_sub(1).and_then(|n| n.checked_mul(stride));
    let end = last.and_then(|n| n.checked_add(start)).and_then(|n| n.checked_add(size * width));
    if count > 0 && (end.is_none_or(|end| end > bytes.len()) || stride < size * width) {
        let reason = format!("{count} elements of {} bytes do not fit a view of {}", size * width, bytes.len());
        return Err(owner.fault(&reason));
    }
    let element = |i: usize| (0..width).map(move |k| component.read(&bytes[start + i * stride + k * size..]));
    Ok((0..count).flat_map(element).collect())
}
