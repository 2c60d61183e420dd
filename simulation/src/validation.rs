//! Validation of an experiment for a robot: all problems at once, each with advice.

use std::collections::BTreeSet;

use overact::Info;

use crate::{
    controller::spectral_radius,
    error::Problem,
    experiment::{Experiment, Run},
    trajectory::{Term, Trajectory},
};

/// Largest number of samples of a run; such a record takes about a gigabyte.
const SAMPLES: f64 = 1e7;

/// Longest delay of drives and encoders, s.
const LONGEST_DELAY: f64 = 0.1;

/// Collects problems.
#[derive(Default)]
struct Problems(Vec<Problem>);

impl Problems {
    fn add(&mut self, field: impl Into<String>, message: impl Into<String>) {
        self.0.push(Problem {
            field: field.into(),
            message: message.into(),
        });
    }

    fn positive(&mut self, field: impl Into<String>, value: f64, unit: &str) -> bool {
        let good = value.is_finite() && value > 0.0;
        if !good {
            self.add(field, format!("is {value}; give a positive number{unit}"));
        }
        good
    }

    /// Checks one number per actuator with `good`; `empty`: whether an empty list is valid.
    fn per_actuator(
        &mut self,
        field: &str,
        values: &[f64],
        info: &Info<'_>,
        empty: bool,
        positive: bool,
    ) {
        let n = info.sizes.actuators;
        if values.len() != n && !(empty && values.is_empty()) {
            self.add(
                field,
                format!(
                    "has {} numbers; give {n}, one for each actuator",
                    values.len()
                ),
            );
        }
        for (i, value) in values.iter().enumerate() {
            let at = format!("{field}[{i}]");
            if positive {
                self.positive(at, *value, "");
            } else if !(value.is_finite() && *value >= 0.0) {
                self.add(at, format!("is {value}; give zero or a positive number"));
            }
        }
    }

    fn parameters(&mut self, field: &str, values: &[f64], info: &Info<'_>) {
        let (own, payload) = (info.sizes.parameters, info.sizes.payload_parameters);
        if values.len() != own + payload {
            self.add(
                field,
                format!(
                    "has {} numbers; give {}: {own} of the robot and {payload} of the payload, in column order",
                    values.len(),
                    own + payload
                ),
            );
        }
        for (i, value) in values
            .iter()
            .enumerate()
            .filter(|(_, value)| !value.is_finite())
        {
            self.add(
                format!("{field}[{i}]"),
                format!("is {value}; give a finite number"),
            );
        }
    }
}

impl Experiment {
    /// All invalid values for the robot that `info` describes; empty if the experiment is valid.
    #[must_use]
    pub fn problems(&self, info: &Info<'_>) -> Vec<Problem> {
        let mut found = Problems::default();
        control(&mut found, self);
        found.per_actuator(
            "encoder_resolution",
            &self.encoder_resolution,
            info,
            true,
            false,
        );
        found.per_actuator("torque_noise", &self.torque_noise, info, true, false);
        drives(&mut found, self, info);
        if let Some(limit) = &self.torque_limit {
            found.per_actuator("torque_limit", limit, info, false, true);
        }
        found.parameters("parameters", &self.parameters, info);
        if let Some(nominal) = &self.nominal_parameters {
            found.parameters("nominal_parameters", nominal, info);
        }
        if self.runs.is_empty() {
            found.add("runs", "is empty; give at least one run");
        }
        let mut names = BTreeSet::new();
        for (i, run) in self.runs.iter().enumerate() {
            if run.name.is_empty() {
                found.add(format!("runs[{i}].name"), "is empty; give a name");
            } else if !names.insert(run.name.as_str()) {
                found.add(
                    format!("runs[{i}].name"),
                    format!(
                        "`{}` is the name of an earlier run; give each run its own",
                        run.name
                    ),
                );
            }
            check_run(&mut found, self, run, i, info);
        }
        found.0
    }
}

/// Checks the drives, and the delays of drives and encoders.
fn drives(found: &mut Problems, experiment: &Experiment, info: &Info<'_>) {
    let drives = &experiment.drives;
    let lists = [
        ("gain", &drives.gain, true),
        ("current_bandwidth_hz", &drives.current_bandwidth_hz, false),
        ("cogging", &drives.cogging, false),
        ("cogging_periods", &drives.cogging_periods, true),
        ("flexible_hz", &drives.flexible_hz, false),
        ("flexible_stiffness", &drives.flexible_stiffness, false),
    ];
    for (field, values, positive) in lists {
        found.per_actuator(&format!("drives.{field}"), values, info, true, positive);
    }
    let delays = [
        ("drives.delay_s", drives.delay_s),
        ("encoder_delay_s", experiment.encoder_delay_s),
    ];
    for (field, delay) in delays {
        if !(0.0..=LONGEST_DELAY).contains(&delay) {
            found.add(
                field,
                format!("is {delay}; give 0 to {LONGEST_DELAY} seconds"),
            );
        }
    }
    if !(0.0..1.0).contains(&drives.flexible_damping) {
        let damping = drives.flexible_damping;
        found.add(
            "drives.flexible_damping",
            format!("is {damping}; give zero or more, below 1"),
        );
    }
}

/// Checks the controller's settings and the stability of the loop.
fn control(found: &mut Problems, experiment: &Experiment) {
    let mut good = found.positive("sampling_hz", experiment.sampling_hz, " of hertz");
    found.positive("duration_s", experiment.duration_s, " of seconds");
    good &= found.positive("bandwidth_hz", experiment.bandwidth_hz, " of hertz");
    good &= found.positive("damping", experiment.damping, "");
    good &= found.positive(
        "derivative_cutoff_hz",
        experiment.derivative_cutoff_hz,
        " of hertz",
    );
    if good && spectral_radius(experiment) >= 1.0 {
        found.add(
            "bandwidth_hz",
            "makes the controlled robot unstable; lower `bandwidth_hz`, or raise `sampling_hz`, `derivative_cutoff_hz` or `damping`",
        );
    }
    if !(1..=1000).contains(&experiment.integration_steps) {
        found.add(
            "integration_steps",
            format!(
                "is {}; give 1 to 1000 steps a sample",
                experiment.integration_steps
            ),
        );
    }
}

/// Checks duration and trajectory of a run.
fn check_run(
    found: &mut Problems,
    experiment: &Experiment,
    run: &Run,
    index: usize,
    info: &Info<'_>,
) {
    let at = format!("runs[{index}]");
    if let Some(duration) = run.duration_s {
        found.positive(format!("{at}.duration_s"), duration, " of seconds");
    }
    let samples = run.duration_s.unwrap_or(experiment.duration_s) * experiment.sampling_hz;
    if samples.is_finite() && samples > 0.0 && !(1.5..=SAMPLES).contains(&samples) {
        found.add(
            format!("{at}.duration_s"),
            format!("gives {samples:.0} samples; choose a duration of 2 to {SAMPLES:.0} samples"),
        );
    }
    let at = format!("{at}.trajectory");
    match &run.trajectory {
        Trajectory::Periodic {
            fundamental_hz,
            terms,
        } => {
            check_terms(found, experiment, &at, *fundamental_hz, terms, info);
        }
        Trajectory::PointToPoint { points, times } => {
            check_points(found, &at, points, times, info.sizes.dof);
        }
    }
}

/// Frequencies, coordinates and numbers of a Fourier series.
fn check_terms(
    found: &mut Problems,
    experiment: &Experiment,
    at: &str,
    fundamental_hz: f64,
    terms: &[Term],
    info: &Info<'_>,
) {
    let known = found.positive(format!("{at}.fundamental_hz"), fundamental_hz, " of hertz");
    for (i, term) in terms.iter().enumerate() {
        let at = format!("{at}.terms[{i}]");
        if !info.coordinates.contains(&term.coordinate.as_str()) {
            found.add(
                format!("{at}.coordinate"),
                format!(
                    "`{}` is none of {}",
                    term.coordinate,
                    info.coordinates.join(", ")
                ),
            );
        }
        let frequency = fundamental_hz * f64::from(term.harmonic);
        if term.harmonic == 0 {
            found.add(format!("{at}.harmonic"), "is 0; give 1 or more");
        } else if known && frequency >= 0.5 * experiment.sampling_hz {
            found.add(
                format!("{at}.harmonic"),
                format!("is a motion of {frequency} Hz; stay below half of `sampling_hz`"),
            );
        }
        for (name, value) in [("amplitude", term.amplitude), ("phase_rad", term.phase_rad)] {
            if !value.is_finite() {
                found.add(
                    format!("{at}.{name}"),
                    format!("is {value}; give a finite number"),
                );
            }
        }
    }
}

/// Points and times of a point-to-point motion.
fn check_points(found: &mut Problems, at: &str, points: &[Vec<f64>], times: &[f64], dof: usize) {
    if points.is_empty() || points.len() != times.len() {
        found.add(
            format!("{at}.times"),
            format!(
                "has {} numbers for {} points; give one for each point",
                times.len(),
                points.len()
            ),
        );
    }
    for (i, point) in points.iter().enumerate() {
        if point.len() != dof || point.iter().any(|s| !s.is_finite()) {
            found.add(
                format!("{at}.points[{i}]"),
                format!(
                    "is {point:?}; give {dof} finite numbers, one for each platform coordinate"
                ),
            );
        }
    }
    for (i, time) in times.iter().enumerate() {
        if !time.is_finite() || (i > 0 && *time <= times[i - 1]) {
            found.add(
                format!("{at}.times[{i}]"),
                format!("is {time}; give increasing times in seconds"),
            );
        }
    }
}
