//! The observation system (39)-(41) of an identification model.
//!
//! Case 1 projects the inputs on the platform, Γ¹ = (J_p^inv)ᵀ τ, with the columns of IDM_red (30).
//! Case 2 projects them on r kept actuators: with J_a the kept rows of J_p^inv, Γ² = J_a^-T Γ¹, and
//! the same for every column (36). Without redundancy all actuators are kept, which is eq. (19), and
//! eq. (1) for a robot without a loop.
//!
//! Y and every column are decimated in parallel (40) and their rows sorted by line of Γ (41). What is
//! kept of them does not grow with the data: one R `factor` for each line and part of
//! a run, and some stretches of successive equations, from which the correlation of the residual is
//! told.

use nalgebra::DMatrix;
use overact::Code;
use overact::Info;
use serde::Serialize;

use super::{
    factor::Factor,
    fold::{self, Folds},
    projection::Projection,
};
use crate::{error::Problem, kinematics::Motion};

/// How badly conditioned the kept rows J_a of J_p^inv get along a trajectory, and where. It depends
/// on the units of the platform's coordinates; above 30 or so case 2 suffers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartitionCondition {
    /// Largest condition number (2-norm).
    pub largest: f64,
    /// Name of the run in which it occurs.
    pub run: String,
    /// Sample of the log.
    pub sample: usize,
    /// Time of that sample, s from the start of the log.
    pub time: f64,
    /// How often the determinant of J_a changes its sign: the partition's singularity is crossed, be
    /// it between two samples.
    pub crossings: usize,
}

impl PartitionCondition {
    /// What two runs, or two parts of one, have together.
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

/// The system of all runs.
#[derive(Debug, Clone)]
pub struct System {
    /// On what the inputs are projected.
    pub projection: Projection,
    /// Names of the lines of Γ.
    pub line_names: Vec<String>,
    /// R factor of each line.
    pub lines: Vec<Factor>,
    /// Parts of the runs, of which some can be held out.
    pub parts: Vec<Part>,
    /// Successive equations as they are, from which the correlation of the residual is told.
    pub stretches: Vec<Stretch>,
    /// Of each motion that returns, the mean equations of its phases.
    pub(crate) folds: Vec<Folds>,
    /// Where actuators are kept: how well they determine the platform.
    pub partition: Option<PartitionCondition>,
    /// With instruments, R factor of the columns, the instruments and Y of each line; else empty.
    pub instruments: Vec<Factor>,
}

/// The equations of a part of a run.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Part {
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
    /// For each line of Γ: equations x (columns + 1), Y last.
    pub lines: Vec<DMatrix<f64>>,
    /// With instruments, for each line of Γ: equations x columns; else empty.
    pub instruments: Vec<DMatrix<f64>>,
}

impl System {
    /// A system without equations in `parameters` unknowns.
    #[must_use]
    pub fn new(projection: Projection, info: &Info<'_>, parameters: usize) -> Self {
        Self {
            line_names: projection.line_names(info),
            lines: vec![Factor::new(parameters); info.sizes.dof],
            projection,
            parts: Vec::new(),
            stretches: Vec::new(),
            folds: Vec::new(),
            partition: None,
            instruments: Vec::new(),
        }
    }

    /// With instruments to come for every equation.
    pub(crate) fn with_instruments(mut self) -> Self {
        let wide = |line: &Factor| Factor::new(2 * line.parameters());
        self.instruments = self.lines.iter().map(wide).collect();
        self
    }

    /// Adds the equations of a run.
    pub(crate) fn extend(&mut self, observed: Observed) {
        for (line, factor) in self.lines.iter_mut().enumerate() {
            let of_line = observed
                .parts
                .iter()
                .filter_map(|part| part.lines.get(line));
            of_line.for_each(|part| factor.add(part));
        }
        // Instruments serve if all equations have them.
        if observed.instruments.is_empty() {
            self.instruments.clear();
        }
        let lines = self.instruments.iter_mut().zip(&observed.instruments);
        lines.for_each(|(line, factor)| line.add(factor));
        self.parts.extend(observed.parts);
        self.stretches.extend(observed.stretches);
        if !observed.folds.is_empty() {
            fold::add(&mut self.folds, observed.folds);
        }
        let own = self.partition.take();
        self.partition = PartitionCondition::joined(own, observed.partition);
    }
}

/// What one run adds to a system.
#[derive(Debug, Clone, Default)]
pub(crate) struct Observed {
    pub(crate) parts: Vec<Part>,
    pub(crate) stretches: Vec<Stretch>,
    /// For a motion that returns, of each line the mean equations of its phases; else empty.
    pub(crate) folds: Folds,
    pub(crate) partition: Option<PartitionCondition>,
    /// As in the system.
    pub(crate) instruments: Vec<Factor>,
    /// Equations at the points of the plots, line by line: points x (columns + 1).
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
