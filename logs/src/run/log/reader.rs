//! Reads a run block by block.

use overact::Code;

use crate::{
    bytes::temporary_store::TemporaryStore,
    error::{Error, Problem},
    period_sums::MeanOfOtherPeriods,
    run::rows,
    samples::Samples,
};

/// Rows of a block.
const BLOCK_ROWS: usize = 4096;

/// Reads a run block by block.
#[derive(Debug)]
pub struct Reader<'a> {
    pub(super) rows: Rows<'a>,
    pub(super) name: &'a str,
    /// Offset subtracted from the position of each actuator.
    pub(super) offsets: &'a [f64],
    /// Factor of the torque of each actuator.
    pub(super) torque_factors: &'a [f64],
    /// Number of samples left.
    pub(super) left: usize,
}

/// Remaining rows of the source.
#[derive(Debug)]
pub(super) enum Rows<'a> {
    Memory([&'a [f64]; 3]),
    Files(Box<rows::Rows<'a>>),
    /// A temporary file, and the number of samples read.
    Spilled(&'a TemporaryStore, usize),
    Others(Box<Reader<'a>>, MeanOfOtherPeriods<'a>),
}

impl Reader<'_> {
    /// Skips samples at the start of the source.
    pub(super) fn skip(&mut self, samples: usize) -> Result<(), Error> {
        if let Rows::Memory(_) = self.rows {
            self.block(samples)?;
            return Ok(());
        }
        if let Rows::Spilled(_, taken) = &mut self.rows {
            *taken += samples;
            return Ok(());
        }
        for first in (0..samples).step_by(BLOCK_ROWS) {
            self.block(BLOCK_ROWS.min(samples - first))?;
        }
        Ok(())
    }

    /// The next block of samples, or `None` at the end.
    ///
    /// # Errors
    /// A file that cannot be read any more, or has changed since it was checked.
    #[expect(clippy::should_implement_trait, reason = "an iterator has no errors")]
    pub fn next(&mut self) -> Result<Option<Samples>, Error> {
        let count = BLOCK_ROWS.min(self.left);
        if count == 0 {
            return Ok(None);
        }
        self.left -= count;
        let mut block = self.block(count)?;
        for row in block.positions.chunks_exact_mut(self.offsets.len()) {
            row.iter_mut()
                .zip(self.offsets)
                .for_each(|(position, offset)| *position -= offset);
        }
        for row in block.torques.chunks_exact_mut(self.torque_factors.len()) {
            row.iter_mut()
                .zip(self.torque_factors)
                .for_each(|(torque, factor)| *torque *= factor);
        }
        Ok(Some(block))
    }

    /// The next samples as stored in the source.
    fn block(&mut self, count: usize) -> Result<Samples, Error> {
        let size = count * self.offsets.len();
        match &mut self.rows {
            Rows::Memory(all) => {
                let [positions, torques, velocities] = all.each_mut().map(|rest| {
                    // Velocities may be absent.
                    let (now, later) = rest.split_at(size.min(rest.len()));
                    *rest = later;
                    now.to_vec()
                });
                Ok(Samples {
                    positions,
                    torques,
                    velocities,
                })
            }
            Rows::Files(rows) => {
                let mut block = Samples::default();
                for _ in 0..count {
                    if !rows.next(&mut block)? {
                        let problem = Problem::new(
                            Code::UNREADABLE_LOG,
                            "the file has become shorter while it was read",
                        );
                        return Err(problem.file(self.name).into());
                    }
                }
                Ok(block)
            }
            Rows::Spilled(spill, taken) => {
                let block = spill.read(*taken, count);
                *taken += count;
                block.map_err(|error| {
                    let message =
                        format!("its numbers can't be read from a temporary file: {error}");
                    Problem::new(Code::UNREADABLE_LOG, message)
                        .file(self.name)
                        .into()
                })
            }
            Rows::Others(reader, others) => {
                let mut block = reader.next()?.unwrap_or_default();
                others.replace(&mut block.positions);
                block.velocities.clear();
                Ok(block)
            }
        }
    }
}
