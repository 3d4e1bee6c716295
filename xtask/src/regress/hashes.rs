//! The hashes that were last approved on Linux x86-64, compared bit for bit.
//!
//! Golden records hold on every platform and leave room for rounding. These hashes leave none, so they show which results a change
//! touched at all. Other platforms round `sin` and `cos` differently, and faer's kernels add up in the order of the processor's vectors;
//! there, the comparison is passed over.

use super::threads::Hashes;
use crate::{Fault, root};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// Compares with the approved hashes, or approves these; returns how many results differ.
pub fn run(now: &Hashes, bless: bool) -> Result<usize, Fault> {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        println!("regress: hashes are approved on Linux x86-64 only; not compared here");
        return Ok(0);
    }
    if bless {
        fs::write(path(), table(now, vectors()))?;
        return Ok(0);
    }
    let approved = fs::read_to_string(path()).map_err(|e| format!("{}: {e}", path().display()))?;
    let (on, hashes) = parse(&approved);
    if on != vectors() {
        println!("regress: hashes were approved on a processor with {on}, this one has {}; not compared", vectors());
        return Ok(0);
    }
    let faults = differences(now, &hashes);
    for fault in &faults {
        println!("regress: {fault}");
    }
    println!("regress: {} results compared bit for bit, {} faults", now.len(), faults.len());
    Ok(faults.len())
}

fn path() -> PathBuf {
    root().join("fixtures/hashes-linux-x64.tsv")
}

/// The widest vectors of this processor, on which the order of faer's sums depends.
fn vectors() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx512f") {
        return "avx512f";
    } else if std::arch::is_x86_feature_detected!("fma") {
        return "fma";
    }
    "sse2"
}

/// The file: the processor's vectors, then a line for each result.
fn table(hashes: &Hashes, vectors: &str) -> String {
    let lines = hashes.iter().map(|(name, hash)| format!("{name}\t{hash}\n"));
    format!("case\thash with {vectors}\n{}", lines.collect::<String>())
}

/// The processor's vectors and each result's hash.
fn parse(text: &str) -> (&str, BTreeMap<&str, &str>) {
    let mut lines = text.lines();
    let head = lines.next().unwrap_or_default();
    let vectors = head.rsplit(' ').next().unwrap_or_default();
    (vectors, lines.filter_map(|line| line.split_once('\t')).collect())
}

/// One sentence for every result that is new, gone or made of other bits.
fn differences(now: &Hashes, approved: &BTreeMap<&str, &str>) -> Vec<String> {
    const REMEDY: &str = "if that is meant, run `cargo xtask regress --bless`";
    let of = |(name, hash): (&String, &String)| match approved.get(name.as_str()) {
        Some(was) if was == hash => None,
        Some(was) => Some(format!("{name}: bits changed: hash {hash}, approved {was}; {REMEDY}")),
        None => Some(format!("{name}: has no approved hash; {REMEDY}")),
    };
    let gone = approved.keys().filter(|name| !now.contains_key(**name));
    let gone = gone.map(|name| format!("{name}: has an approved hash and was not run; {REMEDY}"));
    now.iter().filter_map(of).chain(gone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hashes(rows: &[(&str, &str)]) -> Hashes {
        rows.iter().map(|&(name, hash)| (name.to_owned(), hash.to_owned())).collect()
    }

    #[test]
    fn a_changed_a_new_and_a_missing_result_are_faults() {
        let approved = hashes(&[("kept", "01"), ("changed", "02"), ("gone", "03")]);
        let text = table(&approved, "fma");
        let (vectors, parsed) = parse(&text);
        assert_eq!(vectors, "fma");
        assert!(differences(&approved, &parsed).is_empty());
        let faults = differences(&hashes(&[("kept", "01"), ("changed", "09"), ("new", "04")]), &parsed);
        assert_eq!(faults.len(), 3, "{faults:?}");
        for name in ["changed", "new", "gone"] {
            assert!(faults.iter().any(|f| f.starts_with(name)), "{faults:?}");
        }
    }

    #[test]
    fn every_case_has_an_approved_hash() {
        let text = fs::read_to_string(path()).unwrap();
        let (_, approved) = parse(&text);
        for (name, _) in super::super::posed_parts().unwrap() {
            assert!(approved.contains_key(name.as_str()), "{name}");
        }
    }
}
