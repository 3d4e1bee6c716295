//! The bytes behind a glTF file: the binary chunk, data URIs, and files in the same folder.

use super::json::Node;
use crate::error::Fault;
use crate::folder::Folder;
use std::borrow::Cow;

/// The chunks of a GLB file: JSON, and the binary one if there is any.
pub(super) fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let word = |at: usize| {
        let raw =
            bytes.get(at..at + 4).ok_or_else(|| Fault::binary(bytes.len(), "the file ends inside a chunk head"))?;
        Ok::<_, Fault>(u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]]) as usize)
    };
    let version = word(4)?;
    if version != 2 {
        return Err(Fault::binary(4, format!("glTF version {version}; only version 2 is supported")));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at + 8 <= bytes.len() && (json.is_none() || binary.is_none()) {
        let (length, kind) = (word(at)?, &bytes[at + 4..at + 8]);
        let data = bytes.get(at + 8..).and_then(|rest| rest.get(..length)).ok_or_else(|| {
            let left = bytes.len() - at - 8;
            Fault::binary(at, format!("a chunk of {length} bytes, where {left} are left"))
        })?;
        match kind {
            b"JSON" if json.is_none() => json = Some(data),
            b"BIN\0" if binary.is_none() => binary = Some(data),
            _ => {}
        }
        at += 8 + length;
    }
    json.map(|json| (json, binary)).ok_or_else(|| Fault::binary(12, "there is no JSON chunk"))
}

/// Every buffer, loaded when first asked for.
pub(super) struct Buffers<'a> {
    document: &'a Node<'a>,
    binary: Option<&'a [u8]>,
    folder: &'a Folder,
    loaded: Vec<Option<Cow<'a, [u8]>>>,
}

impl<'a> Buffers<'a> {
    pub fn new(document: &'a Node<'a>, binary: Option<&'a [u8]>, folder: &'a Folder) -> Result<Self, Fault> {
        let count = document.get("buffers").items()?.len();
        Ok(Self { document, binary, folder, loaded: vec![None; count] })
    }

    /// The bytes of a buffer view.
    pub fn view(&mut self, index: usize) -> Result<(&[u8], Node<'a>), Fault> {
        let view = self.document.get("bufferViews").item(index)?;
        if !view.get("extensions").get("EXT_meshopt_compression").is_absent() {
            return Err(view.fault("EXT_meshopt_compression is not supported; decompress the file first"));
        }
        let buffer = view.get("buffer").expect_index()?;
        let start = view.get("byteOffset").index()?.unwrap_or(0);
        let length = view.get("byteLength").expect_index()?;
        let bytes = self.buffer(buffer)?;
        let held = bytes.len();
        match start.checked_add(length).and_then(|end| bytes.get(start..end)) {
            Some(bytes) => Ok((bytes, view)),
            None => Err(view.fault(&format!("bytes {start} to {start} + {length} of a buffer that has {held}"))),
        }
    }

    fn buffer(&mut self, index: usize) -> Result<&[u8], Fault> {
        let buffer = self.document.get("buffers").item(index)?;
        if self.loaded[index].is_none() {
            self.loaded[index] = Some(match buffer.get("uri").text() {
                None if index == 0 && self.binary.is_some() => self.binary.unwrap_or_default().into(),
                None => return Err(buffer.fault("the buffer has neither a URI nor a binary chunk")),
                Some(uri) => load(uri, self.folder).map_err(|reason| buffer.fault(&reason))?.into(),
            });
        }
        Ok(self.loaded[index].as_deref().unwrap_or_default())
    }
}

/// The bytes that a URI names: inside itself, or in the folder.
pub(super) fn load(uri: &str, folder: &Folder) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, payload) = data.split_once(',').ok_or("a data URI without a comma")?;
        if !kind.ends_with(";base64") {
            return Ok(percent_decoded(payload));
        }
        return from_base64(payload.as_bytes()).ok_or_else(|| "a data URI that is not base64".into());
    }
    let shown: String = uri.chars().take(80).collect();
    let name = file_name(uri);
    let path = folder.find(&name).map_err(|reason| format!("{shown:?}: {reason}"))?;
    std::fs::read(path).map_err(|error| format!("{shown:?}: {error}"))
}

/// A relative URI as a file name.
pub(super) fn file_name(uri: &str) -> String {
    String::from_utf8_lossy(&percent_decoded(uri)).into_owned()
}

fn percent_decoded(text: &str) -> Vec<u8> {
    let hex = |b: u8| char::from(b).to_digit(16).map(|d| d as u8);
    let (bytes, mut out, mut at) = (text.as_bytes(), vec![], 0);
    while at < bytes.len() {
        let pair = bytes.get(at + 1..at + 3).and_then(|p| Some(16 * hex(p[0])? + hex(p[1])?));
        if let Some(byte) = pair.filter(|_| bytes[at] == b'%') {
            out.push(byte);
            at += 3;
        } else {
            out.push(bytes[at]);
            at += 1;
        }
    }
    out
}

/// A file name as a relative URI.
pub(super) fn percent_encoded(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~/".contains(&b);
    name.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

pub(super) fn to_base64(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = [0, 1, 2].iter().fold(0u32, |w, &i| w << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * i)) as usize & 63];
            out.push(if i <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    out
}

fn from_base64(text: &[u8]) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut word, mut bits) = (0u32, 0);
    for &b in text.iter().filter(|b| !b.is_ascii_whitespace() && **b != b'=') {
        let digit = match b {
            b'A'..=b'Z' => b - b'A',
            b'a'..=b'z' => b - b'a' + 26,
            b'0'..=b'9' => b - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        word = word << 6 | u32::from(digit);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn base64_round_trip(bytes: Vec<u8>) {
            prop_assert_eq!(from_base64(to_base64(&bytes).as_bytes()), Some(bytes));
        }

        #[test]
        fn uri_round_trip(name in ".*") {
            prop_assert_eq!(file_name(&percent_encoded(&name)), name);
        }
    }

    #[test]
    fn base64_known_answers() {
        assert_eq!(
            ["", "f", "fo", "foo", "foob"].map(|s| to_base64(s.as_bytes())),
            ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]
        );
        assert_eq!(from_base64(b"Zg*="), None);
    }
}
