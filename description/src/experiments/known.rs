//! Requirements of the identification of drive gains: known values, drives with one signal each,
//! and payloads of robots without a platform.

use crate::diagnostic::{Code, Diagnostic};
use crate::experiments::experiment::parameters;
use crate::robot::inventory::Inventory;
use crate::robot::model::{Joint, Leg};
use crate::toml_text::reader::Item;
use overact_core::StandardParameter;

/// Why joints have no gains if motors drive several joints.
pub const COUPLED_MOTORS: &str = "gains require drives that turn one joint each, but motors of this robot turn several: the torque of a joint has no single gain";

/// Why gains are not identified with known joint torques.
pub const KNOWN_TORQUES: &str = "gains are not identified if torques of joints are known: a gain scales measured torques, not known ones";

impl Leg {
    /// Whether a torque of a joint is known.
    #[must_use]
    pub fn has_known_torques(&self) -> bool {
        self.joints.iter().any(|joint| joint.known.is_some())
    }

    /// Whether a motor drives a combination of joints, so that joint torques are not multiples of
    /// one motor's signal.
    #[must_use]
    pub fn has_coupled_motors(&self) -> bool {
        let mut joints = self.joints.iter();
        joints.any(|joint| joint.motor.is_some() && joint.variable.len() > 1)
    }

    /// Whether a body of the leg is the payload of a robot without a platform: a fixed joint named
    /// `payload`.
    #[must_use]
    pub fn carries_payload(&self) -> bool {
        self.joints.iter().any(Joint::is_payload)
    }
}

/// Reads `[identification.known]`: values by name, SI units.
///
/// Friction is excluded, since neither scales nor drawings give it.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Vec<(String, f64)> {
    use StandardParameter as P;
    let mut known = Vec::new();
    for one in parameters(item, robot) {
        let report = |message: String, help: &str| {
            let error = Diagnostic::new(Code::KNOWN, message, one.name.span.clone());
            item.context.report(error.help(help));
        };
        match one.symbol {
            friction if friction.is_friction() || friction == P::Off => report(
                format!(
                    "`{}` is friction or an offset, which are never known exactly",
                    one.name.value
                ),
                "give masses, first moments, inertias or springs; friction is identified",
            ),
            P::M | P::Xx | P::Yy | P::Zz | P::Ia if one.value <= 0.0 => report(
                format!(
                    "masses and moments of inertia are positive, but `{}` is not",
                    one.name.value
                ),
                "leave out unknown values",
            ),
            _ => known.push((one.name.value.clone(), one.value)),
        }
    }
    known
}

/// Reads the switch `gains`, which requires a known value and drives of one joint each.
pub(crate) fn gains(item: &Item<'_, '_>, known: &[(String, f64)], robot: &Inventory<'_>) -> bool {
    if item.boolean() != Some(true) {
        return false;
    }
    if robot.legs.iter().any(Leg::has_coupled_motors) {
        let help = "leave out `gains`; a gain of a motor scales its `torque_gain` in [data]";
        item.context
            .report(item.error(Code::CONTRADICTION, COUPLED_MOTORS).help(help));
        return false;
    }
    let is_known = robot.springs.iter().any(|spring| spring.known.is_some());
    if is_known || robot.legs.iter().any(Leg::has_known_torques) {
        let help = "leave out `gains`, or the key `known` of joints and springs";
        item.context
            .report(item.error(Code::CONTRADICTION, KNOWN_TORQUES).help(help));
        return false;
    }
    if known.is_empty() {
        let error = item.error(
            Code::KNOWN,
            "gains are identified relative to known values, and there are none",
        );
        let help = "give the mass of a payload that was weighed: [identification.known] m_payload = \"5 kg\"";
        item.context.report(error.help(help));
    }
    true
}
