//! Robots written by hand, planar and spatial, redundant and not.

mod dualv;
mod planar;
mod serial;
mod spatial;
mod translation;

use super::mechanism::Mechanism;

pub use dualv::{DUALV_GAMMA_DEG, DUALV_LINK, DUALV_PLATFORM_RADIUS, DUALV_SHOULDER, dualv};
pub use planar::{five_bar, three_rr_point, two_slides};
pub use serial::{branched_arm, serial_3r};
pub use spatial::{hexapod, hinged_2ups, octopod, schoenflies_5ups, spherical_4ups};
pub use translation::{delta, tilted_tripteron};

/// Every robot here with its name.
#[must_use]
pub fn all() -> Vec<(&'static str, Mechanism)> {
    vec![
        ("dualv", dualv()),
        ("five_bar", five_bar()),
        ("three_rr_point", three_rr_point()),
        ("two_slides", two_slides()),
        ("serial_3r", serial_3r()),
        ("branched_arm", branched_arm()),
        ("delta", delta()),
        ("tilted_tripteron", tilted_tripteron()),
        ("hexapod", hexapod()),
        ("octopod", octopod()),
        ("spherical_4ups", spherical_4ups()),
        ("hinged_2ups", hinged_2ups()),
        ("schoenflies_5ups", schoenflies_5ups()),
    ]
}
