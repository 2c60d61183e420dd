//! What is told of a torque that is clipped, however that was seen.

use super::suspicion::{Suspicion, Trouble};

/// What is told of a torque that is clipped for a part of the samples.
/// At most a part `usual` of a torque that is not clipped lies there.
pub(super) fn clipping(actuator: &str, part: f64, usual: f64, levels: &[String]) -> Suspicion {
    Suspicion {
        trouble: Trouble::Clipped,
        actuator: Some(actuator.to_owned()),
        statistic: 100.0 * part,
        unit: "%",
        threshold: 100.0 * usual,
        message: format!(
            "the torque is clipped at {} for {:.1} % of the time: the drive or its measurement saturates, and parameters come out too small; move less fast, or leave the run out",
            levels.join(" and "),
            100.0 * part
        ),
    }
}
