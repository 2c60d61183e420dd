//! A description while it is written.

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

/// What is said of it at once.
#[derive(Serialize)]
struct Said<'a> {
    robot: &'a str,
    summary: &'a str,
    legs: usize,
    joints: usize,
    actuators: usize,
    dof: usize,
    /// What may not be meant.
    note: Option<&'a str>,
}

#[wasm_bindgen]
impl Description {
    /// Checks a description; errors call it `name`.
    ///
    /// # Errors
    /// Everything that is wrong with it.
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
            actuators: mechanism.actuated().len(),
            dof: mechanism.dof(),
            note: self.note.as_deref(),
        })
    }

    /// The drawing at home, turned around its vertical and over, rad: an SVG document.
    #[must_use]
    pub fn drawing(&self, around: f64, over: f64) -> String {
        drawing::turned(&self.mechanism, around, over)
    }
}
