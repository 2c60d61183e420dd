//! Parts of a run: stretches of a recording with gaps, and the motion between long standstills.

use std::ops::Range;

use super::{Log, RecordingPart};
use crate::{
    error::Error,
    run::{block_ranges::BlockRanges, gaps::Stretch, time_range},
    significant::significant,
};

impl Log {
    /// The run as a stretch of a recording with gaps.
    ///
    /// `continues` says whether an earlier stretch is used, too.
    pub(crate) fn into_stretch(mut self, stretch: &Stretch, continues: bool) -> Self {
        let (name, [start, end]) = time_range::name_and_bounds(&self.name);
        let [own_start, own_end] = stretch.bounds.each_ref().map(Option::as_deref);
        let range = format!(
            "[{}:{}]",
            own_start.unwrap_or(start),
            own_end.unwrap_or(end)
        );
        let name = name.to_owned();
        self.stretch = Some(RecordingPart {
            range,
            start: stretch.start,
            continues,
        });
        self.with_name(name)
    }

    /// Whether the run is a later stretch of the recording with gaps of the run before.
    #[must_use]
    pub fn continues(&self) -> bool {
        self.stretch.as_ref().is_some_and(|own| own.continues)
    }

    /// Time from the first sample of the recording to that of the run, s.
    ///
    /// It is not 0 for a later stretch of a recording with gaps.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.stretch.as_ref().map_or(0.0, |own| own.start)
    }

    /// The samples `range` of the run as a run of its own.
    ///
    /// Its name has the range of time if `is_named`. Outside the run, the range is cut.
    #[must_use]
    pub fn part(&self, range: &Range<usize>, is_named: bool) -> Self {
        let end = range.end.min(self.samples);
        let first = range.start.min(end);
        let seconds = |samples: usize| samples as f64 / self.sampling_frequency;
        let instruments = self.instruments.as_ref();
        let part = Self {
            first: self.first + first,
            samples: end - first,
            ranges: None,
            first_time: self.first_time + seconds(first),
            instruments: instruments.map(|own| Box::new(own.part(range, is_named))),
            ..self.clone()
        };
        if !is_named {
            return part;
        }
        let before = self.stretch.as_ref();
        // Half a sample before a time, which is that of no sample.
        let bound =
            |sample: usize| significant(self.first_time + seconds(sample) - seconds(1) / 2.0, 7);
        part.into_stretch(
            &Stretch {
                tables: Vec::new(),
                bounds: [
                    (first > 0).then(|| bound(first)),
                    (end < self.samples).then(|| bound(end)),
                ],
                start: self.start() + seconds(first),
                duration: seconds(end - first),
            },
            first > 0 || before.is_some_and(|own| own.continues),
        )
    }

    /// Samples during which all actuators stand still for at least 1 s, in order.
    ///
    /// An actuator stands still over 0.1 s if its positions range over less than 1 % of their usual
    /// largest range in such a time, or over less than twice the smallest range other than zero,
    /// which is that of noise.
    ///
    /// # Errors
    /// As [`Log::reader`] and [`Reader::next`](crate::Reader::next).
    pub fn long_standstills(&self) -> Result<Vec<Range<usize>>, Error> {
        if let Some(ranges) = &self.ranges {
            return Ok(ranges.long_standstills(self.sampling_frequency));
        }
        let mut ranges = BlockRanges::new(self.actuators);
        let mut reader = self.reader()?;
        while let Some(block) = reader.next()? {
            ranges.take(&block.positions);
        }
        Ok(ranges.long_standstills(self.sampling_frequency))
    }
}
