//! Settled beds, kept by content so that a second run starts at once.
//!
//! A bed lies in the folder `grouser/beds` of the user's cache (`$XDG_CACHE_HOME`, else `~/.cache`), or of
//! `$GROUSER_CACHE` when that is set; an empty `$GROUSER_CACHE` keeps none. The whole key stands in the file: a bed is used only
//! if every part of it agrees.

use crate::output::checkpoint;
use grouser_dem::Settled;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::env;
use std::path::PathBuf;

/// A settled bed and what it was made from.
#[derive(Serialize, Deserialize)]
struct Kept<B> {
    key: String,
    settled: Settled,
    bed: B,
}

/// The settled bed kept under `key`, if there is one.
pub fn find<B: DeserializeOwned>(key: &str) -> Option<(B, Settled)> {
    let kept: Kept<B> = checkpoint::read(&folder(key)?).ok()?;
    (kept.key == key).then_some((kept.bed, kept.settled))
}

/// Keeps a settled bed. A cache that cannot be written is no failure: the next run settles again.
pub fn keep<B: Serialize>(key: &str, bed: &B, settled: Settled) {
    if let Some(folder) = folder(key) {
        let kept = Kept { key: key.to_owned(), settled, bed };
        let _ = std::fs::create_dir_all(&folder).and_then(|()| checkpoint::write(&folder, &kept));
    }
}

fn folder(key: &str) -> Option<PathBuf> {
    let root = match env::var_os("GROUSER_CACHE") {
        Some(chosen) if chosen.is_empty() => return None,
        Some(chosen) => PathBuf::from(chosen),
        None => match env::var_os("XDG_CACHE_HOME").filter(|path| !path.is_empty()) {
            Some(cache) => PathBuf::from(cache).join("grouser"),
            None => PathBuf::from(env::var_os("HOME")?).join(".cache").join("grouser"),
        },
    };
    let (low, high) = (crc32fast::hash(key.as_bytes()), crc32fast::hash(&[key.as_bytes(), b"+"].concat()));
    Some(root.join("beds").join(format!("{low:08x}{high:08x}")))
}
