//! The bytes behind a glTF file: the binary chunk, data URIs, and files in the same folder.

use super::json::Node;
use crate::error::Fault;
use crate::folder::Folder;
use base64::alphabet;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig, STANDARD};
use base64::engine::{DecodePaddingMode, Engine};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
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
            return Ok(percent_decode_str(payload).collect());
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
    percent_decode_str(uri).decode_utf8_lossy().into_owned()
}

/// What a relative URI may hold as it is.
const PLAIN: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~').remove(b'/');

/// A file name as a relative URI.
pub(super) fn percent_encoded(name: &str) -> String {
    utf8_percent_encode(name, PLAIN).to_string()
}

pub(super) fn to_base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Files in the wild have line breaks, no padding, either alphabet and bits to spare.
const LENIENT: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

fn from_base64(text: &[u8]) -> Option<Vec<u8>> {
    let standard = |b: &u8| match b {
        b'-' => b'+',
        b'_' => b'/',
        &b => b,
    };
    // Padding ends a run of digits, wherever it stands.
    let run = |run: &[u8]| {
        let mut digits: Vec<u8> = run.iter().filter(|b| !b.is_ascii_whitespace()).map(standard).collect();
        // A digit on its own at the end holds no whole byte.
        if digits.len() % 4 == 1 && alphabet::STANDARD.as_str().as_bytes().contains(&digits[digits.len() - 1]) {
            digits.pop();
        }
        LENIENT.decode(digits).ok()
    };
    let runs: Option<Vec<Vec<u8>>> = text.split(|b| *b == b'=').map(run).collect();
    runs.map(|r| r.concat())
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
        for text in ["Zm9v\r\nYg==", "Zm9vYg", "Zm9v Yh==", "Zm9vYg==A", "Zm9v=Yg"] {
            assert_eq!(from_base64(text.as_bytes()).as_deref(), Some(&b"foob"[..]), "{text}");
        }
        assert_eq!(from_base64(b"-_-_"), from_base64(b"+/+/"));
    }
}
