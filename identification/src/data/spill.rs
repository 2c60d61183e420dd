//! The numbers of a large run whose files are slow to read, in a temporary file: a text is then read once, however
//! often its run is gone through.
//!
//! The file has no name where the system allows it, and is gone with the run. Where there is no room for it, or no
//! folder for such files, the run's own files are read again.

#[cfg(not(target_family = "wasm"))]
use std::io::{Read, Seek, SeekFrom, Write};
use std::{
    fs::File,
    sync::{Arc, Mutex},
};

use super::samples::Samples;

/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// Numbers in a temporary file: positions, torques and velocities of one sample after the other.
#[derive(Debug, Clone)]
pub(super) struct Spill {
    /// Readers share it, and go to their own places.
    file: Arc<Mutex<File>>,
    /// Numbers of positions of a sample, as many of torques, and of velocities if there are some.
    parts: [usize; 3],
}

impl PartialEq for Spill {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.file, &other.file)
    }
}

impl Spill {
    /// A file for runs of so many actuators; none where there can't be one.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn new(actuators: usize, has_velocities: bool) -> Option<Self> {
        let file = tempfile::tempfile().ok()?;
        let velocities = if has_velocities { actuators } else { 0 };
        Some(Self {
            file: Arc::new(Mutex::new(file)),
            parts: [actuators, actuators, velocities],
        })
    }

    /// There are no files.
    #[cfg(target_family = "wasm")]
    pub(super) fn new(_actuators: usize, _has_velocities: bool) -> Option<Self> {
        None
    }

    /// Adds samples; `false` where there is no room for them.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn write(&self, samples: &Samples) -> bool {
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

    /// There are no files.
    #[cfg(target_family = "wasm")]
    pub(super) fn write(&self, _samples: &Samples) -> bool {
        false
    }

    /// So many samples from number `first` on.
    ///
    /// # Errors
    /// A file that can't be read.
    pub(super) fn read(&self, first: usize, count: usize) -> std::io::Result<Samples> {
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

    /// There are no files.
    #[cfg(target_family = "wasm")]
    fn fill(&self, _first: usize, _bytes: &mut [u8]) -> std::io::Result<()> {
        Err(std::io::ErrorKind::Unsupported.into())
    }

    /// Numbers of a sample.
    fn width(&self) -> usize {
        self.parts.iter().sum()
    }
}

#[cfg(all(test, not(target_family = "wasm")))]
mod tests {
    use super::Spill;
    use crate::data::samples::Samples;

    #[test]
    fn samples_come_back_from_any_place() {
        let rows = |first: usize, count: usize, scale: f64| -> Vec<f64> {
            let values = 2 * first..2 * (first + count);
            values.map(|k| scale * k as f64).collect()
        };
        let samples = |first: usize, count: usize| Samples {
            positions: rows(first, count, 0.1),
            torques: rows(first, count, -3.0),
            velocities: rows(first, count, 1e-300),
        };
        let spill = Spill::new(2, true).expect("a temporary file");
        assert!(spill.write(&samples(0, 5)));
        assert_eq!(spill.read(3, 2).expect("samples"), samples(3, 2));
        assert!(spill.write(&samples(5, 7)));
        assert_eq!(spill.read(1, 10).expect("samples"), samples(1, 10));
        assert!(spill.read(6, 7).is_err());
    }
}
