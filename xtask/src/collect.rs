//! The real models behind the tables in docs/, collected from clones of the repositories they come from.

use crate::{Fault, root};
use serde::Deserialize;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the models go.
#[derive(clap::Args)]
pub struct Options {
    /// The folder to fill; clones are looked for in DIR/clones/OWNER/REPOSITORY, packages in DIR/packages/NAME
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Clone the repositories that are not there
    #[arg(long)]
    clone: bool,
}

#[derive(Deserialize)]
struct List {
    model: Vec<Entry>,
}

/// One model, as fixtures/models.toml holds it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// Where it belongs.
    file: PathBuf,
    /// On GitHub.
    repository: Option<String>,
    commit: Option<String>,
    /// Registry, name and version, where it comes from no repository.
    package: Option<String>,
    /// Within the repository or package.
    path: Option<String>,
    /// What it was made of, where it is no original.
    derived: Option<String>,
    /// What it was converted from.
    converted: Option<String>,
    sha256: String,
}

/// Collects every model of fixtures/models.toml and fails if one is not there, or is not the one that was measured.
pub fn run(options: &Options) -> Result<(), Fault> {
    let list: List = toml::from_str(&fs::read_to_string(root().join("fixtures/models.toml"))?)?;
    let (mut there, mut wrong) = (0, 0);
    for entry in &list.model {
        match collect(entry, options) {
            Ok(()) => there += 1,
            Err(why) => {
                println!("models: {}: {why}", entry.file.display());
                wrong += 1;
            }
        }
    }
    println!("models: {there} of {} are in {}", list.model.len(), options.folder.display());
    if wrong == 0 { Ok(()) } else { Err(format!("{wrong} models are missing or differ").into()) }
}

fn collect(entry: &Entry, options: &Options) -> Result<(), Fault> {
    let place = options.folder.join(&entry.file);
    if let Ok(bytes) = fs::read(&place) {
        return check(entry, &bytes);
    }
    if let Some(what) = entry.derived.as_ref().or(entry.converted.as_ref()) {
        return Err(format!("is no original: made from {what}").into());
    }
    let bytes = match (&entry.repository, &entry.package, &entry.path) {
        (Some(repository), _, Some(path)) => {
            let commit = entry.commit.as_deref().unwrap_or("HEAD");
            from_clone(&clone_of(repository, options)?, commit, path)?
        }
        (None, Some(package), Some(path)) => from_package(package, path, &options.folder)?,
        _ => return Err("fixtures/models.toml does not say where it comes from".into()),
    };
    check(entry, &bytes)?;
    fs::create_dir_all(place.parent().unwrap_or(&options.folder))?;
    Ok(fs::write(&place, bytes)?)
}

fn check(entry: &Entry, bytes: &[u8]) -> Result<(), Fault> {
    let found = sha256(bytes);
    if found == entry.sha256 { Ok(()) } else { Err(format!("is another file: its SHA-256 is {found}").into()) }
}

/// The clone of a repository, made if need be and allowed.
fn clone_of(repository: &str, options: &Options) -> Result<PathBuf, Fault> {
    let clone = options.folder.join("clones").join(repository);
    if !clone.exists() {
        let address = format!("https://github.com/{repository}");
        if !options.clone {
            return Err(format!("there is no {}; `git clone {address}` it, or add --clone", clone.display()).into());
        }
        let status = Command::new("git").args(["clone", "--quiet", &address]).arg(&clone).status()?;
        if !status.success() {
            return Err(format!("git clone {address} failed").into());
        }
    }
    Ok(clone)
}

fn from_clone(clone: &Path, commit: &str, path: &str) -> Result<Vec<u8>, Fault> {
    let output = Command::new("git").arg("-C").arg(clone).args(["show", &format!("{commit}:{path}")]).output()?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    Err(String::from_utf8_lossy(&output.stderr).trim().to_string().into())
}

/// A file of a package that was unpacked by hand, at its path or below it.
fn from_package(package: &str, path: &str, folder: &Path) -> Result<Vec<u8>, Fault> {
    let name = package.split(' ').nth(1).unwrap_or(package);
    let unpacked = folder.join("packages").join(name);
    let mut files = vec![];
    crate::walk(&unpacked, &mut files);
    let found = files.iter().find(|f| f.ends_with(path));
    let found = found.ok_or_else(|| format!("unpack {package} into {}", unpacked.display()))?;
    Ok(fs::read(found)?)
}

/// The SHA-256 of some bytes in hexadecimal digits (FIPS 180-4).
fn sha256(bytes: &[u8]) -> String {
    let mut padded = bytes.to_vec();
    padded.push(0x80);
    padded.resize(padded.len().next_multiple_of(64), 0);
    if padded.len() - bytes.len() < 9 {
        padded.resize(padded.len() + 64, 0);
    }
    let end = padded.len() - 8;
    padded[end..].copy_from_slice(&(8 * bytes.len() as u64).to_be_bytes());
    let constants = fractions(64, f64::cbrt);
    let mut state = fractions(8, f64::sqrt);
    for block in padded.chunks_exact(64) {
        let mut w: Vec<u32> = block.chunks_exact(4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]])).collect();
        for i in 16..64 {
            let (a, b) = (w[i - 15], w[i - 2]);
            let low = a.rotate_right(7) ^ a.rotate_right(18) ^ (a >> 3);
            let high = b.rotate_right(17) ^ b.rotate_right(19) ^ (b >> 10);
            w.push(w[i - 16].wrapping_add(low).wrapping_add(w[i - 7]).wrapping_add(high));
        }
        let mut s = state.clone();
        for (word, constant) in w.into_iter().zip(&constants) {
            let mixed = s[4].rotate_right(6) ^ s[4].rotate_right(11) ^ s[4].rotate_right(25);
            let choice = (s[4] & s[5]) ^ (!s[4] & s[6]);
            let first = s[7].wrapping_add(mixed).wrapping_add(choice).wrapping_add(*constant).wrapping_add(word);
            let mixed = s[0].rotate_right(2) ^ s[0].rotate_right(13) ^ s[0].rotate_right(22);
            let majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
            s.rotate_right(1);
            s[4] = s[4].wrapping_add(first);
            s[0] = first.wrapping_add(mixed).wrapping_add(majority);
        }
        state.iter_mut().zip(s).for_each(|(a, b)| *a = a.wrapping_add(b));
    }
    state.iter().fold(String::new(), |mut text, word| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{word:08x}");
        text
    })
}

/// The first 32 bits of the fractions of roots of the first primes.
fn fractions(count: usize, root: fn(f64) -> f64) -> Vec<u32> {
    let is_prime = |n: &u32| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    (2..).filter(is_prime).take(count).map(|p| (root(f64::from(p)).fract() * 2f64.powi(32)) as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_the_standard() {
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert_eq!(sha256(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        let long = b"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
        assert_eq!(sha256(long), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    }

    #[test]
    fn the_list_can_be_read() {
        let text = fs::read_to_string(root().join("fixtures/models.toml")).unwrap();
        let list: List = toml::from_str(&text).unwrap();
        assert!(list.model.iter().all(|m| m.sha256.len() == 64));
    }
}
