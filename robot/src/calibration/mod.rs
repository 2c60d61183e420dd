//! Calibration of a described robot: lengths of its legs and offsets of its encoders, estimated from runs
//! and written back into the description.
//!
//! - `length`: which lengths a mechanism has;
//! - `closure`: a mechanism with changed lengths, evaluated.

mod closure;
mod length;

use crate::{error::Error, robot::Robot};
use closure::MechanismGeometry;
use overact_identification::{Calibration, CalibrationScope, Log, calibrate};

impl Robot {
    /// Estimates encoder offsets and lengths from the closure of the loops in runs. Where the loops tell
    /// nothing, nothing is estimated, and the remarks say why.
    ///
    /// # Errors
    /// No run, or runs that do not fit the robot, that can't be read or that leave its workspace.
    pub fn calibrate(&self, runs: &[Log], scope: CalibrationScope) -> Result<Calibration, Error> {
        let geometry = MechanismGeometry::new(self.model());
        Ok(calibrate(self.model(), &geometry, runs, scope)?)
    }
}
