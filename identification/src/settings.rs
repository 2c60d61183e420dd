//! Settings of an identification, and usual rules for them (Gautier 1997, the paper's Ref. \[27\]).
//!
//! Let f_dyn be the bandwidth of the robot's dynamics, the fastest motion of the run. The low-pass
//! of the positions must not distort signals within it: cutoff >= 10 f_dyn. The decimation removes
//! frequencies above the model's band: 0.8 f_m/(2 n_d) is about 2 to 5 times f_dyn.

use overact::Code;
use std::collections::BTreeMap;

use overact::Info;
use serde::{Deserialize, Serialize};

use crate::{
    filters::{DECIMATION_PADDING, Decimator, butterworth, settling},
    gear_friction::GearFriction,
    online_settings::OnlineSettings,
    prior::Prior,
};
use overact_logs::{Error, Problem};

/// Largest frequency after decimation, in multiples of f_dyn.
const DECIMATION_BAND: f64 = 4.0;

/// Largest cutoff of the position low-pass, by the Nyquist frequency.
const LARGEST_CUTOFF: f64 = 0.8;

/// Relative size of the position filter's transient in the samples used.
const TRANSIENT: f64 = 1e-5;

/// Rule for σ_ρ of eq. (46).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Normalisation {
    /// σ² = ||ρ||²/(r_c - n_b), the unbiased estimate (46).
    #[default]
    Unbiased,
    /// σ² = Σ(ρ - mean)²/(N - 1), the sample variance (MATLAB's `std`), as in published EMPS
    /// results.
    SampleVariance,
}

/// Source of instruments, which detect and correct errors of the regressor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Instruments {
    /// The other periods of a periodic motion.
    #[default]
    Periods,
    /// Motion of the simulated robot, supplied with each run
    /// ([`Log::with_instruments`](overact_logs::Log::with_instruments)).
    Simulated,
    /// No instruments.
    None,
}

impl Instruments {
    /// `periods`, `simulated` or `none`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Periods => "periods",
            Self::Simulated => "simulated",
            Self::None => "none",
        }
    }
}

/// Checks that an identification runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CheckScope {
    /// All checks.
    #[default]
    All,
    /// Checks of the raw samples and of the residuals only.
    ///
    /// Fault hypotheses, position noise and instruments need further passes over the data. They are
    /// left out, so a wrong gain, a delay or missing physics may pass unnoticed.
    Basic,
}

impl CheckScope {
    /// `all` or `basic`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Basic => "basic",
        }
    }

    /// Whether faults are sought in further passes over the data.
    #[must_use]
    pub const fn has_fault_hypotheses(self) -> bool {
        matches!(self, Self::All)
    }
}

/// Settings of an identification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Order of the Butterworth low-pass on the positions, run forwards and backwards.
    pub filter_order: usize,
    /// Cutoff frequency of this low-pass, Hz.
    pub filter_cutoff_hz: f64,
    /// Order of the error of central differences, 2 or 4.
    ///
    /// The relative error of a velocity of frequency ω at a sampling period T is (ωT)²/6 or
    /// (ωT)⁴/30.
    #[serde(default = "finest_differences")]
    pub difference_order: usize,
    /// Decimation factor n_d; 1 keeps all samples, unfiltered.
    pub decimation: usize,
    /// Samples excluded at the start of each run after differentiation.
    pub skip_start: usize,
    /// Samples excluded at the end of each run after differentiation.
    pub skip_end: usize,
    /// Joint velocity (rad/s or m/s) below which Coulomb friction counts as zero; 0 for no dead
    /// band.
    ///
    /// Near standstill the sign of a measured velocity is noise.
    pub velocity_dead_band: f64,
    /// Velocity of each actuator's joint (rad/s or m/s) below which its equations are excluded.
    ///
    /// Friction has no constant coefficient there. Empty excludes nothing. Only for robots without
    /// redundancy, whose equations are those of their joints.
    #[serde(default)]
    pub standstill_velocity: Vec<f64>,
    /// Whether the torques pass the low-pass of the positions, too.
    ///
    /// The columns do not. Published work does this if torques are not decimated.
    #[serde(default)]
    pub filter_torques: bool,
    /// Whether both sides of the equations pass the low-pass of the positions before decimation.
    ///
    /// Torques and columns are then filtered alike, in particular steps of dry friction.
    #[serde(default)]
    pub filter_equations: bool,
    /// Number of decimated samples of a validation run that count in the errors.
    ///
    /// Counted from the first one; `None` for all.
    #[serde(default)]
    pub validation_samples: Option<usize>,
    /// Whether Coulomb columns use the mean sign of the velocity over a sampling interval.
    ///
    /// Reversals are then resolved to a fraction of the interval.
    pub averaged_reversals: bool,
    /// r_σ: elimination ends if the largest relative standard deviation is below r_σ times the
    /// smallest.
    pub r_sigma: f64,
    /// Whether elimination also ends at a significant parameter (|χ| > 5 σ).
    ///
    /// Without it, the paper's rule applies, with warnings.
    pub keep_significant: bool,
    /// Rule for σ_ρ.
    pub normalisation: Normalisation,
    /// Whether friction has separate coefficients for both directions of each joint.
    pub asymmetric_friction: bool,
    /// Whether to use weighted least squares (48).
    pub weighted: bool,
    /// Source of the instruments.
    pub instruments: Instruments,
    /// Known friction of the gears, one for each actuator; empty for none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gear_friction: Vec<GearFriction>,
    /// Stribeck velocities by parameter (rad/s or m/s), instead of those of the model.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub stribeck_velocities: BTreeMap<String, f64>,
    /// Checks that are run.
    #[serde(default)]
    pub checks: CheckScope,
    /// Period of the motion, s, for instruments from other periods; `None` to find it in each run.
    pub period_s: Option<f64>,
    /// Prior of the standard parameters, for the consistent estimate.
    #[serde(default)]
    pub prior: Prior,
    /// Exactly known values of standard parameters (SI units), by name.
    ///
    /// They only serve to fix the scale in the identification of drive gains.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub known: BTreeMap<String, f64>,
    /// Kept actuators of the actuator projection, r indices among the actuators.
    pub kept_actuators: Vec<usize>,
    /// Seed of the random states for the base parameters.
    pub seed: u64,
    /// Replay of the runs through the online filter, if requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub online: Option<OnlineSettings>,
}

/// Default order of differences.
const fn finest_differences() -> usize {
    4
}

impl Settings {
    /// Usual settings for a robot of bandwidth `dynamics_hz` (f_dyn).
    ///
    /// With `sampling_frequency` (f_m, Hz): order 4, cutoff 10 f_dyn, decimation to 4 f_dyn.
    /// `kept_actuators` is the description's choice. No samples are excluded, see
    /// [`Settings::trimmed`].
    #[must_use]
    pub fn for_bandwidth(dynamics_hz: f64, sampling_frequency: f64, info: &Info<'_>) -> Self {
        let nyquist = sampling_frequency / 2.0;
        // Without a bandwidth there is no decimation; the check rejects the cutoff.
        let decimation = if dynamics_hz > 0.0 {
            (0.8 * nyquist / (DECIMATION_BAND * dynamics_hz)).floor()
        } else {
            1.0
        };
        Self {
            filter_order: 4,
            filter_cutoff_hz: (10.0 * dynamics_hz).min(LARGEST_CUTOFF * nyquist),
            difference_order: finest_differences(),
            // The cast saturates, and `max` handles NaN.
            decimation: decimation.max(1.0) as usize,
            skip_start: 0,
            skip_end: 0,
            velocity_dead_band: 0.0,
            standstill_velocity: Vec::new(),
            filter_torques: false,
            filter_equations: false,
            validation_samples: None,
            averaged_reversals: false,
            r_sigma: 10.0,
            keep_significant: false,
            normalisation: Normalisation::Unbiased,
            asymmetric_friction: false,
            weighted: true,
            instruments: Instruments::default(),
            gear_friction: Vec::new(),
            stribeck_velocities: BTreeMap::new(),
            checks: CheckScope::default(),
            period_s: None,
            prior: Prior::default(),
            known: BTreeMap::new(),
            kept_actuators: info.kept_actuators.to_vec(),
            seed: 1,
            online: None,
        }
    }

    /// [`Settings::for_bandwidth`] with f_dyn = f_m/100, for an unknown bandwidth.
    ///
    /// Controllers typically run a hundred times faster than the robot moves. The cutoff is f_m/10,
    /// and the decimation factor 10.
    #[must_use]
    pub fn for_sampling_frequency(sampling_frequency: f64, info: &Info<'_>) -> Self {
        Self::for_bandwidth(sampling_frequency / 100.0, sampling_frequency, info)
    }

    /// Excludes the transient of the position filter at both ends of a run.
    ///
    /// The filter extends a run by its odd reflection, whose acceleration has the wrong sign. Its
    /// duration is a property of the filter. Decimation needs no exclusion, since it filters both
    /// sides of the equations alike.
    #[must_use]
    pub fn trimmed(mut self, sampling_frequency: f64) -> Self {
        // The checks reject impossible filters.
        let cutoff = 2.0 * self.filter_cutoff_hz / sampling_frequency;
        if let Ok(filter) = butterworth(self.filter_order, cutoff) {
            self.skip_start = settling(&filter, TRANSIENT);
            self.skip_end = self.skip_start;
        }
        self
    }

    /// Number of samples that a run needs for these settings.
    #[must_use]
    pub fn samples_needed(&self) -> usize {
        let filter = self.filter_order.saturating_mul(3).saturating_add(1);
        let decimation = if self.decimation > 1 {
            DECIMATION_PADDING + 1
        } else {
            1
        };
        let skipped = self.skip_start.saturating_add(self.skip_end);
        let again = if self.filter_equations { filter } else { 1 };
        let used = decimation.max(self.decimation).max(again);
        filter.max(skipped.saturating_add(used))
    }

    /// Decimator for equations sampled at `frequency` (Hz), with this `factor`.
    pub(crate) fn decimator(&self, factor: usize, frequency: f64) -> Result<Decimator, Error> {
        let decimator = Decimator::new(factor)?;
        if !self.filter_equations {
            return Ok(decimator);
        }
        let cutoff = self.filter_cutoff_hz * 2.0 / frequency;
        Ok(decimator.behind(butterworth(self.filter_order, cutoff)?))
    }

    /// Checks the settings against the robot; those that concern a run are checked with it.
    ///
    /// # Errors
    /// Every invalid setting.
    pub fn check(&self, info: &Info<'_>) -> Result<(), Error> {
        let mut problems = Vec::new();
        if !(self.filter_cutoff_hz.is_finite() && self.filter_cutoff_hz > 0.0) {
            problems.push(
                Problem::new(
                    Code::SETTINGS,
                    format!("the cutoff frequency is {} Hz", self.filter_cutoff_hz),
                )
                .help("give `filter_cutoff` of [identification] about ten times the bandwidth of the motion"),
            );
        }
        if !matches!(self.difference_order, 2 | 4) {
            problems.push(
                Problem::new(
                    Code::SETTINGS,
                    format!(
                        "there are no central differences of order {}",
                        self.difference_order
                    ),
                )
                .help("set `difference_order` of [identification] to 4, or to 2 as published work does"),
            );
        }
        if self.filter_order == 0 {
            problems.push(
                Problem::new(Code::SETTINGS, "the filter's order is 0")
                    .help("`filter_order` of [identification]: 4 is usual"),
            );
        }
        if self.decimation == 0 {
            problems.push(
                Problem::new(Code::SETTINGS, "a decimation by 0 is not possible")
                    .help("set `decimation` of [identification] to 1 to keep every sample"),
            );
        }
        if !(self.velocity_dead_band.is_finite() && self.velocity_dead_band >= 0.0) {
            problems.push(
                Problem::new(
                    Code::SETTINGS,
                    format!("the velocity dead band is {}", self.velocity_dead_band),
                )
                .help("give `velocity_dead_band` of [identification] about three times the noise of the velocities, or 0 for none"),
            );
        }
        if self.filter_torques && self.filter_equations {
            problems.push(
                Problem::new(Code::SETTINGS, "the torques would be filtered twice: both `filter_torques` and `filter_equations` are set")
                    .help("`filter_equations` filters torques and columns alike; leave out the other one"),
            );
        }
        problems.extend(self.check_standstill(info));
        problems.extend(self.check_gears(info));
        problems.extend(self.check_stribeck());
        if self.r_sigma.is_nan() || self.r_sigma <= 1.0 {
            problems.push(
                Problem::new(
                    Code::SETTINGS,
                    format!("r_sigma is {}; it must be greater than 1", self.r_sigma),
                )
                .help("choose `r_sigma` of [identification] between 10 and 30"),
            );
        }
        if info.sizes.actuators > info.sizes.dof {
            problems.extend(check_partition(&self.kept_actuators, info));
        }
        Error::check(problems)
    }

    /// The problem of invalid friction of gears.
    fn check_gears(&self, info: &Info<'_>) -> Option<Problem> {
        let (gears, actuators) = (&self.gear_friction, info.sizes.actuators);
        if !gears.is_empty() && gears.len() != actuators {
            let message = format!("there are {} gears for {actuators} actuators", gears.len());
            let help = "give the friction of one gear for each actuator, or none";
            return Some(Problem::new(Code::SETTINGS, message).help(help));
        }
        let is_possible = |gear: &GearFriction| gear.coefficient.abs() < 1.0;
        let bad = gears.iter().find(|gear| !is_possible(gear))?;
        let message = format!("a gear has the friction coefficient {}", bad.coefficient);
        let help = "it is a part of the transmitted torque, below 1";
        Some(Problem::new(Code::SETTINGS, message).help(help))
    }

    /// The problem of invalid Stribeck velocities.
    fn check_stribeck(&self) -> Option<Problem> {
        let mut velocities = self.stribeck_velocities.iter();
        let (name, velocity) = velocities.find(|(_, own)| !(own.is_normal() && **own > 0.0))?;
        let message = format!("the Stribeck velocity of `{name}` is {velocity}");
        let help = "it is positive, in rad/s or m/s";
        Some(Problem::new(Code::SETTINGS, message).help(help))
    }

    /// The problem of invalid standstill velocities.
    fn check_standstill(&self, info: &Info<'_>) -> Option<Problem> {
        let (limits, actuators) = (&self.standstill_velocity, info.sizes.actuators);
        if limits.is_empty() {
            return None;
        }
        if actuators > info.sizes.dof {
            let message = "equations can't be skipped at a joint's standstill: those of a redundant robot are not those of single joints";
            let help = "leave out `standstill_velocity`; use `velocity_dead_band` for this robot";
            return Some(Problem::new(Code::SETTINGS, message).help(help));
        }
        if limits.len() != actuators {
            let message = format!(
                "there are {} velocities of standstill for {actuators} actuator{}",
                limits.len(),
                if actuators == 1 { "" } else { "s" }
            );
            return Some(
                Problem::new(Code::SETTINGS, message)
                    .help("give `standstill_velocity` one for each actuator, or none"),
            );
        }
        let mut limits = limits.iter();
        let bad = limits.find(|limit| !(limit.is_finite() && **limit >= 0.0))?;
        Some(Problem::new(
            Code::SETTINGS,
            format!("a velocity of standstill is {bad}"),
        ))
    }
}

/// The problem of invalid kept actuators, which must be r different ones.
pub(crate) fn check_partition(kept: &[usize], info: &Info<'_>) -> Option<Problem> {
    let (dof, actuators) = (info.sizes.dof, info.sizes.actuators);
    let mut sorted = kept.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let right = sorted.len() == dof && kept.len() == dof && sorted.iter().all(|k| *k < actuators);
    (!right).then(|| {
        Problem::new(Code::KEPT_ACTUATORS, format!(
            "the kept actuators {kept:?} are not a choice of {dof} among the {actuators} actuators"
        ))
        .help(format!(
            "the choice consists of different indices from 0 to {}",
            actuators.saturating_sub(1)
        ))
    })
}
