//! The document kept while it is not saved, on a thread of its own.

use crate::desk::{AUTOSAVE, EARLIER};
use crate::root::Root;
use std::io;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};

/// Writes the newest text.
#[derive(Debug)]
pub struct Autosave {
    texts: Sender<Option<String>>,
}

impl Autosave {
    /// Starts the thread, which ends with its owner.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(root: Root) -> io::Result<Self> {
        let (texts, incoming) = channel::<Option<String>>();
        std::thread::Builder::new().name("autosave".into()).spawn(move || {
            while let Ok(mut text) = incoming.recv() {
                while let Ok(newer) = incoming.try_recv() {
                    text = newer;
                }
                // A folder that cannot be written to must not stop the work: saving says so.
                let _ = keep(&root, text.as_deref());
            }
        })?;
        Ok(Self { texts })
    }

    /// Keeps a text; `None` once there is nothing that could be lost.
    pub fn keep(&self, text: Option<String>) {
        let _ = self.texts.send(text);
    }
}

/// Moves what an earlier session left to a place of its own, so that this one does not write over it.
pub fn put_aside(root: &Root) -> Option<&'static str> {
    let file = root.existing("", Path::new(AUTOSAVE)).ok()?;
    let place = root.place("", Path::new(EARLIER)).ok()?;
    std::fs::rename(file, place).ok().map(|()| EARLIER)
}

fn keep(root: &Root, text: Option<&str>) -> Option<()> {
    let folder = Path::new(AUTOSAVE).parent()?;
    let Some(text) = text else {
        let file = root.existing("", Path::new(AUTOSAVE)).ok()?;
        return std::fs::remove_file(file).ok();
    };
    // Checked before anything is made: the folder may be a link.
    root.place("", folder).ok()?;
    std::fs::create_dir_all(root.folder().join(folder)).ok()?;
    root.write(Path::new(AUTOSAVE), text.as_bytes()).ok()
}
