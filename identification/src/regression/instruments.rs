//! Motion of the instruments, read in step with that of a run.

use std::ops::Range;

use overact::{Code, Model};

use super::{
    chunk::Chunk,
    observer::{Conditioning, Observer},
};
use crate::{
    kinematics::{Motion, Motions},
    settings::Settings,
};
use overact_logs::{Error, Log, Problem};

/// A run of instruments.
///
/// Its positions correspond to those of a measured run sample by sample but do not have their
/// errors. Its torques are not used.
pub(crate) struct InstrumentRun<'a> {
    motions: Motions<'a>,
    /// Its motion at the current samples of the run.
    motion: Option<Motion>,
    /// Reason why it is unusable.
    failed: Option<Error>,
}

impl<'a> InstrumentRun<'a> {
    /// Starts with the first sample, for a run of `samples` samples.
    ///
    /// # Errors
    /// As [`Motions::new`], or another number of samples.
    pub(crate) fn new(
        model: &'a dyn Model,
        log: &'a Log,
        samples: usize,
        settings: &Settings,
    ) -> Result<Self, Error> {
        if log.samples() != samples {
            return Err(Problem::new(
                Code::INSTRUMENTS,
                format!(
                    "the instruments have {} samples, the run has {samples}",
                    log.samples()
                ),
            )
            .file(log.name())
            .into());
        }
        let motions = Motions::new(model, log, settings)?.unwatched();
        Ok(Self {
            motions,
            motion: None,
            failed: None,
        })
    }

    /// Moves to the samples of a motion of the run.
    pub(crate) fn advance(&mut self, motion: &Motion) {
        self.motion = None;
        if self.failed.is_none() {
            match self.next(motion) {
                Ok(own) => self.motion = Some(own),
                Err(error) => self.failed = Some(error),
            }
        }
    }

    /// Equations at the samples of some blocks, with the scales of the platform's coordinates.
    ///
    /// Empty, with a stored error, if they cannot be computed.
    pub(crate) fn chunks(
        &mut self,
        observer: &Observer<'_>,
        blocks: Range<usize>,
        scales: &[f64],
    ) -> Vec<Chunk> {
        let Some(motion) = self.motion.as_ref().filter(|_| self.failed.is_none()) else {
            return Vec::new();
        };
        let mut failed: Vec<Option<Error>> = observer.projections.iter().map(|_| None).collect();
        let conditioning = Conditioning {
            scales,
            is_recorded: false,
        };
        let chunks = observer.chunks_with(motion, blocks, &mut failed, conditioning);
        let error = failed.into_iter().flatten().next();
        match (chunks, error) {
            (Ok(chunks), None) => chunks,
            (Err(error), _) | (_, Some(error)) => {
                self.failed = Some(error);
                Vec::new()
            }
        }
    }

    fn next(&mut self, motion: &Motion) -> Result<Motion, Error> {
        let next = self.motions.next()?;
        let own = next
            .filter(|own| (own.first_sample, own.samples) == (motion.first_sample, motion.samples));
        let own = own.ok_or_else(|| {
            Problem::new(
                Code::INSTRUMENTS,
                "the instruments are not synchronous with the run",
            )
        })?;
        Ok(own)
    }

    /// Reason why it was unusable.
    pub(crate) fn into_failure(self) -> Option<Error> {
        self.failed
    }
}
