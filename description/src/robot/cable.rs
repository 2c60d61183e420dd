//! Legs that are cables: `type = "cable"` of `[leg.NAME]`.
//!
//! A cable runs from an exit point over a pulley, which may swivel, straight to a platform point.
//! Its coordinate is its length, an actuated slide without a body.

use crate::diagnostic::Code;
use crate::expressions::dimension::Dimension;
use crate::robot::joint_shape::JointShape;
use crate::robot::joint_shape::compound_kind::CompoundJointKind;
use crate::robot::model::{Cable, JointKind, Spanned};
use crate::robot::parameters::Owner;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;
use overact_exact::Number;

/// Name of the coordinate of a cable.
const LENGTH: &str = "length";
/// Parameters of a cable's drive unless others are listed.
const DEFAULT: [StandardParameter; 3] = [
    StandardParameter::Ia,
    StandardParameter::Fv,
    StandardParameter::Fs,
];

/// A cable with unevaluated expressions.
pub(crate) struct CableShape<'c, 't> {
    pulley: Option<Item<'c, 't>>,
    minimum: Option<Item<'c, 't>>,
    drum: Option<Item<'c, 't>>,
}

/// Reads the keys of a cable, and its length as an actuated slide.
pub(crate) fn shape<'c, 't>(table: &Table<'c, 't>) -> (CableShape<'c, 't>, JointShape<'c, 't>) {
    for key in ["joint", "motor"] {
        if let Some(item) = table.get(key) {
            let message = format!("a cable has no `{key}`");
            let help = "its coordinate is its length: write `base`, `end`, `pulley` and `parameters`, or leave out type = \"cable\"";
            let error = item.error(Code::CONTRADICTION, message);
            table.context.report(error.help(help));
        }
    }
    let cable = CableShape {
        pulley: table.get("pulley"),
        minimum: table.get("minimum"),
        drum: table.get("drum"),
    };
    let parameters = table.get("parameters");
    let parameters = parameters.and_then(|item| item.parameters(Owner::Cable));
    let length = JointShape {
        name: Spanned::new(LENGTH.to_owned(), table.span.clone()),
        kind: Spanned::new(JointKind::Prismatic, table.span.clone()),
        antecedent: None,
        steps: [const { None }; 6],
        turned: false,
        actuated: true,
        dependent: None,
        parameters: parameters.unwrap_or_else(|| DEFAULT.to_vec()),
        spring: None,
        known: None,
        stribeck: None,
        load: None,
        pitch: None,
        word: CompoundJointKind::Simple(JointKind::Prismatic),
        called: LENGTH.to_owned(),
        span: table.span.clone(),
    };
    (cable, length)
}

/// Reports a home position of a cable; always false.
pub(crate) fn refuse_home(item: &Item<'_, '_>) -> bool {
    let error = item.error(Code::CONTRADICTION, "a cable has no `home`");
    let help = "its length at home follows from the platform's `home`: leave it out";
    item.context.report(error.help(help));
    false
}

impl CableShape<'_, '_> {
    /// The cable with the values of a placement.
    pub(crate) fn evaluate(&self, scope: &Scope) -> Cable {
        let length = |item: &Option<Item<'_, '_>>, is_zero_allowed: bool| {
            quantity(item.as_ref()?, Dimension::LENGTH, is_zero_allowed, scope)
        };
        let minimum = self.minimum.as_ref();
        let minimum = minimum.and_then(|item| quantity(item, Dimension::FORCE, true, scope));
        Cable {
            pulley: length(&self.pulley, true).unwrap_or(Number::ZERO),
            minimum: minimum.unwrap_or(Number::ZERO),
            drum: length(&self.drum, false),
        }
    }
}

/// A quantity that is positive, or zero if that is allowed; others are reported.
fn quantity(
    item: &Item<'_, '_>,
    dimension: Dimension,
    is_zero_allowed: bool,
    scope: &Scope,
) -> Option<Number> {
    let number = item.number(dimension, scope)?;
    let value = number.value.value();
    if value > 0.0 || is_zero_allowed && value == 0.0 {
        return Some(number.value);
    }
    let help = if is_zero_allowed {
        "write a positive value, or leave it out"
    } else {
        "write a positive radius; leave it out if the log contains tensions"
    };
    let message = format!("`{}` of a cable must be positive", item.key.value);
    let error = item.error(Code::OUT_OF_RANGE, message).help(help);
    item.context.report_once(error);
    None
}
