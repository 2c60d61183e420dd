//! Tests whether the residual depends on velocity, acceleration, position or time.
//!
//! Such a dependence is an effect that the model lacks.

use super::{
    Context,
    fault_hypotheses::{Harm, TestedHypothesis, harm, most_significant, tested, worst_harm},
    level::{level, origin},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        evidence::{Axis, Curve, Evidence},
        hypotheses::{FaultHypothesis, Group, Scores, Shape},
    },
    display_names::called,
    error::Error,
    significant,
};

/// Tests all torques and forces that the model may lack.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let found = tested(
        scores,
        Group::hypotheses(scores, FaultHypothesis::is_missing_effect),
    );
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let (tests, level) = (found.len(), level(found.len()));
    let ratio = |one: &TestedHypothesis| one.wald.strength();
    let worst = most_significant(&found, level);
    let limit = worst.unwrap_or(&found[0]).wald.quantile(level);
    let check = Check::new(CheckKind::MissingParameter, About::Model, "")
        .shown_by(evidence(scores, &found, limit));
    let Some(worst) = worst else {
        let largest = found.iter().map(ratio).fold(0.0, f64::max);
        let words = format!(
            "the residual depends on no further function of velocity, acceleration, position or time ({tests} columns tested)"
        );
        return Ok(vec![
            Check { words, ..check }
                .measured(largest, "standard deviations")
                .against(limit, origin(tests)),
        ]);
    };
    let hypothesis = worst.hypothesis(scores);
    let mut harm = worst_harm(context, scores, &found, worst, level);
    let others = others(context, scores, &found, hypothesis, level);
    for (_, other) in &others {
        harm.with(context, other);
    }
    let rest = format!(
        "which explains {} % of the residual's square; {}{}",
        significant(100.0 * worst.wald.explained, 2),
        harm.words(),
        too(&others)
    );
    let words = words(context, hypothesis, worst, rest);
    let check = Check { words, ..check }
        .measured(ratio(worst), "standard deviations")
        .against(limit, origin(tests))
        .with_harm(&harm);
    let actuator = match hypothesis {
        FaultHypothesis::Torque(actuator, _) | FaultHypothesis::Crosstalk { to: actuator, .. } => {
            context.model.info().actuators.get(actuator)
        }
        _ => None,
    };
    Ok(vec![match actuator {
        Some(name) => check.of_actuator(name),
        None => check,
    }])
}

/// Describes the strongest hypothesis; `rest` is the consequence.
fn words(
    context: &Context<'_>,
    hypothesis: FaultHypothesis,
    worst: &TestedHypothesis,
    rest: String,
) -> String {
    let info = context.model.info();
    let named = |what: &str, name: Option<&&str>| {
        format!("{what} {}", called(name.copied().unwrap_or_default()))
    };
    let drive = |actuator: usize| named("torque of", info.actuators.get(actuator));
    let what = match hypothesis {
        FaultHypothesis::Force(line, _) => named("force on", info.coordinates.get(line)),
        FaultHypothesis::Torque(actuator, _) | FaultHypothesis::Crosstalk { to: actuator, .. } => {
            drive(actuator)
        }
        FaultHypothesis::Potential(_) => String::from("first joints"),
        _ => String::from("torque of every drive"),
    };
    let finding = Finding {
        what,
        size: worst.wald.largest(),
        strength: worst.wald.strength(),
        rest,
    };
    if matches!(hypothesis, FaultHypothesis::Potential(_)) {
        return finding.of_potential();
    }
    let Some(shape) = hypothesis.shape() else {
        let neighbour = match hypothesis {
            FaultHypothesis::Crosstalk { from, .. } => drive(from),
            _ => String::from("torques of its neighbours"),
        };
        return finding.of_crosstalk(&neighbour);
    };
    match hypothesis {
        FaultHypothesis::Torque(actuator, Shape::Stribeck) => {
            finding.near_standstill(context, actuator)
        }
        FaultHypothesis::Torque(actuator, _) => {
            let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
            finding.words(shape, Some(shape.unit(revolute)))
        }
        FaultHypothesis::Force(..) => finding.words(shape, Some("")),
        _ => finding.words(shape, None),
    }
}

/// Strongest harmful hypothesis of every other drive and coordinate.
///
/// If all drives share a fault, chance decides which of them has the strongest result.
fn others(
    context: &Context<'_>,
    scores: &Scores,
    found: &[TestedHypothesis],
    strongest: FaultHypothesis,
    level: f64,
) -> Vec<(String, Harm)> {
    let info = context.model.info();
    let place = |hypothesis: FaultHypothesis| match hypothesis {
        FaultHypothesis::Torque(actuator, _) | FaultHypothesis::Crosstalk { to: actuator, .. } => {
            (0, actuator)
        }
        FaultHypothesis::Force(line, _) => (1, line),
        _ => (2, 0),
    };
    let place_of = |one: &TestedHypothesis| place(one.hypothesis(scores));
    let mut places: Vec<(usize, usize)> = found.iter().map(place_of).collect();
    places.sort_unstable();
    places.dedup();
    places.retain(|one| *one != place(strongest) && one.0 < 2);
    if place(strongest).0 == 2 {
        return Vec::new();
    }
    let worst_of = |at: (usize, usize)| {
        let beyond = found
            .iter()
            .filter(|one| place_of(one) == at && one.wald.probability < level);
        let tested = beyond.max_by(|a, b| a.wald.explained.total_cmp(&b.wald.explained))?;
        let harm = harm(context, scores, tested);
        let names = match at.0 {
            0 => info.actuators,
            _ => info.coordinates,
        };
        let name = names.get(at.1).copied().unwrap_or_default();
        (harm.grade > Grade::Use).then(|| (name.to_owned(), harm))
    };
    places.into_iter().filter_map(worst_of).collect()
}

/// Names the others, as the end of a sentence.
fn too(others: &[(String, Harm)]) -> String {
    let names: Vec<String> = others.iter().map(|(name, _)| format!("`{name}`")).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!("; the same test also fails for {}", names.join(", "))
    }
}

/// Data for the words of a finding.
struct Finding {
    /// The dependent torque or force.
    what: String,
    /// δ, with its sign.
    size: f64,
    /// δ divided by its standard deviation.
    strength: f64,
    /// Consequence.
    rest: String,
}

impl Finding {
    /// Sentence for a constant force or a weight.
    fn of_potential(&self) -> String {
        format!(
            "the {} feel a further potential ({:.1} standard deviations), as of a constant force on a body, a balancer, a cable or a tilted base, {}. Look for such forces and add them to the description, or check the direction of `gravity`",
            self.what, self.strength, self.rest
        )
    }

    /// Sentence for crosstalk from a `neighbour`.
    fn of_crosstalk(&self, neighbour: &str) -> String {
        format!(
            "the {} contains up to {} % of the {neighbour} ({:.1} standard deviations), {}. Look for crosstalk in the measurement of the torques, for a coupling of the gears that the description lacks, and for swapped columns",
            self.what,
            significant(100.0 * self.size.abs(), 3),
            self.strength,
            self.rest
        )
    }

    /// Sentence for a shape whose size has a `unit`; `None` for several sizes.
    fn words(&self, shape: Shape, unit: Option<&str>) -> String {
        let by = match (shape, unit) {
            // The waves are nearly collinear, so their sizes have no meaning.
            (Shape::Waves | Shape::LoadWaves, _) | (_, None) => String::new(),
            (_, Some(unit)) => format!(", by {} {unit}", significant(self.size, 3)),
        };
        let by = by.trim_end();
        format!(
            "the {} depends on {} beyond the model{by} ({:.1} standard deviations), {}. Add the missing term to the description, or look for other differences from it",
            self.what,
            shape.words(),
            self.strength,
            self.rest
        )
    }

    /// Sentence for friction that differs near standstill; only rising friction is Stribeck's.
    fn near_standstill(&self, context: &Context<'_>, actuator: usize) -> String {
        let info = context.model.info();
        let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
        let (unit, rate) = if revolute {
            ("N m", "rad/s")
        } else {
            ("N", "m/s")
        };
        let identified = context.watched.iter().take(context.dataset.runs.len());
        let speeds = identified.filter_map(|one| one.monitor.speeds().get(actuator).copied());
        let fading = significant(Shape::fading(speeds.fold(0.0, f64::max)), 2);
        let limits = &context.settings.standstill_velocity;
        let left_out = match limits.get(actuator) {
            Some(limit) if *limit > 0.0 => format!(
                " Equations below `standstill_velocity`, {} {rate}, are skipped, so lower velocities are not tested.",
                significant(*limit, 2)
            ),
            _ => String::new(),
        };
        let (does, advice) = if self.size > 0.0 {
            (
                "rises",
                "Set `stribeck` of the joint, the velocity over which its friction rises, or look for other causes near standstill",
            )
        } else {
            (
                "falls",
                "That is not Stribeck's friction, which rises there: check how low velocities are measured and filtered, consider presliding friction, or skip more equations with `standstill_velocity`",
            )
        };
        format!(
            "the friction in the {} {does} towards standstill by {} {unit} beyond the model, over about {fading} {rate} ({:.1} standard deviations), {}.{left_out} {advice}",
            self.what,
            significant(self.size.abs(), 3),
            self.strength,
            self.rest
        )
    }
}

/// Plot of size by standard deviation for all hypotheses, grouped by shape.
fn evidence(scores: &Scores, found: &[TestedHypothesis], limit: f64) -> Evidence {
    let mut points: Vec<(Shape, Curve)> = Vec::new();
    for one in found {
        let (FaultHypothesis::Torque(number, shape) | FaultHypothesis::Force(number, shape)) =
            one.hypothesis(scores)
        else {
            continue;
        };
        let place = points.iter().position(|(own, _)| *own == shape);
        let place = place.unwrap_or_else(|| {
            points.push((shape, Curve::new(shape.words(), &[], &[])));
            points.len() - 1
        });
        let curve = &mut points[place].1;
        curve.x.push((number + 1) as f64);
        curve
            .y
            .push(one.wald.strength() * one.wald.largest().signum());
    }
    Evidence {
        title: String::from("Possible missing terms of the model"),
        x: Axis::new("number of the actuator or coordinate", ""),
        y: Axis::new("size by standard deviation", ""),
        points: points.into_iter().map(|(_, curve)| curve).collect(),
        limits: vec![-limit, limit],
        ..Evidence::default()
    }
}
