//! Samples of a large run in a temporary file, so that a text is parsed only once.
//!
//! The file has no name if the system supports that, and is deleted with the run. Without space or
//! a temporary folder, the run's own files are read again.

#[cfg(not(target_family = "wasm"))]
use std::io::{Read, Seek, SeekFrom, Write};
use std::{
    fs::File,
    sync::{Arc, Mutex},
};

use crate::samples::Samples;

/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// Samples in a temporary file: positions, torques and velocities of each sample.
#[derive(Debug, Clone)]
pub(crate) struct TemporaryStore {
    /// Shared by readers, each with its own position.
    file: Arc<Mutex<File>>,
    /// Values per sample of positions, torques, and velocities if measured.
    parts: [usize; 3],
}

impl PartialEq for TemporaryStore {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.file, &other.file)
    }
}

impl TemporaryStore {
    /// A file for runs with `actuators` actuators; `None` if it cannot be created.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn new(actuators: usize, has_velocities: bool) -> Option<Self> {
        let file = tempfile::tempfile().ok()?;
        let velocities = if has_velocities { actuators } else { 0 };
        Some(Self {
            file: Arc::new(Mutex::new(file)),
            parts: [actuators, actuators, velocities],
        })
    }

    /// Without a file system.
    #[cfg(target_family = "wasm")]
    pub(crate) fn new(_actuators: usize, _has_velocities: bool) -> Option<Self> {
        None
    }

    /// Adds samples; `false` if there is no space.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn write(&self, samples: &Samples) -> bool {
        let all = [&samples.positions, &samples.torques, &samples.velocities];
        let count = samples.positions.len() / self.parts[0].max(1);
        let mut bytes = Vec::with_capacity(count * self.width() * BYTES);
        for sample in 0..count {
            for (values, part) in all.into_iter().zip(self.parts) {
                for value in &values[sample * part..(sample + 1) * part] {
                    bytes.extend_from_slice(&value.to_le_bytes());
                }
            }
        }
        let mut file = self
            .file
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        file.seek(SeekFrom::End(0)).is_ok() && file.write_all(&bytes).is_ok()
    }

    /// Without a file system.
    #[cfg(target_family = "wasm")]
    pub(crate) fn write(&self, _samples: &Samples) -> bool {
        false
    }

    /// Reads `count` samples from number `first` on.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn read(&self, first: usize, count: usize) -> std::io::Result<Samples> {
        let mut bytes = vec![0; count * self.width() * BYTES];
        self.fill(first, &mut bytes)?;
        let mut samples = Samples::default();
        let (numbers, _) = bytes.as_chunks::<BYTES>();
        let mut numbers = numbers.iter().map(|own| f64::from_le_bytes(*own));
        let [positions, torques, velocities] = self.parts;
        for _ in 0..count {
            samples.positions.extend(numbers.by_ref().take(positions));
            samples.torques.extend(numbers.by_ref().take(torques));
            samples.velocities.extend(numbers.by_ref().take(velocities));
        }
        Ok(samples)
    }

    /// Reads bytes from a sample on.
    #[cfg(not(target_family = "wasm"))]
    fn fill(&self, first: usize, bytes: &mut [u8]) -> std::io::Result<()> {
        let place = (first * self.width() * BYTES) as u64;
        let mut file = self
            .file
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        file.seek(SeekFrom::Start(place))?;
        file.read_exact(bytes)
    }

    /// Without a file system.
    #[cfg(target_family = "wasm")]
    fn fill(&self, _first: usize, _bytes: &mut [u8]) -> std::io::Result<()> {
        Err(std::io::ErrorKind::Unsupported.into())
    }

    /// Values per sample.
    fn width(&self) -> usize {
        self.parts.iter().sum()
    }
}

#[cfg(all(test, not(target_family = "wasm")))]
mod tests {
    use super::TemporaryStore;
    use crate::samples::Samples;

    #[test]
    fn samples_are_read_back_from_any_offset() {
        let rows = |first: usize, count: usize, scale: f64| -> Vec<f64> {
            let values = 2 * first..2 * (first + count);
            values.map(|k| scale * k as f64).collect()
        };
        let samples = |first: usize, count: usize| Samples {
            positions: rows(first, count, 0.1),
            torques: rows(first, count, -3.0),
            velocities: rows(first, count, 1e-300),
        };
        let spill = TemporaryStore::new(2, true).expect("a temporary file");
        assert!(spill.write(&samples(0, 5)));
        assert_eq!(spill.read(3, 2).expect("samples"), samples(3, 2));
        assert!(spill.write(&samples(5, 7)));
        assert_eq!(spill.read(1, 10).expect("samples"), samples(1, 10));
        assert!(spill.read(6, 7).is_err());
    }
}
