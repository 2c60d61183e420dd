//! Motors of robots with loops: each drives a combination of joints of one or several legs.
//!
//! A table `[motor.NAME]` names joints by leg, `turns = "left.q1 + right.q1"`. A table
//! `[[leg.NAME.motor]]` gives every placement of the leg a motor of its own. In a robot without
//! loops both describe coupled joints without a body, see [`motor`](crate::robot::motor).

use crate::diagnostic::{Code, Diagnostic};
use crate::expressions::value::Value;
use crate::robot::joint_shape::variable_name;
use crate::robot::leg::joint;
use crate::robot::model::{BodyIndex, Joint, Leg, Motor, MotorTerm};
use crate::robot::motor;
use crate::robot::shape::Shape;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word};
use overact_exact::{Number, Ratio};

/// Largest number of tables `[motor.NAME]`.
const MOST: usize = 200;

/// Takes the motors that are described with legs out of the legs of a robot with loops.
///
/// Afterwards the last joint of a leg carries its end.
pub(crate) fn take_from_legs(shapes: &[Shape<'_, '_>], legs: &mut [Leg]) -> Vec<Motor> {
    let mut motors = Vec::new();
    for (index, leg) in legs.iter_mut().enumerate() {
        let (joints, own): (Vec<Joint>, Vec<Joint>) = std::mem::take(&mut leg.joints)
            .into_iter()
            .partition(|joint| joint.motor.is_none());
        leg.joints = joints;
        let shape = shapes.get(leg.shape);
        for joint in own {
            let given = shape.and_then(|shape| {
                let mut motors = shape.motors.iter();
                motors.find(|motor| motor.name.value == joint.name.value)
            });
            let in_leg = |&(joint, factor): &(usize, Ratio)| MotorTerm {
                joint: BodyIndex { leg: index, joint },
                factor,
            };
            let terms = joint.variable.iter().map(in_leg).collect();
            let is_usual = given.is_none_or(|shape| shape.parameters.is_none());
            motors.push(of_joint(joint, Some(index), terms, is_usual));
        }
    }
    motors
}

/// The motor of a coupled joint without a body; `is_usual` if its parameters are not given.
fn of_joint(joint: Joint, leg: Option<usize>, terms: Vec<MotorTerm>, is_usual: bool) -> Motor {
    let mut parameters = joint.parameters;
    // A passive joint has the friction of its bearings, the motor its own.
    if is_usual && terms.len() == 1 {
        parameters.splice(0..0, motor::usual(true));
    }
    Motor {
        name: joint.name,
        leg,
        kind: joint.kind.value,
        terms,
        ratio: joint.motor.unwrap_or(Number::ONE),
        parameters,
        stribeck: joint.stribeck,
        span: joint.span,
    }
}

/// Reads the tables `[motor.NAME]`.
///
/// In a robot without loops the motors are added to the joints of its leg.
pub(crate) fn read(
    table: &Table<'_, '_>,
    scope: &Scope,
    is_closed: bool,
    has_platform: bool,
    legs: &mut [Leg],
) -> Vec<Motor> {
    let tables = table
        .get("motor")
        .and_then(|item| item.table("the table `[motor]`"));
    let mut items = tables.map_or_else(Vec::new, |motors| motors.items());
    items.sort_by_key(|item| item.key.span.start);
    if let Some(next) = items.get(MOST) {
        let message = format!("there are more than {MOST} motors");
        let error = Diagnostic::new(Code::OUT_OF_RANGE, message, next.key.span.clone());
        table
            .context
            .report(error.help("leave out those that drive nothing"));
    }
    let variables = Variables::new(scope, has_platform, legs);
    let tables = items.iter().take(MOST);
    let tables: Vec<MotorTable> = tables
        .filter_map(|item| read_table(item, &variables, legs))
        .collect();
    if is_closed {
        let motors = tables.into_iter();
        return motors
            .map(|one| of_joint(one.joint, None, one.terms, one.is_usual))
            .collect();
    }
    if let Some(leg) = legs.first_mut() {
        add_to_tree(table, tables, leg);
    }
    Vec::new()
}

/// A table `[motor.NAME]`.
struct MotorTable {
    /// The motor as a coupled joint.
    joint: Joint,
    /// The independent joints that it drives.
    terms: Vec<MotorTerm>,
    /// Whether its parameters are not given.
    is_usual: bool,
}

/// Joint variables of all legs, with the joints that they belong to.
struct Variables {
    scope: Scope,
    joints: Vec<BodyIndex>,
}

impl Variables {
    /// Variables `LEG.q1`; those of the first leg of a robot without a platform also as `q1`.
    fn new(constants: &Scope, has_platform: bool, legs: &[Leg]) -> Self {
        let (mut scope, mut joints) = (constants.clone(), Vec::new());
        for (index, leg) in legs.iter().enumerate() {
            let own = leg.joints.iter().enumerate();
            for (joint, of) in own.filter(|(_, joint)| joint.motor.is_none()) {
                let Some(dimension) = joint::dimension(of.kind.value) else {
                    continue;
                };
                let value = || Some(Value::variable(joints.len(), dimension));
                let name = variable_name(&of.name.value);
                if index == 0 && !has_platform {
                    scope.add(name.clone(), value());
                }
                scope.add(format!("{}.{name}", leg.name.value), value());
                joints.push(BodyIndex { leg: index, joint });
            }
        }
        Self { scope, joints }
    }
}

/// Reads one table; `None` after an error.
fn read_table(item: &Item<'_, '_>, variables: &Variables, legs: &[Leg]) -> Option<MotorTable> {
    let name = item.key.clone();
    let table = item.table(format!("the motor `{}`", name.value))?;
    let starts_well = name.value.starts_with(|c: char| c.is_ascii_alphabetic());
    if !starts_well || !is_word(&name.value) {
        let message = format!("`{}` cannot be the name of a motor", name.value);
        let error = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        let help = "use letters, digits and underscores, a letter first";
        item.context.report(error.help(help));
    }
    let shape = motor::shape(&table, name);
    table.finish();
    let joint = shape.joint(&variables.scope)?;
    let Some(terms) = independent_terms(&joint.variable, variables, legs) else {
        let message = "the factors of this motor are too large";
        let error = Diagnostic::new(Code::TRANSMISSION, message, joint.span);
        item.context
            .report(error.help("write smaller factors, such as 0.5 or 3/4"));
        return None;
    };
    if terms.is_empty() {
        let message = "the joints that this motor turns cancel each other";
        let error = Diagnostic::new(Code::TRANSMISSION, message, joint.span);
        let help = "coupled joints count with the joints that they follow: name others";
        item.context.report(error.help(help));
        return None;
    }
    Some(MotorTable {
        joint,
        terms,
        is_usual: shape.parameters.is_none(),
    })
}

/// A combination of any joints in terms of independent ones; `None` on overflow.
fn independent_terms(
    given: &[(usize, Ratio)],
    variables: &Variables,
    legs: &[Leg],
) -> Option<Vec<MotorTerm>> {
    let mut terms: Vec<MotorTerm> = Vec::new();
    for (variable, factor) in given {
        let BodyIndex { leg, joint } = *variables.joints.get(*variable)?;
        for (own, weight) in &legs.get(leg)?.joints.get(joint)?.variable {
            let joint = BodyIndex { leg, joint: *own };
            let product = factor.times(*weight)?;
            match terms.iter_mut().find(|term| term.joint == joint) {
                Some(term) => term.factor = term.factor.plus(product)?,
                None => terms.push(MotorTerm {
                    joint,
                    factor: product,
                }),
            }
        }
    }
    terms.retain(|term| !term.factor.is_zero());
    terms.sort_unstable_by_key(|term| (term.joint.leg, term.joint.joint));
    Some(terms)
}

/// Adds motors to a robot without loops, as coupled joints without a body.
fn add_to_tree(table: &Table<'_, '_>, motors: Vec<MotorTable>, leg: &mut Leg) {
    for MotorTable {
        mut joint, terms, ..
    } in motors
    {
        let name = &joint.name;
        if leg.joints.iter().any(|own| own.name.value == name.value) {
            let message = format!("there are two joints or motors `{}`", name.value);
            let error = Diagnostic::new(Code::SAME_NAME, message, name.span.clone());
            table.context.report(error.help("rename one of them"));
            continue;
        }
        let variable = terms.iter().map(|term| (term.joint.joint, term.factor));
        joint.variable = variable.collect();
        leg.joints.push(joint);
    }
}
