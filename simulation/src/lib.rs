//! Virtual experiments of parallel and serial robots, overactuated or not.
//!
//! They produce what a laboratory would record when a robot with known parameters follows given
//! trajectories. An [`Experiment`] is plain data: controller, sensors, true parameters and [`Run`]s
//! with their [`Trajectory`]. [`simulate`] closes the loop of the paper's Fig. 4 around a robot
//! that implements [`overact::Model`], compiled or interpreted:
//!
//! ```text
//!  trajectory --x_d, v_d, v̇_d--> inverse dynamics --τ_ff--+
//!      |                                                  v
//!      +--q_d--> (+) --> PD, filtered derivative ------> (+) --> projection (50) --> limit --τ--+
//!                 ^ -                                                                           |
//!                 +---- encoder <--q-- plant  v̇ = M^-1 (Γ¹(τ) - bias) <-- drives, held torques -+
//! ```
//!
//! The stages, each in a module of its own:
//!
//! - [`trajectory`]: desired displacement of the platform and its derivatives;
//! - `reference`: the desired motion of platform and actuators, block by block;
//! - `controller`: PD with filtered derivative, feed-forward, projection of internal torques;
//! - [`drives`]: gains, delay, current loop, cogging and flexibility between command and robot;
//! - `plant`: the robot's motion under torques that are held between samples;
//! - `sensors`: encoder delay and quantisation, torque noise;
//! - [`run`]: the loop, over all runs; [`log`]: the record as CSV;
//! - [`fleet`]: many robots over many days;
//! - [`cascade`]: the loops of an industrial drive along a recorded reference.
//!
//! ```
//! use overact_simulation::{Error, Experiment, Run, Term, Trajectory, simulate, write_csv};
//!
//! fn log(model: &dyn overact::Model, parameters: Vec<f64>) -> Result<Vec<u8>, Error> {
//!     let term = Term { coordinate: "x".into(), harmonic: 2, amplitude: 0.05, phase_rad: 0.0 };
//!     let trajectory = Trajectory::Periodic { fundamental_hz: 0.5, terms: vec![term] };
//!     let run = Run { name: "shake".into(), payload: false, duration_s: None, trajectory };
//!     let experiment = Experiment { parameters, runs: vec![run], ..Experiment::default() };
//!     let records = simulate(model, &experiment, &|fraction, run| {
//!         eprintln!("{run}: {:.0} %", 100.0 * fraction);
//!     })?;
//!     let mut csv = Vec::new();
//!     write_csv(&records[0], &mut csv).expect("memory takes every byte");
//!     Ok(csv)
//! }
//! ```
//!
//! Results of the same model and experiment on the same machine are bitwise equal. Every noise
//! stream is seeded by run name and actuator, and no result depends on the order of threads.

pub mod cascade;
mod controller;
pub mod drives;
mod drivetrain;
pub mod error;
pub mod experiment;
pub mod fleet;
pub mod log;
mod plant;
mod reference;
pub mod run;
mod sensors;
pub mod trajectory;
mod validation;

#[cfg(test)]
#[path = "../tests/support/mod.rs"]
mod support;

pub use cascade::{Cascade, Recorded, follow_recorded};
pub use controller::{Control, Desired};
pub use drives::Drives;
pub use error::{Cause, Error, Problem, RunError, Stage};
pub use experiment::{Experiment, Run};
pub use fleet::{Fault, Fleet, Member};
pub use log::write_csv;
pub use reference::{Sampled, sample};
pub use run::{Record, actuator_inertias, simulate, simulate_controlled};
pub use trajectory::{Term, Trajectory};
