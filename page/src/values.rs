//! Functions of a robot at samples.

use crate::{Session, problems::thrown};
use overact::Function;
use overact_robot::{function_of_model, values};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
impl Session {
    /// Names of the available functions, one per line.
    #[must_use]
    pub fn functions(&self) -> String {
        let model = self.robot.model().model();
        let served = { model.all_functions() }.filter(|one| model.served(*one).is_some());
        let name = |function| match function {
            Function::Frame(_) => model.function_name(function),
            _ => function_of_model(function),
        };
        let names: Vec<String> = served.map(name).collect();
        names.join("\n")
    }

    /// Evaluates a function at samples.
    ///
    /// `inputs` contains its inputs in order, each sample by sample; parameters occur once.
    ///
    /// # Errors
    /// An unknown function, a wrong number of inputs, or a sample without a value.
    pub fn values(
        &self,
        function: &str,
        samples: usize,
        inputs: &[f64],
    ) -> Result<Vec<f64>, JsValue> {
        values(self.robot.model(), function, samples, inputs).map_err(thrown)
    }
}
