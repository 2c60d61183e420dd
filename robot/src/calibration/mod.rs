//! Calibration of a robot: leg lengths and encoder offsets, estimated from runs.
//!
//! The result can be written back into the description.
//!
//! - `length`: lengths of a mechanism;
//! - `closure`: evaluation of a mechanism with changed lengths;
//! - `text`: calibrated description.

mod closure;
pub(crate) mod gravity;
mod length;
mod text;
pub(crate) mod variants;

pub(crate) use length::of_tree;

use crate::{error::Error, robot::Robot};
use closure::MechanismGeometry;
use overact_identification::{Calibration, CalibrationScope, DescribedGeometry, Log, calibrate};

/// Remark for robots whose lengths cannot be calibrated.
const OFFSETS_ONLY: &str = "calibration of lengths requires a platform with legs of joints: here only encoder offsets are estimated";

impl Robot {
    /// Estimates encoder offsets and lengths from the loop closures in runs.
    ///
    /// If the loops determine nothing, nothing is estimated, and the remarks give the reason. For a
    /// robot without a platform, only encoder offsets are estimated.
    ///
    /// # Errors
    /// No run, or runs that do not fit the robot, cannot be read or leave its workspace.
    pub fn calibrate(&self, runs: &[Log], scope: CalibrationScope) -> Result<Calibration, Error> {
        let model = self.model();
        if let Some(geometry) = MechanismGeometry::new(model) {
            return Ok(calibrate(model, &geometry, runs, scope)?);
        }
        let geometry = DescribedGeometry::new(model);
        let mut calibration = calibrate(model, &geometry, runs, scope)?;
        if calibration.sensors > calibration.coordinates {
            calibration.remarks.push(OFFSETS_ONLY.to_owned());
        }
        Ok(calibration)
    }

    /// Text of the description with the changes of a calibration of this robot.
    ///
    /// Without changes, the text is returned as it is.
    ///
    /// # Errors
    /// Never for descriptions that a robot was created from.
    pub fn calibrated_text(&self, calibration: &Calibration) -> Result<String, Error> {
        if !calibration.is_change() {
            return Ok(self.source().text.clone());
        }
        let (lengths, _) = length::lengths(&self.model().model().mechanism);
        text::calibrated(self, calibration, &|parameter| lengths[parameter])
    }

    /// Robot with the changes of a calibration of this robot.
    ///
    /// # Errors
    /// Lengths with which the robot's loops no longer close.
    pub fn calibrated(&self, calibration: &Calibration) -> Result<Self, Error> {
        Self::from_text(self.file(), &self.calibrated_text(calibration)?)
    }
}
