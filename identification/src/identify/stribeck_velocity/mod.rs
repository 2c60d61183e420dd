//! Identification of Stribeck velocities by their profile likelihood, together with the parameters.
//!
//! The torques are linear in all parameters but the velocity v of Stribeck friction,
//! f sign(q̇)/(1 + (q̇/v)²). For each of several velocities, the other parameters have their best
//! values, and the sum of squared weighted residuals is the profile S(v). All columns of these
//! velocities are observed in one pass over the runs, so that the profile follows from one R
//! factor. The estimate is the minimum of S. The 95 % interval contains the velocities with
//!
//! ```text
//! S(v) - min S <= q² s²,
//! ```
//!
//! in which s² is the variance of the residuals. q is half the width of the interval of f by its
//! standard deviation for white residuals, so that it counts correlated residuals as well.
//! (D. M. Bates, D. G. Watts, *Nonlinear Regression Analysis and Its Applications*, 1988, chapter 6.)
//! Velocities of other joints keep their estimates.
//!
//! Passes are repeated in narrower ranges around the minima, until the points resolve the
//! intervals. A velocity is not determined if its interval leaves the first range; then that of the
//! description is kept.

mod equations;
mod joint;
mod profiles;
mod result;

pub use result::{StribeckVelocities, StribeckVelocity, VelocityEstimate};

use overact::Model;
use overact_logs::{Dataset, Error};

use super::{estimates::estimate_projection, prepare::prepare, progress::Progress};
use crate::{
    regression::{
        factor::Factor, friction::stribeck_velocities as of_model, observer::Observer,
        projection::Projection,
    },
    settings::{Instruments, Settings},
};
use equations::systems;
use joint::{Joint, POINTS};
use profiles::{Candidates, Profiles};

/// Largest number of passes.
const MOST_PASSES: usize = 6;

/// Identifies the Stribeck velocities of a model from the training runs of a data set.
///
/// # Errors
/// As [`prepare`](super::prepare()).
pub fn stribeck_velocities(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<StribeckVelocities, Error> {
    let settings = Settings {
        instruments: Instruments::None,
        r_sigma: f64::INFINITY,
        ..settings.clone()
    };
    let of_model = of_model(model, settings.seed)?;
    let mut search = Search {
        model,
        dataset,
        settings,
        joints: Joint::all(model, &of_model),
    };
    for _ in 0..MOST_PASSES {
        if search.joints.iter().all(|joint| joint.is_finished) {
            break;
        }
        search.pass(progress)?;
    }
    Ok(search.result())
}

/// State of the search for all velocities.
struct Search<'a> {
    model: &'a dyn Model,
    dataset: &'a Dataset<'a>,
    settings: Settings,
    joints: Vec<Joint>,
}

impl Search<'_> {
    /// Evaluates the profiles of the unfinished velocities from one pass over the runs.
    fn pass(&mut self, progress: &dyn Fn(Progress<'_>)) -> Result<(), Error> {
        let velocity = |joint: &Joint| (joint.parameter.clone(), joint.centre.exp());
        self.settings.stribeck_velocities = self.joints.iter().map(velocity).collect();
        let (settings, runs) = (&self.settings, self.dataset.runs);
        let mut projections = Projection::usual(&self.model.info(), &settings.kept_actuators);
        projections.truncate(1);
        let prepared = prepare(self.model, runs, &projections, settings, progress)?;
        let estimate = estimate_projection(&prepared, 0, settings, None)?.base;
        let mut sought = Vec::new();
        for joint in self.joints.iter_mut().filter(|joint| !joint.is_finished) {
            let mut parameters = estimate.parameters.iter();
            match parameters.position(|one| one.name == joint.parameter) {
                Some(parameter) => sought.push((parameter, joint)),
                None => joint.give_up(),
            }
        }
        if sought.is_empty() {
            return Ok(());
        }
        let mut columns = prepared.columns.clone();
        let mut picked = prepared.base.columns.clone();
        let mut candidates = Vec::new();
        for (parameter, joint) in &sought {
            let column = prepared.base.columns[estimate.parameters[*parameter].column];
            candidates.push(Candidates {
                parameter: *parameter,
                first: picked.len(),
            });
            let points = (0..POINTS).map(|point| joint.point(point).exp());
            picked.extend(points.map(|velocity| columns.add_stribeck(column, velocity)));
        }
        let observer = Observer {
            model: self.model,
            columns: &columns,
            base: &picked,
            projections: &projections,
            settings,
        };
        let mut systems = systems(&observer, runs)?;
        let lines = systems.swap_remove(0)?.lines;
        let profiles = Profiles {
            factor: Factor::merged(&lines, &estimate.weights),
            estimate: &estimate,
            candidates,
        };
        let chosen = profiles.minimum();
        for (number, (parameter, joint)) in sought.into_iter().enumerate() {
            let of_point = |point: usize| {
                let mut points = chosen.clone();
                points[number] = point;
                profiles.squares(&points)
            };
            let profile: Vec<f64> = (0..POINTS).map(of_point).collect();
            let own = &estimate.parameters[parameter];
            let [low, high] = own.interval_95;
            let ratio = 0.5 * (high - low) / own.standard_deviation;
            let rise = ratio * ratio * profiles.variance(&chosen);
            joint.examine(&profile, rise, profiles.coefficient(&chosen, number));
        }
        Ok(())
    }

    fn result(self) -> StribeckVelocities {
        let found = |joint: &Joint| Some((joint.parameter.clone(), joint.found?.coefficient));
        let coefficients = self.joints.iter().filter_map(found).collect();
        let joint = |joint: Joint| StribeckVelocity {
            estimate: joint.found.map(|found| VelocityEstimate {
                value: found.at.exp(),
                interval_95: found.interval.map(f64::exp),
            }),
            parameter: joint.parameter,
            unit: joint.unit,
            described: joint.described,
        };
        StribeckVelocities {
            coefficients,
            joints: self.joints.into_iter().map(joint).collect(),
        }
    }
}
