//! Products of columns and residual, section by section of a run's time, and their sums over cosines of
//! the time.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, DMatrixViewMut, DVector};

use super::{
    columns::{Layout, Suspect},
    pairs::Pairs,
    shapes::{Moment, Reach, Shape},
};
use crate::{
    estimation::intervals::scores::cosines,
    regression::fold::{Fold, Folds, Phases},
};

/// Sections of a run for each cosine of the covariance.
const SECTIONS: usize = 4;

/// Products of columns and residual: a column for each section of the run, or for each cosine
/// cos(π m (k + 1/2)/K) over its K sections, m = 0 … 2 B. Columns W are the base parameters', Z all.
#[derive(Debug, Clone)]
struct Products {
    /// Wᵀ Z, p x columns, weighted.
    cross: DMatrix<f64>,
    /// Products of the columns of a block with each other, one block behind the other.
    own: DMatrix<f64>,
    /// Zᵀ ρ.
    scores: DMatrix<f64>,
}

/// What one run tells, as sums over cosines of its time.
#[derive(Debug, Clone)]
pub(super) struct RunScores {
    products: Products,
    /// Products of pairs of actuators.
    pub(super) pairs: Pairs,
    /// B, the cosines of the covariance.
    pub(super) cosines: usize,
    /// Σ ρ², weighted, and how many equations it is of.
    pub(super) square: f64,
    pub(super) equations: usize,
    /// Lines of the model.
    pub(super) lines: usize,
    /// ρ² of each instant, summed over the lines, weighted.
    pub(super) squares: Vec<f64>,
    /// How the run is timed and how the actuators move.
    pub(super) tempo: Tempo,
    /// For a motion that returns, of each line the mean rows of all columns and the residual at each phase.
    pub(super) folds: Folds,
}

/// The time of a run and the frequencies of its motion.
#[derive(Debug, Clone, Default)]
pub(super) struct Tempo {
    /// From the beginning of the log to the first instant, and from one to the next, s.
    pub(super) start: f64,
    pub(super) interval: f64,
    /// Σ q̇² and Σ q̈² of each actuator over the samples.
    pub(super) velocities: Vec<f64>,
    pub(super) accelerations: Vec<f64>,
}

impl Tempo {
    /// Notes velocities and accelerations of all actuators, sample by sample.
    pub(super) fn take(&mut self, actuators: &[Moment]) {
        let n = self.velocities.len().max(1);
        for row in actuators.chunks_exact(n) {
            let sums = self.velocities.iter_mut().zip(&mut self.accelerations);
            for ((velocities, accelerations), own) in sums.zip(row) {
                *velocities += own.velocity * own.velocity;
                *accelerations += own.acceleration * own.acceleration;
            }
        }
    }
}

impl Products {
    /// Those of no rows.
    fn new(layout: &Layout, sections: usize) -> Self {
        Self {
            cross: DMatrix::zeros(layout.base * layout.columns, sections),
            own: DMatrix::zeros(layout.squares, sections),
            scores: DMatrix::zeros(layout.columns, sections),
        }
    }

    /// Adds rows of all columns with their residual to a section.
    fn add(
        &mut self,
        layout: &Layout,
        section: usize,
        (all, residual): (&DMatrix<f64>, &DVector<f64>),
    ) {
        let size = layout.base * layout.columns;
        let cross = &mut self.cross.as_mut_slice()[section * size..(section + 1) * size];
        let mut cross = DMatrixViewMut::from_slice(cross, layout.base, layout.columns);
        cross.gemm(1.0, &all.columns(0, layout.base).transpose(), all, 1.0);
        let first = section * layout.squares;
        for (block, place) in layout.blocks.iter().zip(&layout.places) {
            let own = &mut self.own.as_mut_slice()[first + place.start..first + place.end];
            let mut own = DMatrixViewMut::from_slice(own, block.len(), block.len());
            let columns = all.columns_range(block.clone());
            own.gemm_tr(1.0, &columns, &columns, 1.0);
        }
        let mut scores = self.scores.column_mut(section);
        scores.gemv_tr(1.0, all, residual, 1.0);
    }

    /// Its sums over cosines.
    fn over(&self, waves: &DMatrix<f64>) -> Self {
        Self {
            cross: &self.cross * waves,
            own: &self.own * waves,
            scores: &self.scores * waves,
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

    /// Products of some columns of base parameters with some of all columns, over cosine m.
    pub(super) fn beside(
        &self,
        layout: &Layout,
        m: usize,
        (rows, columns): (&[usize], &[usize]),
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

    /// Zᵀ ρ, columns x cosines.
    pub(super) fn scores(&self) -> &DMatrix<f64> {
        &self.products.scores
    }
}

/// What makes equations of decimated rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    pub(super) suspects: &'a [Suspect],
    pub(super) layout: &'a Layout,
    /// Where the actuators move in all runs.
    pub(super) reaches: &'a [Reach],
    /// The weight of each line, and for each base parameter its estimate.
    pub(super) weights: &'a [f64],
    pub(super) values: &'a [f64],
}

/// Where the equations of a run go.
pub(super) struct Sink<'a> {
    frame: Frame<'a>,
    /// Instants that have come, and those to come in all.
    taken: usize,
    expected: usize,
    /// The columns of constant torques, by which waves are multiplied.
    constants: Vec<usize>,
    products: Products,
    pairs: Pairs,
    equations: usize,
    lines: usize,
    squares: Vec<f64>,
    phases: Option<Phases>,
    folds: Folds,
}

impl<'a> Sink<'a> {
    /// For so many instants, at the phases of a motion that returns.
    pub(super) fn new(frame: Frame<'a>, instants: usize, phases: Option<Phases>) -> Self {
        let constant = |one: &Suspect| matches!(one, Suspect::Torque(_, Shape::Constant));
        let suspects = frame.suspects.iter().zip(&frame.layout.blocks);
        let constants = suspects.filter(|(one, _)| constant(one));
        let constants: Vec<usize> = constants.map(|(_, block)| block.start).collect();
        let sections = (SECTIONS * cosines(instants)).min(instants).max(1);
        Self {
            frame,
            taken: 0,
            expected: instants,
            pairs: Pairs::new(constants.len(), sections),
            constants,
            products: Products::new(frame.layout, sections),
            equations: 0,
            lines: 0,
            squares: Vec::new(),
            phases,
            folds: Vec::new(),
        }
    }

    /// What the run tells that was gone through in this time.
    pub(super) fn told(self, tempo: Tempo) -> RunScores {
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
            lines: self.lines,
            squares: self.squares,
            tempo,
            folds: self.folds,
        }
    }

    /// Takes decimated rows of all lines, and the decimated positions of the actuators.
    pub(super) fn take(&mut self, lines: &[Vec<f64>], positions: &[f64]) {
        let count = positions.len() / self.constants.len().max(1);
        if count == 0 {
            return;
        }
        let taken: Vec<(DMatrix<f64>, DVector<f64>)> = lines
            .iter()
            .enumerate()
            .map(|(line, rows)| self.line(line, (rows, count), positions))
            .collect();
        self.fold(&taken);
        let mut first = 0;
        while first < count {
            let section = self.section(first);
            let same = (first..count).take_while(|sample| self.section(*sample) == section);
            let part = first..first + same.count();
            let (rows, left) = together(&taken, part.clone());
            self.products
                .add(self.frame.layout, section, (&rows, &left));
            first = part.end;
        }
        self.equations += count * lines.len();
        self.lines = lines.len();
        for sample in 0..count {
            let (n, constants) = (self.constants.len(), &self.constants);
            let jacobian = DMatrix::from_fn(n, lines.len(), |i, line| {
                taken[line].0[(sample, constants[i])]
            });
            let residual = DVector::from_fn(lines.len(), |line, _| taken[line].1[sample]);
            self.pairs.add(self.section(sample), &jacobian, &residual);
            self.squares.push(residual.norm_squared());
        }
        self.taken += count;
    }

    /// Adds rows of all lines at the phases of the motion.
    fn fold(&mut self, lines: &[(DMatrix<f64>, DVector<f64>)]) {
        let Some(phases) = self.phases else {
            return;
        };
        if self.folds.is_empty() {
            let fold = |_| Fold::new(phases, self.frame.layout.columns + 1);
            self.folds = (0..lines.len()).map(fold).collect();
        }
        for (fold, (rows, residual)) in self.folds.iter_mut().zip(lines) {
            for (sample, (row, rest)) in rows.row_iter().zip(residual.iter()).enumerate() {
                let row = row.iter().chain(std::iter::once(rest));
                fold.add(self.taken + sample, row);
            }
        }
    }

    /// The section of a sample of those that come.
    fn section(&self, sample: usize) -> usize {
        let sections = self.products.scores.ncols();
        let section = (self.taken + sample) * sections / self.expected.max(1);
        section.min(sections - 1)
    }

    /// The rows of a line with all columns, weighted, and its residual.
    fn line(
        &self,
        line: usize,
        (rows, count): (&[f64], usize),
        positions: &[f64],
    ) -> (DMatrix<f64>, DVector<f64>) {
        let layout = self.frame.layout;
        let weight = self.frame.weights.get(line).copied().unwrap_or(1.0);
        let all = DMatrix::from_row_slice(count, rows.len() / count, rows) * weight;
        let mut residual: DVector<f64> = all.column(layout.base).clone_owned();
        for (column, value) in self.frame.values.iter().enumerate() {
            residual.axpy(-value, &all.column(column), 1.0);
        }
        let mut all = all.remove_column(layout.base);
        all.resize_horizontally_mut(layout.columns, 0.0);
        self.add_waves(&mut all, positions);
        (all, residual)
    }

    /// Fills in the waves: those of a decimated position, times what a torque of its actuator is worth in
    /// this line.
    fn add_waves(&self, all: &mut DMatrix<f64>, positions: &[f64]) {
        let n = self.constants.len();
        for (suspect, block) in self.frame.suspects.iter().zip(&self.frame.layout.blocks) {
            let Suspect::Torque(actuator, Shape::Waves) = *suspect else {
                continue;
            };
            let reach = self.frame.reaches[actuator];
            for row in 0..all.nrows() {
                let share = all[(row, self.constants[actuator])];
                let waves = reach.waves(positions[row * n + actuator]);
                for (column, wave) in block.clone().zip(waves) {
                    all[(row, column)] = share * wave;
                }
            }
        }
    }
}

/// Some instants of all lines, one line below the other: rows and residual.
fn together(
    lines: &[(DMatrix<f64>, DVector<f64>)],
    instants: Range<usize>,
) -> (DMatrix<f64>, DVector<f64>) {
    let (count, columns) = (instants.len(), lines.first().map_or(0, |own| own.0.ncols()));
    let mut rows = DMatrix::zeros(lines.len() * count, columns);
    let mut left = DVector::zeros(lines.len() * count);
    for (line, (all, residual)) in lines.iter().enumerate() {
        let place = line * count;
        rows.rows_mut(place, count)
            .copy_from(&all.rows_range(instants.clone()));
        left.rows_mut(place, count)
            .copy_from(&residual.rows_range(instants.clone()));
    }
    (rows, left)
}
