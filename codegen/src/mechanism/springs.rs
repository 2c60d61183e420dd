//! Lengths of springs between points, which must not vanish at home.

use super::numeric::platform_frame;
use super::{Mechanism, PointSpring, SpringBody, SpringEnd};
use nalgebra::Point3;
use overact_description::Description;
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics};

/// Length relative to the robot's below which it counts as zero.
const NOTHING: f64 = 1e-6;

impl Mechanism {
    /// Length of a spring in a configuration, m.
    #[must_use]
    pub fn spring_length(&self, spring: &PointSpring, pose: &[f64], joints: &[f64]) -> f64 {
        let [from, to] = &spring.ends;
        let at = |end| self.spring_end(end, pose, joints);
        nalgebra::distance(&at(from), &at(to))
    }

    /// A spring's end in the base frame.
    fn spring_end(&self, end: &SpringEnd, pose: &[f64], joints: &[f64]) -> Point3<f64> {
        let at = Point3::from(end.at.map(crate::cas::Number::value));
        match (end.body, &self.platform) {
            (SpringBody::Joint(body), _) => self.body_frame(body, pose, joints) * at,
            (SpringBody::Platform, Some(platform)) => platform_frame(platform.motion, pose) * at,
            (SpringBody::Ground, _) | (SpringBody::Platform, None) => at,
        }
    }
}

/// Reports springs whose force has no direction or no value at home.
pub(super) fn check_springs(
    description: &Description,
    mechanism: &Mechanism,
    errors: &mut Diagnostics,
) {
    if mechanism.springs.is_empty() {
        return;
    }
    let scale = mechanism.length_scale();
    let (pose, joints) = (&mechanism.home.pose, &mechanism.home.joints);
    for (given, spring) in description.springs.iter().zip(&mechanism.springs) {
        let length = mechanism.spring_length(spring, pose, joints);
        let force = spring.force.as_ref().map(|force| &force.formula);
        let mut formulas = force.into_iter().chain(&spring.known);
        let has_value = formulas.all(|formula| formula.value(length).is_finite());
        let name = &spring.name;
        let (message, help) = if length <= NOTHING * scale {
            (
                format!("the points of the spring `{name}` coincide at the home configuration"),
                "its force has no direction there: correct `at` of `from` or `to`, or choose another home configuration",
            )
        } else if !has_value {
            (
                format!(
                    "the force of the spring `{name}` has no value at its length of home, {} m",
                    significant(length)
                ),
                "a root of a negative number or a division by zero: correct `force` or `known`, or `at` of its points",
            )
        } else {
            continue;
        };
        let error = Diagnostic::new(Code::SPRING, message, given.name.span.clone());
        errors.push(error.help(help));
    }
}

/// A number with four digits.
fn significant(value: f64) -> String {
    let text = format!("{value:.3e}");
    text.parse::<f64>()
        .map_or(text, |rounded| rounded.to_string())
}
