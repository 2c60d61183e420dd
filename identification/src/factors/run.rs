//! What is kept of a run.

use super::record::Record;
use crate::{
    regression::{
        factor::Factor,
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

    /// The factors of all models as records.
    #[must_use]
    pub fn records(&self) -> Vec<Record> {
        let models = self.models.iter();
        models.flat_map(|model| self.records_of(model)).collect()
    }

    /// Those of one of its models.
    pub(super) fn records_of(&self, model: &ModelFactors) -> Vec<Record> {
        let number = |text: &str| u128::from_str_radix(text, 16).unwrap_or(0);
        let summary = &self.summary;
        let load = summary.payload_name.clone().unwrap_or_default();
        let load = summary.payload.then_some(load);
        let parts = model.parts.as_deref().unwrap_or_default();
        let lines = parts.iter().enumerate().flat_map(|(part, own)| {
            let lines = own.lines.iter().enumerate();
            lines.map(move |(line, factor)| (part, line, factor))
        });
        let record = |(part, line, factor): (usize, usize, &Factor)| Record {
            like: number(&self.like),
            content: number(&self.content),
            model: model.model,
            load: load.clone(),
            part: part as u16,
            line: line as u16,
            line_name: model.lines.get(line).cloned().unwrap_or_default(),
            columns: self.columns.join(","),
            factor: factor.clone(),
        };
        lines.map(record).collect()
    }
}
