//! Results kept: in memory up to a stated size, and in a folder where one is given.

use super::entry::Entry;
use super::key::{self, Key};
use super::store::Store;
use crate::join::First;
use mesh_io::Model;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

/// What steps have made, by all that it depends on, so that a step whose key is known is not taken again. Several threads may
/// share one, and several processes one folder.
#[derive(Debug)]
pub struct Cache {
    memory: Mutex<Memory>,
    /// Models that are in use somewhere, each with its key, so that it is not hashed for every evaluation.
    models: Mutex<Vec<(Weak<Model>, Key)>>,
    /// What booleans made before their seams were blended, the newest last.
    firsts: Mutex<Vec<(Key, Arc<OnceLock<First>>)>>,
    store: Option<Store>,
}

#[derive(Debug, Default)]
struct Memory {
    entries: HashMap<Key, Kept>,
    /// Bytes in all, and the most.
    size: usize,
    most: usize,
    /// Rises with every look.
    clock: u64,
}

#[derive(Debug)]
struct Kept {
    entry: Arc<Entry>,
    size: usize,
    /// When it was last looked at.
    at: u64,
}

/// Booleans that are kept on their way.
const FIRSTS: usize = 4;

/// Memory taken where nothing else is said.
const MOST: usize = 1 << 30;

impl Default for Cache {
    /// A gigabyte of memory for results, and no folder.
    fn default() -> Self {
        Self::in_memory(MOST)
    }
}

impl Cache {
    /// At most so many bytes of memory, about; 0 keeps nothing.
    pub fn in_memory(bytes: usize) -> Self {
        let memory = Mutex::new(Memory { most: bytes, ..Memory::default() });
        Self { memory, models: Mutex::default(), firsts: Mutex::default(), store: None }
    }

    /// The same, and a folder, which is made where there is none. Of its entries the oldest go once they take more bytes in all.
    /// What cannot be written or read there is done again, without a word.
    #[must_use]
    pub fn with_folder(self, folder: impl Into<PathBuf>, bytes: u64) -> Self {
        Self { store: Some(Store::new(folder.into(), bytes)), ..self }
    }

    /// What is known by a key.
    pub(super) fn get(&self, key: &Key) -> Option<Arc<Entry>> {
        if let Some(entry) = self.memory().get(key) {
            return Some(entry);
        }
        let entry = Arc::new(Entry::from_bytes(&self.store.as_ref()?.read(key)?)?);
        self.memory().put(*key, &entry);
        Some(entry)
    }

    /// Keeps what a step has made.
    pub(super) fn put(&self, key: Key, entry: &Arc<Entry>) {
        self.memory().put(key, entry);
        if let Some(store) = &self.store
            && let Some(bytes) = entry.to_bytes()
        {
            store.write(&key, &bytes);
        }
    }

    /// The key of a part.
    pub(super) fn key_of(&self, model: &Arc<Model>) -> Key {
        let known = |models: &[(Weak<Model>, Key)]| {
            // An address is not given to another model while this one is held.
            let same = models.iter().find(|(held, _)| std::ptr::eq(held.as_ptr(), Arc::as_ptr(model)));
            same.map(|&(_, key)| key)
        };
        if let Some(key) = known(&self.models.lock().unwrap_or_else(PoisonError::into_inner)) {
            return key;
        }
        let key = key::of_part(model);
        let mut models = self.models.lock().unwrap_or_else(PoisonError::into_inner);
        models.retain(|(held, _)| held.strong_count() > 0);
        models.push((Arc::downgrade(model), key));
        key
    }

    /// The place of what a boolean makes before its seams are blended, by all that this depends on. The last few are kept, whatever
    /// memory they take, as long as anything is.
    pub(super) fn first(&self, key: &Key) -> Arc<OnceLock<First>> {
        let mut firsts = self.firsts.lock().unwrap_or_else(PoisonError::into_inner);
        let known = firsts.iter().position(|(of, _)| of == key).map(|i| firsts.remove(i));
        let first = known.unwrap_or_else(|| (*key, Arc::default()));
        let place = Arc::clone(&first.1);
        if self.memory().most > 0 {
            firsts.push(first);
            let excess = firsts.len().saturating_sub(FIRSTS);
            firsts.drain(..excess);
        }
        place
    }

    fn memory(&self) -> std::sync::MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Memory {
    fn get(&mut self, key: &Key) -> Option<Arc<Entry>> {
        self.clock += 1;
        let kept = self.entries.get_mut(key)?;
        kept.at = self.clock;
        Some(Arc::clone(&kept.entry))
    }

    fn put(&mut self, key: Key, entry: &Arc<Entry>) {
        self.clock += 1;
        let (size, at) = (entry.size(), self.clock);
        let old = self.entries.insert(key, Kept { entry: Arc::clone(entry), size, at });
        self.size += size;
        self.size -= old.map_or(0, |old| old.size);
        while self.size > self.most {
            let Some(oldest) = self.entries.iter().min_by_key(|(_, kept)| kept.at).map(|(key, _)| *key) else { break };
            self.size -= self.entries.remove(&oldest).map_or(0, |kept| kept.size);
        }
    }
}
