//! The direction of gravity, identified together with the parameters: where a base stands off the vertical.
//!
//! With W_x, W_y, W_z the columns that a field of 1 m/s² along an axis of the base's frame gives at rest, and
//! W_0 those of the robot as it is described, in gravity g_0,
//!
//! ```text
//! τ = (W_0 + Σ_k (g_k - g_0k) W_k) χ,    |g| = |g_0|.
//! ```
//!
//! Every column is a combination of the independent ones among W_0, W_x, W_y and W_z, so one pass over the
//! runs gives R factors of these, and all that follows works on the factors. For a given direction the
//! parameters follow linearly: a separable least-squares problem in two angles (G. Golub, V. Pereyra 1973), solved
//! by Gauss and Newton's steps of the projected residual (L. Kaufman 1975), with damping.
//!
//! - `columns`: the independent columns, and how those of all parameters are made of them;
//! - `observation`: the equations of all runs, as R factors;
//! - `frame`: a direction and how it turns;
//! - `solve`: the direction;
//! - `determined`: in which directions it can be turned so that the torques tell;
//! - `deviations`: how sure it is;
//! - `shares`: what its uncertainty does to parameters;
//! - `result`: what is told.

mod columns;
mod determined;
mod deviations;
mod frame;
mod observation;
mod result;
mod shares;
mod solve;

pub use result::GravityDirection;

use nalgebra::Vector3;
use overact::Code;
use overact::Model;

use crate::{
    data::Log,
    error::{Error, Problem},
    settings::Settings,
};
use columns::Extended;
use determined::free_turns;
use deviations::covariance;
use frame::Frame;
use observation::Observer;
use shares::Turned;
use solve::solve;

/// Smallest deviation of an angle at which runs are said not to determine it, rad.
const UNDETERMINED: f64 = 0.2;

/// A field of gravity in which a robot is described, and models of it in other ones.
#[derive(Clone, Copy)]
pub struct Fields<'a> {
    /// The acceleration of gravity that the model has, m/s², in the base's frame.
    pub described: [f64; 3],
    /// The robot in fields of 1 m/s² along x, y and z of the base's frame.
    pub along: [&'a dyn Model; 3],
}

/// Identifies the direction of gravity from runs of a robot whose description says how large it is and about
/// where it points. `progress` hears the name of a run, its samples that are done, and of how many.
///
/// # Errors
/// Settings or runs that can't be used; a direction that is not determined, and why.
pub fn gravity_direction(
    model: &dyn Model,
    fields: &Fields<'_>,
    runs: &[Log],
    settings: &Settings,
    progress: &dyn Fn(&str, usize, usize),
) -> Result<GravityDirection, Error> {
    settings.check(&model.info())?;
    let described = Vector3::from(fields.described);
    let Some(frame) = Frame::new(described) else {
        let message = "the direction of gravity is not determined: there is no gravity";
        let help = "give the acceleration of gravity in the description, about where it points";
        return Err(Problem::new(Code::GRAVITY_DIRECTION, message)
            .help(help)
            .into());
    };
    let extended = Extended::new(model, fields, runs, settings)?;
    let turns = free_turns(&extended, &frame, settings.seed);
    if turns.is_empty() {
        return Err(Problem::new(Code::GRAVITY_DIRECTION,
            "the direction of gravity is not determined: wherever it points, parameters of the robot explain the same torques",
        )
        .help("leave out `gravity_direction`; offsets and moments take in what a tilt does")
        .into());
    }
    let frame = frame.confined(&turns);
    let observer = Observer {
        model,
        fields,
        extended: &extended,
        settings,
    };
    let systems = observer.systems(runs, progress)?;
    let first = systems.first().map(Result::as_ref);
    let system = first.and_then(Result::ok);
    let system = system.ok_or_else(|| {
        Error::from(Problem::new(
            Code::GRAVITY_DIRECTION,
            "there are no equations",
        ))
    })?;
    let solution = solve(&extended, system, &frame, settings)?;
    let angles = covariance(system, &solution);
    let angles = angles.filter(|own| own.diagonal().iter().all(|square| square.is_finite()));
    let worst = angles.as_ref().map(|own| own.symmetric_eigenvalues().max());
    let sure = worst.is_some_and(|worst| worst.sqrt() < UNDETERMINED);
    let Some(angles) = angles.filter(|_| sure) else {
        let far = worst.map_or_else(String::new, |worst| {
            format!(
                ": its standard deviation is {:.0} deg",
                worst.sqrt().to_degrees().min(180.0)
            )
        });
        let message = format!("the direction of gravity is not determined by these runs{far}");
        let help = "record runs with larger motions of joints that bear weight";
        return Err(Problem::new(Code::GRAVITY_DIRECTION, message)
            .help(help)
            .into());
    };
    let turned = Turned::new(&extended, &systems, &solution);
    Ok(GravityDirection::new(
        described,
        &solution.frame,
        angles,
        turned,
    ))
}
