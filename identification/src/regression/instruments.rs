//! The motion of the instruments, gone through in step with that of a run.

use overact::Code;
use overact::Model;

use super::{chunk::Chunk, observation::Observer};
use crate::{
    data::Log,
    error::{Error, Problem},
    kinematics::{Motion, Motions},
    settings::Settings,
};

/// A run of instruments: positions that go with those of a measured run, sample by sample, but not with
/// their errors. Its torques are not used.
pub(crate) struct Companion<'a> {
    motions: Motions<'a>,
    /// Why it can't be used.
    failed: Option<Error>,
}

impl<'a> Companion<'a> {
    /// Starts with the first sample, beside a run of so many samples.
    ///
    /// # Errors
    /// As [`Motions::new`], or another number of samples.
    pub(crate) fn new(
        model: &'a dyn Model,
        (log, samples): (&'a Log, usize),
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
        let motions = Motions::new(model, log, settings)?;
        Ok(Self {
            motions,
            failed: None,
        })
    }

    /// The equations at the samples of a block of the run. Without any where they can't be had, which
    /// is noted.
    pub(crate) fn chunks(&mut self, observer: &Observer<'_>, motion: &Motion) -> Vec<Chunk> {
        if self.failed.is_some() {
            return Vec::new();
        }
        self.next(observer, motion).unwrap_or_else(|error| {
            self.failed = Some(error);
            Vec::new()
        })
    }

    fn next(&mut self, observer: &Observer<'_>, motion: &Motion) -> Result<Vec<Chunk>, Error> {
        let next = self.motions.next()?;
        let own = next
            .filter(|own| (own.first_sample, own.samples) == (motion.first_sample, motion.samples));
        let own = own.ok_or_else(|| {
            Problem::new(
                Code::INSTRUMENTS,
                "the instruments are not in step with the run",
            )
        })?;
        let mut failed: Vec<Option<Error>> = observer.projections.iter().map(|_| None).collect();
        let chunks = observer.chunks(&own, &mut failed)?;
        match failed.into_iter().flatten().next() {
            Some(error) => Err(error),
            None => Ok(chunks),
        }
    }

    /// Why it could not be used.
    pub(crate) fn into_failure(self) -> Option<Error> {
        self.failed
    }
}
