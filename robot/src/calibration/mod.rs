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
use overact_identification::{Calibration, CalibrationScope, DescribedGeometry, Log, calibrate};

/// Remark on robots whose lengths cannot be calibrated.
const OFFSETS_ONLY: &str = "lengths are calibrated for robots with a platform only: here only encoder offsets are estimated";

impl Robot {
    /// Estimates encoder offsets and lengths from the closure of the loops in runs. Where the loops tell
    /// nothing, nothing is estimated, and the remarks say why. Of a robot without a platform only the
    /// encoder offsets are estimated.
    ///
    /// # Errors
    /// No run, or runs that do not fit the robot, that can't be read or that leave its workspace.
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
