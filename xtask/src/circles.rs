//! Files that import each other in a circle. Neither can be read, tested or moved without the other; what both need belongs in a third.
//!
//! Imports are the `use` statements outside of tests, followed through re-exports to the file that holds the item. A re-export is
//! no import, nor is `mod`.

use crate::{Fault, root, walk};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that still stand in a circle. Nothing may be added; a file that has left its circle must be taken off.
const STANDING: &[&str] = &[
    "crates/fusion/src/compose/adjust.rs",
    "crates/fusion/src/compose/constraints.rs",
    "crates/fusion/src/compose/lead.rs",
    "crates/fusion/src/compose/mod.rs",
    "crates/fusion/src/compose/openings.rs",
    "crates/fusion/src/compose/silhouette.rs",
    "crates/fusion/src/compose/surface.rs",
    "crates/fusion/src/compose/weld.rs",
    "crates/fusion/src/cut/keep.rs",
    "crates/fusion/src/cut/mod.rs",
    "crates/fusion/src/cut/section.rs",
    "crates/rolling-blend/src/corner.rs",
    "crates/rolling-blend/src/ending.rs",
    "crates/rolling-blend/src/error.rs",
    "crates/rolling-blend/src/keep/border.rs",
    "crates/rolling-blend/src/keep/domain.rs",
    "crates/rolling-blend/src/keep/mod.rs",
    "crates/rolling-blend/src/keep/region.rs",
    "crates/rolling-blend/src/keep/target.rs",
    "crates/rolling-blend/src/linkage.rs",
    "crates/rolling-blend/src/params.rs",
    "crates/rolling-blend/src/profiles.rs",
    "crates/rolling-blend/src/sew.rs",
    "crates/rolling-blend/src/sketch.rs",
    "crates/rolling-blend/src/strip.rs",
    "crates/rolling-blend/src/trouble.rs",
    "crates/spine/src/curve.rs",
    "crates/spine/src/error.rs",
    "crates/spine/src/offset.rs",
    "crates/spine/src/offset/moved.rs",
    "crates/spine/src/offset/sampling.rs",
    "crates/spine/src/patch.rs",
    "crates/spine/src/roll.rs",
];

/// Every circle with a file that is not listed, and every listed file that is in none.
pub fn faults() -> Result<Vec<String>, Fault> {
    let mut folders: Vec<PathBuf> = fs::read_dir(root().join("crates"))?.flatten().map(|e| e.path()).collect();
    folders.push(root().join("xtask"));
    folders.sort();
    let mut circles = vec![];
    for folder in folders {
        circles.extend(Sources::read(&folder.join("src"))?.circles());
    }
    let listed = |file: &String| STANDING.contains(&file.as_str());
    let new = circles.iter().filter(|circle| !circle.iter().all(listed));
    let new =
        new.map(|c| format!("{}: these files import each other; move what they share into another", c.join(", ")));
    let gone = STANDING.iter().filter(|file| !circles.iter().flatten().any(|f| f == *file));
    let gone =
        gone.map(|file| format!("{file}: is in no circle any more; take it off the list in xtask/src/circles.rs"));
    Ok(new.chain(gone).collect())
}

/// A module's path within its crate; that of the crate is empty.
type Module = Vec<String>;

/// A name that a `use` statement brings into a file.
struct Import {
    path: Vec<String>,
    name: String,
    is_export: bool,
}

/// The files of a crate, by module.
struct Sources {
    files: BTreeMap<Module, (String, Vec<Import>)>,
}

impl Sources {
    fn read(folder: &Path) -> Result<Self, Fault> {
        let mut paths = vec![];
        walk(folder, &mut paths);
        let mut files = BTreeMap::new();
        for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "rs")) {
            let inside = path.strip_prefix(folder)?.with_extension("");
            let mut module: Module = inside.iter().map(|s| s.to_string_lossy().into_owned()).collect();
            if module.last().is_some_and(|m| m == "mod" || m == "lib" || m == "main" && module.len() == 1) {
                module.pop();
            }
            let name = path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/");
            files.insert(module, (name, imports(&fs::read_to_string(path)?)));
        }
        Ok(Self { files })
    }

    /// The file that holds what `path` names, seen from `module`; `None` in another crate.
    fn holder(&self, module: &Module, path: &[String], depth: usize) -> Option<Module> {
        let mut base = module.clone();
        let mut rest = path;
        match rest.first().map(String::as_str) {
            Some("crate") => (base, rest) = (vec![], &rest[1..]),
            Some("self") => rest = &rest[1..],
            Some("super") => {
                while rest.first().is_some_and(|s| s == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            Some(child) if self.files.contains_key(&[base.as_slice(), &[child.to_owned()]].concat()) => {}
            _ => return None,
        }
        let whole = [base.as_slice(), rest].concat();
        let known = (0..=whole.len()).rev().find(|&n| self.files.contains_key(&whole[..n]))?;
        let (holder, left) = whole.split_at(known);
        let holder = holder.to_vec();
        // Re-exports and imports may lead on; they cannot do so for ever in code that compiles.
        let passed = left.first().and_then(|name| self.files[&holder].1.iter().find(|import| import.name == *name));
        match passed {
            Some(import) if depth < 16 => self.holder(&holder, &[&import.path[..], &left[1..]].concat(), depth + 1),
            _ => Some(holder),
        }
    }

    /// The files that each file imports from.
    fn arrows(&self) -> BTreeMap<&Module, Vec<Module>> {
        let of = |(module, (_, imports)): (&Module, &(String, Vec<Import>))| {
            let used = imports.iter().filter(|i| !i.is_export);
            used.filter_map(|i| self.holder(module, &i.path, 0)).filter(|m| m != module).collect()
        };
        self.files.iter().map(|entry| (entry.0, of(entry))).collect()
    }

    /// Groups of files each of which leads to every other, by name.
    fn circles(&self) -> Vec<Vec<String>> {
        let arrows = self.arrows();
        let reached = |from: &Module| {
            let (mut seen, mut stack) = (vec![], vec![from.clone()]);
            while let Some(module) = stack.pop() {
                for next in arrows.get(&module).into_iter().flatten() {
                    if !seen.contains(next) {
                        seen.push(next.clone());
                        stack.push(next.clone());
                    }
                }
            }
            seen
        };
        let reach: BTreeMap<&Module, Vec<Module>> = self.files.keys().map(|m| (m, reached(m))).collect();
        let mut circles: Vec<Vec<String>> = vec![];
        for (module, there) in reach.iter().filter(|(module, there)| there.contains(module)) {
            let back = there.iter().filter(|m| reach[m].contains(module));
            let mut circle: Vec<String> = back.map(|m| self.files[m].0.clone()).collect();
            circle.sort();
            if !circles.contains(&circle) {
                circles.push(circle);
            }
        }
        circles
    }
}

/// The names that a file's `use` statements bring in, those of its tests left aside.
fn imports(text: &str) -> Vec<Import> {
    let uncommented: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let uncommented = uncommented.join("\n");
    let code = uncommented.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let mut all = vec![];
    for statement in code.split(';') {
        let Some(at) = statement.rfind("use ") else { continue };
        // A visibility may stand before it on its line, and nothing else.
        let before = statement[..at].rsplit('\n').next().unwrap_or_default().trim();
        let is_export = before == "pub" || before.starts_with("pub(") && before.ends_with(')');
        if is_export || before.is_empty() {
            expand(&[], &statement[at + 4..], is_export, &mut all);
        }
    }
    all
}

/// A tree such as `a::{b, c::d as e}` as single paths.
fn expand(above: &[String], tree: &str, is_export: bool, all: &mut Vec<Import>) {
    let tree = tree.trim();
    if let Some((head, inner)) = tree.split_once('{').and_then(|(head, rest)| Some((head, rest.strip_suffix('}')?))) {
        let head = head.split("::").map(str::trim).filter(|s| !s.is_empty()).map(str::to_owned);
        let above: Vec<String> = above.iter().cloned().chain(head).collect();
        let (mut depth, mut start) = (0, 0);
        for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    expand(&above, &inner[start..at], is_export, all);
                    start = at + 1;
                }
                _ => {}
            }
        }
        return;
    }
    let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias.trim())));
    let own = path.split("::").map(str::trim).filter(|s| !s.is_empty() && *s != "*").map(str::to_owned);
    let mut path: Vec<String> = above.iter().cloned().chain(own).collect();
    if path.len() > 1 && path.last().is_some_and(|s| s == "self") {
        path.pop();
    }
    let Some(name) = alias.map(str::to_owned).or(path.last().cloned()) else { return };
    if !tree.is_empty() {
        all.push(Import { path, name, is_export });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(files: &[(&str, &str)]) -> Sources {
        let module = |name: &str| name.split('/').filter(|s| !s.is_empty()).map(str::to_owned).collect();
        Sources { files: files.iter().map(|(m, text)| (module(m), ((*m).to_owned(), imports(text)))).collect() }
    }

    #[test]
    fn circles_are_found_through_re_exports_and_over_several_files() {
        let all = sources(&[
            ("", "mod a;\nmod b;\npub use a::{A, part::Part};\n"),
            ("a", "mod part;\nuse crate::b::{self, C as D};\npub(crate) use part::Part;\n"),
            ("a/part", "//! use crate::Nothing;\nuse std::fmt;\n"),
            ("b", "use crate::\n    c::{x::Y};\nstruct B;\n"),
            ("c", "use super::A;\n#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n"),
        ]);
        assert_eq!(all.circles(), [["a", "b", "c"]]);
    }

    #[test]
    fn a_chain_is_no_circle() {
        let all = sources(&[
            ("", "mod a;\nmod b;\npub use a::A;\nuse b::B;\n"),
            ("a", "mod inner;\nuse inner::X;\nuse crate::b::B;\n"),
            ("a/inner", "use crate::b::{B};\n"),
            ("b", "use other::a::A;\n"),
        ]);
        assert!(all.circles().is_empty(), "{:?}", all.circles());
    }
}
