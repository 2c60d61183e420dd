//! Factors of a run.

use super::record::Record;
use crate::{
    regression::{
        factor::Factor,
        projection::ModelKind,
        system::{PartitionCondition, RunPart, Stretch},
    },
    result::RunSummary,
};

/// A run as the R factors of its equations.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RunFactors {
    /// Name of the robot's description.
    pub robot: String,
    /// Serial number of the robot; empty if not given.
    pub serial: String,
    /// Start of the run, µs since 1970 (UTC); `None` if not given.
    pub time_us: Option<i64>,
    /// Hash of the description and of the settings that affect the equations.
    pub settings_hash: String,
    /// Hash of the numbers.
    pub content: String,
    /// Summary of the run.
    pub summary: RunSummary,
    /// Suspicions about its raw numbers.
    pub flags: Vec<String>,
    /// Names of the columns of the factors.
    pub columns: Vec<String>,
    /// Equations of each model.
    pub models: Vec<ModelFactors>,
}

/// Equations of a run in one model.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ModelFactors {
    /// Model.
    pub model: ModelKind,
    /// Names of the lines of Γ.
    pub lines: Vec<String>,
    /// Factors of the parts, or the reason why they are missing: a singular partition.
    pub parts: Result<Vec<RunPart>, String>,
    /// Successive equations, if they were requested.
    pub stretches: Vec<Stretch>,
    /// Condition of the kept actuators.
    pub partition: Option<PartitionCondition>,
}

impl RunFactors {
    /// Name of the run, with the serial number if known.
    #[must_use]
    pub fn title(&self) -> String {
        if self.serial.is_empty() {
            self.summary.name.clone()
        } else {
            format!("{} of {}", self.summary.name, self.serial)
        }
    }

    /// Factors of all models as records.
    #[must_use]
    pub fn records(&self) -> Vec<Record> {
        let models = self.models.iter();
        models.flat_map(|model| self.records_of(model)).collect()
    }

    /// Records of one model.
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
            settings_hash: number(&self.settings_hash),
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
