//! Products of columns and residual by section of a run's time, and their cosine sums.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DVector};

use super::{
    columns::{FaultHypothesis, Layout},
    pairs::Pairs,
    potential::MOST,
    products::{LineGroup, Products, WeightedRows, live_columns::LiveColumns},
    shapes::{ActuatorState, PositionRange, Shape},
};
use crate::{
    estimation::{
        intervals::scores::{SECTIONS, cosines},
        periodic_variance::Mean,
    },
    regression::phase_sums::{PhaseSums, Phases},
};

/// Scores of one run, as sums over cosines of its time.
#[derive(Debug, Clone)]
pub(super) struct RunScores {
    products: Products,
    /// Products of actuator pairs.
    pub(super) pairs: Pairs,
    /// B, number of cosines of the covariance.
    pub(super) cosines: usize,
    /// Σ ρ², weighted, and its number of equations.
    pub(super) square: f64,
    pub(super) equations: usize,
    /// Number of lines of the model.
    pub(super) lines: usize,
    /// ρ² of each sample, weighted and summed over the lines.
    pub(super) squares: Vec<f64>,
    /// Timing of the run and pace of the actuators.
    pub(super) tempo: Tempo,
    /// For periodic motion: mean rows and residual of each line at each phase.
    pub(super) folds: Vec<PhaseSums>,
}

/// Mean residual of a periodic motion, and the runs that have it.
#[derive(Debug, Clone)]
pub(super) struct MotionMean {
    pub(super) runs: Vec<usize>,
    pub(super) mean: Mean,
}

/// Timing of a run and pace of its motion.
#[derive(Debug, Clone, Default)]
pub(super) struct Tempo {
    /// Time of the first sample from the start of the log, and sampling interval, s.
    pub(super) start: f64,
    pub(super) interval: f64,
    /// Σ q̇² and Σ q̈² of each actuator over the samples.
    pub(super) velocities: Vec<f64>,
    pub(super) accelerations: Vec<f64>,
    /// Number of these samples.
    pub(super) samples: usize,
}

impl Tempo {
    /// Adds velocities and accelerations of all actuators, sample by sample.
    pub(super) fn take(&mut self, actuators: &[ActuatorState]) {
        let n = self.velocities.len().max(1);
        self.samples += actuators.len() / n;
        for row in actuators.chunks_exact(n) {
            let sums = self.velocities.iter_mut().zip(&mut self.accelerations);
            for ((velocities, accelerations), own) in sums.zip(row) {
                *velocities += own.velocity * own.velocity;
                *accelerations += own.acceleration * own.acceleration;
            }
        }
    }
}

impl RunScores {
    /// Wᵀ Z over cosine m.
    pub(super) fn cross(&self, layout: &Layout, m: usize) -> DMatrixView<'_, f64> {
        let size = layout.base * layout.columns;
        let all = &self.products.cross.as_slice()[m * size..(m + 1) * size];
        DMatrixView::from_slice(all, layout.base, layout.columns)
    }

    /// Products of some base parameter columns with some of all columns, over cosine m.
    pub(super) fn cross_products(
        &self,
        layout: &Layout,
        m: usize,
        rows: &[usize],
        columns: &[usize],
    ) -> DMatrix<f64> {
        let all = self.cross(layout, m);
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| all[(rows[i], columns[j])])
    }

    /// Products of the columns of a block with each other, over cosine m.
    pub(super) fn own(&self, layout: &Layout, block: usize, m: usize) -> DMatrixView<'_, f64> {
        let (place, first) = (&layout.places[block], m * layout.squares);
        let all = &self.products.own.as_slice()[first + place.start..first + place.end];
        let width = layout.blocks[block].len();
        DMatrixView::from_slice(all, width, width)
    }

    /// Zᵀ ρ, columns × cosines.
    pub(super) fn scores(&self) -> &DMatrix<f64> {
        &self.products.scores
    }
}

/// Parameters that convert decimated rows to equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    pub(super) hypotheses: &'a [FaultHypothesis],
    pub(super) layout: &'a Layout,
    /// Position ranges of the actuators in all runs.
    pub(super) position_ranges: &'a [PositionRange],
    /// Weight of each line, and estimate of each base parameter.
    pub(super) weights: &'a [f64],
    pub(super) values: &'a [f64],
}

/// Accumulates the equations of a run.
pub(super) struct Sink<'a> {
    frame: Frame<'a>,
    /// Live columns of each line, the index of each column among them, and lines alike.
    live: &'a [LiveColumns],
    indices: Vec<Vec<Option<usize>>>,
    groups: Vec<LineGroup>,
    /// Number of samples so far, and in total.
    taken: usize,
    expected: usize,
    /// Columns of constant torques, by which waves are multiplied.
    constants: Vec<usize>,
    /// Columns of the gains, by which waves of the load are multiplied.
    gains: Vec<usize>,
    products: Products,
    pairs: Pairs,
    equations: usize,
    squares: Vec<f64>,
    phases: Option<Phases>,
    folds: Vec<PhaseSums>,
}

impl<'a> Sink<'a> {
    /// For lines with these columns and this number of samples, with the phases of a periodic motion.
    pub(super) fn new(
        frame: Frame<'a>,
        live: &'a [LiveColumns],
        instants: usize,
        phases: Option<Phases>,
    ) -> Self {
        let columns_of = |wanted: fn(&FaultHypothesis) -> bool| -> Vec<usize> {
            let hypotheses = frame.hypotheses.iter().zip(&frame.layout.blocks);
            let wanted = hypotheses.filter(|(one, _)| wanted(one));
            wanted
                .flat_map(|(_, block)| block.first().copied())
                .collect()
        };
        let constants =
            columns_of(|one| matches!(one, FaultHypothesis::Torque(_, Shape::Constant)));
        let gains = columns_of(|one| matches!(one, FaultHypothesis::Gain(_)));
        let sections = (SECTIONS * cosines(instants)).min(instants).max(1);
        let indices = live.iter().map(|own| own.indices(frame.layout.columns));
        Self {
            frame,
            live,
            indices: indices.collect(),
            groups: LineGroup::all(frame.layout, live),
            taken: 0,
            expected: instants,
            pairs: Pairs::new(constants.len(), sections),
            constants,
            gains,
            products: Products::new(frame.layout, sections),
            equations: 0,
            squares: Vec::new(),
            phases,
            folds: Vec::new(),
        }
    }

    /// The scores of the run with this timing.
    pub(super) fn into_scores(self, tempo: Tempo) -> RunScores {
        let sections = self.products.scores.ncols();
        let cosines = cosines(self.expected).min(sections / 2).max(1);
        let waves = DMatrix::from_fn(sections, 2 * cosines + 1, |k, m| {
            let angle = m as f64 * (k as f64 + 0.5) / sections as f64;
            (std::f64::consts::PI * angle).cos()
        });
        RunScores {
            products: self.products.over(&waves),
            pairs: self.pairs.over(&waves),
            cosines,
            square: self.squares.iter().sum(),
            equations: self.equations,
            lines: self.live.len(),
            squares: self.squares,
            tempo,
            folds: self.folds,
        }
    }

    /// Adds decimated rows of all lines, and decimated actuator positions.
    pub(super) fn take(&mut self, lines: &[Vec<f64>], positions: &[f64]) {
        let count = positions.len() / self.constants.len().max(1);
        if count == 0 {
            return;
        }
        let gradients = self.gradients(positions);
        let taken: Vec<WeightedRows> = lines
            .iter()
            .enumerate()
            .map(|(line, rows)| self.line(line, rows, positions, &gradients))
            .collect();
        self.fold(&taken);
        let mut first = 0;
        while first < count {
            let section = self.section(first);
            let same = (first..count).take_while(|sample| self.section(*sample) == section);
            let part = first..first + same.count();
            for group in &self.groups {
                let lines: Vec<&WeightedRows> =
                    group.lines.iter().map(|line| &taken[*line]).collect();
                let rows = together(&lines, part.clone());
                self.products.add(self.frame.layout, section, group, &rows);
            }
            first = part.end;
        }
        self.equations += count * lines.len();
        for sample in 0..count {
            let (n, constants) = (self.constants.len(), &self.constants);
            let jacobian = DMatrix::from_fn(n, lines.len(), |i, line| {
                let place = self.indices[line][constants[i]];
                place.map_or(0.0, |place| taken[line].columns[(sample, place)])
            });
            let residual = DVector::from_fn(lines.len(), |line, _| taken[line].residual[sample]);
            self.pairs.add(self.section(sample), &jacobian, &residual);
            self.squares.push(residual.norm_squared());
        }
        self.taken += count;
    }

    /// Adds rows of all lines at their phases of the motion.
    fn fold(&mut self, lines: &[WeightedRows]) {
        let Some(phases) = self.phases else {
            return;
        };
        let width = self.frame.layout.columns + 1;
        if self.folds.is_empty() {
            let fold = |_| PhaseSums::new(phases, width);
            self.folds = (0..lines.len()).map(fold).collect();
        }
        for ((fold, line), live) in self.folds.iter_mut().zip(lines).zip(self.live) {
            let mut whole = vec![0.0; width];
            let rows = line.columns.row_iter().zip(line.residual.iter());
            for (sample, (row, rest)) in rows.enumerate() {
                let columns = live.columns.iter().zip(row.iter());
                columns.for_each(|(column, value)| whole[*column] = *value);
                whole[width - 1] = *rest;
                fold.add(self.taken + sample, whole.iter());
            }
        }
    }

    /// Section of a sample, counted from the first sample of the next rows.
    fn section(&self, sample: usize) -> usize {
        let sections = self.products.scores.ncols();
        let section = (self.taken + sample) * sections / self.expected.max(1);
        section.min(sections - 1)
    }

    /// Weighted rows of a line, from its decimated rows.
    fn line(
        &self,
        line: usize,
        rows: &[f64],
        positions: &[f64],
        gradients: &[Gradients],
    ) -> WeightedRows {
        let live = &self.live[line];
        let count = rows.len() / (live.decimated + 1);
        let weight = self.frame.weights.get(line).copied().unwrap_or(1.0);
        let all = DMatrix::from_row_slice(count, live.decimated + 1, rows) * weight;
        let models = live.models();
        let mut residual: DVector<f64> = all.column(models).clone_owned();
        for (place, column) in live.columns[..models].iter().enumerate() {
            let value = self.frame.values.get(*column).copied().unwrap_or(0.0);
            residual.axpy(-value, &all.column(place), 1.0);
        }
        let mut columns = all.remove_column(models);
        columns.resize_horizontally_mut(live.columns.len(), 0.0);
        self.add_waves(&self.indices[line], &mut columns, positions);
        self.add_potentials(&self.indices[line], &mut columns, gradients);
        WeightedRows { columns, residual }
    }

    /// Fills in the waves of decimated positions, multiplied by the column of a constant torque, or
    /// by that of the gain for waves of the load.
    ///
    /// `indices` are those of all columns among the columns of the line.
    fn add_waves(&self, indices: &[Option<usize>], all: &mut DMatrix<f64>, positions: &[f64]) {
        let n = self.constants.len();
        for (hypothesis, block) in self.frame.hypotheses.iter().zip(&self.frame.layout.blocks) {
            let (actuator, factors) = match *hypothesis {
                FaultHypothesis::Torque(actuator, Shape::Waves) => (actuator, &self.constants),
                FaultHypothesis::Torque(actuator, Shape::LoadWaves) => (actuator, &self.gains),
                _ => continue,
            };
            let first = block.first().and_then(|column| indices[*column]);
            let (Some(first), Some(factor)) = (first, indices[factors[actuator]]) else {
                continue;
            };
            let position_range = self.frame.position_ranges[actuator];
            for row in 0..all.nrows() {
                let factor = all[(row, factor)];
                let waves = position_range.waves(positions[row * n + actuator]);
                for (wave, value) in waves.iter().enumerate() {
                    all[(row, first + wave)] = factor * value;
                }
            }
        }
    }

    /// Gradients of all products of a potential at decimated positions, product by product.
    fn gradients(&self, positions: &[f64]) -> Vec<Gradients> {
        let rows = positions.chunks_exact(self.constants.len().max(1));
        let mut potentials = self.frame.hypotheses.iter();
        let potential = potentials.find_map(|one| match one {
            FaultHypothesis::Potential(joints) => Some(*joints),
            _ => None,
        });
        let Some(joints) = potential else {
            return Vec::new();
        };
        let all = |row: &[f64]| -> Gradients {
            let products = 0..joints.products();
            products
                .map(|product| joints.gradient(product, row))
                .collect()
        };
        rows.map(all).collect()
    }

    /// Fills in the gradients of potentials, multiplied by the columns of constant torques.
    fn add_potentials(
        &self,
        indices: &[Option<usize>],
        all: &mut DMatrix<f64>,
        gradients: &[Gradients],
    ) {
        for (hypothesis, block) in self.frame.hypotheses.iter().zip(&self.frame.layout.blocks) {
            let first = block.first().and_then(|column| indices[*column]);
            let (FaultHypothesis::Potential(_), Some(first)) = (hypothesis, first) else {
                continue;
            };
            for (row, gradients) in gradients.iter().enumerate() {
                for (product, gradient) in gradients.iter().enumerate() {
                    let torques = self.constants.iter().zip(gradient);
                    let torques = torques.map(|(constant, part)| {
                        let place = indices[*constant];
                        place.map_or(0.0, |place| all[(row, place)] * part)
                    });
                    all[(row, first + product)] = torques.sum();
                }
            }
        }
    }
}

/// Gradients of the products of a potential at one time.
type Gradients = Vec<[f64; MOST]>;

/// Rows of some samples of lines, stacked line by line.
fn together(lines: &[&WeightedRows], instants: Range<usize>) -> WeightedRows {
    let count = instants.len();
    let width = lines.first().map_or(0, |own| own.columns.ncols());
    let mut columns = DMatrix::zeros(lines.len() * count, width);
    let mut residual = DVector::zeros(lines.len() * count);
    for (line, own) in lines.iter().enumerate() {
        let place = line * count;
        columns
            .rows_mut(place, count)
            .copy_from(&own.columns.rows_range(instants.clone()));
        residual
            .rows_mut(place, count)
            .copy_from(&own.residual.rows_range(instants.clone()));
    }
    WeightedRows { columns, residual }
}
