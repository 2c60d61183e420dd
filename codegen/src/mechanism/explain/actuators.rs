//! Errors of actuators: too few, more driven motions than described, or a motion not determined.

use super::motions::{Motions, listed};
use crate::mechanism::mobility::Mobility;
use crate::mechanism::parasitic::{Parasitic, Rated};
use crate::mechanism::singular_values::SingularValues;
use crate::mechanism::states::random_states;
use crate::mechanism::{Home, Mechanism};
use nalgebra::DMatrix;
use overact_description::Description;
use overact_description::SIX;
use overact_description::diagnostic::{Code, Diagnostic, DiagnosticKind};

/// Fewer actuators than coordinates; states which motions the closed legs allow.
pub(in crate::mechanism) fn too_few_actuators(
    description: &Description,
    mechanism: &Mechanism,
    left: Option<(Mobility, Option<Parasitic>)>,
) -> Diagnostic {
    let (dof, count) = (mechanism.dof(), mechanism.actuator_count());
    let motion = description.platform.as_ref().map(|p| &p.motion);
    let span = motion.map_or(description.name.span.clone(), |m| m.span.clone());
    let actuators = if count == 1 { "actuator" } else { "actuators" };
    let owner = owner(mechanism);
    let degrees = if dof == 1 { "degree" } else { "degrees" };
    let message = match owner {
        ROBOT => format!("the robot has {dof} {degrees} of freedom, but {count} {actuators}"),
        _ => {
            format!("{owner} has {dof} {degrees} of freedom, but the robot has {count} {actuators}")
        }
    };
    let left = left.and_then(|(m, parasitic)| Some((m.of(motion?.value), m.parts(), parasitic)));
    let help = match left {
        Some((left, parts, parasitic)) if left < dof => {
            let (words, way) = match &parasitic {
                Some(found) => (words(&found.independent), parasitic_motions(found)),
                None => (
                    Motions::of_directions(&parts).words("along", "about"),
                    "choose a `motion` that the legs allow, or give the legs more passive joints"
                        .to_owned(),
                ),
            };
            format!(
                "the legs allow the platform only {left} of these {dof} motions ({words}), so more actuators do not help: {way}"
            )
        }
        _ if !mechanism.motors.is_empty() => {
            "mark more joints with actuated = true, or give more motors: a joint that a motor turns has no actuator of its own".to_owned()
        }
        _ => "mark more joints with actuated = true".to_owned(),
    };
    Diagnostic::new(Code::MOVES_FREELY, message, span)
        .label(legs_without_actuator(mechanism))
        .help(help)
}

/// Describes the platform's parasitic motion and how to declare it.
fn parasitic_motions(found: &Parasitic) -> String {
    format!(
        "these determine the others best (condition number {:.1} at home), and away from home the platform has parasitic motion with them, {}: write {} next to `motion`, or give the legs more passive joints",
        found.condition,
        words(&found.following),
        key(&found.independent)
    )
}

/// The key that names independent coordinates.
fn key(coordinates: &[usize]) -> String {
    let names = coordinates.iter().map(|&at| format!("\"{}\"", SIX[at]));
    format!("independent = [{}]", names.collect::<Vec<_>>().join(", "))
}

/// Independent coordinates of a platform with parasitic motion that are of the wrong number, or do
/// not determine the others.
pub(in crate::mechanism) fn independent(
    description: &Description,
    mechanism: &Mechanism,
    found: Option<&Rated>,
) -> Diagnostic {
    let span = description.platform.as_ref().map(|p| p.motion.span.clone());
    let span = span.unwrap_or(description.name.span.clone());
    let own = mechanism.dof();
    let Some(found) = found else {
        let left = Mobility::at_home(mechanism).map_or(0, |mobility| mobility.count());
        let help = match Parasitic::at_home(mechanism) {
            Some(found) => format!("write {}", key(&found.independent)),
            None if left == 6 => {
                "leave `independent` out: the legs allow the platform all six".to_owned()
            }
            None => "choose a `motion` that the legs allow, or give the legs other passive joints"
                .to_owned(),
        };
        let coordinates = if own == 1 {
            "coordinate is"
        } else {
            "coordinates are"
        };
        let motions = if left == 1 { "motion" } else { "motions" };
        let message = format!(
            "{own} {coordinates} independent, but the legs allow the platform {left} {motions}"
        );
        return Diagnostic::new(Code::NOT_HELD, message, span).help(help);
    };
    let message = "the independent coordinates do not determine the platform's motion at home";
    Diagnostic::new(Code::NOT_HELD, message, span)
        .label(if found.condition.is_finite() {
            format!("their condition number is {:.1e}", found.condition)
        } else {
            "they do not determine the others".to_owned()
        })
        .help(format!(
            "write {}, whose condition number is {:.1}",
            key(&found.best),
            found.least
        ))
}

/// "along z, and about x and y".
fn words(directions: &[usize]) -> String {
    let parts = std::array::from_fn(|at| f64::from(u8::from(directions.contains(&at))));
    Motions::of_directions(&parts).words("along", "about")
}

/// The legs with passive joints only, where the missing actuator may belong.
fn legs_without_actuator(mechanism: &Mechanism) -> String {
    let all = mechanism.joints();
    let driven = mechanism.actuators().into_iter();
    let driven = driven.flat_map(|actuator| mechanism.actuator_terms(actuator));
    let driven: Vec<usize> = driven.map(|(joint, _)| all[joint].leg).collect();
    let legs = mechanism.legs.iter().enumerate();
    let names = legs.filter(|(index, _)| !driven.contains(index));
    let names: Vec<&str> = names.map(|(_, leg)| leg.name.as_str()).collect();
    if names.is_empty() {
        "every leg has an actuator".to_owned()
    } else {
        format!("without an actuator: {}", names.join(", "))
    }
}

/// Legs that allow motions which are not described, while actuators drive them.
pub(in crate::mechanism) fn not_held(description: &Description, mobility: &Mobility) -> Diagnostic {
    let span = description.platform.as_ref().map(|p| p.motion.span.clone());
    let span = span.unwrap_or(description.name.span.clone());
    let words = Motions::of_directions(&mobility.parts()).words("along", "about");
    Diagnostic::new(Code::NOT_HELD, "the legs do not restrict the platform to this motion", span)
        .label(format!(
            "they allow {} motions, {words}, and the actuators drive all of them",
            mobility.count()
        ))
        .help("choose a `motion` with all of these coordinates: with fewer, torques that the model considers internal would move the platform; a platform with parasitic motion, as that of a 3-RPS, is `spatial` with `independent` coordinates")
        .kind(DiagnosticKind::NotHeld)
}

/// Actuators that do not determine the platform's motion.
pub(in crate::mechanism) fn underactuated(
    description: &Description,
    mechanism: &Mechanism,
) -> Diagnostic {
    let span = description.platform.as_ref().map(|p| p.motion.span.clone());
    let span = span.unwrap_or(description.name.span.clone());
    let jacobian = |mechanism: &Mechanism| {
        let rates = mechanism.rates_at_home()?;
        Some(mechanism.actuator_rows(&rates))
    };
    let owner = owner(mechanism);
    // Poses near home show whether only home is singular.
    let everywhere = random_states(mechanism, 4, 3).into_iter().all(|state| {
        let mut displaced = mechanism.clone();
        displaced.home = Home::new(mechanism, state.pose, state.joints);
        displaced.independent_actuators().len() < displaced.dof()
    });
    let label = jacobian(mechanism).map_or_else(String::new, |j| free_motions(mechanism, &j));
    let twins = jacobian(mechanism).map_or_else(Vec::new, |j| twins(mechanism, &j));
    let (message, help) = if everywhere {
        let help = match twins.first() {
            Some((a, b)) if !mechanism.motors.is_empty() => format!(
                "the motors `{a}` and `{b}` have the same effect: let one of them turn another combination of joints"
            ),
            None if !mechanism.motors.is_empty() => {
                "let the motors turn other combinations of joints".to_owned()
            }
            Some((a, b)) if mechanism.platform.is_none() => {
                format!("the motors `{a}` and `{b}` have the same effect: actuate another joint")
            }
            Some((a, b)) => format!(
                "the motors `{a}` and `{b}` have the same effect, as in legs at the same place: move or rotate one of the legs, or actuate another joint"
            ),
            None if mechanism.platform.is_none() => "actuate another joint".to_owned(),
            None => "actuate another joint, or attach the legs at other points".to_owned(),
        };
        (
            format!("the actuators never determine {owner}'s motion"),
            help,
        )
    } else {
        let place = match mechanism.platform {
            Some(_) => "[platform]",
            None => "the skeleton's [[place]]",
        };
        let help = format!("home is a singular pose: choose another one in `home` of {place}");
        (
            format!("the actuators do not determine {owner}'s motion at the home configuration"),
            help,
        )
    };
    Diagnostic::new(Code::MOVES_FREELY, message, span)
        .label(label)
        .help(help)
}

/// The moving system of a robot without a platform that is more than a skeleton.
const ROBOT: &str = "the robot";

/// What the actuators have to hold: the platform, the skeleton, or the skeleton and the branches on
/// chains.
fn owner(mechanism: &Mechanism) -> &'static str {
    let mut others = mechanism.legs.iter().skip(1);
    match &mechanism.platform {
        Some(_) => "the platform",
        None if mechanism.is_tree() || others.any(|leg| leg.end.is_none()) => ROBOT,
        None => "the skeleton",
    }
}

/// The motions of the platform with all actuators locked.
fn free_motions(mechanism: &Mechanism, jacobian: &DMatrix<f64>) -> String {
    let start = format!("with all motors locked {} can still", owner(mechanism));
    let Some(found) = SingularValues::new(jacobian) else {
        return format!("{start} move");
    };
    let free = found.null_space(1e-5 * jacobian.amax());
    // Component of each coordinate within the free motions.
    let parts: Vec<f64> = free.row_iter().map(|row| row.norm()).collect();
    if mechanism.skeleton().is_some() {
        let names = mechanism.coordinates().into_iter().zip(&parts);
        let names: Vec<String> = names
            .filter(|(_, part)| **part > 1e-3)
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        return format!("{start} move {}", listed(&names));
    }
    let moves = Motions::new(mechanism, &parts, 1e-3);
    let together = if free.ncols() == moves.count() {
        ""
    } else {
        " at once"
    };
    format!(
        "{start} {}{together}",
        moves.words("move along", "turn about")
    )
}

/// Pairs of actuators whose rates are proportional.
fn twins(mechanism: &Mechanism, jacobian: &DMatrix<f64>) -> Vec<(String, String)> {
    let names = mechanism.actuator_names();
    let mut pairs = Vec::new();
    for (a, first) in jacobian.row_iter().enumerate() {
        for (b, second) in jacobian.row_iter().enumerate().skip(a + 1) {
            let along = first.dot(&second) / first.norm_squared();
            if (second - first * along).norm() < 1e-9 * second.norm() {
                pairs.push((names[a].clone(), names[b].clone()));
            }
        }
    }
    pairs
}
