//! Errors as JSON documents that are thrown to the script.

use overact_codegen::diagnostic::Code;
use overact_robot::{Error, Problem};
use serde::Serialize;
use wasm_bindgen::JsValue;

/// JSON of a document.
///
/// # Errors
/// Never for the documents of the page: their keys are strings.
pub(crate) fn json(document: &impl Serialize) -> Result<String, JsValue> {
    serde_json::to_string(document).map_err(|error| {
        let problem = Problem::new(Code::NO_RESULT_TEXT, error.to_string());
        JsValue::from_str(&problem.to_string())
    })
}

/// List of problems with code, message, file, line, column and advice.
pub(crate) fn thrown(error: impl Into<Error>) -> JsValue {
    match json(&error.into().problems()) {
        Ok(text) => JsValue::from_str(&text),
        Err(text) => text,
    }
}
