//! Fit of selected parameters by the Levenberg-Marquardt method, with poses eliminated.

use nalgebra::{DMatrix, DVector};

use super::elimination::{Eliminated, Normal, Problem, State};

/// Largest number of steps; a convergent fit needs fewer than ten.
const STEPS: usize = 60;

/// Step length at convergence, in standard deviations for the sensors' noise.
const SMALL_STEP: f64 = 1e-3;

/// Initial damping, its factors after a good and a bad step, and its limit.
const DAMPING: f64 = 1e-6;
const DAMPING_LESS: f64 = 0.1;
const DAMPING_MORE: f64 = 10.0;
const DAMPING_LARGEST: f64 = 1e8;

/// Fit of selected parameters; the others stay as described.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// Fitted parameters, in ascending order.
    pub(super) selected: Vec<usize>,
    /// Final state.
    pub(super) state: State,
    /// Equations of the final state.
    pub(super) equations: Vec<Eliminated>,
    /// Their normal equations, in all parameters.
    pub(super) normal: Normal,
    /// Whether the steps became small before their number was exhausted.
    pub(super) converged: bool,
}

impl Fit {
    /// Fits the parameters `selected` from a state; all others keep their changes.
    ///
    /// # Errors
    /// The robot cannot reach the start.
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
                // The poses may need a last step after the parameters have converged.
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
                // A step that leaves the workspace is too long, too.
                _ => damping *= DAMPING_MORE,
            }
            if damping > DAMPING_LARGEST {
                break;
            }
        }
        Ok(fit)
    }

    /// Damped step of all parameters; zero for those that are not fitted.
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

    /// Length of a step in standard deviations: √(δpᵀ N δp).
    fn size(&self, step: &DVector<f64>) -> f64 {
        step.dot(&(&self.normal.matrix * step)).max(0.0).sqrt()
    }

    /// Changes of the fitted parameters.
    pub(super) fn values(&self) -> Vec<f64> {
        let changes = &self.state.changes;
        self.selected.iter().map(|&place| changes[place]).collect()
    }
}

/// Selected rows and columns of a matrix.
pub(super) fn restricted(matrix: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    matrix.select_rows(places).select_columns(places)
}

/// Solves a positive definite system whose unknowns may have different units.
pub(super) fn solved(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let inverse = inverted(matrix)?;
    Some(inverse * right)
}

/// Inverse of a positive definite matrix whose rows may have different units.
pub(super) fn inverted(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scales = matrix.diagonal().map(|entry| 1.0 / entry.sqrt());
    let scale = DMatrix::from_diagonal(&scales);
    let factored = (&scale * matrix * &scale).cholesky()?;
    Some(&scale * factored.inverse() * &scale)
}
