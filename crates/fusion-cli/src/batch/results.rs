//! The file of results: locked, only appended to, cut where its last line is torn.

use crate::batch::outcome::Outcome;
use crate::failure::Failure;
use crate::output::is_special;
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// An open file of results.
pub struct Results {
    file: File,
    path: PathBuf,
    /// Bytes of finished lines; `None` for a device or pipe.
    length: Option<u64>,
}

/// What was there before.
#[derive(Default)]
pub struct Before {
    /// Finished jobs, by id.
    pub outcomes: BTreeMap<String, Outcome>,
    /// Bytes of a torn line that were cut off.
    pub torn: usize,
    /// Where older results went.
    pub moved: Option<PathBuf>,
}

impl Results {
    /// Opens a new file; older results get another name.
    pub fn create(path: &Path) -> Result<(Self, Before), Failure> {
        let mut before = Before::default();
        if !is_special(path) && fs::metadata(path).is_ok_and(|m| m.len() > 0) {
            // Refused while another batch writes it.
            let _locked = open(path)?;
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let free = |n: &usize| !path.with_file_name(format!("{name}.{n}")).exists();
            let moved = path.with_file_name(format!("{name}.{}", (1..1_000_000).find(free).unwrap_or_default()));
            fs::rename(path, &moved).map_err(|e| cannot_write(&moved, &e))?;
            before.moved = Some(moved);
        }
        let file = open(path)?;
        let length = (!is_special(path)).then_some(0);
        Ok((Self { file, path: path.into(), length }, before))
    }

    /// Opens a file to go on with. Its finished lines stay as they are.
    pub fn resume(path: &Path) -> Result<(Self, Before), Failure> {
        if is_special(path) {
            return Err(Failure::usage(format!("--resume needs a file, which {} is not", path.display())));
        }
        let mut file = open(path)?;
        let mut bytes = vec![];
        file.read_to_end(&mut bytes).map_err(|e| unreadable(path, &e))?;
        let finished = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |end| end + 1);
        let outcomes = read(&bytes[..finished], path)?;
        let torn = bytes.len() - finished;
        if torn > 0 {
            file.set_len(finished as u64).map_err(|e| cannot_write(path, &e))?;
        }
        Ok((Self { file, path: path.into(), length: Some(finished as u64) }, Before { outcomes, torn, moved: None }))
    }

    /// Appends a line, whole or not at all.
    pub fn append(&mut self, outcome: &Outcome) -> Result<(), Failure> {
        let line = outcome.line();
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // Should this fail as well, the next batch cuts the line off.
            if let Some(length) = self.length {
                let _ = self.file.set_len(length);
            }
            let failure = format!("cannot write {}: {error}; --resume goes on from here", self.path.display());
            return Err(Failure::unwritable(failure));
        }
        self.length = self.length.map(|length| length + line.len() as u64);
        Ok(())
    }
}

/// Reads a finished file of results, whose last line may be torn.
pub fn read_file(path: &Path) -> Result<Vec<Outcome>, Failure> {
    let bytes = fs::read(path).map_err(|e| unreadable(path, &e))?;
    let finished = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |end| end + 1);
    Ok(read(&bytes[..finished], path)?.into_values().collect())
}

fn read(bytes: &[u8], path: &Path) -> Result<BTreeMap<String, Outcome>, Failure> {
    let mut outcomes = BTreeMap::new();
    for (i, line) in bytes.split(|b| *b == b'\n').enumerate().filter(|(_, line)| !line.trim_ascii().is_empty()) {
        let place = format!("{}: line {}", path.display(), i + 1);
        let outcome: Outcome = serde_json::from_slice(line)
            .map_err(|e| Failure::unreadable(format!("{place} is no result of a job: {e}; nothing was changed")))?;
        let id = outcome.id.clone();
        if outcomes.insert(id.clone(), outcome).is_some() {
            return Err(Failure::unreadable(format!(
                "{place} is a second result of the job `{id}`; nothing was changed"
            )));
        }
    }
    Ok(outcomes)
}

/// Opens for appending, and keeps others out as long as the file is open.
fn open(path: &Path) -> Result<File, Failure> {
    let special = is_special(path);
    let file = OpenOptions::new().read(!special).append(true).create(!special).open(path);
    let file = file.map_err(|e| cannot_write(path, &e))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) if !special => {
            Err(Failure::unwritable(format!("cannot write {}: another batch is writing it", path.display())))
        }
        // Some network file systems know no locks.
        _ => Ok(file),
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::unwritable(format!("cannot write {}: {error}", path.display()))
}

fn unreadable(path: &Path, error: &std::io::Error) -> Failure {
    let hint = if error.kind() == ErrorKind::NotFound { "; `batch` writes such a file" } else { "" };
    Failure::unreadable(format!("cannot read {}: {error}{hint}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::outcome::{State, error};

    fn outcome(id: &str) -> Outcome {
        Outcome::told(id, State::Failed, 4, 1.5, error("impossible", "no\nway", None))
    }

    /// Cut anywhere, what was finished stays byte for byte, and what was not can be written again.
    #[test]
    fn a_torn_line_is_cut_off() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.jsonl");
        let whole = outcome("a").line() + &outcome("b").line();
        let first = outcome("a").line().len();
        for cut in 0..=whole.len() {
            fs::write(&path, &whole[..cut]).unwrap();
            let (mut results, before) = Results::resume(&path).unwrap();
            let kept = [0, first, whole.len()].into_iter().rfind(|end| *end <= cut).unwrap();
            assert_eq!(
                (before.outcomes.len(), before.torn),
                ([0, first, whole.len()].iter().position(|e| *e == kept).unwrap(), cut - kept)
            );
            results.append(&outcome("c")).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), whole[..kept].to_string() + &outcome("c").line());
        }
    }

    #[test]
    fn one_batch_writes_a_file_at_a_time_and_none_loses_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.jsonl");
        let (mut results, _) = Results::create(&path).unwrap();
        results.append(&outcome("a")).unwrap();
        assert!(Results::resume(&path).err().unwrap().to_string().contains("another batch"));
        assert!(Results::create(&path).err().unwrap().to_string().contains("another batch"));
        drop(results);
        let (_, before) = Results::create(&path).unwrap();
        assert_eq!(fs::read_to_string(before.moved.unwrap()).unwrap(), outcome("a").line());
        assert_eq!(fs::read_to_string(&path).unwrap(), "");
    }

    #[test]
    fn lines_that_are_no_results_or_come_twice_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.jsonl");
        for (text, words) in [
            (outcome("a").line() + "{\"id\": 3}\n", "line 2 is no result"),
            (outcome("a").line() + &outcome("a").line(), "line 2 is a second result of the job `a`"),
        ] {
            fs::write(&path, &text).unwrap();
            assert!(Results::resume(&path).err().unwrap().to_string().contains(words));
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_error() {
        let (mut results, _) = Results::create(Path::new("/dev/full")).unwrap();
        let failure = results.append(&outcome("a")).unwrap_err();
        assert_eq!(failure.code(), 6);
    }
}
