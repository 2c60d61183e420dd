//! Errors of dependent joints of a skeleton.

use super::motions::listed;
use crate::mechanism::Mechanism;
use crate::mechanism::dependent::Rated;
use overact_description::Description;
use overact_description::diagnostic::{Code, Diagnostic};

/// Ratio of rates above which it is rounding.
const LARGEST: f64 = 1e9;

/// Dependent joints that are of the wrong number, or that the chains do not determine.
pub(in crate::mechanism) fn dependent(
    description: &Description,
    mechanism: &Mechanism,
    found: &Rated,
) -> Diagnostic {
    let joints = description.legs.iter().flat_map(|leg| &leg.joints);
    let span = joints.filter_map(|joint| joint.dependent.clone()).next();
    let span = span.unwrap_or_else(|| description.name.span.clone());
    let all = mechanism.joints();
    let of_pose = mechanism.coordinate_joints();
    let (count, dof) = (of_pose.len(), mechanism.dof());
    let others = (0..count).filter(|place| !found.best.contains(place));
    let names: Vec<String> = others
        .map(|place| format!("`{}`", mechanism.joint_name(all[of_pose[place]])))
        .collect();
    let advice = if names.is_empty() {
        "leave `dependent` out: the chains leave all joints of the skeleton independent".to_owned()
    } else {
        format!("write `dependent = true` at {}", listed(&names))
    };
    if found.motions != dof {
        let dependent = count - dof;
        let joints = if dependent == 1 {
            "joint is"
        } else {
            "joints are"
        };
        let determined = count.saturating_sub(found.motions);
        let message = format!(
            "{dependent} {joints} dependent, but the chains determine {determined} of the {count} joints"
        );
        return Diagnostic::new(Code::NOT_HELD, message, span)
            .label(format!(
                "the chains block {determined} directions at home: those in which a chain with too few joints holds its end"
            ))
            .help(advice);
    }
    let message = "the chains do not determine the dependent joints at home";
    Diagnostic::new(Code::NOT_HELD, message, span)
        .label(if found.gain < LARGEST {
            format!("joints move {:.1e} times as fast as the others", found.gain)
        } else {
            "the others do not determine them".to_owned()
        })
        .help(format!(
            "{advice}: joints then move at most {:.1} times as fast as the others",
            found.least
        ))
}
