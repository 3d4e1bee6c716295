//! Parts of pages that are written by the machine, between two marks; the rest is written by hand.

use crate::{Fault, root};
use std::fs;

/// A part of a page.
pub struct Part {
    /// The page's path in the workspace.
    pub page: &'static str,
    /// The lines it stands between.
    pub marks: [&'static str; 2],
}

/// What the tables of documents take.
pub const DOCUMENTS: Part = Part {
    page: "docs/documents.md",
    marks: ["<!-- keys: written by cargo xtask reference -->", "<!-- end of keys -->"],
};

impl Part {
    /// Puts a text into its place.
    pub fn renew(&self, text: &str) -> Result<(), Fault> {
        let [before, _, after] = self.split()?;
        Ok(fs::write(root().join(self.page), format!("{before}{}\n{text}{}{after}", self.marks[0], self.marks[1]))?)
    }

    /// Whether this text stands there.
    pub fn holds(&self, text: &str) -> Result<bool, Fault> {
        // Git may have turned the ends of lines into those of the system.
        Ok(self.split()?[1].replace('\r', "") == format!("\n{text}"))
    }

    fn split(&self) -> Result<[String; 3], Fault> {
        let text = fs::read_to_string(root().join(self.page))?;
        let marked = || {
            let (before, rest) = text.split_once(self.marks[0])?;
            let (between, after) = rest.split_once(self.marks[1])?;
            Some([before, between, after].map(str::to_string))
        };
        marked().ok_or_else(|| format!("{} has lost its marks {:?}", self.page, self.marks).into())
    }
}
