//! Asymmetric and Stribeck friction of joints and motors, and lists with redundant parameters.

use crate::diagnostic::Code;
use crate::expressions::dimension::Dimension;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;
use overact_exact::Number;

/// Reads the key `stribeck` of a joint or motor: the velocity at which half of the excess static
/// friction is left.
pub(crate) fn stribeck(item: &Item<'_, '_>, kind: JointKind, scope: &Scope) -> Option<Number> {
    let (dimension, example) = match kind {
        JointKind::Revolute => (Dimension::ANGULAR_SPEED, "0.05 rad/s"),
        JointKind::Prismatic => (Dimension::SPEED, "2 mm/s"),
        JointKind::Fixed => {
            let error = item.error(Code::SPRING, "a fixed joint has no friction");
            item.context
                .report_once(error.help("give it to a joint that moves"));
            return None;
        }
    };
    let velocity = item.number(dimension, scope)?.value;
    if velocity.value() > 0.0 {
        return Some(velocity);
    }
    let error = item.error(Code::SPRING, "a Stribeck velocity is positive");
    let help = format!(
        "give the velocity at which the excess of friction at standstill has fallen to one half, for instance \"{example}\""
    );
    item.context.report_once(error.help(help));
    None
}

/// Groups of parameters that describe the same friction twice.
const TWICE: [([&str; 3], &str); 3] = [
    (["fv", "fv_pos", "fv_neg"], "viscous friction"),
    (["fs", "fs_pos", "fs_neg"], "Coulomb friction"),
    (["off", "fs_pos", "fs_neg"], "an offset"),
];

/// Reports a list with friction for both directions and for each one.
pub(crate) fn check(item: &Item<'_, '_>, parameters: &[StandardParameter]) {
    let has = |name: &&str| parameters.iter().any(|one| one.name() == *name);
    let Some((names, what)) = TWICE.iter().find(|(names, _)| names.iter().all(&has)) else {
        return;
    };
    let [whole, positive, negative] = names;
    let message = format!(
        "`{whole}` of this list is contained in `{positive}` and `{negative}`: {what} occurs twice"
    );
    let help = "leave `fv`, `fs` and `off` out if friction differs by direction, for instance \
                parameters = [\"inertia\", \"ia\", \"friction by direction\"]";
    item.context
        .report(item.error(Code::SPRING, message).help(help));
}
