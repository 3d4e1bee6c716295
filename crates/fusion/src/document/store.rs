//! A folder of entries, shared by processes.
//!
//! An entry is written to a temporary file beside its place and renamed, so it is there as a whole or not at all. It is believed
//! only if its checksum and its key are right; what is not is done again and written anew.

use super::key::Key;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The first bytes of every entry.
const HEAD: &[u8] = b"fusion entry 1\n";
const EXTENSION: &str = "entry";
/// What a process that was ended in the middle of writing leaves, and for how long it is left alone.
const UNFINISHED: &str = "part";
const PATIENCE: Duration = Duration::from_secs(3600);

/// A folder of entries.
#[derive(Debug)]
pub(super) struct Store {
    folder: PathBuf,
    /// The most bytes in all.
    most: u64,
}

impl Store {
    pub(super) fn new(folder: PathBuf, most: u64) -> Self {
        Self { folder, most }
    }

    /// The bytes of an entry, if they are what was written.
    pub(super) fn read(&self, key: &Key) -> Option<Vec<u8>> {
        let path = self.place(key);
        let mut bytes = fs::read(&path).ok()?;
        let body = bytes.strip_prefix(HEAD)?.strip_prefix(&key[..])?;
        let (sum, payload) = body.split_at_checked(blake3::OUT_LEN)?;
        if *blake3::hash(payload).as_bytes() != *sum {
            return None;
        }
        let start = bytes.len() - payload.len();
        bytes.drain(..start);
        // What is used is young again. Failing to say so only ages it.
        let _ = fs::File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        Some(bytes)
    }

    /// Writes an entry; without a word where that fails.
    pub(super) fn write(&self, key: &Key, payload: &[u8]) {
        if self.try_write(key, payload).is_ok() {
            self.trim();
        }
    }

    fn try_write(&self, key: &Key, payload: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let mut file =
            tempfile::Builder::new().prefix(".fusion-").suffix(&format!(".{UNFINISHED}")).tempfile_in(&self.folder)?;
        for bytes in [HEAD, &key[..], blake3::hash(payload).as_bytes(), payload] {
            file.write_all(bytes)?;
        }
        file.persist(self.place(key)).map(drop).map_err(|e| e.error)
    }

    fn place(&self, key: &Key) -> PathBuf {
        self.folder.join(format!("{}.{EXTENSION}", blake3::Hash::from_bytes(*key).to_hex()))
    }

    /// Removes the oldest entries while all take too much, and what was never finished.
    fn trim(&self) {
        let Ok(listing) = fs::read_dir(&self.folder) else { return };
        let mut entries = vec![];
        for file in listing.flatten() {
            let (path, Ok(about)) = (file.path(), file.metadata()) else { continue };
            let age = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            if ends_with(&path, EXTENSION) {
                entries.push((age, about.len(), path));
            } else if ends_with(&path, UNFINISHED) && age.elapsed().is_ok_and(|age| age > PATIENCE) {
                let _ = fs::remove_file(path);
            }
        }
        let mut all: u64 = entries.iter().map(|e| e.1).sum();
        entries.sort();
        for (_, size, path) in entries {
            if all <= self.most {
                break;
            }
            // Another process may have been faster.
            let _ = fs::remove_file(path);
            all -= size;
        }
    }
}

fn ends_with(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e == extension)
}
