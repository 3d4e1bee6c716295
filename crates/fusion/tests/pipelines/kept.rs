//! Results of steps kept, in memory and in folders: never other than those of a fresh evaluation.

use crate::documents::{CUBES, bytes, evaluate, sources};
use fusion::Error;
use fusion::document::{Cache, Document, Evaluation, Precisions};
use fusion::mesh_core::{Watch, shapes};
use glam::DVec3;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A random edit of one option or switch.
#[derive(Clone, Debug)]
struct Edit(usize, usize, f64);

/// Numbers that look random, the same for the same seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        // The constants of Knuth's MMIX.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// From 0.05 to 0.45.
    fn share(&mut self) -> f64 {
        0.05 + 0.4 * (self.next() % 100_000) as f64 / 1e5
    }
}

/// A document of random steps on two cubes and a ball.
fn document_of(steps: &[(usize, f64)]) -> String {
    let mut text = format!("version = 2\n{CUBES}[[part]]\nname = \"c\"\nmesh = \"ball.off\"\nscale = 0.4\n");
    for &(kind, x) in steps {
        let step = match kind {
            0 => format!("[[step]]\ndo = \"pose\"\nof = \"b\"\ntranslate = [{x:?}, 0.031, 0.017]\n"),
            1 => format!("[[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]\nnear = [[{x:?}, 0, 0]]\n"),
            2 => format!("[[step]]\ndo = \"difference\"\nof = [\"a\", \"c\"]\nlonger = {x:?}\n"),
            3 => format!(
                "[[step]]\ndo = \"cut\"\nof = \"c\"\nplane = {{ point = [0, 0, {x:?}], normal = [0.1, 0, 1] }}\n"
            ),
            _ => format!("[[step]]\ndo = \"pose\"\nof = \"c\"\nscale = {:?}\nas = \"d\"\n", 1.0 + x),
        };
        text.push_str(&step);
    }
    text + "[[output]]\nof = \"a\"\nfile = \"a.off\"\n[[output]]\nof = \"c\"\nfile = \"c.stl\"\n"
}

fn apply(document: &mut Document, &Edit(step, what, x): &Edit) {
    let number = 1 + step % document.steps().len();
    let verb = document.steps()[number - 1].action.verb();
    let value = format!("{x:?}");
    let (option, value) = match (what, verb) {
        (0, _) => ("off", (x < 0.2).to_string()),
        (_, "pose") => ("scale", format!("{:?}", 1.0 + x)),
        (_, "cut") => ("plane.point", format!("[0, 0, {value}]")),
        (_, _) => ("longer", value),
    };
    document.set(&format!("{number}.{option}"), &value).unwrap();
}

/// With results kept in memory, in a folder, or in both, edits give the bytes of a fresh evaluation.
#[test]
fn kept_results_are_those_of_a_fresh_evaluation() {
    let (mut good, mut bad) = (0, 0);
    for seed in 0..8 {
        let mut random = Random(seed);
        let steps: Vec<_> = (0..2 + random.below(3)).map(|_| (random.below(5), random.share())).collect();
        let folder = tempfile::tempdir().unwrap();
        let caches = [Cache::default(), Cache::in_memory(20_000).with_folder(folder.path(), 1 << 30)];
        let mut document = Document::parse(&document_of(&steps)).unwrap();
        for _ in 0..5 {
            let made = evaluate(&document, &Cache::in_memory(0));
            *(if made.is_ok() { &mut good } else { &mut bad }) += 1;
            let fresh = bytes(&made);
            let text = document.to_toml();
            for cache in &caches {
                assert_eq!(bytes(&evaluate(&document, cache)), fresh, "{seed}: {text}");
            }
            let other = Cache::in_memory(0).with_folder(folder.path(), 1 << 30);
            assert_eq!(bytes(&evaluate(&document, &other)), fresh, "{seed}: {text}");
            let edit = Edit(random.below(6), random.below(3), random.share());
            apply(&mut document, &edit);
        }
    }
    assert!(good > 20, "{good} evaluations gave something, {bad} did not");
}

fn known(made: &Evaluation) -> Vec<bool> {
    made.steps.iter().map(|s| s.is_known).collect()
}

const CHAIN: &str = "[[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]\n[[step]]\ndo = \"pose\"\nof = \"a\"\nscale = 2\n[[step]]\ndo = \"cut\"\nof = \"a\"\nplane = { point = [0, 0, 0.1], normal = [0, 0, 1] }\n[[output]]\nof = \"a\"\nfile = \"a.off\"\n";

#[test]
fn an_edit_takes_only_what_it_touches() {
    let mut document = Document::parse(&format!("version = 2\n{CUBES}{CHAIN}")).unwrap();
    let cache = Cache::default();
    assert_eq!(known(&evaluate(&document, &cache).unwrap()), [false; 3]);
    assert_eq!(known(&evaluate(&document, &cache).unwrap()), [true; 3]);
    document.set("3.snap", "0.05").unwrap();
    assert_eq!(known(&evaluate(&document, &cache).unwrap()), [true, true, false]);
    document.set("2.scale", "3").unwrap();
    assert_eq!(known(&evaluate(&document, &cache).unwrap()), [true, false, false]);
    // The contents of a part count, not its name.
    let mut other = sources();
    other.0.insert("cube.off".into(), Arc::new(shapes::cuboid(DVec3::new(1.0, 1.0, 1.5)).into()));
    let made = document.evaluate_from(&mut other, &cache, Precisions::ByFile, &Watch::default()).unwrap();
    assert_eq!(known(&made), [false; 3]);
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    all.sort();
    all
}

/// Flipped, cut short, emptied, or another's: what is not what was written is done again, and written again.
#[test]
fn a_damaged_entry_is_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::parse(&format!("version = 2\n{CUBES}{CHAIN}")).unwrap();
    let cache = || Cache::in_memory(0).with_folder(folder.path(), 1 << 30);
    let fresh = evaluate(&document, &cache());
    let whole = bytes(&fresh);
    let all = entries(folder.path());
    // Three steps, and the pose of the second part.
    assert_eq!(all.len(), 4);
    let sound: Vec<_> = all.iter().map(|path| fs::read(path).unwrap()).collect();
    let damages: [&dyn Fn(usize) -> Vec<u8>; 5] = [
        &|i| sound[i].iter().enumerate().map(|(k, b)| if k == sound[i].len() / 2 { b ^ 1 } else { *b }).collect(),
        &|i| sound[i][..sound[i].len() - 7].to_vec(),
        &|_| vec![],
        &|i| sound[(i + 1) % 4].clone(),
        &|i| [&sound[i][..], b"more"].concat(),
    ];
    for damage in damages {
        for (i, path) in all.iter().enumerate() {
            fs::write(path, damage(i)).unwrap();
        }
        let made = evaluate(&document, &cache());
        assert_eq!(known(made.as_ref().unwrap()), [false; 3]);
        assert_eq!(bytes(&made), whole);
        let again = evaluate(&document, &cache());
        assert_eq!(known(again.as_ref().unwrap()), [true; 3]);
        assert_eq!(bytes(&again), whole);
    }
}

/// A folder that cannot be made costs nothing but time; one that is full keeps the newest.
#[test]
fn a_folder_has_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::parse(&format!("version = 2\n{CUBES}{CHAIN}")).unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    evaluate(&document, &Cache::default().with_folder(&file, 1 << 30)).unwrap();
    let inside = folder.path().join("inside");
    evaluate(&document, &Cache::default().with_folder(&inside, 0)).unwrap();
    assert!(entries(&inside).is_empty());
    evaluate(&document, &Cache::default().with_folder(&inside, 1 << 30)).unwrap();
    assert_eq!(entries(&inside).len(), 4);
}

/// A cancelled step leaves nothing behind that a later one could take for a result.
#[test]
fn a_cancelled_evaluation_keeps_only_whole_steps() {
    let document = Document::parse(&format!("version = 2\n{CUBES}{CHAIN}")).unwrap();
    let cache = Cache::default();
    let fresh = bytes(&evaluate(&document, &Cache::in_memory(0)));
    for steps in 1..40 {
        let left = std::sync::atomic::AtomicUsize::new(steps);
        let handle: Arc<std::sync::OnceLock<Watch>> = Arc::default();
        let inner = Arc::clone(&handle);
        let watch = Watch::new(move |_, _| {
            if left.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) == 1
                && let Some(watch) = inner.get()
            {
                watch.cancel();
            }
        });
        let _ = handle.set(watch.clone());
        let made = document.evaluate_from(&mut sources(), &cache, Precisions::ByFile, &watch);
        assert!(made.as_ref().is_ok() || made.as_ref().is_err_and(Error::is_cancelled));
    }
    assert_eq!(bytes(&evaluate(&document, &cache)), fresh);
}
