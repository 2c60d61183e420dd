//! A description that is being edited.

use crate::problems::{json, thrown};
use overact_codegen::{Source, mechanism::Mechanism};
use overact_robot::{CheckedFile, check_text, drawing};
use serde::Serialize;
use wasm_bindgen::prelude::*;

/// A description without errors.
#[wasm_bindgen]
pub struct Description {
    mechanism: Mechanism,
    note: Option<String>,
}

/// Information shown while editing.
#[derive(Serialize)]
struct Said<'a> {
    robot: &'a str,
    summary: &'a str,
    legs: usize,
    joints: usize,
    actuators: usize,
    dof: usize,
    /// Contents that may be unintended.
    note: Option<&'a str>,
}

#[wasm_bindgen]
impl Description {
    /// Checks a description; `name` is its name in errors.
    ///
    /// # Errors
    /// All errors of the description.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, text: &str) -> Result<Self, JsValue> {
        let checked = check_text(Source::new(name, text)).map_err(thrown)?;
        let CheckedFile {
            mechanism, note, ..
        } = checked;
        Ok(Self { mechanism, note })
    }

    /// Name and size of the robot.
    ///
    /// # Errors
    /// Never.
    pub fn said(&self) -> Result<String, JsValue> {
        let mechanism = &self.mechanism;
        json(&Said {
            robot: &mechanism.name,
            summary: &mechanism.summary,
            legs: mechanism.legs.len(),
            joints: mechanism.joints().len(),
            actuators: mechanism.actuator_count(),
            dof: mechanism.dof(),
            note: self.note.as_deref(),
        })
    }

    /// Drawing at home as SVG, rotated about the vertical and towards the reader, rad.
    #[must_use]
    pub fn drawing(&self, around: f64, over: f64) -> String {
        drawing::turned(&self.mechanism, around, over)
    }
}
