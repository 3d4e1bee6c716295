//! A job done again whenever one of its files is saved.

use crate::failure::Failure;
use crate::options::Read;
use crate::session::Session;
use fusion::document::Sources;
use fusion::mesh_core::{TriMesh, Watch};
use fusion::operation::Files;
use mesh_io::Model;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};

/// How often files are looked at.
const PAUSE: Duration = Duration::from_millis(200);

/// Files that are read, noted by their paths.
pub struct Watched<'a> {
    inner: Read<'a>,
    folder: &'a Path,
    seen: &'a mut Seen,
}

impl<'a> Watched<'a> {
    /// Notes in `seen` what `inner` reads, which takes paths relative to `folder`.
    pub fn new(inner: Read<'a>, folder: &'a Path, seen: &'a mut Seen) -> Self {
        Self { inner, folder, seen }
    }

    fn note(&mut self, path: &Path) {
        self.seen.note(self.folder.join(path));
    }
}

impl Sources for Watched<'_> {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        self.note(path);
        self.inner.model(path)
    }
}

impl Files for Watched<'_> {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        self.note(path);
        self.inner.text(path)
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.note(path);
        self.inner.mesh(path)
    }
}

/// When a file was saved, and how long it is; `None` for one that is not there.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(file: &Path) -> Stamp {
    fs::metadata(file).ok().and_then(|about| Some((about.modified().ok()?, about.len())))
}

/// Files, each as it was just before it was read.
#[derive(Clone, Default)]
pub struct Seen(Vec<(PathBuf, Stamp)>);

impl Seen {
    fn note(&mut self, path: PathBuf) {
        if self.0.iter().all(|(known, _)| *known != path) {
            let stamp = stamp(&path);
            self.0.push((path, stamp));
        }
    }

    fn is_current(&self) -> bool {
        self.0.iter().all(|(path, known)| stamp(path) == *known)
    }
}

/// Does a job, and again after every save of `file` or of one that the job has seen, until Ctrl-C. A save while the job is under
/// way ends it, and it begins anew. What fails is told, and waits for the next save.
pub fn follow(
    session: &Session,
    file: &Path,
    job: impl Fn(&mut Seen, &Watch) -> Result<String, Failure>,
) -> Result<(), Failure> {
    let mut others = Seen::default();
    loop {
        let start = Instant::now();
        let mut seen = Seen::default();
        seen.note(file.to_path_buf());
        // What the last job has seen may be seen again; until it is, its newest save is looked out for.
        let mut eyed = seen.clone();
        others.0.iter().for_each(|(path, _)| eyed.note(path.clone()));
        let outer = session.watch().clone();
        let watch = Watch::new(move |stage, share| {
            let _ = outer.step(stage, share);
        });
        let done = AtomicBool::new(false);
        let result = std::thread::scope(|scope| {
            let eye = scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    if !eyed.is_current() {
                        watch.cancel();
                    }
                    std::thread::park_timeout(PAUSE);
                }
            });
            let result = job(&mut seen, &watch);
            done.store(true, Ordering::Relaxed);
            eye.thread().unpark();
            result
        });
        session.watch().step("wait", 0.0).map_err(|_| Failure::cancelled())?;
        let begins_anew = result.as_ref().is_err_and(Failure::is_cancelled);
        match result {
            Err(_) if begins_anew => {}
            Err(failure) => failure.say(),
            Ok(done) => {
                session.tell(&format!("{}: {done}, in {:.2} s", file.display(), start.elapsed().as_secs_f64()));
            }
        }
        while !begins_anew && seen.is_current() {
            session.watch().step("wait", 0.0).map_err(|_| Failure::cancelled())?;
            std::thread::sleep(PAUSE);
        }
        others = seen;
    }
}
