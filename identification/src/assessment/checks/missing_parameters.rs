//! Tests whether the residual depends on velocity, acceleration, position or time.
//!
//! Such a dependence is an effect that the model lacks.

use super::{
    Context,
    level::{level, origin},
    suspected::{Harm, Tested, guilty, harm, tested, worst_harm},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        evidence::{Axis, Curve, Evidence},
        suspects::{Group, Scores, Shape, Suspect},
    },
    called::called,
    error::Error,
    significant,
};

/// Tests all torques and forces that the model may lack.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let (suspects, found) = all_tested(scores);
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let (tests, level) = (found.len(), level(found.len()));
    let ratio = |one: &Tested| one.accused.strength();
    let worst = guilty(&found, level);
    let limit = worst.unwrap_or(&found[0]).accused.quantile(level);
    let check = Check::new(CheckKind::MissingParameter, About::Model, "")
        .shown_by(evidence(&suspects, &found, limit));
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
    let place = found.iter().position(|one| std::ptr::eq(one, worst));
    let place = place.unwrap_or(0);
    let mut harm = worst_harm(context, scores, (&found, worst), level);
    let others = others((context, scores), (&suspects, &found, place), level);
    for (_, other) in &others {
        harm.with(context, other);
    }
    let rest = format!(
        "which explains {} % of the residual's square; {}{}",
        significant(100.0 * worst.accused.explained, 2),
        harm.words(),
        too(&others)
    );
    let words = words(context, suspects[place], worst, rest);
    let check = Check { words, ..check }
        .measured(ratio(worst), "standard deviations")
        .against(limit, origin(tests))
        .because(&harm);
    let actuator = match suspects[place].0 {
        Suspect::Torque(actuator, _) => context.model.info().actuators.get(actuator),
        _ => None,
    };
    Ok(vec![match actuator {
        Some(name) => check.of_actuator(name),
        None => check,
    }])
}

/// All testable torque and force hypotheses, with their shapes.
fn all_tested(scores: &Scores) -> (Vec<(Suspect, Shape)>, Vec<Tested>) {
    let (mut suspects, mut found) = (Vec::new(), Vec::new());
    for (place, suspect) in scores.suspects.iter().enumerate() {
        if let Suspect::Torque(_, shape) | Suspect::Force(_, shape) = *suspect {
            for one in tested(scores, std::iter::once(Group::suspect(place))) {
                suspects.push((*suspect, shape));
                found.push(one);
            }
        }
    }
    (suspects, found)
}

/// Describes the strongest hypothesis; `rest` is the consequence.
fn words(
    context: &Context<'_>,
    (suspect, shape): (Suspect, Shape),
    worst: &Tested,
    rest: String,
) -> String {
    let info = context.model.info();
    let (what, name) = match suspect {
        Suspect::Force(line, _) => ("force on", info.coordinates.get(line)),
        Suspect::Torque(actuator, _) => ("torque of", info.actuators.get(actuator)),
        _ => ("", None),
    };
    let told = Told {
        what: format!("{what} {}", called(name.copied().unwrap_or_default())),
        size: worst.accused.largest(),
        strength: worst.accused.strength(),
        rest,
    };
    match suspect {
        Suspect::Torque(actuator, Shape::Stribeck) => told.near_standstill(context, actuator),
        Suspect::Torque(actuator, _) => {
            let revolute = info.actuator_is_revolute.get(actuator) == Some(&true);
            told.words(shape, shape.unit(revolute))
        }
        _ => told.words(shape, ""),
    }
}

/// Strongest harmful hypothesis of every other drive and coordinate.
///
/// If all drives share a fault, chance decides which of them has the strongest result.
fn others(
    (context, scores): (&Context<'_>, &Scores),
    (suspects, found, worst): (&[(Suspect, Shape)], &[Tested], usize),
    level: f64,
) -> Vec<(String, Harm)> {
    let info = context.model.info();
    let place = |suspect: Suspect| match suspect {
        Suspect::Torque(actuator, _) => (0, actuator),
        Suspect::Force(line, _) => (1, line),
        _ => (2, 0),
    };
    let mut places: Vec<(usize, usize)> = suspects.iter().map(|(one, _)| place(*one)).collect();
    let own = places[worst];
    places.sort_unstable();
    places.dedup();
    places.retain(|one| *one != own);
    let worst_of = |at: (usize, usize)| {
        let all = suspects.iter().zip(found);
        let beyond = all
            .filter(|((one, _), tested)| place(*one) == at && tested.accused.probability < level);
        let explained = |one: &Tested| one.accused.explained;
        let (_, tested) = beyond.max_by(|a, b| explained(a.1).total_cmp(&explained(b.1)))?;
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
struct Told {
    /// The dependent torque or force.
    what: String,
    /// δ, with its sign.
    size: f64,
    /// δ divided by its standard deviation.
    strength: f64,
    /// Consequence.
    rest: String,
}

impl Told {
    /// Sentence for a shape whose size has a unit.
    fn words(&self, shape: Shape, unit: &str) -> String {
        let size = format!(", by {} {unit}", significant(self.size, 3));
        let by = match shape {
            // The waves are nearly collinear, so their sizes have no meaning.
            Shape::Waves => "",
            _ => size.trim_end(),
        };
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
fn evidence(suspects: &[(Suspect, Shape)], found: &[Tested], limit: f64) -> Evidence {
    let mut points: Vec<(Shape, Curve)> = Vec::new();
    for ((suspect, shape), one) in suspects.iter().zip(found) {
        let (Suspect::Torque(number, _) | Suspect::Force(number, _)) = *suspect else {
            continue;
        };
        let place = points.iter().position(|(own, _)| own == shape);
        let place = place.unwrap_or_else(|| {
            points.push((*shape, Curve::new(shape.words(), &[], &[])));
            points.len() - 1
        });
        let curve = &mut points[place].1;
        curve.x.push((number + 1) as f64);
        curve
            .y
            .push(one.accused.strength() * one.accused.largest().signum());
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
