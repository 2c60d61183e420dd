//! The fit of some of the parameters: the method of Levenberg and Marquardt on the equations that are
//! free of poses.

use nalgebra::{DMatrix, DVector};

use super::elimination::{Eliminated, Normal, Problem, State};

/// Steps, at most; a fit that converges takes fewer than ten.
const STEPS: usize = 60;

/// A fit has ended when a step is below this part of the deviations of all parameters under the
/// sensors' noise.
const SMALL_STEP: f64 = 1e-3;

/// Damping at the start, its change after a good and a bad step, and where it gives up.
const DAMPING: f64 = 1e-6;
const DAMPING_LESS: f64 = 0.1;
const DAMPING_MORE: f64 = 10.0;
const DAMPING_LARGEST: f64 = 1e8;

/// A fit of some parameters; the others are as described.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// The parameters that were fitted, in ascending order.
    pub(super) selected: Vec<usize>,
    /// Where it ended.
    pub(super) state: State,
    /// The equations there.
    pub(super) equations: Vec<Eliminated>,
    /// Their normal equations, in all parameters.
    pub(super) normal: Normal,
    /// Whether the steps became small, and not merely too many.
    pub(super) converged: bool,
}

impl Fit {
    /// Fits the parameters `selected` from a state on; all others keep the changes that the state has.
    ///
    /// # Errors
    /// A start that the robot does not reach.
    pub(super) fn new(
        problem: &Problem<'_>,
        mut state: State,
        mut selected: Vec<usize>,
    ) -> Result<Self, overact::Error> {
        selected.sort_unstable();
        let equations = problem.eliminated(&mut state)?;
        let normal = Normal::new(&equations, problem.parameters());
        let mut fit = Self {
            selected,
            state,
            equations,
            normal,
            converged: false,
        };
        let mut damping = DAMPING;
        for _ in 0..STEPS {
            let Some(step) = fit.step(damping) else { break };
            let size = fit.size(&step);
            let mut state = problem.moved(&fit.state, &fit.equations, &step);
            let tried = problem.eliminated(&mut state);
            let tried = tried.map(|all| (Normal::new(&all, problem.parameters()), all));
            match tried {
                // The poses may need a last step where the parameters are settled.
                Ok((normal, equations))
                    if normal.square <= fit.normal.square || size < SMALL_STEP =>
                {
                    fit.state = state;
                    fit.normal = normal;
                    fit.equations = equations;
                    if size < SMALL_STEP {
                        fit.converged = true;
                        break;
                    }
                    damping *= DAMPING_LESS;
                }
                // A step out of the workspace is too long as well.
                _ => damping *= DAMPING_MORE,
            }
            if damping > DAMPING_LARGEST {
                break;
            }
        }
        Ok(fit)
    }

    /// The damped step of all parameters, zero for those that are not fitted.
    fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let mut step = DVector::zeros(self.normal.right.len());
        if self.selected.is_empty() {
            return Some(step);
        }
        let mut matrix = restricted(&self.normal.matrix, &self.selected);
        for k in 0..self.selected.len() {
            matrix[(k, k)] *= 1.0 + damping;
        }
        let right = self.normal.right.select_rows(&self.selected);
        let solved = solved(&matrix, &right)?;
        for (&place, value) in self.selected.iter().zip(solved.iter()) {
            step[place] = *value;
        }
        Some(step)
    }

    /// The length of a step in units of the deviations: √(δpᵀ N δp).
    fn size(&self, step: &DVector<f64>) -> f64 {
        step.dot(&(&self.normal.matrix * step)).max(0.0).sqrt()
    }

    /// The changes of the fitted parameters.
    pub(super) fn values(&self) -> Vec<f64> {
        let changes = &self.state.changes;
        self.selected.iter().map(|&place| changes[place]).collect()
    }
}

/// Rows and columns of a matrix.
pub(super) fn restricted(matrix: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    matrix.select_rows(places).select_columns(places)
}

/// Solves a positive definite system whose unknowns may have different units.
pub(super) fn solved(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let inverse = inverted(matrix)?;
    Some(inverse * right)
}

/// The inverse of a positive definite matrix whose rows may have different units.
pub(super) fn inverted(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scales = matrix.diagonal().map(|entry| 1.0 / entry.sqrt());
    let scale = DMatrix::from_diagonal(&scales);
    let factored = (&scale * matrix * &scale).cholesky()?;
    Some(&scale * factored.inverse() * &scale)
}
