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
        let all = Function::ALL.into_iter();
        let served = all.filter(|one| self.robot.model().model().served(*one).is_some());
        let names: Vec<String> = served.map(function_of_model).collect();
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
