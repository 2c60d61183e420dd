//! Tests whether the residual depends on velocity, acceleration, position or time.
//!
//! Such a dependence is an effect that the model lacks.

use crate::assessment::{
    check::{About, Check, CheckKind, Grade},
    checks::{
        Context,
        fault_hypotheses::{Harm, TestedHypothesis, harm, most_significant, tested, worst_harm},
        level::{level, origin},
    },
    detectable::Detectable,
    evidence::{Axis, Curve, Evidence},
    hypotheses::{FaultHypothesis, Group, Scores, Shape, wave_amplitude},
};
use overact_logs::{Error, called, significant};

/// Tests all torques and forces that the model may lack.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
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
        .detecting(detection_limits(context, scores, &found, level))
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
    let others = harmful_elsewhere(context, scores, &found, hypothesis, level);
    for (_, other) in &others {
        harm.with(context, other);
    }
    let consequence = format!(
        "which explains {} % of the residual's square; {}{}",
        significant(100.0 * worst.wald.explained, 2),
        harm.words(),
        failures_elsewhere(&others)
    );
    let words = sentence(context, hypothesis, worst, consequence);
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

/// Detection limits of the harmful torques and forces that the model may lack.
///
/// The most harmful one comes first, waves over the position last.
fn detection_limits(
    context: &Context<'_>,
    scores: &Scores,
    found: &[TestedHypothesis],
    level: f64,
) -> Vec<Detectable> {
    let info = context.model.info();
    let mut harmful: Vec<Detectable> = Vec::new();
    for one in found {
        let hypothesis = one.hypothesis(scores);
        let line = EquationLine::of(hypothesis);
        let (name, is_revolute) = match line {
            EquationLine::Actuator(number) => (
                info.actuators.get(number),
                info.actuator_is_revolute.get(number) == Some(&true),
            ),
            EquationLine::Coordinate(number) => (info.coordinates.get(number), false),
            EquationLine::All => (None, true),
        };
        let unit = match (hypothesis, hypothesis.shape()) {
            // Those of each drive are tested one by one, too, and so are the products of a potential.
            (
                FaultHypothesis::Force(..)
                | FaultHypothesis::AllTorques(_)
                | FaultHypothesis::AllCrosstalk
                | FaultHypothesis::Potential(_),
                _,
            ) => continue,
            (_, Some(shape)) => shape.unit(is_revolute),
            (FaultHypothesis::PotentialTerm(_), _) => "N m",
            _ => "",
        };
        let limit = match hypothesis.shape() {
            Some(shape) if shape.is_waves() => {
                one.detectable_in_worst(context, scores, unit, level, wave_amplitude)
            }
            _ => one.detectable_in_base(context, scores, unit, one.wald.visible(level)),
        };
        let Some(limit) = limit else {
            continue;
        };
        if !limit.is_harmful() {
            continue;
        }
        let limit = Detectable {
            name: name.copied().unwrap_or_default().to_owned(),
            ..limit
        };
        harmful.push(limit);
    }
    // A sum of waves imitates nearly any torque, so that it is the most harmful one of nearly all.
    let is_waves = |limit: &Detectable| limit.hypothesis.shape().is_some_and(Shape::is_waves);
    harmful.sort_by(|a, b| {
        let size = b.shift_deviations.total_cmp(&a.shift_deviations);
        is_waves(a).cmp(&is_waves(b)).then(size)
    });
    harmful
}

/// Sentence on the strongest hypothesis, which ends with its consequence.
fn sentence(
    context: &Context<'_>,
    hypothesis: FaultHypothesis,
    worst: &TestedHypothesis,
    consequence: String,
) -> String {
    let info = context.model.info();
    let named = |quantity: &str, name: Option<&&str>| {
        format!("{quantity} {}", called(name.copied().unwrap_or_default()))
    };
    let drive = |actuator: usize| named("torque of", info.actuators.get(actuator));
    let quantity = match hypothesis {
        FaultHypothesis::Force(line, _) => named("force on", info.coordinates.get(line)),
        FaultHypothesis::Torque(actuator, _) | FaultHypothesis::Crosstalk { to: actuator, .. } => {
            drive(actuator)
        }
        potential if potential.is_potential() => String::from("first joints"),
        _ => String::from("torque of every drive"),
    };
    let finding = Finding {
        quantity,
        size: worst.wald.largest(),
        strength: worst.wald.strength(),
        consequence,
    };
    if hypothesis.is_potential() {
        return finding.potential_sentence();
    }
    let Some(shape) = hypothesis.shape() else {
        let neighbour = match hypothesis {
            FaultHypothesis::Crosstalk { from, .. } => drive(from),
            _ => String::from("torques of its neighbours"),
        };
        return finding.crosstalk_sentence(&neighbour);
    };
    match hypothesis {
        FaultHypothesis::Torque(actuator, Shape::Stribeck) => {
            finding.standstill_sentence(context, actuator)
        }
        FaultHypothesis::Torque(actuator, _) => {
            let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
            finding.sentence(shape, Some(shape.unit(revolute)))
        }
        FaultHypothesis::Force(..) => finding.sentence(shape, Some("")),
        _ => finding.sentence(shape, None),
    }
}

/// Equations in which a missing term acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum EquationLine {
    /// Those of an actuator, by number.
    Actuator(usize),
    /// Those of a coordinate, by number.
    Coordinate(usize),
    All,
}

impl EquationLine {
    const fn of(hypothesis: FaultHypothesis) -> Self {
        match hypothesis {
            FaultHypothesis::Torque(actuator, _)
            | FaultHypothesis::Crosstalk { to: actuator, .. } => Self::Actuator(actuator),
            FaultHypothesis::Force(line, _) => Self::Coordinate(line),
            _ => Self::All,
        }
    }
}

/// Strongest harmful hypothesis of every other drive and coordinate.
///
/// If all drives share a fault, chance decides which of them has the strongest result.
fn harmful_elsewhere(
    context: &Context<'_>,
    scores: &Scores,
    found: &[TestedHypothesis],
    strongest: FaultHypothesis,
    level: f64,
) -> Vec<(String, Harm)> {
    let info = context.model.info();
    if EquationLine::of(strongest) == EquationLine::All {
        return Vec::new();
    }
    let line = |one: &TestedHypothesis| EquationLine::of(one.hypothesis(scores));
    let mut lines: Vec<EquationLine> = found.iter().map(line).collect();
    lines.sort_unstable();
    lines.dedup();
    lines.retain(|one| *one != EquationLine::of(strongest) && *one != EquationLine::All);
    let worst_of = |of: EquationLine| {
        let significant = found
            .iter()
            .filter(|one| line(one) == of && one.wald.probability < level);
        let tested = significant.max_by(|a, b| a.wald.explained.total_cmp(&b.wald.explained))?;
        let harm = harm(context, scores, tested);
        let name = match of {
            EquationLine::Actuator(number) => info.actuators.get(number),
            EquationLine::Coordinate(number) => info.coordinates.get(number),
            EquationLine::All => None,
        };
        let name = name.copied().unwrap_or_default();
        (harm.grade > Grade::Use).then(|| (name.to_owned(), harm))
    };
    lines.into_iter().filter_map(worst_of).collect()
}

/// Drives and coordinates that fail the same test, as the end of a sentence.
fn failures_elsewhere(others: &[(String, Harm)]) -> String {
    let names: Vec<String> = others.iter().map(|(name, _)| format!("`{name}`")).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!("; the same test also fails for {}", names.join(", "))
    }
}

/// Data for the words of a finding.
struct Finding {
    /// The torque or force that the model lacks.
    quantity: String,
    /// δ, with its sign.
    size: f64,
    /// δ divided by its standard deviation.
    strength: f64,
    /// Explained part of the residual, and harm.
    consequence: String,
}

impl Finding {
    /// Sentence for a constant force or a weight.
    fn potential_sentence(&self) -> String {
        format!(
            "the {} feel a further potential ({:.1} standard deviations), as of a constant force on a body, a balancer, a cable or a tilted base, {}. Look for such forces and add them to the description, or check the direction of `gravity`",
            self.quantity, self.strength, self.consequence
        )
    }

    /// Sentence for crosstalk from a `neighbour`.
    fn crosstalk_sentence(&self, neighbour: &str) -> String {
        format!(
            "the {} contains up to {} % of the {neighbour} ({:.1} standard deviations), {}. Look for crosstalk in the measurement of the torques, for a coupling of the gears that the description lacks, and for swapped columns",
            self.quantity,
            significant(100.0 * self.size.abs(), 3),
            self.strength,
            self.consequence
        )
    }

    /// Sentence for a shape whose size has a `unit`; `None` for several sizes.
    fn sentence(&self, shape: Shape, unit: Option<&str>) -> String {
        let size = match (shape, unit) {
            // The waves are nearly collinear, so their sizes have no meaning.
            (Shape::Waves | Shape::LoadWaves, _) | (_, None) => String::new(),
            (_, Some(unit)) => format!(", by {} {unit}", significant(self.size, 3)),
        };
        let size = size.trim_end();
        format!(
            "the {} depends on {} beyond the model{size} ({:.1} standard deviations), {}. Add the missing term to the description{}, or look for other differences from it",
            self.quantity,
            shape.words(),
            self.strength,
            self.consequence,
            shape.keys()
        )
    }

    /// Sentence for friction that differs near standstill; only rising friction is Stribeck's.
    fn standstill_sentence(&self, context: &Context<'_>, actuator: usize) -> String {
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
            self.quantity,
            significant(self.size.abs(), 3),
            self.strength,
            self.consequence
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
