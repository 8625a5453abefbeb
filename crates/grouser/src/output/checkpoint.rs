//! The whole state of a run in one file: a versioned header with a checksum, then the state.
//!
//! The previous checkpoint stays until the new one lies complete on the disk, so that a kill at any moment leaves one
//! that is good.

use super::write_atomic;
use serde::{Serialize, de::DeserializeOwned};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const MAGIC: &[u8; 8] = b"GROUSER\n";
/// Raised with every change of what a state holds.
const VERSION: u32 = 5;
const HEADER: usize = 24;

/// Why a checkpoint cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// There is none.
    #[error(
        "{0} holds no checkpoint; expected a folder of an earlier run that was interrupted; remedy: run without --resume"
    )]
    Missing(PathBuf),
    /// None of those present is whole.
    #[error(
        "the checkpoint in {folder} cannot be used: {reason}; usual cause: {cause}; remedy: run without --resume"
    )]
    Broken {
        /// The run's folder.
        folder: PathBuf,
        /// What is wrong with it.
        reason: String,
        /// How this comes about.
        cause: &'static str,
    },
}

/// Writes a state as the folder's checkpoint.
pub fn write(folder: &Path, state: &impl Serialize) -> io::Result<()> {
    let payload = postcard::to_stdvec(state).map_err(io::Error::other)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(crc32fast::hash(&payload).to_le_bytes());
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(payload);
    let [newest, previous] = names(folder);
    // `next` is complete before the names move; between the two renames `previous` is the good one.
    let next = folder.join("checkpoint.next");
    write_atomic(&next, &bytes)?;
    if newest.exists() {
        fs::rename(&newest, &previous)?;
    }
    fs::rename(&next, &newest)
}

/// Reads the newest checkpoint that is whole.
pub fn read<S: DeserializeOwned>(folder: &Path) -> Result<S, CheckpointError> {
    let mut broken = None;
    for path in names(folder) {
        match fs::read(&path) {
            Err(_) => {}
            Ok(bytes) => match decode(&bytes) {
                Ok(state) => return Ok(state),
                Err(error) => broken = broken.or(Some(error)),
            },
        }
    }
    Err(match broken {
        None => CheckpointError::Missing(folder.to_owned()),
        Some((reason, cause)) => CheckpointError::Broken { folder: folder.to_owned(), reason, cause },
    })
}

/// Removes the checkpoints of a finished or new run.
pub fn remove(folder: &Path) {
    for path in names(folder) {
        let _ = fs::remove_file(path);
    }
}

fn names(folder: &Path) -> [PathBuf; 2] {
    [folder.join("checkpoint.bin"), folder.join("checkpoint.previous.bin")]
}

fn decode<S: DeserializeOwned>(bytes: &[u8]) -> Result<S, (String, &'static str)> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    if bytes.len() < HEADER || &bytes[..8] != MAGIC {
        return Err(("it is not a checkpoint".into(), "another program's file, or a damaged disk"));
    }
    if word(8) != VERSION {
        let reason = format!("it has version {}, expected {VERSION}", word(8));
        return Err((reason, "it was written by another version of grouser"));
    }
    let payload = &bytes[HEADER..];
    let length = u64::from_le_bytes(bytes[16..24].try_into().expect("eight bytes"));
    if payload.len() as u64 != length || crc32fast::hash(payload) != word(12) {
        return Err(("its checksum is wrong".into(), "a damaged disk or an incomplete copy"));
    }
    postcard::from_bytes(payload)
        .map_err(|error| (format!("it does not fit this scene: {error}"), "the scenario was changed"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_whole_checkpoint_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        assert!(matches!(read::<u64>(path), Err(CheckpointError::Missing(_))));
        write(path, &1_u64).unwrap();
        write(path, &2_u64).unwrap();
        assert_eq!(read::<u64>(path).unwrap(), 2);
        // A byte of the newest rots: the previous one serves.
        let newest = path.join("checkpoint.bin");
        let mut bytes = fs::read(&newest).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(&newest, &bytes).unwrap();
        assert_eq!(read::<u64>(path).unwrap(), 1);
        // Killed between the renames: only the previous one is there.
        fs::remove_file(&newest).unwrap();
        assert_eq!(read::<u64>(path).unwrap(), 1);
        remove(path);
        assert!(matches!(read::<u64>(path), Err(CheckpointError::Missing(_))));
    }

    #[test]
    fn no_damage_makes_the_reader_panic() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &vec![1.0_f64; 9]).unwrap();
        let good = fs::read(folder.path().join("checkpoint.bin")).unwrap();
        for i in 0..good.len() {
            let mut bad = good.clone();
            bad[i] ^= 0x55;
            assert!(decode::<Vec<f64>>(&bad).is_err(), "byte {i}");
            assert!(decode::<Vec<f64>>(&good[..i]).is_err(), "length {i}");
        }
    }
}
