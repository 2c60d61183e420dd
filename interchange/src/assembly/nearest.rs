//! The configuration of a tree that comes closest to closing its loops.

use super::motion::{Motion, State};
use nalgebra::{DMatrix, DVector};

/// Largest number of steps.
const STEPS: usize = 200;
/// Steps below this end the search, rad or m.
const SMALL: f64 = 1e-12;
/// Damping at the start, at least and at most, as a fraction of the largest diagonal entry.
const DAMPING: [f64; 3] = [1e-3, 1e-14, 1e6];

/// Configuration near `start` with the least sum of squared closure residuals, m² and rad².
///
/// Levenberg-Marquardt steps: they converge where the loops can't close, and the closure Jacobian
/// is singular.
pub(super) fn nearest(motion: &Motion<'_>, start: &State) -> State {
    let mut state = start.clone();
    let [mut damping, least, most] = DAMPING;
    let (gaps, mut jacobian) = motion.closure(&state);
    let mut gaps = DVector::from_vec(gaps);
    for _ in 0..STEPS {
        let Some(step) = step(&jacobian, &gaps, damping) else {
            break;
        };
        let moved = motion.moved_by(&state, &step);
        let (left, next) = motion.closure(&moved);
        let left = DVector::from_vec(left);
        if left.norm_squared() < gaps.norm_squared() {
            (state, gaps, jacobian) = (moved, left, next);
            damping = (0.3 * damping).max(least);
        } else {
            damping *= 4.0;
        }
        if step.amax() < SMALL || damping > most {
            break;
        }
    }
    state
}

/// Damped step towards smaller residuals; `None` if it is not finite.
fn step(jacobian: &DMatrix<f64>, gaps: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let mut normal = jacobian.transpose() * jacobian;
    let added = damping * normal.diagonal().amax().max(f64::MIN_POSITIVE);
    for at in 0..normal.nrows() {
        normal[(at, at)] += added;
    }
    let step = -normal.cholesky()?.solve(&(jacobian.transpose() * gaps));
    step.iter().all(|value| value.is_finite()).then_some(step)
}
