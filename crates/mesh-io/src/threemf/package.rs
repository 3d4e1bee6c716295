//! The zip package around a 3MF model.

use crate::error::Fault;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// An archive may unpack to this much, or to [`MAX_RATIO`] times its own size. Model text packs some ten to thirty
/// times; a zip bomb a thousand times.
const MIN_BUDGET: u64 = 64 << 20;
const MAX_RATIO: u64 = 200;

/// An open package, with the number of bytes it may still unpack to.
pub(super) struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    budget: u64,
}

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self, Fault> {
        let archive = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| Fault::whole(format!("not a 3MF file: its zip package cannot be opened ({error})")))?;
        Ok(Self { archive, budget: MIN_BUDGET.max(MAX_RATIO * bytes.len() as u64) })
    }

    /// The text of one part, named from the package's root.
    pub fn text(&mut self, name: &str) -> Result<String, Fault> {
        let name = name.trim_start_matches('/');
        let fault = |reason: String| Fault::whole(format!("{name}: {reason}"));
        let file = self.archive.by_name(name).map_err(|error| fault(error.to_string()))?;
        let mut bytes = vec![];
        file.take(self.budget + 1).read_to_end(&mut bytes).map_err(|error| fault(error.to_string()))?;
        self.budget = self.budget.checked_sub(bytes.len() as u64).ok_or_else(|| {
            fault(format!("the package unpacks to more than {MAX_RATIO} times its size; it looks like a zip bomb"))
        })?;
        String::from_utf8(bytes).map_err(|_| fault("the text is not UTF-8".into()))
    }

    /// The name of the part that the package presents as its model.
    pub fn root_model(&mut self) -> Result<String, Fault> {
        let relations = self.text("_rels/.rels").unwrap_or_default();
        let mut reader = Reader::from_str(&relations);
        while let Ok(event) = reader.read_event() {
            match event {
                Event::Eof => break,
                Event::Start(tag) | Event::Empty(tag) if tag.local_name().as_ref() == "Relationship" => {
                    if attribute(&tag, "Type").is_some_and(|kind| kind.ends_with("/3dmodel"))
                        && let Some(target) = attribute(&tag, "Target")
                    {
                        return Ok(target);
                    }
                }
                _ => {}
            }
        }
        let mut models = self.archive.file_names().filter_map(Result::ok).filter(|name| name.ends_with(".model"));
        models.next().map(|name| name.to_string()).ok_or_else(|| Fault::whole("the package holds no model"))
    }
}

/// An attribute by its name without prefix, unescaped.
pub(super) fn attribute(tag: &BytesStart, name: &str) -> Option<String> {
    let mut attributes = tag.attributes();
    let found = attributes.with_checks(false).flatten().find(|a| a.key.local_name().as_ref() == name)?;
    Some(
        found.normalized_value(quick_xml::XmlVersion::Explicit1_0).map_or_else(|_| found.value.to_string(), Into::into),
    )
}
