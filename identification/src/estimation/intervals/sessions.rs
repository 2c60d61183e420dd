//! Increase of the variances from changes of the robot between recording sessions.
//!
//! Friction, temperature and load differ between days. Let the parameters of session s be χ + b_s,
//! with b_s of zero mean and the variance τ_i² of component i, equal for all sessions (random
//! effects; DerSimonian and Laird, *Controlled Clinical Trials* 7, 1986). With G_s of a session and
//! A = Σ_s G_s, the estimate moves by Σ_s P_s b_s, P_s = A^-1 G_s. The moved score of a session is
//! T_s = A^-1 s_s. With p_s = [P_s]_ii and the variance σ_i² without such changes,
//!
//! ```text
//! E Σ_s T_si² = κ_i σ_i² + τ_i² Σ_s p_s² (1 - 2 p_s + Σ_r p_r²),
//! Var χ_i = σ_i² + τ_i² Σ_s p_s².
//! ```
//!
//! κ_i = tr C/Σ_s a_s accounts for the fit, with C and a_s of the sessions as in `parts`. The first
//! equation gives τ_i², at least zero. Its part of the variance has one degree of freedom less than
//! there are sessions.

use nalgebra::{DMatrix, DVector};

use super::{parts, scores::Context};
use crate::{
    estimation::periodic_variance::VarianceRatio,
    regression::system::{RunPart, System},
};

/// Smallest fraction of a session in the estimate for which τ can be separated.
const LEAST_SEPARATION: f64 = 1e-3;

/// Gram matrix and score of a session.
struct Session {
    /// G_s A^-1.
    share: DMatrix<f64>,
    /// A^-1 s_s.
    moved: DVector<f64>,
}

/// Ratios of the variances with and without changes between sessions; `None` for one session.
///
/// `variances` are those without.
pub(super) fn ratios(
    system: &System,
    context: &Context<'_>,
    variances: &[f64],
) -> Option<Vec<VarianceRatio>> {
    let sessions = sessions(system, context);
    if sessions.len() < 2 {
        return None;
    }
    let own = variances.iter().enumerate();
    Some(
        own.map(|(i, variance)| ratio(&sessions, context, i, *variance))
            .collect(),
    )
}

/// Sums over the parts of the runs of each session.
fn sessions(system: &System, context: &Context<'_>) -> Vec<Session> {
    let mut numbers = system.sessions.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let session = |number: &usize| {
        let is_own = |part: &&RunPart| system.sessions.get(part.run) == Some(number);
        let own = || system.parts.iter().filter(is_own);
        let gram = own()
            .map(|part| parts::gram(part, context))
            .reduce(|a, b| a + b)?;
        let score = own()
            .map(|part| parts::score(part, context))
            .reduce(|a, b| a + b)?;
        Some(Session {
            share: gram * &context.inverse,
            moved: &context.inverse * score,
        })
    };
    numbers.iter().filter_map(session).collect()
}

/// Ratio of the variances of parameter `i`.
fn ratio(sessions: &[Session], context: &Context<'_>, i: usize, variance: f64) -> VarianceRatio {
    let fraction: Vec<f64> = sessions.iter().map(|one| one.share[(i, i)]).collect();
    let squares: f64 = fraction.iter().map(|p| p * p).sum();
    let separation: f64 = { &fraction }
        .iter()
        .map(|p| p * p * (1.0 - 2.0 * p + squares))
        .sum();
    let found: f64 = sessions.iter().map(|one| one.moved[i].powi(2)).sum();
    let excess = found - noise_left(sessions, context, i) * variance;
    let freedom = (sessions.len() - 1) as f64;
    let can_separate = separation > LEAST_SEPARATION * squares && variance > 0.0;
    if !can_separate || excess <= 0.0 {
        return VarianceRatio::ONE;
    }
    let between = excess * squares / separation;
    let whole = variance + between;
    VarianceRatio {
        ratio: whole / variance,
        freedom: freedom * (whole / between).powi(2),
    }
}

/// κ of parameter `i`: part of its variance that the moved scores of the sessions contain.
fn noise_left(sessions: &[Session], context: &Context<'_>, i: usize) -> f64 {
    let inverse = &context.inverse;
    let turned = context.estimation.inverse.transpose();
    let (mut all, mut fitted) = (0.0, 0.0);
    for one in sessions {
        let column = one.share.column(i);
        all += inverse.column(i).dot(&column);
        fitted += (&turned * column).norm_squared();
    }
    1.0 - fitted / all
}
