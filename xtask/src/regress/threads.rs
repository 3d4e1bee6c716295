//! The same job on one thread and on two: every bit of the result must agree. The hashes are kept as a file, so that machines and
//! builds can be compared, and the results themselves where they are to be compared with those of another build.

use super::against::Against;
use crate::{Fault, root};
use mesh_core::TriMesh;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

/// The hash of each result by the name of its case.
pub type Hashes = BTreeMap<String, String>;

/// Pools of one and of two threads, and the hash of every result so far.
pub struct Threads {
    pools: [rayon::ThreadPool; 2],
    hashes: String,
    approved: Hashes,
    against: Option<Against>,
}

impl Threads {
    /// Starts both pools. Results are compared with those of another build where there is one.
    pub fn new(against: Option<Against>) -> Result<Self, Fault> {
        let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build();
        Ok(Self { pools: [pool(1)?, pool(2)?], hashes: String::new(), approved: Hashes::new(), against })
    }

    /// Does a job in both pools and gives the result of the second, and a sentence if they differ.
    pub fn twice<T: Send>(
        &mut self,
        name: &str,
        job: impl Fn() -> T + Sync,
        mesh: impl Fn(&T) -> Option<&TriMesh>,
    ) -> (T, Option<String>) {
        let [one, two] = [&self.pools[0], &self.pools[1]].map(|pool| pool.install(&job));
        let hashes = [&one, &two].map(|made| mesh(made).map(hash));
        let [first, second] = hashes.map(|h| h.map_or_else(|| "none".to_string(), |h| format!("{h:016x}")));
        let fault = (first != second).then(|| format!("gives {first} on one thread and {second} on two"));
        let _ = writeln!(self.hashes, "{name}\t{first}\t{second}");
        self.approved.insert(name.to_owned(), second);
        if let (Some(against), Some(mesh)) = (&mut self.against, mesh(&two)) {
            against.add(name, mesh);
        }
        (two, fault)
    }

    /// Writes the hashes to `target/regress/hashes-BUILD.tsv` and gives them.
    pub fn finish(self) -> Result<Hashes, Fault> {
        let folder = root().join("target/regress");
        fs::create_dir_all(&folder)?;
        let build = if cfg!(debug_assertions) { "debug" } else { "release" };
        let path = folder.join(format!("hashes-{build}.tsv"));
        fs::write(&path, format!("case\tone thread\ttwo threads\n{}", self.hashes))?;
        println!("regress: hashes of {} results in {}", self.hashes.lines().count(), path.display());
        if let Some(against) = self.against {
            against.finish()?;
        }
        Ok(self.approved)
    }
}

/// FNV-1a over all coordinates' bits and all corners.
fn hash(mesh: &TriMesh) -> u64 {
    let places = mesh.positions.iter().flat_map(glam::DVec3::to_array).flat_map(|x| x.to_bits().to_le_bytes());
    let corners = mesh.faces.iter().flatten().flat_map(|v| v.0.to_le_bytes());
    places
        .chain(corners)
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
