//! Calibration of a described robot: lengths of its legs and offsets of its encoders, estimated from runs
//! and written back into the description.
//!
//! - `length`: which lengths a mechanism has;
//! - `closure`: a mechanism with changed lengths, evaluated;
//! - `text`: the calibrated description.

mod closure;
mod length;
mod text;

pub(crate) use length::of_tree;

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

    /// The text of the description with the changes of a calibration that was made with this robot; as it is
    /// where there is none.
    ///
    /// # Errors
    /// Never for descriptions that a robot was made from.
    pub fn calibrated_text(&self, calibration: &Calibration) -> Result<String, Error> {
        if !calibration.is_change() {
            return Ok(self.source().text.clone());
        }
        let (lengths, _) = length::lengths(&self.model().model().mechanism);
        text::calibrated(self, calibration, &|parameter| lengths[parameter])
    }

    /// The robot with the changes of a calibration that was made with this one.
    ///
    /// # Errors
    /// Lengths with which the robot does not close any more.
    pub fn calibrated(&self, calibration: &Calibration) -> Result<Self, Error> {
        Self::from_text(self.file(), &self.calibrated_text(calibration)?)
    }
}
