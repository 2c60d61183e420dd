//! Rows of some columns, read block by block.

use hdf5_reader::{Dataset, SliceInfo, SliceInfoElem, error::Result};
use overact::Code;

use super::{
    number::Number,
    series::{Series, broken},
};
use crate::{
    error::{Error, Problem},
    formats::table_file::RowReader,
    problems::shown,
};

/// Fewest samples and most numbers of a block.
const BATCH: u64 = 4096;
const LARGEST_BLOCK: u64 = 1 << 20;

/// A requested column: its dataset, its index in it, and its name for messages.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    pub(super) series: usize,
    pub(super) part: usize,
    pub(super) name: &'a str,
}

/// The value of a scalar dataset.
///
/// # Errors
/// A number that cannot be read.
pub(super) fn single(dataset: &Dataset) -> Result<Option<f64>> {
    let values = dataset.read_slice::<Number>(&SliceInfo::all(dataset.shape().len()))?;
    Ok(values.first().map(|own| own.0))
}

/// The remaining rows of a file.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The file as the caller named it, and its size.
    file: &'a str,
    size: u64,
    series: &'a [Series],
    wanted: Vec<Wanted<'a>>,
    blocks: Vec<Block>,
    /// Block of each column.
    of: Vec<usize>,
    /// Number of samples returned so far.
    samples: u64,
    is_broken: bool,
}

/// Some samples of a dataset, from the first to the last requested column.
#[derive(Debug)]
struct Block {
    series: usize,
    from: usize,
    to: usize,
    /// First sample, and end.
    start: u64,
    end: u64,
    /// Values in the order of the file.
    values: Vec<Number>,
}

impl<'a> Rows<'a> {
    /// Starts at the first row.
    pub(super) fn new(
        file: &'a str,
        size: u64,
        series: &'a [Series],
        wanted: Vec<Wanted<'a>>,
    ) -> Self {
        let mut blocks: Vec<Block> = Vec::new();
        let mut of = Vec::new();
        for own in &wanted {
            let place = blocks.iter().position(|block| block.series == own.series);
            let place = place.unwrap_or_else(|| {
                blocks.push(Block {
                    series: own.series,
                    from: own.part,
                    to: own.part + 1,
                    start: 0,
                    end: 0,
                    values: Vec::new(),
                });
                blocks.len() - 1
            });
            let block = &mut blocks[place];
            block.from = block.from.min(own.part);
            block.to = block.to.max(own.part + 1);
            of.push(place);
        }
        Self {
            file,
            size,
            series,
            wanted,
            blocks,
            of,
            samples: 0,
            is_broken: false,
        }
    }

    /// Reads the block of a dataset that starts with the next sample.
    fn fill(&mut self, number: usize) -> std::result::Result<(), Problem> {
        let block = &mut self.blocks[number];
        let series = &self.series[block.series];
        block.start = self.samples;
        let read = block.read(series);
        read.map_err(|error| {
            let what = format!(
                "`{}` from sample {} on: {error}",
                shown(&series.name),
                self.samples
            );
            broken(self.file, &what).column(series.name.as_str())
        })
    }
}

impl Block {
    /// Reads samples from `start` on.
    fn read(&mut self, series: &Series) -> Result<()> {
        let width = (self.to - self.from) as u64;
        let most = (LARGEST_BLOCK / width).max(1);
        // Large chunks of the file are read whole, so that each is unpacked only once.
        let own = series
            .dataset
            .chunks()
            .and_then(|sides| sides.get(series.side).copied());
        let length = u64::from(own.unwrap_or(0)).max(1);
        let count = (BATCH.next_multiple_of(length)).min(most.max(1));
        self.end = series.samples.min(self.start.saturating_add(count));
        let along = SliceInfoElem::Slice {
            start: self.start,
            end: self.end,
            step: 1,
        };
        let across = SliceInfoElem::Slice {
            start: self.from as u64,
            end: self.to as u64,
            step: 1,
        };
        let selections = match (series.dataset.shape().len(), series.side) {
            (0, _) => Vec::new(),
            (1, _) => vec![along],
            (_, 0) => vec![along, across],
            _ => vec![across, along],
        };
        let values = series
            .dataset
            .read_slice::<Number>(&SliceInfo { selections })?;
        self.values = values.into_iter().collect();
        let count = (self.end - self.start).saturating_mul(width);
        if self.values.len() as u64 == count {
            Ok(())
        } else {
            let message = String::from("it has fewer numbers than declared");
            Err(hdf5_reader::error::Error::InvalidData(message))
        }
    }

    /// A number of the block.
    fn get(&self, series: &Series, sample: u64, part: usize) -> f64 {
        let (row, column) = ((sample - self.start) as usize, part - self.from);
        let place = if series.side == 0 {
            row * (self.to - self.from) + column
        } else {
            column * (self.end - self.start) as usize + row
        };
        self.values.get(place).map_or(f64::NAN, |own| own.0)
    }
}

impl RowReader for Rows<'_> {
    fn next(&mut self, values: &mut [f64]) -> std::result::Result<bool, Error> {
        let count = self
            .wanted
            .first()
            .map(|own| self.series[own.series].samples);
        if self.is_broken || count.is_none_or(|count| self.samples >= count) {
            return Ok(false);
        }
        for number in 0..self.blocks.len() {
            if self.samples >= self.blocks[number].end {
                let filled = self.fill(number);
                self.is_broken |= filled.is_err();
                filled?;
            }
        }
        let mut problems = Vec::new();
        for ((wanted, block), value) in self.wanted.iter().zip(&self.of).zip(values) {
            let series = &self.series[wanted.series];
            *value = self.blocks[*block].get(series, self.samples, wanted.part);
            if !value.is_finite() {
                let message = format!(
                    "`{}`: sample {} is not a finite number",
                    shown(wanted.name),
                    self.samples
                );
                problems.push(
                    Problem::new(Code::NOT_A_NUMBER, message)
                        .file(self.file)
                        .column(wanted.name),
                );
            }
        }
        self.samples += 1;
        Error::check(problems)?;
        Ok(true)
    }

    fn is_broken(&self) -> bool {
        self.is_broken
    }

    // Mean over the samples.
    fn bytes(&self) -> u64 {
        let count = self
            .wanted
            .first()
            .map_or(1, |own| self.series[own.series].samples.max(1));
        (self.samples as f64 / count as f64 * self.size as f64) as u64
    }
}
