//! What is told of a torque that is clipped, however that was seen.

use crate::finding::{Finding, FindingKind};

/// The finding of a torque that is clipped for a part of the samples.
pub(super) fn clipping(run: &str, actuator: &str, part: f64, levels: &[String]) -> Finding {
    Finding {
        kind: FindingKind::ClippedTorque,
        run: Some(run.to_owned()),
        actuator: Some(actuator.to_owned()),
        message: format!(
            "the torque is clipped at {} for {:.1} % of the time: the drive or its measurement saturates, and parameters come out too small; move less fast, or leave the run out",
            levels.join(" and "),
            100.0 * part
        ),
    }
}
