//! Checks that closures hold all free bodies.

use super::network::{edges, edges_at, grouped};
use crate::{files::Files, model::Model};

/// Rejects free bodies that no closure connects to the ground; `None` after an error.
pub(crate) fn check(files: &Files, model: &Model) -> Option<()> {
    if !model.joints.iter().any(|joint| joint.is_virtual) {
        return Some(());
    }
    let of_body = grouped(model);
    let edges = edges(model, &of_body);
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let edges_at = edges_at(count, &edges);
    let mut is_held = vec![false; count];
    let mut open = vec![0];
    while let Some(group) = open.pop() {
        if std::mem::replace(&mut is_held[group], true) {
            continue;
        }
        let next = edges_at[group].iter().flat_map(|&edge| edges[edge].groups);
        open.extend(next);
    }
    let loose = model.bodies.iter().enumerate().find_map(|(at, body)| {
        let joint = &model.joints[body.joint?];
        (joint.is_virtual && !is_held[of_body[at]]).then_some(joint)
    });
    let Some(joint) = loose else {
        return Some(());
    };
    let message = format!("`{}` is a free joint, which is not supported", joint.name);
    let help = "a floating base has no motor to identify it with: `--fix-base` fixes it";
    files.report(&joint.place, message, help);
    None
}
