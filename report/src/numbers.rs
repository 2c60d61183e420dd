//! All numbers of an identification as one flat table, one number per row.
//!
//! Any program can read it without knowing its contents. Time series are not included; they are in
//! the document of [`Figures`](overact_identification::Figures).

use overact::Code;
use overact_identification::{Error, Estimate, Identification, LineError, Problem, Stage};

/// Column names.
const HEADER: [&str; 7] = [
    "table", "model", "stage", "run", "name", "quantity", "value",
];

/// Flat table as CSV.
///
/// `table` names the source of the number. `model`, `stage`, `run` and `name` identify it and may
/// be empty. Numbers have full precision.
///
/// # Errors
/// Errors of the writer; never for a table in memory.
pub fn numbers(identification: &Identification) -> Result<String, Error> {
    let mut rows = Rows::default();
    for run in &identification.runs {
        rows.run = &run.name;
        rows.add("run", "", "samples", run.samples as f64);
        rows.add("run", "", "sampling_frequency", run.sampling_frequency);
        rows.add("run", "", "payload", f64::from(u8::from(run.payload)));
        rows.add("run", "", "closure_residual", run.closure_residual);
        if !run.standstill_equations.is_empty() {
            let still: usize = run.standstill_equations.iter().sum();
            rows.add("run", "", "standstill_equations", still as f64);
        }
    }
    rows.run = "";
    for base in &identification.base_parameters {
        for term in &base.regrouping {
            rows.add("regrouping", &base.name, &term.parameter, term.coefficient);
        }
        if let Some(value) = base.true_value {
            rows.add("base_parameter", &base.name, "true_value", value);
        }
    }
    add_gravity(&mut rows, identification);
    add_gains(&mut rows, identification);
    for estimate in identification.by_least_squares() {
        (rows.model, rows.stage) = (estimate.model.name(), estimate.stage.name());
        add_estimate(&mut rows, estimate);
    }
    for comparison in &identification.errors_in_regressor {
        (rows.model, rows.stage) = (comparison.model.name(), Stage::Base.name());
        let table = "instruments";
        for own in &comparison.parameters {
            let name = own.name.as_str();
            rows.add(table, name, "value", own.instruments);
            rows.add_known(table, name, "total_least_squares", own.total_least_squares);
            rows.add(table, name, "probability", own.probability);
            rows.add(table, name, "strength", own.strength);
        }
    }
    for one in &identification.cross_validation {
        (rows.model, rows.stage, rows.run) = (one.model.name(), one.stage.name(), &one.run);
        let table = "cross_validation";
        rows.add(table, "", "residual_norm", one.residual_norm);
        rows.add(
            table,
            "",
            "relative_error_percent",
            one.relative_error_percent,
        );
        add_lines(&mut rows, "cross_validation_line", &one.lines);
        add_lines(
            &mut rows,
            "cross_validation_projected",
            &one.projected_torques,
        );
        for torque in &one.table {
            let table = "cross_validation_torque";
            let (name, value) = (&torque.actuator, torque.least_norm_percent);
            rows.add(table, name, "least_norm_percent", value);
            rows.add_known(table, name, "closure_percent", torque.closure_percent);
        }
    }
    (rows.model, rows.stage) = ("", "");
    for tracking in &identification.tracking {
        rows.run = &tracking.run;
        for (actuator, largest) in tracking.actuators.iter().zip(&tracking.largest) {
            rows.add("tracking", actuator, &tracking.controller, *largest);
        }
    }
    rows.csv()
}

/// Gravity direction.
fn add_gravity<'a>(rows: &mut Rows<'a>, identification: &'a Identification) {
    if let Some(own) = &identification.gravity {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            rows.add("gravity", name, "described", own.described[axis]);
            rows.add("gravity", name, "estimated", own.estimated[axis]);
            rows.add("gravity", name, "deviation", own.deviations[axis]);
        }
        rows.add("gravity", "", "tilt", own.tilt);
        rows.add("gravity", "", "tilt_deviation", own.tilt_deviation);
    }
}

/// Drive gains, parameters that were estimated together with them, friction of gears, and Stribeck
/// velocities.
fn add_gains<'a>(rows: &mut Rows<'a>, identification: &'a Identification) {
    for gain in &identification.gains {
        let name = gain.actuator.as_str();
        rows.add("gain", name, "factor", gain.factor);
        rows.add("gain", name, "deviation", gain.deviation);
    }
    for drive in &identification.gear_friction {
        if let Some(own) = drive.coefficient {
            let name = drive.actuator.as_str();
            rows.add("gear_friction", name, "coefficient", own.value);
            rows.add("gear_friction", name, "deviation", own.deviation);
        }
    }
    for joint in &identification.stribeck_velocities {
        if let Some(own) = joint.estimate {
            let name = joint.parameter.as_str();
            rows.add("stribeck_velocity", name, "value", own.value);
            rows.add("stribeck_velocity", name, "low_95", own.interval_95[0]);
            rows.add("stribeck_velocity", name, "high_95", own.interval_95[1]);
        }
    }
    for one in &identification.gain_parameters {
        rows.add("gain_parameter", &one.name, "value", one.value);
        rows.add("gain_parameter", &one.name, "deviation", one.deviation);
    }
}

/// Numbers of one estimate.
fn add_estimate<'a>(rows: &mut Rows<'a>, estimate: &'a Estimate) {
    let table = "estimate";
    rows.add(
        table,
        "",
        "relative_error_percent",
        estimate.relative_error_percent,
    );
    rows.add(table, "", "residual_norm", estimate.residual_norm);
    rows.add(table, "", "residual_deviation", estimate.residual_deviation);
    rows.add(table, "", "condition_number", estimate.condition_number);
    rows.add(table, "", "equations", estimate.equations as f64);
    if let Some(partition) = &estimate.partition {
        rows.add(table, "", "partition_condition", partition.largest);
    }
    for parameter in &estimate.parameters {
        let (table, name) = ("parameter", parameter.name.as_str());
        let relative = parameter.relative_standard_deviation_percent;
        let correlated = parameter.correlated_standard_deviation;
        rows.add(table, name, "value", parameter.value);
        rows.add(
            table,
            name,
            "standard_deviation",
            parameter.standard_deviation,
        );
        rows.add(table, name, "relative_standard_deviation_percent", relative);
        rows.add(table, name, "correlated_standard_deviation", correlated);
        let [low, high] = parameter.interval_95;
        rows.add(table, name, "interval_95_low", low);
        rows.add(table, name, "interval_95_high", high);
        rows.add_known(table, name, "true_value", parameter.true_value);
        rows.add_known(table, name, "error_percent", parameter.error_percent);
    }
    add_lines(rows, "line", &estimate.lines);
    add_removals(rows, estimate);
}

/// Numbers of the elimination.
fn add_removals<'a>(rows: &mut Rows<'a>, estimate: &'a Estimate) {
    for removal in &estimate.removals {
        let (table, name) = ("removal", removal.name.as_str());
        let deviation = removal.relative_standard_deviation_percent;
        rows.add(table, name, "value", removal.value);
        rows.add(
            table,
            name,
            "relative_standard_deviation_percent",
            deviation,
        );
        rows.add(table, name, "deviation_ratio", removal.deviation_ratio);
        rows.add(table, name, "f_statistic", removal.f_statistic);
        rows.add(
            table,
            name,
            "accepted",
            f64::from(u8::from(removal.accepted)),
        );
        let (before, after) = (
            removal.relative_error_before_percent,
            removal.relative_error_after_percent,
        );
        rows.add(table, name, "relative_error_before_percent", before);
        rows.add(table, name, "relative_error_after_percent", after);
        let (before, after) = (
            removal.held_out_before_percent,
            removal.held_out_after_percent,
        );
        rows.add_known(table, name, "held_out_before_percent", before);
        rows.add_known(table, name, "held_out_after_percent", after);
    }
}

/// Errors of the rows or torques.
fn add_lines<'a>(rows: &mut Rows<'a>, table: &'static str, lines: &'a [LineError]) {
    for line in lines {
        let error = line.relative_error_percent;
        rows.add(table, &line.name, "relative_error_percent", error);
        rows.add(table, &line.name, "residual_norm", line.residual_norm);
        rows.add(table, &line.name, "measured_norm", line.measured_norm);
        rows.add(table, &line.name, "rms", line.rms);
        let fit = line.nrmse_fit_percent;
        rows.add_known(table, &line.name, "nrmse_fit_percent", fit);
    }
}

/// Rows so far, and the identification of the next ones.
#[derive(Default)]
struct Rows<'a> {
    model: &'a str,
    stage: &'a str,
    run: &'a str,
    rows: Vec<[String; 7]>,
}

impl Rows<'_> {
    fn add(&mut self, table: &str, name: &str, quantity: &str, value: f64) {
        let row = [table, self.model, self.stage, self.run, name, quantity];
        let [a, b, c, d, e, f] = row.map(str::to_owned);
        self.rows.push([a, b, c, d, e, f, value.to_string()]);
    }

    fn add_known(&mut self, table: &str, name: &str, quantity: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.add(table, name, quantity, value);
        }
    }

    fn csv(&self) -> Result<String, Error> {
        let failed = |error: &dyn std::fmt::Display| {
            Error::from(Problem::new(
                Code::NO_RESULT_TEXT,
                format!("the table can't be written: {error}"),
            ))
        };
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer
            .write_record(HEADER)
            .map_err(|error| failed(&error))?;
        for row in &self.rows {
            writer.write_record(row).map_err(|error| failed(&error))?;
        }
        let bytes = writer.into_inner().map_err(|error| failed(&error))?;
        String::from_utf8(bytes).map_err(|error| failed(&error))
    }
}
