//! The numbers of a PLY body, as text or binary.

use super::header::{Element, Scalar};
use crate::error::{Fault, Spot};
use crate::notes::Notes;
use crate::text::Cursor;

/// The numbers of a body, one after another.
pub(super) trait Body {
    fn scalar(&mut self, kind: Scalar, property: &str) -> Result<f64, Fault>;
    /// Called before and after each row of an element.
    fn begin_row(&mut self, element: &Element, row: usize) -> Result<(), Fault>;
    fn end_row(&mut self, notes: &mut Notes);
    /// How many numbers of this kind can follow at most.
    fn room(&self, kind: Scalar) -> usize;
    fn spot(&self) -> Spot;
    fn fault(&self, reason: String) -> Fault;
}

pub(super) struct TextBody<'a> {
    pub cursor: Cursor<'a>,
}

impl Body for TextBody<'_> {
    #[inline]
    fn scalar(&mut self, _: Scalar, property: &str) -> Result<f64, Fault> {
        match self.cursor.loose_number()? {
            Some(value) => Ok(value),
            None => Err(self.cursor.fault(format!("the value of `{property}` is missing"))),
        }
    }

    fn begin_row(&mut self, element: &Element, row: usize) -> Result<(), Fault> {
        if self.cursor.seek_token() {
            return Ok(());
        }
        let Element { name, count, .. } = element;
        Err(self.cursor.fault(format!("the file ends after {row} of {count} `{name}` elements")))
    }

    fn end_row(&mut self, notes: &mut Notes) {
        if self.cursor.has_token() {
            notes.text("lines with surplus text", self.cursor.offset());
        }
        self.cursor.next_line();
    }

    fn room(&self, _: Scalar) -> usize {
        self.cursor.remaining().div_ceil(2)
    }

    fn spot(&self) -> Spot {
        Spot::Text(self.cursor.offset())
    }

    fn fault(&self, reason: String) -> Fault {
        self.cursor.fault(reason)
    }
}

pub(super) struct BinaryBody<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub big_endian: bool,
}

impl BinaryBody<'_> {
    #[inline]
    fn take<const N: usize>(&mut self, property: &str) -> Result<[u8; N], Fault> {
        let Some(Ok(mut raw)) = self.bytes.get(self.at..self.at + N).map(<[u8; N]>::try_from) else {
            return Err(self.fault(format!("the file ends inside `{property}`")));
        };
        self.at += N;
        if self.big_endian {
            raw.reverse();
        }
        Ok(raw)
    }
}

impl Body for BinaryBody<'_> {
    #[inline]
    fn scalar(&mut self, kind: Scalar, property: &str) -> Result<f64, Fault> {
        Ok(match kind {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take(property)?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take(property)?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take(property)?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take(property)?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take(property)?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take(property)?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take(property)?)),
            Scalar::F64 => f64::from_le_bytes(self.take(property)?),
        })
    }

    fn begin_row(&mut self, _: &Element, _: usize) -> Result<(), Fault> {
        Ok(())
    }

    fn end_row(&mut self, _: &mut Notes) {}

    fn room(&self, kind: Scalar) -> usize {
        (self.bytes.len() - self.at) / kind.size()
    }

    fn spot(&self) -> Spot {
        Spot::Binary(self.at)
    }

    fn fault(&self, reason: String) -> Fault {
        Fault::binary(self.at, reason)
    }
}
