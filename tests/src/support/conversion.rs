//! Converts a checked mechanism to the plain data of the numeric reference.

use crate::reference::{
    Element, ElementBody, ElementEnd, End, Frame, Joint, JointKind, Law, Leg, Mechanism, Motion,
    Motor, Spring,
};
use nalgebra::{Rotation3, Vector3};
use overact_codegen::mechanism;
use overact_codegen::mechanism::{Angle, Number};

/// Reference data of a mechanism; descriptions have no workspace, so the caller gives one in twist
/// coordinates.
#[must_use]
pub fn reference(mechanism: &mechanism::Mechanism, workspace: Vec<f64>) -> Mechanism {
    let first = |leg: usize| mechanism.leg_range(leg);
    let legs = mechanism.legs.iter().enumerate();
    let mut plain = Mechanism {
        gravity: vector(mechanism.gravity),
        motion: match &mechanism.platform {
            Some(platform) => motion(platform.motion),
            None if mechanism.skeleton().is_some() => Motion::Joints(mechanism.dof()),
            None => Motion::None,
        },
        home: mechanism.home.pose.clone(),
        workspace,
        legs: legs
            .map(|(k, own)| leg(own, &mechanism.home.joints[first(k)]))
            .collect(),
        elements: mechanism.springs.iter().map(element).collect(),
        motors: mechanism.motors.iter().map(motor).collect(),
    };
    for payload in &mechanism.payloads {
        if let mechanism::FrameBody::Joint(body) = payload.body {
            let joints = &mut plain.legs[body.leg].joints;
            joints.extend(fixed(&payload.placement, body.joint, joints.len()));
        }
    }
    plain
}

/// Index of the joint of the reference that carries a payload, in its leg.
///
/// Payloads are bodies on fixed joints after all others, two for each: the first one shifts and the
/// second one turns.
#[must_use]
pub fn payload_joint(mechanism: &mechanism::Mechanism, payload: usize) -> Option<(usize, usize)> {
    let leg_of = |payload: &mechanism::Payload| match payload.body {
        mechanism::FrameBody::Joint(body) => Some(body.leg),
        mechanism::FrameBody::Platform => None,
    };
    let leg = leg_of(&mechanism.payloads[payload])?;
    let before = mechanism.payloads[..payload].iter();
    let before = before.filter(|other| leg_of(other) == Some(leg)).count();
    Some((leg, mechanism.legs[leg].joints.len() + 2 * before + 1))
}

/// A placement on a body as two fixed joints, the first of which gets the index `next`.
fn fixed(placement: &mechanism::Placement, body: usize, next: usize) -> [Joint; 2] {
    let at = frame(placement);
    let shift = at.position;
    let gamma = shift.y.atan2(shift.x);
    let shifted = Joint {
        antecedent: Some(body),
        gamma,
        b: shift.z,
        d: shift.x.hypot(shift.y),
        theta: -gamma,
        ..Joint::new(JointKind::Fixed, next)
    };
    // Rz(γ) Rx(α) Rz(θ), as Euler angles.
    let turn = at.rotation;
    let (sine, cosine) = (turn[(0, 2)].hypot(turn[(1, 2)]), turn[(2, 2)]);
    let (gamma, theta) = if sine > 1e-12 {
        (
            turn[(0, 2)].atan2(-turn[(1, 2)]),
            turn[(2, 0)].atan2(turn[(2, 1)]),
        )
    } else {
        (0.0, (-turn[(0, 1)]).atan2(turn[(0, 0)]))
    };
    let turned = Joint {
        antecedent: Some(next),
        gamma,
        alpha: sine.atan2(cosine),
        theta,
        ..Joint::new(JointKind::Fixed, next + 1)
    };
    [shifted, turned]
}

fn motion(motion: mechanism::Motion) -> Motion {
    use mechanism::Motion as Described;
    match motion {
        Described::FixedAxis { axis } => {
            let mut direction = Vector3::zeros();
            direction[axis] = 1.0;
            Motion::Slide {
                point: Vector3::zeros(),
                direction,
            }
        }
        Described::Rotation { axis } => Motion::Hinge {
            point: Vector3::zeros(),
            direction: Vector3::ith(axis, 1.0),
        },
        Described::Point { axis } => Motion::Point(axis),
        Described::Planar { axis } => Motion::Planar(axis),
        Described::Translation => Motion::Translation,
        Described::Schoenflies { axis } => Motion::Schoenflies(axis),
        Described::Spherical => Motion::Spherical,
        Described::Spatial => Motion::Spatial,
        Described::Parasitic { independent } => Motion::Parasitic(independent),
    }
}

fn leg(leg: &mechanism::Leg, start: &[f64]) -> Leg {
    let joints: Vec<Joint> = leg.joints.iter().map(joint).collect();
    let last = joints.len().saturating_sub(1);
    let cable = leg.cable.as_ref();
    let cable = cable.map(|cable| [cable.pulley, cable.minimum].map(Number::value));
    let end = match &leg.end {
        Some(mechanism::End::Point { at, .. }) if cable.is_some() => End::Cable {
            attachment: vector(*at),
            radius: cable.map_or(0.0, |[radius, _]| radius),
            minimum: cable.map_or(0.0, |[_, minimum]| minimum),
        },
        None => End::Free,
        Some(mechanism::End::Rigid(placement)) => End::Rigid {
            joint: last,
            attachment: frame(placement),
        },
        Some(mechanism::End::Point { at, along }) => End::Point {
            joint: last,
            attachment: vector(*at),
            along: *along,
        },
    };
    Leg {
        base: frame(&leg.base),
        carrier: leg.base_body.map(|body| (body.leg, body.joint)),
        body: leg.end_body.map(|body| (body.leg, body.joint)),
        joints,
        end,
        start: start.to_vec(),
    }
}

fn joint(joint: &mechanism::Joint) -> Joint {
    Joint {
        kind: match joint.kind {
            mechanism::JointKind::Revolute => JointKind::Revolute,
            mechanism::JointKind::Prismatic => JointKind::Prismatic,
            mechanism::JointKind::Fixed => JointKind::Fixed,
        },
        antecedent: joint.antecedent,
        gamma: joint.gamma.value(),
        b: joint.b.value(),
        alpha: joint.alpha.value(),
        d: joint.d.value(),
        theta: joint.theta.value(),
        r: joint.r.value(),
        terms: joint
            .variable
            .iter()
            .map(|(of, factor)| (*of, factor.value()))
            .collect(),
        actuated: joint.actuated,
        is_dependent: joint.dependent,
        spring: joint.spring.clone().map(|spring| torque(spring.formula)),
        known: joint.known.clone().map(torque),
        load: joint.load.clone().map(|load| torque(load.formula)),
        stribeck: joint.stribeck.map(Number::value),
    }
}

fn element(spring: &mechanism::PointSpring) -> Element {
    let end = |end: &mechanism::SpringEnd| ElementEnd {
        body: match end.body {
            mechanism::SpringBody::Ground => ElementBody::Ground,
            mechanism::SpringBody::Platform => ElementBody::Platform,
            mechanism::SpringBody::Joint(body) => ElementBody::Joint(body.leg, body.joint),
        },
        at: vector(end.at),
    };
    let law = |formula: &mechanism::Formula| {
        let formula = formula.clone();
        Law::new(move |length, rate| formula.value_at(length, rate))
    };
    Element {
        ends: spring.ends.each_ref().map(end),
        force: spring.force.as_ref().map(|force| law(&force.formula)),
        known: spring.known.as_ref().map(law),
    }
}

fn motor(motor: &mechanism::Motor) -> Motor {
    let terms = motor.terms.iter();
    Motor {
        terms: terms.map(|(at, factor)| (*at, factor.value())).collect(),
        stribeck: motor.stribeck.map(Number::value),
    }
}

fn torque(formula: mechanism::Formula) -> Spring {
    Spring::new(move |q| formula.value(q))
}

fn frame(placement: &mechanism::Placement) -> Frame {
    let [rx, ry, rz] = placement.rotation.map(Angle::value);
    // Roll, pitch, yaw: Rz(rz) Ry(ry) Rx(rx).
    let rotation = Rotation3::from_euler_angles(rx, ry, rz).into_inner();
    Frame::new(rotation, vector(placement.at))
}

fn vector(values: [Number; 3]) -> Vector3<f64> {
    Vector3::from(values.map(Number::value))
}

/// Largest difference of the numbers of two mechanisms; infinite if their structures differ.
///
/// The legs' starts, which only choose a working mode, and the workspace are ignored.
#[must_use]
pub fn distance(a: &Mechanism, b: &Mechanism) -> f64 {
    let same = a.motion == b.motion
        && a.legs.len() == b.legs.len()
        && a.legs.iter().zip(&b.legs).all(|(a, b)| same_shape(a, b));
    if !same {
        return f64::INFINITY;
    }
    let pairs = numbers(a).into_iter().zip(numbers(b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn same_shape(a: &Leg, b: &Leg) -> bool {
    let joints = |a: &Joint, b: &Joint| {
        a.kind == b.kind
            && a.antecedent == b.antecedent
            && a.terms == b.terms
            && a.actuated == b.actuated
    };
    let ends = match (&a.end, &b.end) {
        (End::Free, End::Free) => true,
        (End::Rigid { joint: a, .. }, End::Rigid { joint: b, .. })
        | (End::Point { joint: a, .. }, End::Point { joint: b, .. }) => a == b,
        (End::Cable { .. }, End::Cable { .. }) => true,
        _ => false,
    };
    ends && (a.carrier, a.body) == (b.carrier, b.body)
        && a.joints.len() == b.joints.len()
        && a.joints.iter().zip(&b.joints).all(|(a, b)| joints(a, b))
}

fn numbers(mechanism: &Mechanism) -> Vec<f64> {
    let mut all: Vec<f64> = mechanism.gravity.iter().copied().collect();
    all.extend(&mechanism.home);
    let placed = |frame: &Frame| -> Vec<f64> {
        frame
            .rotation
            .iter()
            .chain(frame.position.iter())
            .copied()
            .collect()
    };
    for leg in &mechanism.legs {
        all.extend(placed(&leg.base));
        for joint in &leg.joints {
            all.extend([joint.gamma, joint.b, joint.alpha]);
            all.extend([joint.d, joint.theta, joint.r]);
        }
        match &leg.end {
            End::Free => {}
            End::Rigid { attachment, .. } => all.extend(placed(attachment)),
            End::Point { attachment, .. } => all.extend(attachment.iter()),
            End::Cable {
                attachment,
                radius,
                minimum,
            } => {
                all.extend(attachment.iter());
                all.extend([radius, minimum]);
            }
        }
    }
    all
}
