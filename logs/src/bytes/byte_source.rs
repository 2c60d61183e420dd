//! Source of a file's bytes: a disk, or memory, as in a browser.

use std::{
    fs::{self, File},
    io::{Cursor, Read, Result, Seek, SeekFrom},
    path::{Path, PathBuf},
    sync::Arc,
};

use bytes::Bytes;
use parquet::{
    errors::{ParquetError, Result as ParquetResult},
    file::reader::{ChunkReader, Length},
};

/// Source of a file's bytes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ByteSource {
    /// In a file of this path.
    Disk(PathBuf),
    /// Shared bytes in memory.
    Memory(Arc<[u8]>),
}

/// A file that is being read.
#[derive(Debug)]
pub(crate) enum Opened {
    Disk(File),
    Memory(Cursor<Arc<[u8]>>),
}

impl ByteSource {
    /// The file at a path.
    pub(crate) fn at(path: &Path) -> Self {
        Self::Disk(path.to_owned())
    }

    /// Opens the file for reading.
    ///
    /// # Errors
    /// A file that cannot be opened.
    pub(crate) fn open(&self) -> Result<Opened> {
        Ok(match self {
            Self::Disk(path) => Opened::Disk(File::open(path)?),
            Self::Memory(bytes) => Opened::Memory(Cursor::new(Arc::clone(bytes))),
        })
    }

    /// Reads all bytes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn read(&self) -> Result<Vec<u8>> {
        match self {
            Self::Disk(path) => fs::read(path),
            Self::Memory(bytes) => Ok(bytes.to_vec()),
        }
    }

    /// The path of a file on a disk.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Disk(path) => Some(path),
            Self::Memory(_) => None,
        }
    }
}

impl Opened {
    /// Another handle at the same position.
    ///
    /// # Errors
    /// A file that cannot be opened again.
    pub(crate) fn try_clone(&self) -> Result<Self> {
        Ok(match self {
            Self::Disk(file) => Self::Disk(file.try_clone()?),
            Self::Memory(bytes) => Self::Memory(bytes.clone()),
        })
    }
}

impl Read for Opened {
    fn read(&mut self, output: &mut [u8]) -> Result<usize> {
        match self {
            Self::Disk(file) => file.read(output),
            Self::Memory(bytes) => bytes.read(output),
        }
    }
}

impl Seek for Opened {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        match self {
            Self::Disk(file) => file.seek(to),
            Self::Memory(bytes) => bytes.seek(to),
        }
    }
}

impl Length for Opened {
    fn len(&self) -> u64 {
        match self {
            Self::Disk(file) => file.len(),
            Self::Memory(bytes) => bytes.get_ref().len() as u64,
        }
    }
}

impl ChunkReader for Opened {
    type T = Box<dyn Read>;

    fn get_read(&self, start: u64) -> ParquetResult<Self::T> {
        Ok(match self {
            Self::Disk(file) => Box::new(file.get_read(start)?),
            Self::Memory(bytes) => {
                let mut own = bytes.clone();
                own.set_position(start);
                Box::new(own)
            }
        })
    }

    fn get_bytes(&self, start: u64, length: usize) -> ParquetResult<Bytes> {
        match self {
            Self::Disk(file) => file.get_bytes(start, length),
            Self::Memory(bytes) => {
                let from = usize::try_from(start).ok();
                let to = from.and_then(|from| from.checked_add(length));
                let part = from
                    .zip(to)
                    .and_then(|(from, to)| bytes.get_ref().get(from..to));
                let part = part.ok_or_else(|| {
                    ParquetError::EOF(String::from("the file ends before its columns"))
                })?;
                Ok(Bytes::copy_from_slice(part))
            }
        }
    }
}
