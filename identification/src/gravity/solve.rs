//! Direction of gravity with the smallest weighted residual.

use nalgebra::{DMatrix, DVector};
use overact::Code;

use super::{columns::Extended, direction::GravityFrame, observation::combined};
use crate::{
    estimation::estimate::{Estimation, fit},
    regression::{
        elimination::eliminate,
        factor::{DATA_RANK_TOLERANCE, Factor, ReducedFactor},
        system::System,
    },
    settings::Settings,
};
use overact_logs::{Error, Problem};

/// Largest number of updates of the weights.
const OUTER: usize = 20;

/// Largest number of steps for given weights.
const INNER: usize = 60;

/// Change of the direction at which the iteration ends, rad: far below any standard deviation.
const TOLERANCE: f64 = 1e-10;

/// Change above which it has not converged, rad.
const CONVERGED: f64 = 1e-6;

/// Largest step, rad.
const LARGEST_STEP: f64 = 0.3;

/// Relative damping of the diagonal at which the search ends.
const LARGEST_DAMPING: f64 = 1e9;

/// A direction with its estimate.
#[derive(Debug, Clone)]
pub(super) struct GravitySolution {
    pub(super) frame: GravityFrame,
    /// Columns of the estimated parameters, as combinations of the independent ones.
    pub(super) columns: DMatrix<f64>,
    /// Estimates.
    pub(super) values: DVector<f64>,
    /// Derivatives of the inputs with respect to the angles, as combinations of columns.
    pub(super) slopes: DMatrix<f64>,
    /// These derivatives minus their projection onto the columns of the parameters.
    pub(super) free: DMatrix<f64>,
    /// JᵀJ of the projected derivatives.
    pub(super) normal: DMatrix<f64>,
    /// Weight of each line.
    pub(super) weights: Vec<f64>,
    /// Standard deviation of the weighted residual.
    pub(super) deviation: f64,
}

/// A direction with its best parameters.
struct GravityFit {
    values: DVector<f64>,
    columns: DMatrix<f64>,
    slopes: DMatrix<f64>,
    free: DMatrix<f64>,
    /// Squared residual, without the part that no column explains.
    square: f64,
    /// JᵀJ and Jᵀ ρ of the projected derivatives J.
    normal: DMatrix<f64>,
    right: DVector<f64>,
}

/// Direction with the best fit, starting from a frame and restricted to its rotations.
///
/// # Errors
/// Data that do not determine the parameters, or steps that do not converge.
pub(super) fn solve(
    extended: &Extended,
    system: &System,
    start: &GravityFrame,
    settings: &Settings,
) -> Result<GravitySolution, Error> {
    let all: Vec<usize> = (0..extended.len()).collect();
    let base = base(extended, start);
    let mut frame = start.clone();
    let mut change = f64::INFINITY;
    for _ in 0..OUTER {
        let weights = weighted(extended, system, &frame, &base, settings)?.weights;
        let reduced = Factor::reduced_together(&system.lines, &weights, &all);
        let next = with_weights(extended, &reduced, &base, frame.clone());
        change = (next.direction - frame.direction).norm();
        frame = next;
        if change < TOLERANCE {
            break;
        }
    }
    if change.is_nan() || change > CONVERGED {
        let message =
            "the direction of gravity is not determined: the estimation does not converge";
        let help =
            "check the geometry, signs and units of the log first, without `gravity_direction`";
        return Err(Problem::new(Code::GRAVITY_DIRECTION, message)
            .help(help)
            .into());
    }
    let estimation = weighted(extended, system, &frame, &base, settings)?;
    let reduced = Factor::reduced_together(&system.lines, &estimation.weights, &all);
    let best = best_fit(extended, &reduced, &base, &frame);
    Ok(GravitySolution {
        frame,
        columns: best.columns,
        values: best.values,
        slopes: best.slopes,
        free: best.free,
        normal: best.normal,
        weights: estimation.weights,
        deviation: estimation.residual_deviation,
    })
}

/// Parameters that are independent if gravity is slightly rotated.
fn base(extended: &Extended, frame: &GravityFrame) -> Vec<usize> {
    let angles = DVector::from_fn(frame.tilts.len(), |tilt, _| 0.1 + 0.05 * tilt as f64);
    let columns = extended.at(&frame.rotated(&angles).gravity());
    let all: Vec<usize> = (0..extended.names.len()).collect();
    eliminate(&(&extended.random * columns), &all, 1e-9).kept
}

/// Estimate of the parameters for a direction, with the weights of the lines.
fn weighted(
    extended: &Extended,
    system: &System,
    frame: &GravityFrame,
    base: &[usize],
    settings: &Settings,
) -> Result<Estimation, Error> {
    let columns = extended.at(&frame.gravity()).select_columns(base);
    let rotated_system = combined(system, &columns);
    let ones = vec![1.0; rotated_system.lines.len()];
    let merged = Factor::merged(&rotated_system.lines, &ones);
    let all: Vec<usize> = (0..base.len()).collect();
    let kept = eliminate(merged.matrix(), &all, DATA_RANK_TOLERANCE).kept;
    fit(&rotated_system, &kept, settings)
}

/// Best direction for given weights.
fn with_weights(
    extended: &Extended,
    reduced: &ReducedFactor,
    base: &[usize],
    mut frame: GravityFrame,
) -> GravityFrame {
    let mut current = best_fit(extended, reduced, base, &frame);
    let mut damping = 0.0;
    for _ in 0..INNER {
        let diagonal = current.normal.diagonal();
        let damped = &current.normal + DMatrix::from_diagonal(&diagonal) * damping;
        let Some(step) = damped.lu().solve(&current.right) else {
            break;
        };
        let length = step.norm();
        let step = step * (LARGEST_STEP / length).min(1.0);
        let candidate_frame = frame.rotated(&step);
        let candidate = best_fit(extended, reduced, base, &candidate_frame);
        if candidate.square <= current.square {
            (frame, current) = (candidate_frame, candidate);
            damping = if damping < 1e-6 { 0.0 } else { damping / 10.0 };
            if length < TOLERANCE {
                break;
            }
        } else {
            damping = (damping * 10.0).max(1e-4);
            if damping > LARGEST_DAMPING || length < TOLERANCE {
                break;
            }
        }
    }
    frame
}

/// Best parameters for a direction, from the weighted R factor and right-hand side.
fn best_fit(
    extended: &Extended,
    reduced: &ReducedFactor,
    base: &[usize],
    frame: &GravityFrame,
) -> GravityFit {
    let ReducedFactor { triangle, rhs, .. } = reduced;
    let columns = extended.at(&frame.gravity()).select_columns(base);
    let mut matrix = triangle * &columns;
    let all: Vec<usize> = (0..base.len()).collect();
    let kept = eliminate(&matrix, &all, DATA_RANK_TOLERANCE).kept;
    let columns = columns.select_columns(&kept);
    matrix = matrix.select_columns(&kept);
    let norms: Vec<f64> = matrix.column_iter().map(|own| own.norm()).collect();
    for (mut column, norm) in matrix.column_iter_mut().zip(&norms) {
        column /= *norm;
    }
    let parts = matrix.qr();
    let (q, r) = (parts.q(), parts.r());
    let along = q.tr_mul(rhs);
    let scaled = r.solve_upper_triangular(&along);
    let scaled = scaled.unwrap_or_else(|| DVector::zeros(norms.len()));
    let values = DVector::from_fn(norms.len(), |at, _| scaled[at] / norms[at]);
    let rest = rhs - &q * along;
    let parameters: Vec<usize> = kept.iter().map(|at| base[*at]).collect();
    let slope = |tilt: &nalgebra::Vector3<f64>| {
        let field = extended.in_field(&(tilt * frame.size));
        field.select_columns(&parameters) * &values
    };
    let slopes = DMatrix::from_columns(&frame.tilts.iter().map(slope).collect::<Vec<_>>());
    let mut outside = triangle * &slopes;
    let mut compensation = DMatrix::zeros(norms.len(), slopes.ncols());
    for _ in 0..2 {
        let inside = q.tr_mul(&outside);
        outside -= &q * &inside;
        compensation += inside;
    }
    let mut compensation = r
        .solve_upper_triangular(&compensation)
        .unwrap_or(compensation);
    for (mut row, norm) in compensation.row_iter_mut().zip(&norms) {
        row /= *norm;
    }
    GravityFit {
        square: rest.norm_squared(),
        normal: outside.tr_mul(&outside),
        right: outside.tr_mul(&rest),
        free: &slopes - &columns * compensation,
        values,
        columns,
        slopes,
    }
}
