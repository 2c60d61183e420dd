//! Source of a file's bytes: a disk, or memory, as in a browser.

use std::{
    fs::{self, File},
    io::{Cursor, Read, Result, Seek, SeekFrom, Write},
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
    /// In a temporary file, which is deleted after the last use.
    #[cfg(not(target_family = "wasm"))]
    Temporary(Arc<TemporaryFile>),
    /// Shared bytes in memory.
    Memory(Arc<[u8]>),
}

/// A temporary file, deleted with this value.
#[cfg(not(target_family = "wasm"))]
#[derive(Debug)]
pub(crate) struct TemporaryFile(tempfile::TempPath);

#[cfg(not(target_family = "wasm"))]
impl PartialEq for TemporaryFile {
    fn eq(&self, other: &Self) -> bool {
        *self.0 == *other.0
    }
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
            #[cfg(not(target_family = "wasm"))]
            Self::Temporary(file) => Opened::Disk(File::open(&file.0)?),
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
            #[cfg(not(target_family = "wasm"))]
            Self::Temporary(file) => fs::read(&file.0),
            Self::Memory(bytes) => Ok(bytes.to_vec()),
        }
    }

    /// The path of a file on a disk.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Disk(path) => Some(path),
            #[cfg(not(target_family = "wasm"))]
            Self::Temporary(file) => Some(&file.0),
            Self::Memory(_) => None,
        }
    }

    /// Number of bytes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn size(&self) -> Result<u64> {
        match (self, self.path()) {
            (Self::Memory(bytes), _) => Ok(bytes.len() as u64),
            (_, Some(path)) => Ok(fs::metadata(path)?.len()),
            (_, None) => Ok(0),
        }
    }

    /// Other bytes in a temporary file, or in memory if these are.
    ///
    /// # Errors
    /// The error of `write`, or a temporary folder that cannot be written.
    pub(crate) fn like(
        &self,
        write: &mut dyn FnMut(&mut dyn Write) -> Result<u64>,
    ) -> Result<Self> {
        #[cfg(not(target_family = "wasm"))]
        if self.path().is_some() {
            let mut file = tempfile::Builder::new().prefix("overact-").tempfile()?;
            write(file.as_file_mut())?;
            return Ok(Self::Temporary(Arc::new(TemporaryFile(
                file.into_temp_path(),
            ))));
        }
        let mut bytes = Vec::new();
        write(&mut bytes)?;
        Ok(Self::Memory(bytes.into()))
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
