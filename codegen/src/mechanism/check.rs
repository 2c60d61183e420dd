//! Checks a description and returns the mechanism: mobility, closure at home, singular legs.

use super::actuation::{rates_per_velocity, shared_velocities};
use super::dependent::{self, Moving, WEAK};
use super::explain;
use super::home::{Home, approach};
use super::mobility::Mobility;
use super::parasitic::{Parasitic, closed, rated};
use super::springs::check_springs;
use super::states::random_states;
use super::still::still_coordinates;
use super::structure::defects;
use super::{
    BaseColumns, Frame, Joint, JointIndex, Leg, Mechanism, Motor, Number, Payload, Platform,
    PointSpring, SpringBody, SpringEnd,
};
use overact_description::Description;
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics};

/// Checks a description and finds its home configuration.
///
/// # Errors
/// All errors of the mechanism, each at the leg or the platform that causes it.
pub fn check(description: &Description) -> Result<Mechanism, Diagnostics> {
    let mut mechanism = plain(description);
    let mut errors = Diagnostics::new();
    let is_too_large = check_sizes(description, &mut errors);
    if is_too_large {
        // The computations for so many joints would take too long.
        return Err(errors);
    }
    check_actuators(description, &mechanism, &mut errors);
    let mut rough = rough_home(description);
    if !mechanism.has_dependent_coordinates() {
        check_structure(description, &mechanism, &rough, &mut errors);
    } else if errors.is_empty() {
        // If the legs do not allow the rough pose, it is moved onto their closures. An allowed pose
        // stays as it is; the joints start near the closures.
        let near = approach(&mechanism, &rough);
        let found = closed_near(&mechanism, &near).or_else(|| closed_near(&mechanism, &rough));
        if let Some(found) = found {
            rough = found.home;
        }
    }
    errors.into_result(())?;
    match Home::refine(&mechanism, &rough) {
        Ok(home) => mechanism.home = home,
        Err(found) => {
            let mut errors = Diagnostics::new();
            found
                .iter()
                .for_each(|e| errors.push(explain::home_error(description, &mechanism, &rough, e)));
            return Err(errors);
        }
    }
    let mut errors = Diagnostics::new();
    if mechanism.has_dependent_coordinates() {
        check_independent(description, &mechanism, &mut errors);
        if errors.is_empty() {
            check_structure(description, &mechanism, &mechanism.home, &mut errors);
        }
        errors.into_result(())?;
        errors = Diagnostics::new();
    }
    for leg in 0..mechanism.legs.len() {
        check_mobility(description, &mechanism, leg, &mut errors);
    }
    errors.into_result(())?;
    let mut errors = Diagnostics::new();
    check_springs(description, &mechanism, &mut errors);
    errors.into_result(())?;
    keep_actuators(description, &mut mechanism)?;
    check_held(description, &mechanism)?;
    mechanism.still = still_coordinates(&mechanism);
    mechanism.blocking = dependent::blocking(&mechanism);
    Ok(mechanism)
}

/// The mechanism of a pose with dependent coordinates, with a home near `start` that closes all
/// legs.
///
/// Independent joints of a skeleton stay as they are, as far as the chains allow.
fn closed_near(mechanism: &Mechanism, start: &Home) -> Option<Mechanism> {
    if mechanism.is_parasitic() {
        return closed(mechanism, start);
    }
    let own = dependent::closed(mechanism, start, Moving::Dependent);
    own.or_else(|| dependent::closed(mechanism, start, Moving::All))
}

/// Chooses the actuators of the actuator projection: those given, or the first that determine the
/// motion.
fn keep_actuators(description: &Description, mechanism: &mut Mechanism) -> Result<(), Diagnostics> {
    let independent = mechanism.independent_actuators();
    let r = mechanism.dof();
    if independent.len() < r {
        return Err(Diagnostics::from(explain::underactuated(
            description,
            mechanism,
        )));
    }
    if mechanism.kept_actuators.is_empty() {
        mechanism.kept_actuators = independent;
    }
    Ok(())
}

/// Equal legs get the same parameters; a robot without several legs on a platform has no such
/// symmetry.
fn base_columns(description: &Description) -> BaseColumns {
    let has_loop = |leg: &overact_description::Leg| leg.end.is_some();
    let by_kind = if description.legs.iter().any(has_loop) {
        BaseColumns::Symmetric
    } else {
        BaseColumns::Cheapest
    };
    description.base_columns.unwrap_or(by_kind)
}

/// The mechanism of a description, with an empty home configuration.
pub(super) fn plain(description: &Description) -> Mechanism {
    let joint = |j: &overact_description::Joint| Joint {
        name: j.name.value.clone(),
        kind: j.kind.value,
        antecedent: j.antecedent,
        gamma: j.gamma.value,
        b: j.b.value,
        alpha: j.alpha.value,
        d: j.d.value,
        theta: j.theta.value,
        r: j.r.value,
        variable: j.variable.clone(),
        actuated: j.actuated,
        dependent: j.dependent.is_some(),
        parameters: j.parameters.clone(),
        motor: j.motor.map(crate::cas::Number::value),
        spring: j.spring.clone(),
        known: j.known.clone(),
        stribeck: j.stribeck,
        load: j.load.clone(),
    };
    let leg = |l: &overact_description::Leg| Leg {
        name: l.name.value.clone(),
        shape: l.shape,
        base: l.base.clone(),
        joints: l.joints.iter().map(joint).collect(),
        cable: l.cable.clone(),
        end: l.end.as_ref().map(|e| e.value.clone()),
        base_body: l.base_body,
        end_body: l.end_body,
    };
    let end = |end: &SpringEnd| {
        let mut end = end.clone();
        if let (SpringBody::Ground, Some(platform)) = (end.body, &description.platform) {
            for (at, origin) in end.at.iter_mut().zip(platform.axis_at) {
                *at = *at - origin;
            }
        }
        end
    };
    let spring = |spring: &overact_description::PointSpring| PointSpring {
        name: spring.name.value.clone(),
        ends: [end(&spring.from), end(&spring.to)],
        force: spring.force.clone(),
        known: spring.known.clone(),
    };
    let platform = description.platform.as_ref().map(|p| Platform {
        motion: p.motion.value,
        parameters: p.parameters.clone(),
        payload: p.payload.clone(),
    });
    let frame = |frame: &overact_description::Frame| Frame {
        name: frame.name.value.clone(),
        body: frame.body,
        placement: frame.placement.clone(),
    };
    let payload = |payload: &overact_description::Payload| Payload {
        name: payload.name.value.clone(),
        body: payload.body,
        placement: payload.placement.clone(),
        parameters: payload.parameters.clone(),
    };
    let axis = description.platform.as_ref().map(|p| p.axis_at);
    let mut mechanism = Mechanism {
        name: description.type_name(),
        summary: description.summary.clone(),
        source: description.source.clone(),
        gravity: description.gravity,
        constants: description.constants.clone(),
        magnitudes: description.magnitudes.clone(),
        platform,
        legs: on_axis(description, description.legs.iter().map(leg).collect()),
        payloads: description.payload_bodies.iter().map(payload).collect(),
        motors: Vec::new(),
        springs: description.springs.iter().map(spring).collect(),
        frames: description.frames.iter().map(frame).collect(),
        origin: axis.unwrap_or([Number::ZERO; 3]),
        home: Home::default(),
        // Chosen after the home configuration is known, unless the description gives them.
        base_columns: base_columns(description),
        kept_actuators: (description.identification.kept_actuators.clone()).unwrap_or_default(),
        still: Vec::new(),
        blocking: Vec::new(),
    };
    mechanism.motors = motors(description, &mechanism);
    mechanism
}

/// The motors, with the positions of their joints among all joints.
fn motors(description: &Description, mechanism: &Mechanism) -> Vec<Motor> {
    let joints = mechanism.joints();
    let term = |term: &overact_description::MotorTerm| {
        let overact_description::BodyIndex { leg, joint } = term.joint;
        let index = JointIndex { leg, joint };
        let at = joints.iter().position(|own| *own == index)?;
        Some((at, term.factor))
    };
    let motor = |motor: &overact_description::Motor| Motor {
        name: motor.name.value.clone(),
        leg: motor.leg,
        kind: motor.kind,
        terms: motor.terms.iter().filter_map(term).collect(),
        parameters: motor.parameters.clone(),
        stribeck: motor.stribeck,
    };
    description.motors.iter().map(motor).collect()
}

/// The legs relative to the platform's origin on a fixed axis.
///
/// The base frame of the mechanism has its origin there, so the platform rotates about it.
fn on_axis(description: &Description, mut legs: Vec<Leg>) -> Vec<Leg> {
    if let Some(platform) = &description.platform {
        for leg in &mut legs {
            for (at, origin) in leg.base.at.iter_mut().zip(platform.axis_at) {
                *at = *at - origin;
            }
        }
    }
    legs
}

fn check_actuators(description: &Description, mechanism: &Mechanism, errors: &mut Diagnostics) {
    let (n, r) = (mechanism.actuator_count(), mechanism.dof());
    let span = description.name.span.clone();
    if mechanism.is_tree() && n < r {
        let passive = mechanism
            .joints()
            .into_iter()
            .find(|&i| !mechanism.joint(i).actuated);
        let span = passive.map_or(span, |i| {
            description.legs[i.leg].joints[i.joint].span.clone()
        });
        errors.push(
            Diagnostic::new(Code::TREE_WITHOUT_MOTOR, "a robot without a platform needs a motor at every joint", span)
                .label(format!("{n} of {r} joints are actuated"))
                .help("write `actuated = true` at this joint (write a joint of several axes as separate joints first), or describe the platform that closes the loop"),
        );
    } else if n < r {
        let rough = rough_home(description);
        let at = |home| Mechanism {
            home,
            ..mechanism.clone()
        };
        let home = Home::refine(mechanism, &rough).ok().map(at);
        // If the legs block directions, the rough pose need not be one that they allow.
        let home = home.or_else(|| closed(mechanism, &rough));
        let left = home.and_then(|at| Some((Mobility::at_home(&at)?, Parasitic::at_home(&at))));
        errors.push(explain::too_few_actuators(description, mechanism, left));
    }
}

/// Reports legs that allow more motions than described, if the actuators drive all of them.
///
/// The motions are counted at home and at poses near it; see [`mobility`](super::mobility). Such a
/// robot has more degrees of freedom than described. Legs that block nothing at all are accepted:
/// they are rods that replace parallelograms, whose constraints are not described.
fn check_held(description: &Description, mechanism: &Mechanism) -> Result<(), Diagnostics> {
    let displaced_states = random_states(mechanism, 3, 5).into_iter().map(|state| {
        let home = Home::new(mechanism, state.pose, state.joints);
        Mechanism {
            home,
            ..mechanism.clone()
        }
    });
    // A single configuration may be singular.
    let loose = |at: &Mechanism| {
        Mobility::at_home(at).filter(|mobility| {
            let left = mobility.count();
            mobility.blocked > 0 && left > at.dof() && mobility.driven(at) >= left
        })
    };
    let Some(mobility) = loose(mechanism) else {
        return Ok(());
    };
    if displaced_states.into_iter().all(|at| loose(&at).is_some()) {
        Err(Diagnostics::from(explain::not_held(description, &mobility)))
    } else {
        Ok(())
    }
}

/// Largest number of independent joints of a leg: operation counts of its model grow quadratically,
/// the time of the search with the fourth power.
const CHAIN: usize = 100;

/// Reports legs without joints or with too many; returns whether any has too many.
fn check_sizes(description: &Description, errors: &mut Diagnostics) -> bool {
    let mut is_too_large = false;
    for leg in &description.legs {
        let own = leg.joints.iter().enumerate();
        let own = own.filter(|(at, joint)| joint.is_independent(*at)).count();
        if own > CHAIN {
            is_too_large = true;
            let message = format!(
                "leg `{}` has {own} independent joints, more than {CHAIN}: its identification model alone \
                 would take some {} operations",
                leg.name.value,
                28 * own * own
            );
            let help = "describe it in parts, each as a robot of its own";
            errors.push(
                Diagnostic::new(Code::LEG_EMPTY_OR_LARGE, message, leg.name.span.clone())
                    .help(help),
            );
        }
        if leg.joints.is_empty() {
            errors.push(Diagnostic::new(
                Code::LEG_EMPTY_OR_LARGE,
                format!("leg `{}` has no joint", leg.name.value),
                leg.span.clone(),
            ));
        }
    }
    is_too_large
}

/// Reports legs whose joint rates their end's motion does not determine, once for each shape.
fn check_structure(
    description: &Description,
    mechanism: &Mechanism,
    home: &Home,
    errors: &mut Diagnostics,
) {
    let Home { pose, joints, .. } = home;
    for (index, place) in description.legs.iter().enumerate() {
        // A cable follows every motion of its platform point.
        if place.cable.is_some() {
            continue;
        }
        let Some(velocities) = shared_velocities(mechanism, index, pose, joints) else {
            continue;
        };
        let leg = &mechanism.legs[index];
        for defect in defects(leg, &velocities) {
            errors.push(explain::defect(place, &defect));
        }
    }
}

/// Reports independent coordinates if their number is wrong or they do not determine the others at
/// home.
fn check_independent(description: &Description, mechanism: &Mechanism, errors: &mut Diagnostics) {
    if mechanism.has_dependent_joints() {
        let found = dependent::Rated::at_home(mechanism);
        if let Some(found) = found.filter(|found| !found.is_good()) {
            errors.push(explain::dependent(description, mechanism, &found));
        }
        return;
    }
    match rated(mechanism) {
        Some(found) if found.condition < WEAK * found.least => {}
        found => errors.push(explain::independent(description, mechanism, found.as_ref())),
    }
}

/// The home configuration as given, which need not close the legs.
pub(super) fn rough_home(description: &Description) -> Home {
    let joints = description.legs.iter().flat_map(|leg| {
        let own = leg
            .joints
            .iter()
            .enumerate()
            .filter(|(i, j)| j.is_independent(*i));
        own.map(|(_, j)| j.home.value())
    });
    let joints: Vec<f64> = joints.collect();
    let pose = match &description.platform {
        // A robot with chains has the joints of its skeleton and branches as pose.
        None => {
            let own = plain(description).coordinate_joints().into_iter();
            own.map(|at| joints[at]).collect()
        }
        Some(platform) => home_pose(platform),
    };
    Home {
        pose,
        joints,
        signs: Vec::new(),
        actuators: Vec::new(),
    }
}

fn home_pose(platform: &overact_description::Platform) -> Vec<f64> {
    let motion = platform.motion.value;
    let at = platform.home.at.map(crate::cas::Number::value);
    let mut pose: Vec<f64> = motion
        .of_pose()
        .twist()
        .iter()
        .filter_map(|c| match c {
            super::TwistCoordinate::Linear(axis) => Some(at[*axis]),
            super::TwistCoordinate::Angular(_) => None,
        })
        .collect();
    if motion.rotation_axis().is_some() {
        pose.push(platform.home.phi.value());
    }
    if motion.has_quaternion() {
        let [rx, ry, rz] = platform.home.rotation.map(crate::cas::Angle::value);
        let q = nalgebra::UnitQuaternion::from_euler_angles(rx, ry, rz);
        pose.extend([q.w, q.i, q.j, q.k]);
    }
    pose
}

/// Reports a leg that cannot follow every motion of the platform.
fn check_mobility(
    description: &Description,
    mechanism: &Mechanism,
    index: usize,
    errors: &mut Diagnostics,
) {
    let leg = &mechanism.legs[index];
    if leg.cable.is_some() {
        return;
    }
    let Home { pose, joints, .. } = &mechanism.home;
    let Some(wanted) = shared_velocities(mechanism, index, pose, joints) else {
        return;
    };
    let joints = &joints[mechanism.leg_range(index)];
    let jacobian = leg.closure_jacobian(joints);
    let Some(rates) = rates_per_velocity(leg, joints) else {
        return;
    };
    let missed = &wanted - &jacobian * (rates * &wanted);
    if missed.amax() > 1e-6 {
        errors.push(explain::blocked(description, mechanism, index, &missed));
    }
}
