//! Tests whether the residuals of two actuators are correlated.
//!
//! An overactuated robot is not tested: its residual is that of the platform projection.
//!
//! Position errors of a robot with coupled axes correlate the residuals, too: an error of one
//! position is an acceleration in the equations of both actuators. That covariance falls with the
//! fifth power of the bandwidth, that of white torque noise with the first power, and that of a
//! slow force hardly at all. So a correlation is confirmed by a test in half the band.

use crate::{
    assessment::{
        check::{About, Check, CheckKind},
        checks::{
            Context,
            level::{level, origin},
            torques::half_band::scores_in_half_the_band,
        },
        evidence::{Axis, Curve, Evidence},
        hypotheses::Correlation,
    },
    estimation::intervals::distributions::student_quantile,
};
use overact_logs::{Error, significant};

/// Smaller correlations are ignored.
const SMALLEST: f64 = 0.1;

/// Fraction of the covariance that must remain in half the band.
///
/// Half of the covariance of white noise remains there, and a thirty-second of that of white position
/// errors.
const REMAINING: f64 = 0.35;

/// Tests all pairs of actuators.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let sizes = context.model.info().sizes;
    if sizes.actuators > sizes.dof {
        return Ok(Vec::new());
    }
    let pairs = context.scores.map(|scores| scores.correlations());
    let pairs = pairs.unwrap_or_default();
    let Some(most) = pairs
        .iter()
        .max_by(|a, b| a.strength.total_cmp(&b.strength))
    else {
        return Ok(Vec::new());
    };
    let (tests, level) = (pairs.len(), level(pairs.len()));
    let beyond = |one: &&Correlation| one.probability < level && one.value.abs() >= SMALLEST;
    let most_significant = pairs.iter().filter(beyond);
    let most_significant = most_significant.max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
    let is_confirmed = match most_significant {
        Some(own) => remains_in_half_the_band(context, own)?,
        None => false,
    };
    let names = context.model.info().actuators;
    let name = |actuator: usize| names.get(actuator).copied().unwrap_or_default();
    let shown = most_significant.unwrap_or(most);
    let (first, second) = (name(shown.actuators.0), name(shown.actuators.1));
    let found = format!(
        "the residuals of `{first}` and `{second}` are correlated: correlation {} ({:.1} standard deviations)",
        significant(shown.value, 2),
        shown.strength
    );
    let words = match most_significant {
        Some(_) if is_confirmed => format!(
            "{found}. The model lacks an effect on both: an external force, a cable, crosstalk between current measurements, or an error of the geometry. Joint torques that are sums of the same motor currents are correlated, too"
        ),
        Some(_) => format!("{found}, as by position errors: little of it remains in half the band"),
        None => String::from("the residuals of the actuators are uncorrelated"),
    };
    let check = Check::new(CheckKind::ResidualCorrelation, About::Fit, words)
        .measured(shown.strength, "standard deviations")
        .against(
            student_quantile(level, shown.freedom),
            format!("{}, and a correlation of {SMALLEST}", origin(tests)),
        )
        .shown_by(evidence(&pairs, &name));
    Ok(vec![if is_confirmed { check.found() } else { check }])
}

/// Whether enough of a covariance remains in half the band, or half the band cannot be tested.
fn remains_in_half_the_band(context: &Context<'_>, found: &Correlation) -> Result<bool, Error> {
    let Some(narrow) = scores_in_half_the_band(context)? else {
        return Ok(true);
    };
    let pairs = narrow.correlations();
    let same = pairs.iter().find(|one| one.actuators == found.actuators);
    Ok(same.is_none_or(|one| one.covariance / found.covariance >= REMAINING))
}

/// Plot of each actuator's correlations with the later ones.
fn evidence<'a>(pairs: &[Correlation], name: &dyn Fn(usize) -> &'a str) -> Evidence {
    let mut curves: Vec<(usize, Curve)> = Vec::new();
    for pair in pairs {
        let (first, second) = pair.actuators;
        if curves.last().is_none_or(|(own, _)| *own != first) {
            let label = format!("with {}", name(first));
            curves.push((first, Curve::new(&label, &[], &[])));
        }
        if let Some((_, curve)) = curves.last_mut() {
            curve.x.push((second + 1) as f64);
            curve.y.push(pair.value);
        }
    }
    Evidence {
        title: String::from("Correlation of the residuals"),
        x: Axis::new("number of the actuator", ""),
        y: Axis::new("correlation", ""),
        points: curves.into_iter().map(|(_, curve)| curve).collect(),
        ..Evidence::default()
    }
}
