//! The functions of a robot at samples: what tests compare with other languages.

use crate::problems::thrown;
use overact_codegen::{Effort, Request, Source};
use overact_robot::{CompiledFile, InterpretedRobot, values};
use wasm_bindgen::prelude::*;

/// A robot with all of its functions, interpreted.
#[wasm_bindgen]
pub struct Values {
    robot: InterpretedRobot,
}

#[wasm_bindgen]
impl Values {
    /// The robot of a description.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, text: &str) -> Result<Self, JsValue> {
        let request = Request::with_effort(Effort::None);
        let compiled = CompiledFile::new(Source::new(name, text), &request).map_err(thrown)?;
        let robot = InterpretedRobot::new(compiled.model);
        Ok(Self { robot })
    }

    /// A function at samples: `inputs` are its inputs in their order, each sample after sample; parameters stand
    /// once.
    ///
    /// # Errors
    /// A function that the robot does not have, another number of inputs, or a sample without a value.
    pub fn of(&self, function: &str, samples: usize, inputs: &[f64]) -> Result<Vec<f64>, JsValue> {
        values(&self.robot, function, samples, inputs).map_err(thrown)
    }
}
