//! The base parameters are those of the model's functions, if the model says which these are.

mod common;

use common::EMPS;
use overact::{Error, Function, Info, Model, SampleError};
use overact_identification::{ColumnSet, PayloadUse, base_parameters};

/// EMPS with functions that keep these columns.
struct Keeping(&'static [&'static str]);

impl Model for Keeping {
    fn info(&self) -> Info<'_> {
        EMPS.info()
    }

    fn base_columns(&self) -> &[&'static str] {
        self.0
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        EMPS.evaluate(function, inputs, output)
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        EMPS.pose_from_actuators(actuators, pose)
    }
}

/// Names of the base parameters, with friction by direction on request.
fn names(model: &dyn Model, asymmetric: bool) -> Vec<String> {
    let columns = ColumnSet::new(model, false, asymmetric, 1).expect("columns");
    let base = base_parameters(model, &columns, PayloadUse::Absent, 1);
    base.expect("base parameters").names
}

#[test]
fn columns_preferred_by_the_functions_are_kept_first() {
    assert_eq!(names(&EMPS, false), ["m_1R", "fv_1", "fs_1", "off_1"]);
    let kept = Keeping(&["off_1", "ia_1", "fs_1", "fv_1"]);
    // The order stays that of the symbols.
    assert_eq!(names(&kept, false), ["ia_1R", "fv_1", "fs_1", "off_1"]);
}

#[test]
fn an_unsuitable_column_preference_is_completed() {
    // Dependent, unknown and missing columns.
    let kept = Keeping(&["m_1", "ia_1", "zz_7"]);
    assert_eq!(names(&kept, false), ["m_1R", "fv_1", "fs_1", "off_1"]);
    let kept = Keeping(&["ia_1", "fv_1", "fs_1", "off_1"]);
    assert_eq!(names(&kept, true)[0], "ia_1R");
}
