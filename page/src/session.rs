//! Session with a robot: virtual runs, user's logs, and identification.

use crate::{
    problems::{json, thrown},
    progress::tell,
};
use overact::Model;
use overact_identification::{Grade, Identification, Progress};
use overact_report::{About, Extent, Units, document, numbers, whole_page};
use overact_robot::{Identifier, Robot, Runs, drawing};
use overact_simulation::{Record, write_csv};
use serde::Serialize;
use wasm_bindgen::prelude::*;

/// A robot with its logs.
#[wasm_bindgen]
pub struct Session {
    pub(crate) robot: Robot,
    runs: Runs,
}

/// Run of the virtual experiment as CSV.
#[derive(Serialize)]
struct Log<'a> {
    name: &'a str,
    payload: bool,
    /// Whether it is a validation run of the description.
    held_out: bool,
    samples: usize,
    csv: String,
}

impl<'a> Log<'a> {
    fn new(record: &'a Record, held_out: &[String]) -> Self {
        let mut csv = Vec::new();
        // Writing to memory does not fail.
        let _ = write_csv(record, &mut csv);
        Self {
            name: &record.name,
            payload: record.payload,
            held_out: held_out.contains(&record.name),
            samples: record.time.len(),
            csv: String::from_utf8_lossy(&csv).into_owned(),
        }
    }
}

#[wasm_bindgen]
impl Session {
    /// Robot of a description; `name` is its name in errors.
    ///
    /// # Errors
    /// All errors of the description.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, text: &str) -> Result<Self, JsValue> {
        let robot = Robot::from_text(name, text).map_err(thrown)?;
        let runs = Runs::default();
        Ok(Self { robot, runs })
    }

    /// Virtual runs as logs.
    ///
    /// # Errors
    /// A description without an experiment, or an invalid one.
    pub fn simulate(&self) -> Result<String, JsValue> {
        let experiment = self.robot.experiment().map_err(thrown)?;
        let records = experiment.records(&tell).map_err(thrown)?;
        let held_out = self.robot.held_out();
        let logs = records.iter().map(|record| Log::new(record, &held_out));
        json(&logs.collect::<Vec<_>>())
    }

    /// Adds a log in any format, with or without payload, for training or validation.
    ///
    /// It is split at gaps of its time.
    ///
    /// # Errors
    /// A log that cannot be used.
    pub fn add_log(
        &mut self,
        name: &str,
        bytes: &[u8],
        payload: bool,
        held_out: bool,
    ) -> Result<(), JsValue> {
        let runs = self.robot.runs_of_bytes(name, bytes.into(), payload);
        let runs = runs.map_err(thrown)?;
        if held_out {
            self.runs.validation.extend(runs);
        } else {
            self.runs.identified.extend(runs);
        }
        Ok(())
    }

    /// Identifies the parameters from the added logs, or from the virtual experiment if there are
    /// none.
    ///
    /// # Errors
    /// Errors of the logs or the experiment, or data that determine no parameter.
    pub fn identify(&self) -> Result<Identified, JsValue> {
        let made;
        let runs = if self.runs.identified.is_empty() {
            let experiment = self.robot.experiment().map_err(thrown)?;
            let held_out = self.robot.held_out();
            made = experiment.runs(&held_out, &tell).map_err(thrown)?;
            &made
        } else {
            &self.runs
        };
        let identifier = Identifier::new(&self.robot).data(runs).progress(&doing);
        let result = identifier.run().map_err(thrown)?;
        Identified::new(&self.robot, &result)
    }
}

fn doing(progress: Progress<'_>) {
    let part = |done: usize, samples: usize| done as f64 / samples.max(1) as f64;
    match progress {
        Progress::Base => tell(0.0, "base parameters"),
        Progress::Run { run, done, samples } => tell(part(done, samples), run),
        Progress::Estimation { model } => tell(1.0, &format!("{model}: estimation")),
        Progress::Validation { run, done, samples } => {
            tell(part(done, samples), &format!("cross-validation on {run}"));
        }
        _ => {}
    }
}

/// Result of an identification in all output formats.
#[wasm_bindgen]
pub struct Identified {
    summary: String,
    page: String,
    document: String,
    numbers: String,
    trusted: bool,
}

impl Identified {
    fn new(robot: &Robot, result: &Identification) -> Result<Self, JsValue> {
        let description = robot.description();
        let about = About {
            units: &Units::new(&robot.model().info()),
            summary: &description.summary,
            source: &description.source,
            drawing: &drawing::svg(&robot.model().model().mechanism),
            published: None,
        };
        let document = document(result).map_err(thrown)?;
        Ok(Self {
            summary: overact_report::summary(result, None, Extent::Whole),
            page: whole_page(result, &about, "identification").map_err(thrown)?,
            document,
            numbers: numbers(result).map_err(thrown)?,
            trusted: result.grade() == Grade::Use,
        })
    }
}

#[wasm_bindgen]
impl Identified {
    /// Output of `overact identify --all`.
    #[must_use]
    pub fn summary(&self) -> String {
        self.summary.clone()
    }

    /// Report as an HTML page.
    #[must_use]
    pub fn page(&self) -> String {
        self.page.clone()
    }

    /// All numbers, as in `overact identify --json`.
    #[must_use]
    pub fn document(&self) -> String {
        self.document.clone()
    }

    /// All numbers as one flat table, CSV.
    #[must_use]
    pub fn numbers(&self) -> String {
        self.numbers.clone()
    }

    /// Whether the verdict is to use the result.
    #[must_use]
    pub fn trusted(&self) -> bool {
        self.trusted
    }
}
