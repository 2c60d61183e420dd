//! Identification of the direction of gravity together with the parameters, for a tilted base.
//!
//! W_x, W_y, W_z are the columns at rest in a field of 1 m/s² along an axis of the base frame. W_0
//! are those of the described robot in gravity g_0. Then
//!
//! ```text
//! τ = (W_0 + Σ_k (g_k - g_0k) W_k) χ,    |g| = |g_0|.
//! ```
//!
//! Every column is a combination of the independent ones among W_0, W_x, W_y and W_z. One pass over
//! the runs gives their R factors, and all further steps use the factors. For a given direction,
//! the parameters follow linearly. This is a separable least-squares problem in two angles (G.
//! Golub, V. Pereyra 1973). Damped Gauss-Newton steps of the projected residual solve it (L.
//! Kaufman 1975).
//!
//! - `columns`: independent columns, and combinations for all parameters;
//! - `observation`: equations of all runs as R factors;
//! - `frame`: a direction and its rotations;
//! - `solve`: estimation of the direction;
//! - `determined`: rotations that the torques determine;
//! - `deviations`: covariance of the angles;
//! - `uncertainty_propagation`: effect of their uncertainty on parameters;
//! - `result`: the result.

mod columns;
mod determined;
mod deviations;
mod direction;
mod observation;
mod result;
mod solve;
mod uncertainty_propagation;

pub use result::GravityDirection;

use nalgebra::Vector3;
use overact::Code;
use overact::Model;

use crate::settings::Settings;
use columns::Extended;
use determined::free_turns;
use deviations::covariance;
use direction::GravityFrame;
use observation::Observer;
use overact_logs::{Error, Log, Problem};
use solve::solve;
use uncertainty_propagation::Turned;

/// Standard deviation of an angle from which on it is undetermined, rad.
const UNDETERMINED: f64 = 0.2;

/// Described gravity, and models in other fields.
#[derive(Clone, Copy)]
pub struct Fields<'a> {
    /// Acceleration of gravity of the model, m/s², in the base frame.
    pub described: [f64; 3],
    /// The robot in fields of 1 m/s² along x, y and z of the base frame.
    pub along: [&'a dyn Model; 3],
}

/// Identifies the direction of gravity from runs of a robot.
///
/// The description gives its magnitude and approximate direction. `progress` gets the name of a
/// run, and its numbers of finished and of all samples.
///
/// # Errors
/// Settings or runs that are unusable; an undetermined direction, with the reason.
pub fn gravity_direction(
    model: &dyn Model,
    fields: &Fields<'_>,
    runs: &[Log],
    settings: &Settings,
    progress: &dyn Fn(&str, usize, usize),
) -> Result<GravityDirection, Error> {
    settings.check(&model.info())?;
    let described = Vector3::from(fields.described);
    let Some(frame) = GravityFrame::new(described) else {
        let message = "the direction of gravity is not determined: there is no gravity";
        let help =
            "give the acceleration of gravity and its approximate direction in the description";
        return Err(Problem::new(Code::GRAVITY_DIRECTION, message)
            .help(help)
            .into());
    };
    let extended = Extended::new(model, fields, runs, settings)?;
    let tilts = free_turns(&extended, &frame, settings.seed);
    if tilts.is_empty() {
        return Err(Problem::new(Code::GRAVITY_DIRECTION,
            "the direction of gravity is not determined: for any direction, some parameters of the robot explain the torques",
        )
        .help("leave out `gravity_direction`; offsets and moments absorb a tilt")
        .into());
    }
    let frame = frame.restricted_to(&tilts);
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
    let rotated = Turned::new(&extended, &systems, &solution);
    Ok(GravityDirection::new(
        described,
        &solution.frame,
        angles,
        rotated,
    ))
}
