//! Checks that motors determine the motion of a robot with loops, and names joints that move freely.

use super::{
    motion::{Motion, null_space},
    network::Network,
};
use crate::files::Files;
use crate::listing::listed;
use nalgebra::DMatrix;

/// Rates below this fraction of the largest are rounding errors.
const STILL: f64 = 1e-6;

/// Checks that there are as many motors as degrees of freedom; `None` after an error.
///
/// The error is located at the first joint that moves while all motors stand still.
pub(crate) fn check(files: &Files, network: &Network<'_>) -> Option<()> {
    let model = network.model;
    if model.closures.is_empty() {
        return Some(());
    }
    let motors = model.drives().len();
    if motors >= network.mobility {
        return Some(());
    }
    let moving = moving(network);
    let names = listed(
        moving
            .iter()
            .map(|&joint| model.joints[joint].name.as_str()),
    );
    let mobility = network.mobility;
    let degrees = if mobility == 1 { "degree" } else { "degrees" };
    let units = if motors == 1 { "motor" } else { "motors" };
    let mut message =
        format!("the robot has {mobility} {degrees} of freedom, and {motors} {units}");
    if !names.is_empty() {
        message += &format!(": with the motors at rest, {names} can still move");
    }
    let help =
        "name all driven joints, `--actuated JOINT,JOINT`, or fix in the file what does not move";
    match moving.first() {
        Some(&joint) => files.report(&model.joints[joint].place, message, help),
        None => files.refuse(message, help),
    }
    None
}

/// Joints that move while all motors are at rest, in the last sampled configuration.
fn moving(network: &Network<'_>) -> Vec<usize> {
    let model = network.model;
    let motion = Motion::new(model);
    let Some(state) = network.states.last() else {
        return Vec::new();
    };
    let free = network.motions(&motion, state);
    let drives = model.drives();
    let rate = |joint: usize, motion_at: usize| {
        let mut coordinates = motion.coordinates.iter();
        let at = coordinates.position(|own| own.joint == joint);
        at.map_or(0.0, |at| free[(at, motion_at)])
    };
    let driven = DMatrix::from_fn(drives.len(), free.ncols(), |i, j| {
        let terms = drives[i].iter();
        terms.map(|(joint, factor)| factor * rate(*joint, j)).sum()
    });
    let undriven = &free * null_space(&driven);
    let largest = undriven.amax();
    let mut moving: Vec<usize> = motion
        .coordinates
        .iter()
        .enumerate()
        .filter(|(at, _)| undriven.row(*at).amax() > STILL * largest)
        .map(|(_, own)| own.joint)
        .filter(|&joint| !model.joints[joint].is_virtual)
        .collect();
    moving.dedup();
    moving
}
