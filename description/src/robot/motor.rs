//! The tables `[[leg.NAME.motor]]` and `[motor.NAME]`: transmissions between motors and joints.
//!
//! A motor drives a combination c of joint variables through its gear: θ = ratio × c. With several
//! coupled joints its rotor inertia and friction act on c and not on a single joint. Their torque
//! acts on the joints by the combination's factors. In the model of a robot without loops a motor is
//! a coupled joint without a body.

use crate::diagnostic::{Code, Diagnostic, Span};
use crate::expressions::dimension::Dimension;
use crate::expressions::value::Value;
use crate::robot::friction;
use crate::robot::model::{Joint, JointKind, Spanned};
use crate::robot::parameters::Owner;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word};
use overact_core::StandardParameter;
use overact_exact::{Angle, Number};

/// The table of a motor, with unevaluated expressions.
pub(crate) struct MotorShape<'c, 't> {
    pub(crate) name: Spanned<String>,
    /// The driven combination of joints.
    turns: Option<Item<'c, 't>>,
    ratio: Option<Item<'c, 't>>,
    stribeck: Option<Item<'c, 't>>,
    /// Parameters, if given.
    pub(crate) parameters: Option<Vec<StandardParameter>>,
    span: Span,
}

/// Reads the motors of a leg with these joint names.
pub(crate) fn shapes<'c, 't>(
    item: &Item<'c, 't>,
    joints: &[Spanned<String>],
) -> Vec<MotorShape<'c, 't>> {
    let mut motors: Vec<MotorShape<'c, 't>> = Vec::new();
    for (index, table) in item.tables("a motor").iter().enumerate() {
        let motor = numbered(table, index);
        let mut names = joints.iter().chain(motors.iter().map(|other| &other.name));
        if names.any(|name| name.value == motor.name.value) {
            let message = format!(
                "there are two joints or motors `{}` in this leg",
                motor.name.value
            );
            let help = "a motor without a name is called by its number, `m1`";
            table.context.report(
                Diagnostic::new(Code::SAME_NAME, message, motor.name.span.clone()).help(help),
            );
        }
        motors.push(motor);
    }
    motors
}

/// A motor of a leg, which is called by its number if it has no name.
fn numbered<'c, 't>(table: &Table<'c, 't>, index: usize) -> MotorShape<'c, 't> {
    let number = || Spanned::new(format!("m{}", index + 1), table.span.clone());
    let given = table.get("name").and_then(|item| item.string());
    let name = given.unwrap_or_else(number);
    if !is_word(&name.value) || name.value == "base" {
        let message = format!("`{}` cannot be the name of a motor", name.value);
        let diagnostic = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        let help = "use letters, digits and underscores, but not \"base\"";
        table.context.report(diagnostic.help(help));
    }
    let motor = shape(table, name);
    table.finish();
    motor
}

/// The keys of a motor's table other than its name.
pub(crate) fn shape<'c, 't>(table: &Table<'c, 't>, name: Spanned<String>) -> MotorShape<'c, 't> {
    let help =
        "joint variables that the motor turns through its gear, for instance turns = \"q5 + q6\"";
    let turns = table.require("turns", help);
    let parameters = table.get("parameters");
    MotorShape {
        name,
        turns,
        ratio: table.get("ratio"),
        stribeck: table.get("stribeck"),
        parameters: parameters.and_then(|item| item.parameters(Owner::Motor)),
        span: table.span.clone(),
    }
}

impl MotorShape<'_, '_> {
    /// The motor as a coupled joint; its variable is as given, in joints that may be coupled
    /// themselves.
    ///
    /// `None` after an error.
    pub(crate) fn joint(&self, scope: &Scope) -> Option<Joint> {
        let ratio = match &self.ratio {
            Some(item) => gear_ratio(item, scope),
            None => Some(Number::ONE),
        };
        let item = self.turns.as_ref()?;
        let value = item.evaluate(scope)?;
        if let Some(problem) = problem(&value, item) {
            item.context.report_once(problem);
            return None;
        }
        let kind = match value.dimension {
            Dimension::LENGTH => JointKind::Prismatic,
            _ => JointKind::Revolute,
        };
        let coupled = value.terms.len() > 1;
        let stribeck = self.stribeck.as_ref();
        let mut parameters = self.parameters.clone().unwrap_or_else(|| usual(coupled));
        parameters.extend(stribeck.map(|_| StandardParameter::Fst));
        let here = |value: Angle| Spanned::new(value, self.span.clone());
        let zero = Spanned::new(Number::ZERO, self.span.clone());
        Some(Joint {
            name: self.name.clone(),
            kind: Spanned::new(kind, item.span.clone()),
            antecedent: None,
            gamma: here(Angle::ZERO),
            b: zero.clone(),
            alpha: here(Angle::ZERO),
            d: zero.clone(),
            theta: here(Angle::ZERO),
            r: zero,
            variable: value.terms,
            actuated: false,
            dependent: None,
            parameters,
            home: Number::ZERO,
            motor: Some(ratio?),
            spring: None,
            known: None,
            load: None,
            stribeck: stribeck.and_then(|item| friction::stribeck(item, kind, scope)),
            span: self.span.clone(),
        })
    }
}

/// Default parameters of a motor: a motor of one joint shares those of the joint.
///
/// Offsets of motors are determined by those of the joints.
pub(crate) fn usual(coupled: bool) -> Vec<StandardParameter> {
    use StandardParameter as P;
    if coupled {
        vec![P::Ia, P::Fv, P::Fs]
    } else {
        Vec::new()
    }
}

/// A gear ratio: a nonzero number; a negative one reverses the direction.
fn gear_ratio(item: &Item<'_, '_>, scope: &Scope) -> Option<Number> {
    let ratio = item.number(Dimension::NONE, scope)?.value;
    if ratio.is_zero() {
        let error = item.error(Code::TRANSMISSION, "a gear of ratio 0 turns nothing");
        let help = "give the turns of the motor for one turn of its output, for instance 100";
        item.context.report(error.help(help));
        return None;
    }
    Some(ratio)
}

/// The error of a value that a motor cannot drive.
fn problem(value: &Value, item: &Item<'_, '_>) -> Option<Diagnostic> {
    if value.terms.is_empty() {
        let error = item.error(Code::TRANSMISSION, "a motor must turn a joint");
        return Some(error.help("name the joint variables, for instance \"q5 + q6\""));
    }
    if !value.scalar.is_zero() {
        let error = item.error(
            Code::TRANSMISSION,
            "a motor turns joint variables without a constant",
        );
        let help = "give the offset of its encoder as `position_offset` of [data]";
        return Some(error.help(help));
    }
    if !value.dimension.fits(Dimension::ANGLE) && !value.dimension.fits(Dimension::LENGTH) {
        let found = value.dimension.name();
        let error = item.error(
            Code::TRANSMISSION,
            format!("a motor turns an angle or a length, found {found}"),
        );
        return Some(error.help("the factors of joint variables are plain fractions"));
    }
    None
}
