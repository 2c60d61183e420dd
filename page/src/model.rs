//! A compiled description: composition, cost and code of its model.

use crate::{
    problems::{json, thrown},
    progress::tell,
};
use overact_codegen::{Effort, Request, Source, backends::c, backends::rust, diagnostic::Code};
use overact_robot::{CompiledFile, Inspection, Problem};
use wasm_bindgen::prelude::*;

/// A compiled robot.
#[wasm_bindgen]
pub struct Model {
    inspection: String,
    rust: String,
    c: c::Files,
}

#[wasm_bindgen]
impl Model {
    /// Compiles a description with all its functions; `effort` is `none`, `quick` or `thorough`.
    ///
    /// # Errors
    /// All errors of the description.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, text: &str, effort: &str) -> Result<Self, JsValue> {
        let unknown = || Problem::new(Code::USAGE, format!("there is no effort `{effort}`"));
        let effort = Effort::named(effort).ok_or_else(|| thrown(unknown()))?;
        let request = Request {
            progress: &|step| {
                let part = step.done as f64 / step.functions.max(1) as f64;
                tell(part, step.work);
            },
            ..Request::with_effort(effort)
        };
        let robot = CompiledFile::new(Source::new(name, text), &request).map_err(thrown)?;
        let rust = rust::file(&robot.model, name);
        let c = c::files(&robot.model, &format!("{name} --lang c"));
        let inspection = json(&Inspection::new(robot))?;
        Ok(Self {
            inspection,
            rust,
            c,
        })
    }

    /// Output of `overact inspect --json`.
    #[must_use]
    pub fn inspection(&self) -> String {
        self.inspection.clone()
    }

    /// Rust module.
    #[must_use]
    pub fn rust(&self) -> String {
        self.rust.clone()
    }

    /// Name of the C files, without `.h` and `.c`.
    #[must_use]
    pub fn c_name(&self) -> String {
        self.c.stem.clone()
    }

    /// C header.
    #[must_use]
    pub fn c_header(&self) -> String {
        self.c.header.clone()
    }

    /// C source.
    #[must_use]
    pub fn c_source(&self) -> String {
        self.c.source.clone()
    }
}
