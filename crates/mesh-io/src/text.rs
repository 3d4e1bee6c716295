//! A cursor over the lines and tokens of a text file. Offsets count from the start of the whole file.

use crate::error::Fault;
use crate::number::{parse_f64, plain_decimal};

/// Reads tokens separated by blanks, line by line. `#` starts a comment where the format says so, and a backslash
/// before a line end joins lines where it does.
#[derive(Clone)]
pub(crate) struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
    base: usize,
    joins: bool,
}

impl<'a> Cursor<'a> {
    /// A cursor over `text`, which starts `base` bytes into its file. No line joining.
    pub fn new(text: &'a [u8], base: usize) -> Self {
        Self { text, at: 0, base, joins: false }
    }

    /// A cursor that takes a backslash before a line end as a blank, as OBJ does.
    pub fn joining_lines(text: &'a [u8], base: usize) -> Self {
        Self { joins: true, ..Self::new(text, base) }
    }

    /// Where the cursor is in the file.
    pub fn offset(&self) -> usize {
        self.base + self.at
    }

    /// Bytes left.
    pub fn remaining(&self) -> usize {
        self.text.len() - self.at
    }

    /// A fault at the cursor.
    pub fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault::text(self.offset(), reason)
    }

    /// Skips blanks and says whether a token follows on this line. A comment counts as the line's end.
    #[inline]
    pub fn has_token(&mut self) -> bool {
        loop {
            match self.text.get(self.at) {
                None | Some(b'\n' | b'#') => return false,
                Some(b' ' | b'\t' | b'\r' | 0x0b | 0x0c) => self.at += 1,
                Some(b'\\') if self.joins => match &self.text[self.at + 1..] {
                    [b'\n', ..] => self.at += 2,
                    [b'\r', b'\n', ..] => self.at += 3,
                    _ => return true,
                },
                Some(_) => return true,
            }
        }
    }

    /// The next token of this line.
    #[inline]
    pub fn token(&mut self) -> Option<&'a [u8]> {
        if !self.has_token() {
            return None;
        }
        let start = self.at;
        while let Some(&b) = self.text.get(self.at) {
            // A comment may follow without a blank; but 1.#IND is how some systems print NaN.
            if is_blank(b)
                || (b == b'#' && self.text[self.at - 1] != b'.')
                || (self.joins && b == b'\\' && self.ends_line(self.at + 1))
            {
                break;
            }
            self.at += 1;
        }
        Some(&self.text[start..self.at])
    }

    fn ends_line(&self, at: usize) -> bool {
        matches!(&self.text[at..], [b'\n', ..] | [b'\r', b'\n', ..])
    }

    /// The next token of this line as a number; `None` at the line's end.
    ///
    /// # Errors
    /// The token is no number, or not a finite one.
    #[inline]
    pub fn number(&mut self) -> Result<Option<f64>, Fault> {
        if !self.has_token() {
            return Ok(None);
        }
        if let Some((value, length)) = plain_decimal(&self.text[self.at..])
            && self.text.get(self.at + length).is_none_or(|&b| is_blank(b))
        {
            self.at += length;
            return Ok(Some(value));
        }
        self.odd_number()
    }

    #[cold]
    fn odd_number(&mut self) -> Result<Option<f64>, Fault> {
        let start = self.offset();
        let Some(token) = self.token() else { return Ok(None) };
        match parse_f64(token) {
            Some(value) if value.is_finite() => Ok(Some(value)),
            Some(_) => Err(Fault::text(start, format!("{} is not a finite number", show(token)))),
            None => Err(Fault::text(start, format!("{} is not a number", show(token)))),
        }
    }

    /// The next token of this line as a number that the mesh can do without: NaN, in whatever spelling, and infinity
    /// both count as no value. `None` at the line's end.
    ///
    /// # Errors
    /// The token is no number.
    #[inline]
    pub fn loose_number(&mut self) -> Result<Option<f64>, Fault> {
        if !self.has_token() {
            return Ok(None);
        }
        let back = self.at;
        self.number().or_else(|fault| {
            self.at = back;
            let token = self.token().unwrap_or_default();
            let bare = token.strip_prefix(b"-").or_else(|| token.strip_prefix(b"+")).unwrap_or(token);
            let absent = parse_f64(token).is_some()
                || bare.starts_with(b"1.#")
                || bare.get(..3).is_some_and(|t| t.eq_ignore_ascii_case(b"nan") || t.eq_ignore_ascii_case(b"inf"));
            if absent { Ok(Some(f64::NAN)) } else { Err(fault) }
        })
    }

    /// The token at the cursor as a natural number below 10⁹ in digits alone; if it is none, the cursor stays.
    #[inline]
    pub fn small_natural(&mut self) -> Option<u32> {
        let text = &self.text[self.at..];
        let (mut value, mut length) = (0, 0);
        while let Some(digit) = text.get(length).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
            if length == 9 {
                return None;
            }
            value = 10 * value + u32::from(digit);
            length += 1;
        }
        if length == 0 || text.get(length).is_some_and(|&b| !is_blank(b)) {
            return None;
        }
        self.at += length;
        Some(value)
    }

    /// The next token of this line, a number that must be there.
    ///
    /// # Errors
    /// The line ends, or the token is no finite number.
    #[inline]
    pub fn expect_number(&mut self, what: &str) -> Result<f64, Fault> {
        match self.number()? {
            Some(value) => Ok(value),
            None => Err(self.fault(format!("{what} is missing"))),
        }
    }

    /// The rest of this line without surrounding blanks, comments included.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let start = self.at;
        while self.text.get(self.at).is_some_and(|&b| b != b'\n') {
            self.at += 1;
        }
        self.text[start..self.at].trim_ascii()
    }

    /// Moves behind the end of this line; `false` at the end of the text. A joined line ends where its last part does.
    #[inline]
    pub fn next_line(&mut self) -> bool {
        while let Some(&b) = self.text.get(self.at) {
            self.at += 1;
            if b == b'\n' {
                break;
            }
        }
        self.at < self.text.len()
    }

    /// Moves to the next token, over as many lines as it takes; `false` at the end of the text.
    pub fn seek_token(&mut self) -> bool {
        loop {
            if self.has_token() {
                return true;
            }
            if !self.next_line() {
                return false;
            }
        }
    }
}

#[inline]
fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c)
}

/// A token for an error message: printable and short.
pub(crate) fn show(token: &[u8]) -> String {
    let text = String::from_utf8_lossy(&token[..token.len().min(40)]);
    format!("\"{}\"", text.escape_debug())
}

/// Text of a file as it is meant: without byte order mark, and with line feeds where only carriage returns end lines.
pub(crate) fn normalized(bytes: &[u8]) -> std::borrow::Cow<'_, [u8]> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if !bytes.contains(&b'\n') && bytes.contains(&b'\r') {
        bytes.iter().map(|&b| if b == b'\r' { b'\n' } else { b }).collect::<Vec<_>>().into()
    } else {
        bytes.into()
    }
}
