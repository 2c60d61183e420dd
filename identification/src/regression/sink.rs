//! Stores the decimated equations of a line: R factors of parts of the run, stretches, plots.

use std::ops::Range;

use super::{
    factor::Factor,
    phase_sums::{PhaseSums, Phases},
    system::{MeasuredSums, PartitionCondition, RunEquations, RunPart, Stretch},
    transpose::transpose,
};
use crate::{filters::Decimation, series::LARGEST_SERIES};
use overact_logs::Error;

/// Number of parts of a run, which are folds of the cross-validation.
const PARTS: usize = 5;

/// Largest number of values kept as successive equations, over runs and projections (64 MB).
pub(crate) const LARGEST_STRETCHES: usize = 1 << 23;

/// Equations of a stretch, if a run has more than are kept.
const STRETCH: usize = 2048;

/// Fewest equations of a line of a run kept in stretches.
const FEWEST_KEPT: usize = 512;

/// Plan of the stored equations of a run, made before the first one.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    equations: usize,
    /// First equation after each part.
    ends: Vec<usize>,
    stretches: Vec<Range<usize>>,
    /// Phases of the equations, for a periodic motion.
    phases: Option<Phases>,
    /// Distance of the equations at the plotted points.
    stride: usize,
}

impl Plan {
    /// A plan for `equations` of each line, of which about `budget` may be kept.
    pub(crate) fn new(equations: usize, budget: usize) -> Self {
        let mut ends: Vec<usize> = (1..=PARTS).map(|part| part * equations / PARTS).collect();
        ends.dedup();
        ends.retain(|end| *end > 0);
        Self {
            equations,
            ends,
            stretches: stretches(equations, budget.max(FEWEST_KEPT)),
            stride: equations.div_ceil(LARGEST_SERIES).max(1),
            phases: None,
        }
    }

    /// Sets the phases of a periodic motion.
    pub(crate) fn with_phases(self, phases: Option<Phases>) -> Self {
        Self { phases, ..self }
    }

    /// Distance of the equations at the plotted points.
    pub(crate) const fn stride(&self) -> usize {
        self.stride
    }

    /// Number of plotted points.
    pub(crate) const fn points(&self) -> usize {
        self.equations.div_ceil(self.stride)
    }

    /// Memory for the rows of `width` values of each stretch.
    fn room(&self, width: usize) -> Vec<Vec<f64>> {
        let stretches = self.stretches.iter();
        let room = |range: &Range<usize>| Vec::with_capacity(range.len() * width);
        stretches.map(room).collect()
    }

    /// Selects the rows at the plotted points from rows of `width` values.
    pub(crate) fn at_points(&self, rows: &[f64], width: usize) -> Vec<f64> {
        let rows = rows.chunks_exact(width).step_by(self.stride);
        rows.flatten().copied().collect()
    }
}

/// All equations if these are few enough; otherwise evenly distributed stretches.
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

/// Stored equations of one line of a run.
#[derive(Debug)]
pub(crate) struct LineSink {
    decimation: Decimation,
    /// Number of columns, including Y.
    width: usize,
    instruments: Option<InstrumentSink>,
    /// Number of equations so far.
    taken: usize,
    /// Decimated rows that are not yet in a factor.
    rows: Vec<f64>,
    factor: Factor,
    parts: Vec<Factor>,
    stretches: Vec<Vec<f64>>,
    phase_sums: Option<PhaseSums>,
    points: Vec<f64>,
    standstill: Option<Standstill>,
    total: Option<TotalSink>,
}

/// Sums of the complete measurement, of which Y is the part without the held parameters.
#[derive(Debug)]
struct TotalSink {
    decimation: Decimation,
    /// Decimated values of the subtracted part that belong to the next equations.
    subtracted: Vec<f64>,
    sums: MeasuredSums,
}

/// Exclusion of equations at standstill of the line's joint.
///
/// The velocity is decimated like other values. In stretches, zeros replace excluded equations.
#[derive(Debug)]
struct Standstill {
    decimation: Decimation,
    /// Velocity (rad/s, m/s) below which the joint is at standstill.
    limit: f64,
    /// Number of excluded equations.
    left_out: usize,
}

/// Stored instruments of a line's equations.
#[derive(Debug)]
struct InstrumentSink {
    decimation: Decimation,
    /// Columns, instruments and Y of equations that are not yet in a factor.
    rows: Vec<f64>,
    factor: Factor,
    stretches: Vec<Vec<f64>>,
}

impl InstrumentSink {
    fn new(plan: &Plan, decimation: Decimation, parameters: usize) -> Self {
        Self {
            decimation,
            rows: Vec::new(),
            factor: Factor::new(2 * parameters),
            stretches: plan.room(parameters),
        }
    }

    /// Adds the instruments of equation number `taken`, whose columns and Y are `own`.
    fn push(&mut self, plan: &Plan, taken: usize, own: &[f64], instruments: &[f64]) {
        let (y, columns) = own.split_last().unwrap_or((&0.0, &[]));
        self.rows.extend_from_slice(columns);
        self.rows.extend_from_slice(instruments);
        self.rows.push(*y);
        for (range, stretch) in plan.stretches.iter().zip(&mut self.stretches) {
            if range.contains(&taken) {
                stretch.extend_from_slice(instruments);
            }
        }
        if self.rows.len() >= self.factor.worthwhile() * (self.factor.parameters() + 1) {
            self.finish();
        }
    }

    /// Adds pending equations to the factor.
    fn finish(&mut self) {
        self.factor.push_rows(&self.rows);
        self.rows.clear();
    }
}

impl LineSink {
    /// A sink for equations in `parameters` unknowns, with instruments if requested.
    ///
    /// `stream` gives the decimation for rows of a width. `standstill` is the velocity of the joint
    /// below which equations are excluded.
    pub(crate) fn new(
        plan: &Plan,
        stream: impl Fn(usize) -> Result<Decimation, Error>,
        parameters: usize,
        instruments: bool,
        standstill: Option<f64>,
    ) -> Result<Self, Error> {
        let width = parameters + 1;
        let instruments = if instruments {
            Some(InstrumentSink::new(plan, stream(width)?, parameters))
        } else {
            None
        };
        let standstill = match standstill {
            Some(limit) => Some(Standstill {
                decimation: stream(1)?,
                limit,
                left_out: 0,
            }),
            None => None,
        };
        Ok(Self {
            decimation: stream(width)?,
            width,
            instruments,
            taken: 0,
            rows: Vec::new(),
            factor: Factor::new(parameters),
            parts: Vec::new(),
            stretches: plan.room(width),
            phase_sums: plan.phases.map(|phases| PhaseSums::new(phases, width)),
            points: Vec::new(),
            standstill,
            total: None,
        })
    }

    /// Also sums the complete measurement; `decimation` is for a single column.
    pub(crate) fn with_total(self, decimation: Decimation) -> Self {
        let total = Some(TotalSink {
            decimation,
            subtracted: Vec::new(),
            sums: MeasuredSums::default(),
        });
        Self { total, ..self }
    }

    /// Call before `push`: the held parameters' part of the measurement, for the same rows.
    pub(crate) fn subtracted(&mut self, values: &[f64]) {
        if let Some(total) = &mut self.total {
            total.decimation.push(values, &mut total.subtracted);
        }
    }

    /// Number of equations excluded at standstill, if exclusion is on.
    pub(crate) fn left_out(&self) -> Option<usize> {
        self.standstill.as_ref().map(|own| own.left_out)
    }

    /// Adds rows at the full rate, with their instruments if there are some.
    ///
    /// Instruments have an unused column for Y. `velocities` are those of the line's joint.
    pub(crate) fn push(
        &mut self,
        plan: &Plan,
        rows: &[f64],
        instruments: Option<&[f64]>,
        velocities: impl Iterator<Item = f64>,
    ) {
        let (width, mut kept) = (self.width, Vec::new());
        self.decimation.push(rows, &mut kept);
        let (mut decimated_instruments, mut speeds) = (Vec::new(), Vec::new());
        if let Some(sink) = &mut self.instruments {
            match instruments.filter(|own| own.len() == rows.len()) {
                Some(own) => sink.decimation.push(own, &mut decimated_instruments),
                // Zeros replace instruments that are unusable.
                None => sink
                    .decimation
                    .push(&vec![0.0; rows.len()], &mut decimated_instruments),
            }
        }
        if let Some(own) = &mut self.standstill {
            let velocities: Vec<f64> = velocities.take(rows.len() / width).collect();
            own.decimation.push(&velocities, &mut speeds);
        }
        let subtracted = self
            .total
            .as_mut()
            .map(|own| std::mem::take(&mut own.subtracted));
        for (place, row) in kept.chunks_exact(width).enumerate() {
            if self.stands_still(speeds.get(place)) {
                self.leave_out(plan, row);
                continue;
            }
            let part = subtracted.as_ref().and_then(|own| own.get(place));
            if let (Some(total), Some(part)) = (&mut self.total, part) {
                total.sums.add(row[width - 1] + part);
            }
            if let Some(sink) = &mut self.instruments {
                let own = decimated_instruments.get(place * width..(place + 1) * width - 1);
                sink.push(plan, self.taken, row, own.unwrap_or_default());
            }
            if self.taken.is_multiple_of(plan.stride) {
                self.points.extend_from_slice(row);
            }
            for (range, stretch) in plan.stretches.iter().zip(&mut self.stretches) {
                if range.contains(&self.taken) {
                    stretch.extend_from_slice(row);
                }
            }
            if let Some(phase_sums) = &mut self.phase_sums {
                phase_sums.add(self.taken, row.iter());
            }
            self.rows.extend_from_slice(row);
            self.advance(plan);
        }
    }

    /// Moves to the next equation, possibly in another part.
    fn advance(&mut self, plan: &Plan) {
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

    /// Whether the joint is at standstill at an equation, by its decimated velocity.
    fn stands_still(&mut self, velocity: Option<&f64>) -> bool {
        match (&mut self.standstill, velocity) {
            (Some(own), Some(velocity)) if velocity.abs() < own.limit => {
                own.left_out += 1;
                true
            }
            _ => false,
        }
    }

    /// Excludes an equation, except from the plots.
    fn leave_out(&mut self, plan: &Plan, row: &[f64]) {
        let columns = self.width - 1;
        if self.taken.is_multiple_of(plan.stride) {
            self.points.extend_from_slice(row);
        }
        for (place, range) in plan.stretches.iter().enumerate() {
            if range.contains(&self.taken) {
                let own = &mut self.stretches[place];
                own.resize(own.len() + self.width, 0.0);
                if let Some(sink) = &mut self.instruments {
                    let own = &mut sink.stretches[place];
                    own.resize(own.len() + columns, 0.0);
                }
            }
        }
        self.advance(plan);
    }
}

/// Equations of run number `run` from the sinks of all lines.
pub(crate) fn observed(
    run: usize,
    plan: &Plan,
    mut sinks: Vec<LineSink>,
    partition: Option<PartitionCondition>,
) -> RunEquations {
    let mut instruments: Vec<InstrumentSink> = sinks
        .iter_mut()
        .filter_map(|sink| sink.instruments.take())
        .collect();
    instruments.iter_mut().for_each(InstrumentSink::finish);
    let width = sinks.first().map_or(1, |sink| sink.width);
    let part = |part: usize| RunPart {
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
            .map(|sink| transpose(&sink.stretches[stretch], width))
            .collect(),
        instruments: instruments
            .iter()
            .map(|sink| transpose(&sink.stretches[stretch], width - 1))
            .collect(),
    };
    RunEquations {
        parts: (0..plan.ends.len()).map(part).collect(),
        stretches: (0..plan.stretches.len()).map(stretch).collect(),
        phase_sums: sinks
            .iter()
            .filter_map(|sink| sink.phase_sums.clone())
            .collect(),
        partition,
        totals: sinks
            .iter()
            .filter_map(|sink| sink.total.as_ref().map(|own| own.sums))
            .collect(),
        points: sinks
            .iter()
            .map(|sink| transpose(&sink.points, width))
            .collect(),
        instruments: instruments.into_iter().map(|sink| sink.factor).collect(),
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
    fn every_equation_belongs_to_one_fold() {
        let plan = Plan::new(1003, usize::MAX);
        assert_eq!(plan.ends, [200, 401, 601, 802, 1003]);
        assert_eq!((plan.stride(), plan.points()), (2, 502));
        assert_eq!(Plan::new(2, 10).ends, [1, 2]);
    }
}
