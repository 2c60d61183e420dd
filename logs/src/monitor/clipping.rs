//! Description of a clipped torque.

use super::suspicion::{DataFault, Suspicion};

/// The suspicion of a torque that is clipped for the fraction `part` of the samples.
///
/// Without clipping, the fraction is at most `usual`.
pub(super) fn clipping(actuator: &str, part: f64, usual: f64, levels: &[String]) -> Suspicion {
    Suspicion {
        fault: DataFault::Clipped,
        actuator: Some(actuator.to_owned()),
        statistic: 100.0 * part,
        unit: "%",
        threshold: 100.0 * usual,
        message: format!(
            "the torque is clipped at {} for {:.1} % of the time: the drive or its measurement saturates, and parameters are underestimated; move more slowly, or leave the run out",
            levels.join(" and "),
            100.0 * part
        ),
    }
}
