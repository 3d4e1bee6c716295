//! Where jobs write: into a folder beside, which takes its name when the job has ended.

use crate::batch::outcome::Output;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Names that Windows keeps for devices.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// The folder's name for an id: letters, digits and `- _ . , = + @` stand for themselves, other bytes as `%` and two digits, as does a
/// `.` at either end and the first letter of a name that Windows keeps for itself.
pub fn name(id: &str) -> String {
    let lower = id.to_ascii_lowercase();
    let stem = lower.split('.').next().unwrap_or_default().trim_end_matches(|c: char| c.is_ascii_digit());
    let device = DEVICES.contains(&stem);
    let last = id.len().saturating_sub(1);
    let mut name = String::new();
    for (i, byte) in id.bytes().enumerate() {
        let dot_at_end = byte == b'.' && (i == 0 || i == last);
        if (byte.is_ascii_alphanumeric() || b"-_.,=+@".contains(&byte)) && !dot_at_end && !(device && i == 0) {
            name.push(char::from(byte));
        } else {
            // Writing into a text cannot fail.
            let _ = write!(name, "%{byte:02X}");
        }
    }
    name
}

/// The folder of all jobs' folders, as one batch uses it.
pub struct Folders {
    root: PathBuf,
    /// Starts the names of this batch's folders of unfinished jobs.
    prefix: String,
}

impl Folders {
    /// Where jobs of the batch that writes `results` go. Batches on other files, here or on other machines, get other names beside.
    pub fn new(root: &Path, results: &Path) -> Self {
        let place = fs::canonicalize(results).unwrap_or_else(|_| results.to_path_buf());
        let tag = blake3::hash(place.as_os_str().as_encoded_bytes()).to_hex();
        Self { root: root.to_path_buf(), prefix: format!(".fusion-{}-", &tag.as_str()[..12]) }
    }

    /// Removes what jobs left that were killed with their batch.
    pub fn sweep(&self) -> io::Result<()> {
        for entry in fs::read_dir(&self.root)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(&self.prefix) {
                fs::remove_dir_all(entry.path())?;
            }
        }
        Ok(())
    }

    /// An empty folder for the job at a place of the queue. A worker that has outlived its batch cannot meet it there.
    pub fn open(&self, place: usize) -> io::Result<PathBuf> {
        let folder = self.root.join(format!("{}{}-{place}", self.prefix, std::process::id()));
        fs::create_dir(&folder)?;
        Ok(folder)
    }

    /// Gives a finished job's folder its name, in the place of any older one.
    pub fn keep(&self, folder: &Path, id: &str) -> io::Result<PathBuf> {
        let place = self.root.join(name(id));
        match fs::remove_dir_all(&place) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
            _ => fs::rename(folder, &place)?,
        }
        Ok(place)
    }

    /// Whether a file can be written here now: where a disk is full, no job can be blamed.
    pub fn check(&self) -> io::Result<()> {
        let probe = self.root.join(format!("{}{}-probe", self.prefix, std::process::id()));
        let written = fs::write(&probe, vec![1; 1 << 16]);
        let _ = fs::remove_file(&probe);
        written
    }
}

/// The files in a folder and below, by name, with their hashes.
pub fn list(folder: &Path) -> io::Result<Vec<Output>> {
    let mut outputs = vec![];
    walk(folder, "", &mut outputs)?;
    outputs.sort_by(|a, b| a.file.cmp(&b.file));
    Ok(outputs)
}

fn walk(folder: &Path, above: &str, outputs: &mut Vec<Output>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let file = format!("{above}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            walk(&entry.path(), &format!("{file}/"), outputs)?;
        } else {
            let mut hasher = blake3::Hasher::new();
            let bytes = io::copy(&mut File::open(entry.path())?, &mut hasher)?;
            outputs.push(Output { file, bytes, blake3: hasher.finalize().to_hex().to_string() });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_and_tell_ids_apart() {
        for (id, expected) in [
            ("bolt-7_a.b", "bolt-7_a.b"),
            ("r=2%,n=3", "r=2%25,n=3"),
            ("../../etc", "%2E./../etc".replace('/', "%2F").as_str()),
            ("..", "%2E%2E"),
            (".", "%2E"),
            ("a/b\\c:d", "a%2Fb%5Cc%3Ad"),
            ("con.off", "%63on.off"),
            ("COM1", "%43OM1"),
            ("ä", "%C3%A4"),
            ("end.", "end%2E"),
        ] {
            assert_eq!(name(id), expected);
        }
    }

    #[test]
    fn a_folder_is_kept_in_place_of_an_older_one() {
        let root = tempfile::tempdir().unwrap();
        let folders = Folders::new(root.path(), Path::new("r.jsonl"));
        for text in ["old", "new"] {
            let folder = folders.open(3).unwrap();
            fs::create_dir(folder.join("sub")).unwrap();
            fs::write(folder.join("sub/x.off"), text).unwrap();
            assert!(folders.keep(&folder, "job").unwrap().ends_with("job"));
        }
        let outputs = list(&root.path().join("job")).unwrap();
        assert_eq!((outputs.len(), outputs[0].file.as_str(), outputs[0].bytes), (1, "sub/x.off", 3));
        assert_eq!(outputs[0].blake3, blake3::hash(b"new").to_hex().to_string());
        folders.open(4).unwrap();
        Folders::new(root.path(), Path::new("other.jsonl")).sweep().unwrap();
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 2);
        folders.sweep().unwrap();
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
    }
}
