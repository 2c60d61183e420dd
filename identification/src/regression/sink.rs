//! Where the decimated equations of a line go: into R factors of parts of the run, and some of them
//! into stretches of successive equations and into the points of the plots.

use std::ops::Range;

use nalgebra::DMatrix;

use super::{
    factor::Factor,
    system::{Observed, Part, PartitionCondition, Stretch},
};
use crate::{filters::Decimation, series::LARGEST_SERIES};

/// Parts of a run, of which each can be held out.
const PARTS: usize = 5;

/// Equations of a stretch, where a run has more than are kept.
const STRETCH: usize = 2048;

/// Equations of a line of a run that are kept as stretches, at least.
const FEWEST_KEPT: usize = 512;

/// What is kept of the equations of a run, told before the first one comes.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    equations: usize,
    /// Number of the first equation behind each part.
    ends: Vec<usize>,
    stretches: Vec<Range<usize>>,
    /// Distance of the equations at the points of the plots.
    stride: usize,
}

impl Plan {
    /// A plan for `equations` of each line, of which about `budget` may be kept as they are.
    pub(crate) fn new(equations: usize, budget: usize) -> Self {
        let mut ends: Vec<usize> = (1..=PARTS).map(|part| part * equations / PARTS).collect();
        ends.dedup();
        ends.retain(|end| *end > 0);
        Self {
            equations,
            ends,
            stretches: stretches(equations, budget.max(FEWEST_KEPT)),
            stride: equations.div_ceil(LARGEST_SERIES).max(1),
        }
    }

    /// Distance of the equations at the points of the plots.
    pub(crate) const fn stride(&self) -> usize {
        self.stride
    }

    /// Number of points of the plots.
    pub(crate) const fn points(&self) -> usize {
        self.equations.div_ceil(self.stride)
    }

    /// Of rows of `width` values for every equation, those at the points of the plots.
    pub(crate) fn at_points(&self, rows: &[f64], width: usize) -> Vec<f64> {
        let rows = rows.chunks_exact(width).step_by(self.stride);
        rows.flatten().copied().collect()
    }
}

/// All equations where these are few enough, else stretches spread evenly.
fn stretches(equations: usize, budget: usize) -> Vec<Range<usize>> {
    if equations <= budget {
        return std::iter::once(0..equations).collect();
    }
    let length = STRETCH.min(budget);
    let count = budget / length;
    let last = equations - length;
    (0..count)
        .map(|index| {
            let first = last * index / (count - 1).max(1);
            first..first + length
        })
        .collect()
}

/// The equations of one line of a run.
#[derive(Debug)]
pub(crate) struct LineSink {
    decimation: Decimation,
    width: usize,
    /// Equations that have come.
    taken: usize,
    /// Decimated rows that are in no factor yet.
    rows: Vec<f64>,
    factor: Factor,
    parts: Vec<Factor>,
    stretches: Vec<Vec<f64>>,
    points: Vec<f64>,
}

impl LineSink {
    /// A sink for equations in `parameters` unknowns that are decimated first.
    pub(crate) fn new(plan: &Plan, decimation: Decimation, parameters: usize) -> Self {
        Self {
            decimation,
            width: parameters + 1,
            taken: 0,
            rows: Vec::new(),
            factor: Factor::new(parameters),
            parts: Vec::new(),
            stretches: vec![Vec::new(); plan.stretches.len()],
            points: Vec::new(),
        }
    }

    /// Takes rows at the full rate.
    pub(crate) fn push(&mut self, plan: &Plan, rows: &[f64]) {
        let mut kept = Vec::new();
        self.decimation.push(rows, &mut kept);
        for row in kept.chunks_exact(self.width) {
            if self.taken.is_multiple_of(plan.stride) {
                self.points.extend_from_slice(row);
            }
            for (range, stretch) in plan.stretches.iter().zip(&mut self.stretches) {
                if range.contains(&self.taken) {
                    stretch.extend_from_slice(row);
                }
            }
            self.rows.extend_from_slice(row);
            self.taken += 1;
            let complete = plan.ends.get(self.parts.len()) == Some(&self.taken);
            if complete || self.rows.len() >= self.factor.worthwhile() * self.width {
                self.factor.push_rows(&self.rows);
                self.rows.clear();
            }
            if complete {
                let next = Factor::new(self.width - 1);
                self.parts.push(std::mem::replace(&mut self.factor, next));
            }
        }
    }
}

/// What the sinks of all lines hold of run number `run`.
pub(crate) fn observed(
    run: usize,
    plan: &Plan,
    sinks: Vec<LineSink>,
    partition: Option<PartitionCondition>,
) -> Observed {
    let width = sinks.first().map_or(1, |sink| sink.width);
    let matrix = |rows: &[f64]| DMatrix::from_row_slice(rows.len() / width, width, rows);
    let part = |part: usize| Part {
        run,
        lines: sinks
            .iter()
            .filter_map(|sink| sink.parts.get(part).cloned())
            .collect(),
    };
    let stretch = |stretch: usize| Stretch {
        run,
        lines: sinks
            .iter()
            .map(|sink| matrix(&sink.stretches[stretch]))
            .collect(),
    };
    Observed {
        parts: (0..plan.ends.len()).map(part).collect(),
        stretches: (0..plan.stretches.len()).map(stretch).collect(),
        partition,
        points: sinks.iter().map(|sink| matrix(&sink.points)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Plan, stretches};

    #[test]
    fn stretches_are_spread_over_the_run_within_the_budget() {
        assert_eq!(stretches(1000, 1000), vec![0..1000; 1]);
        let spread = stretches(360_000, 10_000);
        assert_eq!(spread.len(), 4);
        assert_eq!((spread[0].start, spread[3].end), (0, 360_000));
        assert!(spread.windows(2).all(|pair| pair[0].end <= pair[1].start));
        assert_eq!(stretches(3000, 600), vec![0..600; 1]);
    }

    #[test]
    fn every_equation_belongs_to_one_part() {
        let plan = Plan::new(1003, usize::MAX);
        assert_eq!(plan.ends, [200, 401, 601, 802, 1003]);
        assert_eq!((plan.stride(), plan.points()), (2, 502));
        assert_eq!(Plan::new(2, 10).ends, [1, 2]);
    }
}
