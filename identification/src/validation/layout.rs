//! Layout of the rows of a validation, and their sums of squares.

use std::ops::Range;

use overact::Sizes;

use crate::{
    estimation::estimate::{LineError, LineNorms},
    series::Series,
};

/// Name and unit of a line or torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Label<'a> {
    pub(super) name: &'a str,
    pub(super) unit: &'static str,
}

/// Indices of measured and predicted values of one quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) measured: usize,
    pub(super) predicted: usize,
}

/// Layout of a row.
///
/// Measured torques come first, then those without internal part if redundant. For each candidate
/// follow predicted torques, measured and predicted Γ, and predicted torques by eq. (26).
#[derive(Debug, Clone)]
pub(super) struct Layout {
    n: usize,
    r: usize,
    candidates: usize,
    /// Whether torques by eq. (26) are included.
    closure: bool,
}

impl Layout {
    pub(super) fn new(sizes: Sizes, candidates: usize, closure: bool) -> Self {
        Self {
            n: sizes.actuators,
            r: sizes.dof,
            candidates,
            closure,
        }
    }

    /// Values of a row.
    pub(super) fn width(&self) -> usize {
        self.start(self.candidates)
    }

    /// First value of a candidate.
    fn start(&self, candidate: usize) -> usize {
        let measured = if self.n > self.r { 2 * self.n } else { self.n };
        let closure = if self.closure { self.n } else { 0 };
        measured + candidate * (self.n + 2 * self.r + closure)
    }

    /// Measured torques.
    pub(super) fn measured(&self) -> Range<usize> {
        0..self.n
    }

    /// Measured torques without their internal part.
    pub(super) fn projected(&self) -> Option<Range<usize>> {
        (self.n > self.r).then_some(self.n..2 * self.n)
    }

    /// Predicted torques.
    pub(super) fn predicted_torques(&self, candidate: usize) -> Range<usize> {
        let start = self.start(candidate);
        start..start + self.n
    }

    /// A torque and its prediction.
    pub(super) fn torque(&self, candidate: usize, actuator: usize) -> Pair {
        Pair {
            measured: actuator,
            predicted: self.start(candidate) + actuator,
        }
    }

    /// A torque without its internal part, and its prediction.
    pub(super) fn projected_torque(&self, candidate: usize, actuator: usize) -> Option<Pair> {
        let measured = self.projected()?.start + actuator;
        let pair = self.torque(candidate, actuator);
        Some(Pair { measured, ..pair })
    }

    /// A line of Γ and its prediction.
    pub(super) fn line(&self, candidate: usize, line: usize) -> Pair {
        let measured = self.start(candidate) + self.n + line;
        Pair {
            measured,
            predicted: measured + self.r,
        }
    }

    /// Whether torques by eq. (26) are included.
    pub(super) const fn closure(&self) -> bool {
        self.closure
    }

    /// Torques by eq. (26).
    pub(super) fn closure_torques(&self, candidate: usize) -> Option<Range<usize>> {
        let start = self.start(candidate) + self.n + 2 * self.r;
        self.closure.then_some(start..start + self.n)
    }

    /// A torque and that of eq. (26).
    pub(super) fn closure_torque(&self, candidate: usize, actuator: usize) -> Option<Pair> {
        let predicted = self.closure_torques(candidate)?.start + actuator;
        Some(Pair {
            measured: actuator,
            predicted,
        })
    }

    /// All pairs.
    fn pairs(&self) -> Vec<Pair> {
        (0..self.candidates)
            .flat_map(|candidate| {
                let torques = (0..self.n).map(move |i| self.torque(candidate, i));
                let projected =
                    (0..self.n).filter_map(move |i| self.projected_torque(candidate, i));
                let lines = (0..self.r).map(move |line| self.line(candidate, line));
                let closure = (0..self.n).filter_map(move |i| self.closure_torque(candidate, i));
                torques.chain(projected).chain(lines).chain(closure)
            })
            .collect()
    }
}

/// Sums over the rows of a pair.
#[derive(Debug, Clone, Copy, Default)]
struct PairSums {
    /// Squares of the differences.
    residual: f64,
    /// Squares of the measured values.
    measured: f64,
    /// Measured values.
    sum: f64,
}

/// Sums over decimated rows, and the rows at the plotted points.
#[derive(Debug)]
pub(super) struct Sums<'a> {
    layout: &'a Layout,
    pairs: Vec<Pair>,
    sums: Vec<PairSums>,
    taken: usize,
    stride: usize,
    points: Vec<f64>,
}

impl<'a> Sums<'a> {
    /// Sums without rows; one row in `stride` is kept for plots.
    pub(super) fn new(layout: &'a Layout, stride: usize) -> Self {
        let pairs = layout.pairs();
        Self {
            sums: vec![PairSums::default(); pairs.len()],
            layout,
            pairs,
            taken: 0,
            stride,
            points: Vec::new(),
        }
    }

    /// Layout of the rows.
    pub(super) const fn layout(&self) -> &Layout {
        self.layout
    }

    /// Adds decimated rows.
    pub(super) fn take(&mut self, rows: &[f64]) {
        for row in rows.chunks_exact(self.layout.width()) {
            if self.taken.is_multiple_of(self.stride) {
                self.points.extend_from_slice(row);
            }
            self.taken += 1;
            for (pair, sums) in self.pairs.iter().zip(&mut self.sums) {
                let value = row[pair.measured];
                sums.residual += (value - row[pair.predicted]).powi(2);
                sums.measured += value * value;
                sums.sum += value;
            }
        }
    }

    /// Error of a pair.
    pub(super) fn error(&self, label: Label<'_>, pair: Pair) -> LineError {
        let place = self.pairs.iter().position(|other| *other == pair);
        let sums = place.map_or_else(PairSums::default, |place| self.sums[place]);
        let norms = LineNorms::of_sums(sums.residual, sums.measured, sums.sum, self.taken);
        LineError::new(label.name, label.unit, &norms, self.taken)
    }

    /// Values of a pair at the plotted points.
    pub(super) fn series(&self, name: &str, pair: Pair, time: &dyn Fn(usize) -> f64) -> Series {
        let width = self.layout.width();
        let values = |index: usize| self.points.iter().skip(index).step_by(width).copied();
        Series {
            name: name.to_owned(),
            time: (0..self.points.len() / width).map(time).collect(),
            measured: values(pair.measured).collect(),
            predicted: values(pair.predicted).collect(),
        }
    }
}
