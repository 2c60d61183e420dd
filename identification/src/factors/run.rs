//! What is kept of a run.

use crate::{
    regression::{
        projection::ModelKind,
        system::{Part, PartitionCondition, Stretch},
    },
    result::RunSummary,
};

/// A run as the R factors of its equations.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RunFactors {
    /// Name of the robot's description.
    pub robot: String,
    /// Serial number of the robot; empty where none was given.
    pub serial: String,
    /// When the run began, µs since 1970 (UTC); none where that was not given.
    pub time_us: Option<i64>,
    /// Hash of the description and of the settings that make the equations.
    pub like: String,
    /// Hash of the numbers.
    pub content: String,
    /// What is told of the run.
    pub summary: RunSummary,
    /// What its raw numbers are suspected of.
    pub flags: Vec<String>,
    /// Names of the columns of the factors.
    pub columns: Vec<String>,
    /// For each model its equations.
    pub models: Vec<ModelFactors>,
}

/// The equations of a run in one model.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ModelFactors {
    /// The model.
    pub model: ModelKind,
    /// Names of the lines of Γ.
    pub lines: Vec<String>,
    /// The factors of the parts, or why there are none: kept actuators that are singular at a sample.
    pub parts: Result<Vec<Part>, String>,
    /// Successive equations, where they were asked for.
    pub stretches: Vec<Stretch>,
    /// How well the kept actuators determine the platform.
    pub partition: Option<PartitionCondition>,
}

impl RunFactors {
    /// The run by its serial number, where it has one, and its name.
    #[must_use]
    pub fn title(&self) -> String {
        match self.serial.is_empty() {
            true => self.summary.name.clone(),
            false => format!("{} of {}", self.summary.name, self.serial),
        }
    }
}
