//! Joints of a placed leg: geometry and coupling.

use crate::diagnostic::{Code, Diagnostic};
use crate::expressions::dimension::Dimension;
use crate::expressions::scalar::Scalar;
use crate::expressions::value::Value;
use crate::robot::friction;
use crate::robot::joint_shape::JointShape;
use crate::robot::model::{Joint, JointKind, Spanned};
use crate::robot::shape::Shape;
use crate::robot::spring;
use crate::robot::warnings;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::Scope;
use overact_exact::{Angle, Number, Ratio};
use std::f64::consts::TAU;

/// Joint variables with their factors.
type Combination = Vec<(usize, Ratio)>;

/// Evaluates the joints of a shape with the names of one placement.
pub(crate) fn read(
    shape: &Shape<'_, '_>,
    names: &Scope,
    homes: Option<&Table<'_, '_>>,
) -> Vec<Joint> {
    let mut scope = names.clone();
    for (index, joint) in shape.joints.iter().enumerate() {
        match dimension(joint.kind.value) {
            Some(dimension) => {
                scope.add(joint.variable(), Some(Value::variable(index, dimension)));
            }
            // An actuated fixed joint is already reported; a variable was intended.
            None if joint.actuated => scope.add(joint.variable(), None),
            None => {}
        }
    }
    let joints = shape.joints.iter().enumerate();
    let mut joints: Vec<Joint> = joints
        .map(|(index, joint)| Reader { joint, index }.read(&scope))
        .collect();
    resolve(&mut joints, shape);
    let motors = shape.motors.iter().filter_map(|motor| motor.joint(&scope));
    let motors: Vec<Joint> = motors.filter_map(|motor| driven(&joints, motor)).collect();
    for (index, joint) in joints.iter_mut().enumerate() {
        let dimension = dimension(joint.kind.value).filter(|_| joint.is_independent(index));
        if let Some(dimension) = dimension {
            joint.home = home(homes, &joint.name.value, dimension, names);
        }
    }
    if let Some(homes) = homes {
        homes.finish();
    }
    joints.extend(motors);
    joints
}

/// A motor in terms of independent joints.
fn driven(joints: &[Joint], motor: Joint) -> Option<Joint> {
    let given: Vec<Combination> = joints.iter().map(|joint| joint.variable.clone()).collect();
    let variable = substitute(&given, &motor.variable)?;
    Some(Joint { variable, ..motor })
}

/// Dimension of a joint's variable.
pub(crate) fn dimension(kind: JointKind) -> Option<Dimension> {
    match kind {
        JointKind::Revolute => Some(Dimension::ANGLE),
        JointKind::Prismatic => Some(Dimension::LENGTH),
        JointKind::Fixed => None,
    }
}

/// One joint while it is being evaluated.
struct Reader<'s, 'c, 't> {
    joint: &'s JointShape<'c, 't>,
    index: usize,
}

impl Reader<'_, '_, '_> {
    fn read(&self, scope: &Scope) -> Joint {
        let joint = self.joint;
        let mut scope = scope.clone();
        if let Some(dimension) = dimension(joint.kind.value) {
            scope.add("q".to_owned(), Some(Value::variable(self.index, dimension)));
        }
        let [gamma, b, alpha, d, theta, r] = joint.steps.each_ref().map(Option::as_ref);
        let angle = |item: Option<&Item<'_, '_>>| self.angle(item, &scope);
        let length = |item: Option<&Item<'_, '_>>| self.length(item, &scope);
        let (theta, r, variable) = match joint.kind.value {
            JointKind::Revolute => {
                let (offset, variable) = self.position(theta, Dimension::ANGLE, &scope);
                let offset = offset.to_angle().unwrap_or(Angle::ZERO);
                (self.spanned(theta, offset), length(r), variable)
            }
            JointKind::Prismatic if joint.pitch.is_some() => {
                let variable = lead(joint.pitch.as_ref(), &scope);
                let turn = variable.map_or_else(Vec::new, |lead| vec![(self.index + 1, lead)]);
                (angle(theta), length(r), turn)
            }
            JointKind::Prismatic => {
                let (offset, variable) = self.position(r, Dimension::LENGTH, &scope);
                (angle(theta), self.spanned(r, offset.to_number()), variable)
            }
            JointKind::Fixed => (angle(theta), length(r), Vec::new()),
        };
        let quarter = || {
            let right = Ratio::new(1, 2).map_or(Angle::ZERO, Angle::half_turns);
            self.spanned(None, right)
        };
        let turned =
            |item: Option<&Item<'_, '_>>| if joint.turned { quarter() } else { angle(item) };
        Joint {
            name: joint.name.clone(),
            kind: joint.kind.clone(),
            antecedent: joint.antecedent,
            gamma: turned(gamma),
            b: length(b),
            alpha: turned(alpha),
            d: length(d),
            theta,
            r,
            variable,
            actuated: joint.actuated,
            dependent: joint.dependent.as_ref().map(|item| item.span.clone()),
            parameters: joint.parameters.clone(),
            home: Number::ZERO,
            motor: None,
            spring: self.formula(joint.spring.as_ref(), &scope, spring::read),
            known: self.formula(joint.known.as_ref(), &scope, spring::known),
            load: self.formula(joint.load.as_ref(), &scope, spring::load),
            stribeck: joint
                .stribeck
                .as_ref()
                .and_then(|item| friction::stribeck(item, joint.kind.value, &scope)),
            span: joint.span.clone(),
        }
    }

    /// The value of a key as an expression of the joint's position; `q` is the joint's variable,
    /// even if it is coupled.
    fn formula<'i, 'c, 't, T>(
        &self,
        item: Option<&'i Item<'c, 't>>,
        scope: &Scope,
        read: impl Fn(&'i Item<'c, 't>, JointKind, &Scope) -> Option<T>,
    ) -> Option<T> {
        let kind = self.joint.kind.value;
        let mut scope = scope.without_variables();
        let own = dimension(kind).unwrap_or(Dimension::ANGLE);
        scope.add("q".to_owned(), Some(Value::variable(self.index, own)));
        read(item?, kind, &scope)
    }

    /// A value with the location of its key, or of the joint without a key.
    fn spanned<T>(&self, item: Option<&Item<'_, '_>>, value: T) -> Spanned<T> {
        Spanned::new(
            value,
            item.map_or(&self.joint.span, |item| &item.span).clone(),
        )
    }

    fn angle(&self, item: Option<&Item<'_, '_>>, scope: &Scope) -> Spanned<Angle> {
        let value = item.and_then(|item| {
            let value = self.constant(item, Dimension::ANGLE, scope)?;
            item.to_angle(&value)
        });
        if let (Some(item), Some(value)) = (item, &value) {
            warnings::angle(item, value.value);
        }
        value.unwrap_or_else(|| self.spanned(item, Angle::ZERO))
    }

    fn length(&self, item: Option<&Item<'_, '_>>, scope: &Scope) -> Spanned<Number> {
        let value = item.and_then(|item| {
            let value = self.constant(item, Dimension::LENGTH, scope)?;
            Some(Spanned::new(value.scalar.to_number(), item.span.clone()))
        });
        if let (Some(item), Some(value)) = (item, &value) {
            warnings::length(item, value.value);
        }
        value.unwrap_or_else(|| self.spanned(item, Number::ZERO))
    }

    /// A value without joint variables; the error states where they are allowed.
    ///
    /// `q` counts as a variable even in a joint that has none.
    fn constant(&self, item: &Item<'_, '_>, dimension: Dimension, scope: &Scope) -> Option<Value> {
        let mut scope = scope.clone();
        scope.add("q".to_owned(), Some(Value::variable(self.index, dimension)));
        let value = item.evaluate(&scope)?;
        if !value.terms.is_empty() {
            let message = format!(
                "`{}` is constant and cannot hold a joint variable",
                item.key.value
            );
            let help = self.joint.word.variables(&self.joint.called);
            let error = item.error(Code::JOINT_POSITION, message).help(help);
            item.context.report_once(error);
            return None;
        }
        item.check_dimension(&value, dimension)?;
        Some(value)
    }

    /// Constant and variable part of θ (revolute) or r (prismatic).
    ///
    /// If it is missing or already reported, it is the joint's own variable.
    fn position(
        &self,
        item: Option<&Item<'_, '_>>,
        dimension: Dimension,
        scope: &Scope,
    ) -> (Scalar, Combination) {
        let own = (Scalar::Number(Number::ZERO), vec![(self.index, Ratio::ONE)]);
        let Some(item) = item else { return own };
        let value = item
            .evaluate(scope)
            .filter(|v| item.check_dimension(v, dimension).is_some());
        let Some(value) = value else { return own };
        if let Some(problem) = self.problem(&value, item) {
            item.context.report_once(problem);
            return own;
        }
        match (dimension, value.scalar.to_angle()) {
            (Dimension::LENGTH, _) => warnings::length(item, value.scalar.to_number()),
            (_, Some(angle)) => warnings::angle(item, angle),
            (_, None) => {}
        }
        (value.scalar, value.terms)
    }

    /// The error of a value that cannot be the joint's position.
    fn problem(&self, value: &Value, item: &Item<'_, '_>) -> Option<Diagnostic> {
        let has_own = value.terms.iter().any(|(joint, _)| *joint == self.index);
        if value.terms.is_empty() {
            let error = item.error(
                Code::JOINT_POSITION,
                "the position of this joint is a constant",
            );
            return Some(error.help("add the joint variable `q`, or use type = \"fixed\""));
        }
        if has_own && value.terms != [(self.index, Ratio::ONE)] {
            let error = item.error(
                Code::JOINT_POSITION,
                "the position of a joint with its own variable is `q` plus a constant",
            );
            let help = "reverse the axis to change the sign; only a coupled joint uses the variables of others";
            return Some(error.help(help));
        }
        if !has_own && self.joint.actuated {
            let error = item.error(Code::ACTUATED, "a coupled joint cannot be actuated");
            return Some(error.help("actuate the joint to which it is coupled"));
        }
        None
    }
}

/// Displacement of a helical joint per radian, from a length per turn or per radian.
///
/// The unit decides. `None` after an error.
fn lead(item: Option<&Item<'_, '_>>, scope: &Scope) -> Option<Ratio> {
    let item = item?;
    let value = item.evaluate(scope)?;
    let help = "give the travel for a turn, for instance \"5 mm\"; negative for a left-hand thread";
    if !value.terms.is_empty() {
        let message = "a pitch is constant and cannot hold a joint variable";
        let error = item.error(Code::JOINT_POSITION, message).help(help);
        item.context.report_once(error);
        return None;
    }
    let per_radian = Dimension::ANGLE
        .power(-1)
        .and_then(|per_radian| Dimension::LENGTH.times(per_radian));
    let lead = match per_radian {
        Some(dimension) if value.dimension == dimension => value.scalar.to_ratio(),
        _ => {
            item.check_dimension(&value, Dimension::LENGTH)?;
            warnings::length(item, value.scalar.to_number());
            Scalar::Number(Number::float(value.scalar.value() / TAU)).to_ratio()
        }
    };
    if lead.is_none_or(Ratio::is_zero) {
        let message = "a pitch must not be zero, and be less than 1e6 m";
        item.context
            .report_once(item.error(Code::OUT_OF_RANGE, message).help(help));
        return None;
    }
    lead
}

/// Expresses the variables of coupled joints by independent ones.
fn resolve(joints: &mut [Joint], shape: &Shape<'_, '_>) {
    let given: Vec<Combination> = joints.iter().map(|joint| joint.variable.clone()).collect();
    for (index, joint) in joints.iter_mut().enumerate() {
        match independent(&given, index) {
            Ok(variable) => joint.variable = variable,
            Err(message) => {
                let span = match joint.kind.value {
                    JointKind::Prismatic => joint.r.span.clone(),
                    _ => joint.theta.span.clone(),
                };
                if let Some(item) = shape
                    .joints
                    .get(index)
                    .and_then(|j| j.steps.iter().flatten().next())
                {
                    let help = "an independent joint has `q` instead of the others' variables";
                    item.context.report_once(
                        Diagnostic::new(Code::JOINT_POSITION, message, span).help(help),
                    );
                }
                joint.variable = vec![(index, Ratio::ONE)];
            }
        }
    }
}

/// The variable of one joint in terms of independent ones.
///
/// Coupled joints are replaced until none is left, which takes at most as many rounds as there are
/// joints, unless they form a cycle.
fn independent(given: &[Combination], index: usize) -> Result<Combination, &'static str> {
    let own = |joint: usize| {
        given
            .get(joint)
            .is_some_and(|g| matches!(g.as_slice(), [(j, _)] if *j == joint))
    };
    let mut variable = given.get(index).cloned().unwrap_or_default();
    for _ in 0..=given.len() {
        if variable.iter().all(|(joint, _)| own(*joint)) {
            return Ok(variable);
        }
        variable = substitute(given, &variable).ok_or("the factors of this joint are too large")?;
    }
    Err("the joints are coupled in a cycle")
}

/// Replaces every joint variable by its definition; `None` on overflow.
fn substitute(given: &[Combination], variable: &Combination) -> Option<Combination> {
    let mut result: Combination = Vec::new();
    for (joint, factor) in variable {
        for (target, weight) in given.get(*joint)? {
            let product = factor.times(*weight)?;
            match result.iter_mut().find(|(j, _)| j == target) {
                Some((_, sum)) => *sum = sum.plus(product)?,
                None => result.push((*target, product)),
            }
        }
    }
    result.retain(|(_, factor)| !factor.is_zero());
    result.sort_unstable_by_key(|(joint, _)| *joint);
    Some(result)
}

/// The rough position of a joint at home.
fn home(homes: Option<&Table<'_, '_>>, joint: &str, dimension: Dimension, scope: &Scope) -> Number {
    let item = homes.and_then(|table| table.get(joint));
    let value = item.as_ref().and_then(|item| item.number(dimension, scope));
    if let (Some(item), Some(number)) = (&item, &value)
        && dimension == Dimension::ANGLE
        && {
            let text = item.context.text(&item.span);
            text.trim_matches(['"', '\'']).parse::<f64>().is_ok()
        }
    {
        warnings::bare_angle(item, number.value.value());
    }
    value.map_or(Number::ZERO, |number| number.value)
}
