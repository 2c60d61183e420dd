//! Error messages of mechanisms: the fault, its location, and a remedy.
//!
//! `actuators` has the errors of the robot's actuators; this file has those of legs.

mod actuators;
mod dependent;
mod motions;

pub(super) use actuators::{independent, not_held, too_few_actuators, underactuated};
pub(super) use dependent::dependent;

use super::cable::CableProblem;
use super::home::HomeError;
use super::reach::{Reach, look, wrapped};
use super::structure::Defect;
use super::{Home, JointKind, Leg, Mechanism};
use motions::{Motions, listed};
use nalgebra::DMatrix;
use overact_description::Description;
use overact_description::diagnostic::{Code, Diagnostic};

/// The noun for a leg or chain, and for the body that it ends on.
struct Words {
    kind: &'static str,
    carrier: &'static str,
    carriers: &'static str,
}

impl Words {
    const fn of(leg: &overact_description::Leg) -> Self {
        match leg.end_body {
            None => Self {
                kind: "leg",
                carrier: "the platform",
                carriers: "the platform's",
            },
            Some(_) => Self {
                kind: "chain",
                carrier: "its second body",
                carriers: "its second body's",
            },
        }
    }
}

/// A leg that is defective in every configuration, reported at the leg's shape.
pub(super) fn defect(leg: &overact_description::Leg, defect: &Defect) -> Diagnostic {
    let name = |joint: usize| format!("`{}`", leg.joints[joint].name.value);
    let names = |joints: &[usize]| {
        let all: Vec<String> = joints.iter().map(|&joint| name(joint)).collect();
        match joints {
            [_] => format!("joint {}", all.concat()),
            _ => format!("joints {}", listed(&all)),
        }
    };
    let Words {
        kind,
        carrier,
        carriers,
    } = Words::of(leg);
    let shape = format!("{kind} `{}`", leg.shape_name);
    let at = |joint: usize| leg.joints[joint].d.span.clone();
    let verb = |joints: &[usize], one: &'static str, more: &'static str| match joints {
        [_] => one,
        _ => more,
    };
    match defect {
        Defect::Branch(joints) => Diagnostic::new(Code::USELESS_JOINT,
            format!(
                "{} of {shape} {} on a branch that does not lead to the {kind}'s end",
                names(joints),
                verb(joints, "is", "are")
            ),
            leg.joints[joints[0]].span.clone(),
        )
        .label("nothing determines its position")
        .help("couple it to other joints, such as theta = \"-q2\", or put the joint that carries the leg's end last"),
        Defect::Idle(joints) => Diagnostic::new(Code::USELESS_JOINT,
            format!(
                "{} of {shape} never {} the {kind}'s end",
                names(joints),
                verb(joints, "moves", "move")
            ),
            at(joints[joints.len() - 1]),
        )
        .label("the axis passes through the end, whatever the position")
        .help("a rod of zero length? give it a length; an end of type \"point\" rotates freely and needs no joints there"),
        Defect::Twins(first, second) => {
            let slides = leg.joints[*second].kind.value == JointKind::Prismatic;
            let (what, way) = if slides {
                ("slide in the same direction", "rotate one of the axes by `alpha`, or leave one of the joints out")
            } else {
                ("turn about the same axis", "the link between them has no length: give the second a `d`, or rotate its axis by `alpha`")
            };
            Diagnostic::new(Code::USELESS_JOINT,
                format!("joints {} and {} of {shape} always {what}", name(*first), name(*second)),
                at(*second),
            )
            .label("together they move nothing, so their positions are never determined")
            .help(way)
        }
        Defect::Stiff { motions, needed } => Diagnostic::new(Code::LEG_TOO_STIFF,
            format!("{shape} has too few joints to follow {carriers} motion"),
            leg.joints[leg.joints.len() - 1].span.clone(),
        )
        .label(format!("its joints allow its end {motions} of the {needed} motions that {carrier} has there"))
        .help(match leg.end_body {
            None => "add a passive joint, choose a platform motion with fewer coordinates, or an end with fewer constraints (`type`, `along`)",
            Some(_) => "add a passive joint, or choose an end that leaves more free (`type`, `along`); if the chain determines joints of the skeleton, mark these with `dependent = true`",
        }),
        Defect::Loose { joints, motions } => Diagnostic::new(Code::USELESS_JOINT,
            format!("{shape} can move while {carrier} stands still"),
            leg.joints[leg.joints.len() - 1].span.clone(),
        )
        .label(match motions {
            1 => format!("{joints} joints move an end that shares only one motion with it"),
            _ => format!("{joints} joints move an end that has only {motions} motions"),
        })
        .help(loose_help(leg)),
    }
}

/// How to remove a joint motion that does not move the leg's end.
fn loose_help(leg: &overact_description::Leg) -> &'static str {
    let shares_few_directions = match leg.end.as_ref().map(|end| &end.value) {
        Some(overact_description::End::Point { along, .. }) => along.contains(&false),
        _ => false,
    };
    if shares_few_directions {
        "leave out a joint, couple one to others such as theta = \"-q2\", or constrain the end more: `along` with more directions, or without `along`"
    } else {
        "leave out a joint, couple one to others such as theta = \"-q2\", or fix the leg's end with type = \"rigid\""
    }
}

/// A leg that does not close, or closes only in a singular configuration.
pub(super) fn home_error(
    description: &Description,
    mechanism: &Mechanism,
    rough: &Home,
    error: &HomeError,
) -> Diagnostic {
    match error {
        HomeError::Cable { leg, problem } => cable(&description.legs[*leg], problem),
        HomeError::Open { leg, .. } => open(description, mechanism, rough, *leg),
        HomeError::Singular { leg, condition } => {
            let leg = &description.legs[*leg];
            let kind = Words::of(leg).kind;
            Diagnostic::new(Code::SINGULAR_HOME,
                format!("{kind} `{}` is singular at the home configuration", leg.name.value),
                leg.span.clone(),
            )
            .label(if condition.is_finite() {
                format!("its Jacobian has the condition number {condition:.1e}")
            } else {
                "its Jacobian has no inverse".to_owned()
            })
            .help(format!("choose a home pose where the {kind} is neither stretched nor folded, and joints whose motions are independent"))
        }
    }
}

/// A cable that does not reach its platform point at the home pose.
fn cable(leg: &overact_description::Leg, problem: &CableProblem) -> Diagnostic {
    let name = format!("cable `{}`", leg.name.value);
    let error = |message: String| Diagnostic::new(Code::DOES_NOT_CLOSE, message, leg.span.clone());
    match problem {
        CableProblem::NoLength => error(format!("{name} has no length at the home configuration"))
            .label("its platform point coincides with its exit point")
            .help("correct `at` of `base` or `end`, or choose another home pose"),
        CableProblem::InsidePulley { distance, radius } => error(format!("{name} cannot wrap its pulley at the home configuration"))
            .label(format!("its platform point is {} from the pulley's centre, closer than the radius, {}", length(*distance), length(*radius)))
            .help("correct `pulley`, or `at` of `base` or `end`: the exit point is where the cable reaches the pulley, whose centre is one radius from it"),
        CableProblem::OnSwivelAxis => error(format!("{name} has no direction of its pulley at the home configuration"))
            .label("its platform point is on the swivel axis, z of `base`")
            .help("correct `rotation` or `at` of `base`: the cable reaches the pulley along z, and its platform point is to the side"),
        CableProblem::Behind => error(format!("{name} cannot wrap its pulley at the home configuration"))
            .label("its platform point is between the swivel axis and the pulley, where the cable would have to leave the pulley before it reaches it")
            .help("correct `rotation` of `base`: the cable reaches the pulley in the direction of z and bends towards its platform point"),
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
    let Words {
        kind,
        carrier,
        carriers,
    } = Words::of(place);
    let name = format!("{kind} `{}`", place.name.value);
    let error =
        |message: String| Diagnostic::new(Code::DOES_NOT_CLOSE, message, place.span.clone());
    let Some(target) = mechanism.target(index, &rough.pose, &rough.joints) else {
        return error(format!("{name} has no end"));
    };
    match look(leg, &rough.joints[mechanism.leg_range(index)], &target) {
        Reach::Elsewhere(joints) => error(format!("{name} does not close from its rough home"))
            .label("it closes elsewhere")
            .help(format!("give home = {}, or another place near the wanted working mode", home(leg, &joints))),
        Reach::Turned => error(format!("{name} cannot take {carriers} orientation at the home pose"))
            .label("its end reaches the position, but not the orientation")
            .help("check `alpha`, `base` and `end.rotation`; an end that is a spherical or universal joint has type = \"point\""),
        Reach::Away(distance) if distance < NEARLY_CLOSED => error(format!("{name} misses its place on {carrier} at the home pose by {}", length(distance)))
            .label(format!("it does not close: its end stays at least {} away", length(distance)))
            .help(format!("rounded angles or lengths leave such a misfit: write angles exactly (`alpha = \"90 deg\"` instead of 1.5708), and check its `base` and `end` and {carriers} `home`")),
        Reach::Away(distance) => error(format!("{name} never reaches its place on {carrier} at the home pose"))
            .label(format!("its end stays at least {} away", length(distance)))
            .help(format!("check the lengths of its links, its `base` and `end`, and {carriers} `home`")),
    }
}

/// Distance of a chain's end below which rounded numbers are the likely cause, m.
const NEARLY_CLOSED: f64 = 1e-3;

/// Formats a distance with a suitable unit.
fn length(distance: f64) -> String {
    match distance {
        d if !d.is_finite() => "any distance".to_owned(),
        d if d < 1e-5 => format!("{:.1e} mm", 1e3 * d),
        d if d < 0.1 => format!("{:.3} mm", 1e3 * d),
        d => format!("{d:.3} m"),
    }
}

/// Joint positions in the format of a description.
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

/// A leg that blocks a twist of the platform, for which its joints have no rates.
pub(super) fn blocked(
    description: &Description,
    mechanism: &Mechanism,
    index: usize,
    missed: &DMatrix<f64>,
) -> Diagnostic {
    let place = &description.legs[index];
    let columns = missed.column_iter().map(|column| column.amax());
    let blocked: Vec<f64> = columns.collect();
    if mechanism.skeleton().is_some() {
        let names = mechanism.coordinates().into_iter().zip(&blocked);
        let names: Vec<String> = names
            .filter(|(_, size)| **size > 1e-6)
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        return Diagnostic::new(
            Code::LEG_TOO_STIFF,
            format!(
                "chain `{}` cannot follow the skeleton's motion",
                place.name.value
            ),
            place.span.clone(),
        )
        .label(format!("it blocks {}", listed(&names)))
        .help(
            "add a passive joint to the chain, or an end with fewer constraints (`type`, `along`)",
        );
    }
    Diagnostic::new(Code::LEG_TOO_STIFF,
        format!("leg `{}` cannot follow the platform's motion", place.name.value),
        place.span.clone(),
    )
    .label(format!("it blocks {}", Motions::new(mechanism, &blocked, 1e-6).words("motion along", "rotation about")))
    .help("add a passive joint, choose a platform motion without it, or an end that does not constrain it (`type`, `along`)")
}
