//! Observation system (39)-(41) of an identification model.
//!
//! The platform projection has the inputs Γ¹ = (J_p^inv)ᵀ τ and the columns of IDM_red (30). The
//! actuator projection has Γ² = J_a^-T Γ¹ with the kept rows J_a of J_p^inv, and likewise for every
//! column (36). Without redundancy all actuators are kept, which is eq. (19), and eq. (1) for a
//! robot without loops.
//!
//! Y and all columns are decimated in parallel (40), and their rows are sorted by line of Γ (41).
//! The stored data are independent of the number of samples. They are one R `factor` for each line
//! and part of a run, and some stretches of successive equations for the correlation of the
//! residual.

use nalgebra::DMatrix;
use overact::Code;
use overact::Info;
use serde::Serialize;

use super::{
    factor::Factor,
    phase_sums::{self, PhaseSums},
    projection::Projection,
};
use crate::kinematics::Motion;
use overact_logs::Problem;

/// Worst condition number of the kept rows J_a of J_p^inv along a trajectory, and its place.
///
/// It depends on the units of the platform's coordinates. Above about 30, the actuator projection
/// suffers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartitionCondition {
    /// Largest condition number (2-norm).
    pub largest: f64,
    /// Name of the run.
    pub run: String,
    /// Sample of the log.
    pub sample: usize,
    /// Time of that sample, s from the start of the log.
    pub time: f64,
    /// Number of sign changes of the determinant of J_a, even between two samples.
    ///
    /// Each is a crossing of the partition's singularity.
    pub crossings: usize,
}

impl PartitionCondition {
    /// Combines the results of two runs, or of two parts of one.
    pub(crate) fn joined(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => {
                let crossings = a.crossings + b.crossings;
                let worse = if b.largest > a.largest { b } else { a };
                Some(Self { crossings, ..worse })
            }
            (a, b) => a.or(b),
        }
    }
}

/// System of all runs.
#[derive(Debug, Clone)]
pub struct System {
    /// Projection of the inputs.
    pub projection: Projection,
    /// Names of the lines of Γ.
    pub line_names: Vec<String>,
    /// Unit of each line, `N` or `N m`; empty if unknown.
    pub line_units: Vec<&'static str>,
    /// R factor of each line.
    pub lines: Vec<Factor>,
    /// Parts of the runs, for cross-validation.
    pub parts: Vec<RunPart>,
    /// Number of each run's recording session; empty if all are of one session.
    pub sessions: Vec<usize>,
    /// Successive equations, for the correlation of the residual.
    pub stretches: Vec<Stretch>,
    /// For each periodic motion, the mean equations of its phases.
    pub(crate) phase_sums: Vec<Vec<PhaseSums>>,
    /// Condition of the kept actuators, if there is a partition.
    pub partition: Option<PartitionCondition>,
    /// R factor of columns, instruments and Y of each line; empty without instruments.
    pub instruments: Vec<Factor>,
    /// Sums of the complete measurement of each line; empty without held parameters.
    pub(crate) totals: Vec<MeasuredSums>,
}

/// Sums of the measurement of a line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct MeasuredSums {
    /// Of its squares.
    pub(crate) squares: f64,
    /// Of itself.
    pub(crate) sum: f64,
}

impl MeasuredSums {
    /// Adds a value.
    pub(crate) fn add(&mut self, value: f64) {
        self.squares += value * value;
        self.sum += value;
    }
}

/// Equations of a part of a run.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RunPart {
    /// Number of the run.
    pub run: usize,
    /// R factor of each line.
    pub lines: Vec<Factor>,
}

/// Successive equations of a run.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Stretch {
    /// Number of the run.
    pub run: usize,
    /// For each line of Γ: equations × (columns + 1), Y last.
    pub lines: Vec<DMatrix<f64>>,
    /// For each line of Γ: equations × columns; empty without instruments.
    pub instruments: Vec<DMatrix<f64>>,
}

impl System {
    /// A system without equations in `parameters` unknowns.
    #[must_use]
    pub fn new(projection: Projection, info: &Info<'_>, parameters: usize) -> Self {
        Self {
            line_names: projection.line_names(info),
            line_units: projection.line_units(info),
            lines: vec![Factor::new(parameters); info.sizes.dof],
            projection,
            parts: Vec::new(),
            sessions: Vec::new(),
            stretches: Vec::new(),
            phase_sums: Vec::new(),
            partition: None,
            instruments: Vec::new(),
            totals: Vec::new(),
        }
    }

    /// Prepares for instruments in every equation.
    pub(crate) fn with_instruments(mut self) -> Self {
        let wide = |line: &Factor| Factor::new(2 * line.parameters());
        self.instruments = self.lines.iter().map(wide).collect();
        self
    }

    /// Adds the equations of a run.
    pub(crate) fn extend(&mut self, observed: RunEquations) {
        for (line, factor) in self.lines.iter_mut().enumerate() {
            let of_line = observed
                .parts
                .iter()
                .filter_map(|part| part.lines.get(line));
            of_line.for_each(|part| factor.add(part));
        }
        // Instruments are only usable if all equations have them.
        if observed.instruments.is_empty() {
            self.instruments.clear();
        }
        let lines = self.instruments.iter_mut().zip(&observed.instruments);
        lines.for_each(|(line, factor)| line.add(factor));
        self.totals
            .resize(observed.totals.len(), MeasuredSums::default());
        for (own, more) in self.totals.iter_mut().zip(&observed.totals) {
            own.squares += more.squares;
            own.sum += more.sum;
        }
        self.parts.extend(observed.parts);
        self.stretches.extend(observed.stretches);
        if !observed.phase_sums.is_empty() {
            phase_sums::add(&mut self.phase_sums, observed.phase_sums);
        }
        let own = self.partition.take();
        self.partition = PartitionCondition::joined(own, observed.partition);
    }
}

/// Equations of one run for a system.
#[derive(Debug, Clone, Default)]
pub(crate) struct RunEquations {
    pub(crate) parts: Vec<RunPart>,
    pub(crate) stretches: Vec<Stretch>,
    /// Mean equations of the phases of each line; empty without periodic motion.
    pub(crate) phase_sums: Vec<PhaseSums>,
    pub(crate) partition: Option<PartitionCondition>,
    /// As in the system.
    pub(crate) instruments: Vec<Factor>,
    /// As in the system.
    pub(crate) totals: Vec<MeasuredSums>,
    /// Equations at the plotted points, line by line: points × (columns + 1).
    pub(crate) points: Vec<DMatrix<f64>>,
}

/// The problem of kept actuators that are singular at a sample.
pub(crate) fn singular(motion: &Motion, sample: usize) -> Problem {
    Problem::new(
        Code::KEPT_ACTUATORS,
        format!(
            "sample {} (t = {:.4} s): the kept actuators do not determine the platform's motion",
            motion.first_sample + sample,
            motion.time(sample)
        ),
    )
    .file(motion.run.as_str())
    .help("keep other actuators, or identify with the inputs projected on the platform")
}

/// Ratio of the largest to the smallest singular value; infinite for a singular matrix.
pub(crate) fn condition_number(matrix: &DMatrix<f64>) -> f64 {
    if matrix.is_empty() {
        return 1.0;
    }
    if matrix.iter().any(|value| !value.is_finite()) {
        return f64::INFINITY;
    }
    let values = matrix.singular_values();
    if values.min() > 0.0 {
        values.max() / values.min()
    } else {
        f64::INFINITY
    }
}
