//! Effect of position noise on the columns of the regressor.
//!
//! The columns are computed from measured positions q + δ, so they contain W(q) and the change ΔW
//! from the noise δ. To estimate ΔW, noise δ' of the same size is added to the start of some runs.
//! The noisy positions then pass filters, differences and forward kinematics like the measured
//! ones:
//!
//! ```text
//! ΔW = W(q + δ') - W(q),   N = ΔWᵀ Λ² ΔW.
//! ```
//!
//! With R of the weighted columns, the eigenvalues λ of R^-T N R^-1 are the noise fractions of the
//! directions of W (W. Fuller, *Measurement Error Models*, 1987). Least squares underestimates a
//! direction by the fraction λ. A direction with λ near 1 contains no motion.

use nalgebra::{DMatrix, DVector};

use super::position_noise::with_added_noise;
use crate::regression::{
    factor::Factor,
    observation::MeasuredRun,
    observer::Observer,
    system::{RunEquations, System},
};
use overact_logs::{Error, Log};

/// Samples of a run that are used in addition to those that the filters need.
const SAMPLES: usize = 4096;

/// Fewest equations of each line, if the run is long enough.
const EQUATIONS: usize = 256;

/// Number of runs that are used.
const RUNS: usize = 4;

/// R factors of ΔW of one projection.
#[derive(Debug, Clone)]
pub(crate) struct ColumnNoise {
    lines: Vec<Factor>,
}

/// Directions of weighted columns, with their noise fractions.
#[derive(Debug, Clone)]
pub(crate) struct Directions {
    /// λ of each direction.
    pub(crate) noise: Vec<f64>,
    /// Change of each parameter for a step along each direction, parameters × directions.
    ///
    /// The step changes the weighted equations by one standard deviation of the residual.
    pub(crate) steps: DMatrix<f64>,
    /// Estimate along each direction, in the same unit.
    pub(crate) sizes: DVector<f64>,
}

impl ColumnNoise {
    /// Column noise of all projections of an observer; `None` for one without equations.
    ///
    /// # Errors
    /// A log cannot be read any more.
    pub(crate) fn all(observer: &Observer<'_>, runs: &[Log]) -> Result<Vec<Option<Self>>, Error> {
        let parameters = observer.base.len();
        let lines = observer.model.info().sizes.dof;
        let mut all: Vec<Option<Self>> = observer.projections.iter().map(|_| None).collect();
        let stride = runs.len().div_ceil(RUNS).max(1);
        for (number, log) in runs.iter().enumerate().step_by(stride) {
            let settings = observer.settings;
            let used = SAMPLES.max(EQUATIONS * settings.decimation);
            let piece = log.beginning(settings.samples_needed() + used)?;
            let noisy = with_added_noise(&piece)?;
            let measured = MeasuredRun {
                number,
                log: &piece,
                instruments: Some(&noisy),
                budget: 0,
                periodic_motion: None,
            };
            // Skip this run if the noise leaves the workspace.
            let Ok((observed, _)) = observer.run(&measured, &|_, _| {}) else {
                continue;
            };
            for (own, observed) in all.iter_mut().zip(observed) {
                let Ok(observed) = observed else { continue };
                if observed.instruments.is_empty() {
                    continue;
                }
                own.get_or_insert_with(|| Self {
                    lines: vec![Factor::new(parameters); lines],
                })
                .add(&observed);
            }
        }
        Ok(all)
    }

    /// Adds the equations of a run.
    fn add(&mut self, observed: &RunEquations) {
        for (own, line) in self.lines.iter_mut().zip(&observed.instruments) {
            let parameters = own.parameters();
            let difference = DMatrix::from_fn(2 * parameters, parameters, |row, column| {
                if row == column {
                    -1.0
                } else if row == column + parameters {
                    1.0
                } else {
                    0.0
                }
            });
            own.add(&line.combined(&difference));
        }
    }

    /// Directions of the columns `selected` of a weighted system, with their `values`.
    ///
    /// `None` for linearly dependent columns.
    pub(crate) fn directions(
        &self,
        system: &System,
        weights: &[f64],
        selected: &[usize],
        values: &[f64],
    ) -> Option<Directions> {
        let p = selected.len();
        let triangle = Factor::reduced_together(&system.lines, weights, selected).triangle;
        let inverse = triangle.solve_upper_triangular(&DMatrix::identity(p, p))?;
        let size = self.lines.first()?.matrix().nrows();
        let mut noise = DMatrix::zeros(size * self.lines.len(), p);
        for (place, (own, all)) in self.lines.iter().zip(&system.lines).enumerate() {
            let more = all.equations() as f64 / own.equations().max(1) as f64;
            let scale = weights.get(place)? * more.sqrt();
            for (to, from) in selected.iter().enumerate() {
                let mut rows = noise.view_mut((place * size, to), (size, 1));
                rows.copy_from(&(own.matrix().column(*from) * scale));
            }
        }
        let decomposed = (noise * &inverse).try_svd(false, true, f64::EPSILON, 0)?;
        let turned = decomposed.v_t?;
        let sizes = &turned * (&triangle * DVector::from_column_slice(values));
        Some(Directions {
            noise: decomposed
                .singular_values
                .iter()
                .map(|one| one * one)
                .collect(),
            steps: inverse * turned.transpose(),
            sizes,
        })
    }
}
