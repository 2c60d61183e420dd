//! Global identification of drive gains together with the unknown parameters.
//!
//! A gain is the torque of a drive for each unit of its measured signal (M. Gautier, S. Briot,
//! *Global identification of joint drive gains and dynamic parameters of robots*, J. Dynamic
//! Systems, Measurement, and Control 136, 2014; for parallel robots in 2012).
//!
//! Column j of V is the contribution of drive j's signal to the projected torques. With the unknown
//! base parameters χ and the contribution w of known parameters, V g = W χ + w. If w is independent
//! of the columns of W, it fixes the scale of g and χ. A weighed payload does if some runs carry it
//! and some do not. The noise is in V, not in W and w, so least squares would underestimate the
//! gains.
//!
//! - `known`: columns of known parameters;
//! - `observation`: equations of all runs as R factors; platform projection for redundant robots;
//! - `selection`: columns that are independent on the data;
//! - `noise`: noise of the drives' signals, from the residuals;
//! - `solve`: generalised total least squares with exact columns W and w;
//! - `known_values`: whether several known values agree;
//! - `deviations`: standard deviations of the gains;
//! - `result`: the result.

mod deviations;
mod known;
pub(crate) mod known_values;
mod noise;
mod observation;
mod result;
mod selection;
mod solve;

pub use result::{DriveGain, Gains, JointParameter};

use overact::Code;
use overact::Model;

use crate::settings::Settings;
use deviations::deviations;
use known::Split;
use known_values::{RedundantValue, contradiction, redundant_values};
use observation::{Equations, Observer};
use overact_logs::{Error, Log, Problem, significant};
use selection::{Selection, undetermined};
use solve::{solve, total_least_squares};

/// Smallest ratio of a determined gain to its standard deviation.
const DETERMINED: f64 = 5.0;

/// Identifies the gains of all drives from runs of a robot with some known parameters.
///
/// The known ones are [`Settings::known`]. `progress` gets the name of a run, and its numbers of
/// finished and of all samples.
///
/// # Errors
/// Settings or runs that are unusable; undetermined gains, with the reason.
pub fn drive_gains(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
    progress: &dyn Fn(&str, usize, usize),
) -> Result<Gains, Error> {
    let info = model.info();
    settings.check(&info)?;
    let split = Split::new(model, runs, settings)?;
    let observer = Observer {
        model,
        split: &split,
        settings,
    };
    let equations = observer.equations(runs, progress)?;
    let count = equations.count();
    let unknowns = split.base.columns.len() + info.sizes.actuators;
    if count <= unknowns {
        let message = format!("{count} equations do not determine {unknowns} gains and parameters");
        let help = "record longer runs or decimate less";
        return Err(Problem::new(Code::GAINS, message).help(help).into());
    }
    let selection = Selection::new(&equations, info.actuators)?;
    let redundant = redundant_values(&equations, &selection, &split);
    let contradiction = contradiction(&redundant);
    determined(&equations, &selection, &split, info.actuators, redundant)
        .map_err(|error| contradiction.unwrap_or(error))
}

/// Gains and parameters of the selected columns.
///
/// # Errors
/// Gains that the data do not determine.
fn determined(
    equations: &Equations,
    selection: &Selection,
    split: &Split,
    actuators: &[&str],
    redundant: Vec<RedundantValue>,
) -> Result<Gains, Error> {
    let solution = solve(equations, selection)?;
    let all = || actuators.iter().map(|name| format!("`{name}`"));
    let sure = deviations(equations, selection, &solution);
    let sure = sure.ok_or_else(|| undetermined(&all().collect::<Vec<_>>(), ""))?;
    let (parameters, drives) = sure.all.split_at(selection.parameters());
    let each = solution.gains().iter().zip(drives).zip(all());
    let unsure: Vec<String> = each
        .filter(|((gain, deviation), _)| **gain < DETERMINED * **deviation)
        .map(|((gain, deviation), name)| {
            let [gain, deviation] = [gain, deviation].map(|value| significant(*value, 2));
            format!("{name} ({gain}, standard deviation {deviation})")
        })
        .collect();
    if !unsure.is_empty() {
        let why = format!(" to a {DETERMINED}th of themselves");
        return Err(undetermined(&unsure, &why));
    }
    let plain = total_least_squares(equations, selection, &solution);
    let drive = |(index, name): (usize, &&str)| DriveGain {
        actuator: (*name).to_owned(),
        factor: solution.gains()[index],
        deviation: drives[index],
        total_least_squares: plain.as_ref().map(|gains| gains[index]),
    };
    let parameter = |(place, deviation): (usize, &f64)| {
        let base = selection.columns[place];
        let column = split.columns.as_slice().get(split.base.columns[base]);
        JointParameter {
            name: split.base.names[base].clone(),
            unit: column.map_or_else(String::new, |column| column.unit.to_owned()),
            value: -solution.values[place],
            deviation: *deviation,
        }
    };
    Ok(Gains {
        drives: actuators.iter().enumerate().map(drive).collect(),
        parameters: parameters.iter().enumerate().map(parameter).collect(),
        equations: equations.count(),
        redundant,
        covariance: sure.gains,
    })
}
