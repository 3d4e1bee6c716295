//! What a format's writer hands over: the file's bytes and the side files that go with it.

use crate::model::{Material, Texture, TextureSource};
use crate::notes::Notes;
use rayon::prelude::*;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file ready to be written.
#[derive(Default)]
pub(crate) struct Encoded {
    /// The file, in pieces.
    pub body: Vec<Vec<u8>>,
    pub sides: Vec<Side>,
    pub notes: Notes,
}

/// A side file, to lie in the folder of the named file.
pub(crate) struct Side {
    pub name: String,
    pub content: Content,
}

/// Bytes at hand, or a file to copy.
pub(crate) enum Content {
    Bytes(Vec<u8>),
    Shared(Arc<[u8]>),
    CopyOf(PathBuf),
}

/// The named file: where side files go and what their names begin with.
pub(crate) struct Target {
    pub folder: PathBuf,
    pub stem: String,
}

impl Target {
    pub fn of(path: &Path) -> Self {
        let parent = path.parent().unwrap_or(Path::new(""));
        let folder = if parent.as_os_str().is_empty() { PathBuf::from(".") } else { parent.to_path_buf() };
        // Side files are named inside the mesh file, so their names must be printable text.
        let stem = path.file_stem().map_or(String::new(), |s| clean_name(&s.to_string_lossy()));
        Self { folder, stem }
    }

    /// For each material, the name its picture will have beside the file, and the side files that takes. A picture
    /// already in the right place stays there.
    pub fn pictures(&self, materials: &[Material], sides: &mut Vec<Side>) -> Vec<Option<String>> {
        let mut named: Vec<(&TextureSource, String)> = vec![];
        let mut names = vec![];
        for material in materials {
            let Some(texture) = &material.texture else {
                names.push(None);
                continue;
            };
            let known = named.iter().find(|(source, _)| **source == texture.source);
            let name = match known.filter(|_| texture.source != TextureSource::Missing) {
                Some((_, name)) => name.clone(),
                None => self.place_picture(texture, sides),
            };
            named.push((&texture.source, name.clone()));
            names.push(Some(name));
        }
        names
    }

    fn place_picture(&self, texture: &Texture, sides: &mut Vec<Side>) -> String {
        let here = clean_name(&texture.name);
        let base = here.rsplit(['/', '\\']).next().unwrap_or_default();
        let mut beside = format!("{}_{base}", self.stem);
        while sides.iter().any(|s| s.name == beside) {
            beside.insert(0, '_');
        }
        let content = match &texture.source {
            TextureSource::Missing => return here,
            TextureSource::Embedded(bytes) => Content::Shared(bytes.clone()),
            TextureSource::File(from) => {
                let place = |path: &Path| path.canonicalize().ok();
                if place(&self.folder.join(&here)).is_some_and(|p| Some(p) == place(from)) {
                    return here;
                }
                Content::CopyOf(from.clone())
            }
        };
        sides.push(Side { name: beside.clone(), content });
        beside
    }
}

/// What a material without a name is called where a file must name it.
pub(crate) const UNNAMED: &str = "unnamed";

/// A name that fits on one line of a text file.
pub(crate) fn clean_name(name: &str) -> String {
    name.trim().chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

/// Names that fit on one line each and differ from each other, so that they can be referred to.
pub(crate) fn distinct_names<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut distinct = vec![];
    for (i, name) in names.enumerate() {
        let mut clean = clean_name(name);
        while !taken.insert(clean.clone()) {
            clean = format!("{clean}_{i}");
        }
        distinct.push(clean);
    }
    distinct
}

/// Bytes of `count` elements, made in parallel and joined in order.
pub(crate) fn in_pieces(count: usize, element: impl Fn(usize, &mut Vec<u8>) + Sync) -> Vec<Vec<u8>> {
    const CHUNK: usize = 1 << 13;
    (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|piece| {
            let mut out = Vec::with_capacity(CHUNK * 32);
            for i in piece * CHUNK..((piece + 1) * CHUNK).min(count) {
                element(i, &mut out);
            }
            out
        })
        .collect()
}
