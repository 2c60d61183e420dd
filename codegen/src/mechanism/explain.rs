//! Errors of mechanisms in words: what is wrong, where it is written, and a way out.

use super::home::HomeError;
use super::mobility::Mobility;
use super::numeric::{platform_frame, target};
use super::reach::{Reach, look, wrapped};
use super::singular_values::SingularValues;
use super::states::random_states;
use super::structure::Defect;
use super::{Home, JointKind, Leg, Mechanism, TwistCoordinate};
use crate::description::{self, Description};
use crate::diagnostic::Diagnostic;
use nalgebra::DMatrix;

/// A leg that is wrong in every configuration. The error stands at the leg's shape, where it is made.
pub(super) fn defect(leg: &description::Leg, defect: &Defect) -> Diagnostic {
    let name = |joint: usize| format!("`{}`", leg.joints[joint].name.value);
    let names = |joints: &[usize]| {
        let all: Vec<String> = joints.iter().map(|&joint| name(joint)).collect();
        match joints {
            [_] => format!("joint {}", all.concat()),
            _ => format!("joints {}", listed(&all)),
        }
    };
    let shape = &leg.shape_name;
    let at = |joint: usize| leg.joints[joint].d.span.clone();
    let verb = |joints: &[usize], one: &'static str, more: &'static str| match joints {
        [_] => one,
        _ => more,
    };
    match defect {
        Defect::Branch(joints) => Diagnostic::new(
            format!(
                "{} of leg `{shape}` {} on a branch that does not lead to the leg's end",
                names(joints),
                verb(joints, "is", "are")
            ),
            leg.joints[joints[0]].span.clone(),
        )
        .label("nothing determines its position")
        .help("let it follow other joints, such as theta = \"-q2\", or put the joint that carries the leg's end last"),
        Defect::Idle(joints) => Diagnostic::new(
            format!(
                "{} of leg `{shape}` never {} the leg's end",
                names(joints),
                verb(joints, "moves", "move")
            ),
            at(joints[joints.len() - 1]),
        )
        .label("the axis passes through the end, whatever the position")
        .help("a rod of zero length? give it a length; an end of type \"point\" turns freely, so it needs no joints of its own there"),
        Defect::Twins(first, second) => {
            let slides = leg.joints[*second].kind.value == JointKind::Prismatic;
            let (what, way) = if slides {
                ("slide in the same direction", "turn one of the axes by `alpha`, or leave one of the joints out")
            } else {
                ("turn about the same axis", "the link between them has no length: give the second a `d`, or turn its axis by `alpha`")
            };
            Diagnostic::new(
                format!("joints {} and {} of leg `{shape}` always {what}", name(*first), name(*second)),
                at(*second),
            )
            .label("together they move nothing, so their positions are never determined")
            .help(way)
        }
        Defect::Stiff { motions, needed } => Diagnostic::new(
            format!("leg `{shape}` has too few joints to follow the platform's motion"),
            leg.joints[leg.joints.len() - 1].span.clone(),
        )
        .label(format!("its joints give its end {motions} of the {needed} motions that the platform has there"))
        .help("add a passive joint, choose a platform motion with fewer coordinates, or an end that leaves more free (`type`, `along`)"),
        Defect::Loose { joints, motions } => Diagnostic::new(
            format!("leg `{shape}` can move while the platform stands still"),
            leg.joints[leg.joints.len() - 1].span.clone(),
        )
        .label(format!("{joints} joints move an end that has only {motions} motions"))
        .help("leave out a joint, let one follow others such as theta = \"-q2\", or fix the leg's end with type = \"rigid\""),
    }
}

/// A leg that does not close, or only where it is singular.
pub(super) fn home_error(
    description: &Description,
    mechanism: &Mechanism,
    rough: &Home,
    error: &HomeError,
) -> Diagnostic {
    match error {
        HomeError::Open { leg, .. } => open(description, mechanism, rough, *leg),
        HomeError::Singular { leg, condition } => {
            let leg = &description.legs[*leg];
            Diagnostic::new(
                format!("leg `{}` is singular at the home configuration", leg.name.value),
                leg.span.clone(),
            )
            .label(match condition.is_finite() {
                true => format!("its Jacobian has the condition number {condition:.1e}"),
                false => "its Jacobian has no inverse".to_owned(),
            })
            .help("choose a home pose where the leg is neither stretched nor folded, and joints whose motions are independent")
        }
    }
}

/// A leg that does not close from its rough home.
fn open(
    description: &Description,
    mechanism: &Mechanism,
    rough: &Home,
    index: usize,
) -> Diagnostic {
    let place = &description.legs[index];
    let leg = &mechanism.legs[index];
    let name = &place.name.value;
    let error = |message: String| Diagnostic::new(message, place.span.clone());
    let (Some(platform), Some(end)) = (&mechanism.platform, &leg.end) else {
        return error(format!("leg `{name}` has no end"));
    };
    let target = target(end, &platform_frame(platform.motion, &rough.pose));
    match look(leg, &rough.joints[mechanism.leg_range(index)], &target) {
        Reach::Elsewhere(joints) => error(format!("leg `{name}` does not close from its rough home"))
            .label("it closes elsewhere")
            .help(format!("give home = {}, or another place near the wanted working mode", home(leg, &joints))),
        Reach::Turned => error(format!("leg `{name}` cannot take the platform's orientation at the home pose"))
            .label("its end gets there, but stays turned")
            .help("check `alpha`, `base` and `end.rotation`; an end that is a spherical or universal joint has type = \"point\""),
        Reach::Away(distance) => error(format!("leg `{name}` never reaches its place on the platform at the home pose"))
            .label(format!("its end stays at least {} away", length(distance)))
            .help("check the lengths of its links, its `base` and `end`, and the platform's `home`"),
    }
}

/// A distance for people.
fn length(distance: f64) -> String {
    match distance {
        d if !d.is_finite() => "any distance".to_owned(),
        d if d < 0.1 => format!("{:.3} mm", 1e3 * d),
        d => format!("{d:.3} m"),
    }
}

/// Joint positions as a description gives them.
fn home(leg: &Leg, joints: &[f64]) -> String {
    let one = |(index, value): (usize, &f64)| {
        let joint = &leg.joints[index];
        match joint.kind {
            JointKind::Prismatic => format!("{} = \"{:.3} m\"", joint.name, value),
            _ => format!(
                "{} = \"{:.0} deg\"",
                joint.name,
                wrapped(*value).to_degrees()
            ),
        }
    };
    let all: Vec<String> = leg.independent().zip(joints).map(one).collect();
    format!("{{ {} }}", all.join(", "))
}

/// A leg that blocks motions of the platform: those of the twist for which its joints have no rates.
pub(super) fn blocked(
    description: &Description,
    mechanism: &Mechanism,
    index: usize,
    missed: &DMatrix<f64>,
) -> Diagnostic {
    let place = &description.legs[index];
    let columns = missed.column_iter().map(|column| column.amax());
    let blocked: Vec<f64> = columns.collect();
    Diagnostic::new(
        format!("leg `{}` cannot follow the platform's motion", place.name.value),
        place.span.clone(),
    )
    .label(format!("it blocks {}", Motions::new(mechanism, &blocked, 1e-6).words("motion along", "rotation about")))
    .help("add a passive joint, choose a platform motion without it, or an end that leaves it free (`type`, `along`)")
}

/// Fewer actuators than coordinates, with what the legs leave where they close.
pub(super) fn too_few_actuators(
    description: &Description,
    mechanism: &Mechanism,
    mobility: Option<Mobility>,
) -> Diagnostic {
    let (dof, count) = (mechanism.dof(), mechanism.actuated().len());
    let motion = description.platform.as_ref().map(|p| &p.motion);
    let span = motion.map_or(description.name.span.clone(), |m| m.span.clone());
    let actuators = if count == 1 { "actuator" } else { "actuators" };
    let message =
        format!("the platform has {dof} degrees of freedom, but the robot has {count} {actuators}");
    let left = mobility.and_then(|m| Some((m.of(motion?.value), m.parts())));
    let help = match left {
        Some((left, parts)) if left < dof => format!(
            "the legs leave the platform only {left} of these {dof} motions ({}), so more actuators are no way out: choose a `motion` that the legs allow, or give the legs more passive joints",
            Motions::of_directions(&parts).words("along", "about")
        ),
        _ => "mark more joints with actuated = true".to_owned(),
    };
    Diagnostic::new(message, span)
        .label(legs_without_actuator(mechanism))
        .help(help)
}

/// The legs whose joints are all passive, where the missing actuator may have its place.
fn legs_without_actuator(mechanism: &Mechanism) -> String {
    let passive = |leg: &&Leg| leg.joints.iter().all(|joint| !joint.actuated);
    let names = mechanism.legs.iter().filter(passive);
    let names: Vec<&str> = names.map(|leg| leg.name.as_str()).collect();
    if names.is_empty() {
        "every leg has an actuator".to_owned()
    } else {
        format!("without an actuator: {}", names.join(", "))
    }
}

/// Legs that leave the platform motions which are not described, and actuators that drive them.
pub(super) fn not_held(description: &Description, mobility: &Mobility) -> Diagnostic {
    let span = description.platform.as_ref().map(|p| p.motion.span.clone());
    let span = span.unwrap_or(description.name.span.clone());
    let words = Motions::of_directions(&mobility.parts()).words("along", "about");
    Diagnostic::new("the legs do not hold the platform to this motion", span)
        .label(format!(
            "they leave it {} motions, {words}, and the actuators drive all of them",
            mobility.count()
        ))
        .help("choose a `motion` with all of these coordinates; a platform that moves aside while it turns, as that of a 3-RPS, has no word here: its legs need another passive joint to be described")
}

/// Actuators that do not determine the platform's motion.
pub(super) fn underactuated(description: &Description, mechanism: &Mechanism) -> Diagnostic {
    let span = description.platform.as_ref().map(|p| p.motion.span.clone());
    let span = span.unwrap_or(description.name.span.clone());
    let jacobian = |mechanism: &Mechanism| {
        let rates = mechanism.rates_at_home()?;
        Some(rates.select_rows(&mechanism.actuated()))
    };
    // At poses beside home the robot shows whether home alone is singular.
    let everywhere = random_states(mechanism, 4, 3).into_iter().all(|state| {
        let mut beside = mechanism.clone();
        beside.home = Home::new(mechanism, state.pose, state.joints);
        beside.independent_actuators().len() < beside.dof()
    });
    let label = jacobian(mechanism).map_or_else(String::new, |j| free_motions(mechanism, &j));
    let twins = jacobian(mechanism).map_or_else(Vec::new, |j| twins(mechanism, &j));
    let (message, help) = if everywhere {
        let help = match twins.first() {
            Some((a, b)) => format!(
                "the motors `{a}` and `{b}` do the same, as those of legs do that stand at the same place: move or turn one of the legs, or actuate another joint"
            ),
            None => "actuate another joint, or attach the legs at other points".to_owned(),
        };
        ("the actuators never determine the platform's motion", help)
    } else {
        let help = "home is a singular pose: choose another one in `home` of [platform]";
        (
            "the actuators do not determine the platform's motion at the home configuration",
            help.to_owned(),
        )
    };
    Diagnostic::new(message, span).label(label).help(help)
}

/// How the platform can move while no actuator does.
fn free_motions(mechanism: &Mechanism, jacobian: &DMatrix<f64>) -> String {
    let start = "with all motors locked the platform can still";
    let Some(found) = SingularValues::new(jacobian) else {
        return format!("{start} move");
    };
    let free = found.null_space(1e-5 * jacobian.amax());
    // The part of each coordinate that lies among the free motions.
    let parts: Vec<f64> = free.row_iter().map(|row| row.norm()).collect();
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

/// Motions of the platform along and about axes.
struct Motions {
    along: Vec<String>,
    about: Vec<String>,
}

impl Motions {
    /// Those whose sizes are not negligible.
    fn new(mechanism: &Mechanism, sizes: &[f64], least: f64) -> Self {
        let axis = |axis: usize| ["x", "y", "z"][axis].to_owned();
        let twist = mechanism.platform.as_ref().map(|p| p.motion.twist());
        let (mut along, mut about) = (Vec::new(), Vec::new());
        for (coordinate, size) in twist.iter().flatten().zip(sizes) {
            match coordinate {
                _ if *size <= least => {}
                TwistCoordinate::Linear(a) => along.push(axis(*a)),
                TwistCoordinate::Angular(a) => about.push(axis(*a)),
            }
        }
        Self { along, about }
    }

    /// Those of six directions, three along and three about the axes, of which a part is there.
    fn of_directions(parts: &[f64; 6]) -> Self {
        let there = |parts: &[f64]| -> Vec<String> {
            let axes = ["x", "y", "z"].iter().zip(parts);
            let there = axes.filter(|(_, part)| **part > 1e-3);
            there.map(|(axis, _)| (*axis).to_owned()).collect()
        };
        Self {
            along: there(&parts[..3]),
            about: there(&parts[3..]),
        }
    }

    fn count(&self) -> usize {
        self.along.len() + self.about.len()
    }

    /// "motion along x and y, and rotation about z".
    fn words(&self, along: &str, about: &str) -> String {
        let part = |word: &str, axes: &[String]| match axes {
            [] => None,
            _ => Some(format!("{word} {}", listed(axes))),
        };
        let parts = [part(along, &self.along), part(about, &self.about)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        parts.join(", and ")
    }
}

/// "a, b and c".
fn listed(words: &[String]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
