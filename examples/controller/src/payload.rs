//! Payload of the platform, estimated while the robot moves.
//!
//! The platform's pose follows from the four encoders. Its coordinates and the torques pass equal
//! state-variable filters. In the platform projection, torques minus those of the unloaded robot are
//! the payload's regressor times its parameters; they enter a payload estimator.

use crate::{ACTUATORS, SAMPLING_HZ, platform, unloaded};
use overact::StandardParameter::{M, Mx, My, Zz};
use overact::online::{
    self, ChangeTest, Forgetting, Payload, PayloadEstimator, PayloadSize, StateVariableFilter,
    Whitening,
};

/// r, independent coordinates of the platform.
const DOF: usize = unloaded::DualV::DOF;
/// Cutoff of the filters, Hz; the motions have up to 6 Hz.
pub const CUTOFF_HZ: f64 = 40.0;
/// Samples from one estimation to the next.
pub const EVERY: u32 = 50;
/// Samples until the filters have settled.
const SETTLED: u32 = 500;
/// Estimations without test after a change.
const LEARNED: u32 = 150;
/// Estimations after a change whose torques are partly from before it.
const MIXED: u32 = 10;
/// Standard deviations of what the model of the unloaded robot leaves of Γ¹: N, N and N m.
pub const DEVIATIONS: [f64; DOF] = [0.5, 0.5, 0.05];
/// Largest expected payload.
const SIZE: PayloadSize = PayloadSize {
    mass: 20.0,
    length: 0.2,
};

/// Reason why a sample is not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// The model has no value at the measured pose.
    Model(overact::Error),
    /// The estimator rejects a number.
    Estimator(online::Error),
}

impl From<overact::Error> for Fault {
    fn from(error: overact::Error) -> Self {
        Self::Model(error)
    }
}

impl From<online::Error> for Fault {
    fn from(error: online::Error) -> Self {
        Self::Estimator(error)
    }
}

/// Observer of the payload.
#[derive(Debug, Clone)]
pub struct PayloadObserver {
    coordinates: [StateVariableFilter<3>; DOF],
    torques: [StateVariableFilter<3>; ACTUATORS],
    pose: [f64; DOF],
    estimator: PayloadEstimator<4>,
    whitening: [Whitening; DOF],
    tests: [ChangeTest; DOF],
    /// Samples so far, up to the settling of the filters.
    samples: u32,
    /// Samples until the next estimation.
    wait: u32,
    /// Estimations since the last change.
    since_change: u32,
}

impl PayloadObserver {
    /// An observer that starts at a pose: x, y (m) and φ (rad).
    ///
    /// # Errors
    /// None with the constants of this file.
    pub fn new(pose: [f64; DOF]) -> Result<Self, online::Error> {
        let filter = StateVariableFilter::new(CUTOFF_HZ, SAMPLING_HZ)?;
        let estimator = PayloadEstimator::new([Zz, Mx, My, M], SIZE)?;
        Ok(Self {
            coordinates: [filter; DOF],
            torques: [filter; ACTUATORS],
            pose,
            estimator: estimator.with_forgetting(Forgetting::Directional(0.9995))?,
            whitening: [Whitening::new(); DOF],
            tests: [ChangeTest::new(1.0, 1e7)?; DOF],
            samples: 0,
            wait: 0,
            since_change: LEARNED,
        })
    }

    /// Takes the positions (rad) and torques (N m) of a sample. Whether a change was detected.
    ///
    /// # Errors
    /// Positions that no pose fits, or numbers that are not finite. The estimate is then unchanged.
    pub fn step(
        &mut self,
        positions: &[f64; ACTUATORS],
        torques: &[f64; ACTUATORS],
    ) -> Result<bool, Fault> {
        let pose = platform::DualV::pose_from_actuators(positions, &self.pose)?;
        self.pose = pose;
        let (mut state, mut filtered) = ([[0.0; DOF]; 3], [0.0; ACTUATORS]);
        for (place, (filter, coordinate)) in self.coordinates.iter_mut().zip(pose).enumerate() {
            let signal = filter.update(coordinate)?;
            let numbers = [signal.value, signal.velocity, signal.acceleration];
            for (row, number) in state.iter_mut().zip(numbers) {
                row.iter_mut()
                    .skip(place)
                    .take(1)
                    .for_each(|own| *own = number);
            }
        }
        let signals = self.torques.iter_mut().zip(torques);
        for (own, (filter, torque)) in filtered.iter_mut().zip(signals) {
            *own = filter.update(*torque)?.value;
        }
        if self.samples < SETTLED {
            self.samples += 1;
            return Ok(false);
        }
        if self.wait > 0 {
            self.wait -= 1;
            return Ok(false);
        }
        self.wait = EVERY - 1;
        self.estimate(&state, &filtered)
    }

    /// Adds filtered pose, twist and acceleration with filtered torques to the estimator.
    fn estimate(
        &mut self,
        state: &[[f64; DOF]; 3],
        torques: &[f64; ACTUATORS],
    ) -> Result<bool, Fault> {
        let [pose, twist, acceleration] = state;
        let known = unloaded::DualV::inverse_dynamics(pose, twist, acceleration)?;
        let mut rest = *torques;
        for (rest, known) in rest.iter_mut().zip(known) {
            *rest -= known;
        }
        let residuals = platform::DualV::project_platform(pose, &rest)?;
        let rows = platform::DualV::idm_red_payload(pose, twist, acceleration)?;
        let innovations = self.estimator.update(&rows, &residuals, &DEVIATIONS)?;
        let mut has_changed = false;
        let tests = self.whitening.iter_mut().zip(&mut self.tests);
        for ((whitening, test), one) in tests.zip(innovations) {
            has_changed |= test.update(whitening.update(one.normalised)).is_some();
        }
        if self.since_change < MIXED {
            self.estimator.discount(1e-2)?;
        }
        if self.since_change < LEARNED {
            self.since_change += 1;
            self.tests.iter_mut().for_each(ChangeTest::reset);
            return Ok(false);
        }
        if has_changed {
            self.since_change = 0;
        }
        Ok(has_changed)
    }

    /// The physically consistent payload: mass, centre of mass and inertia.
    ///
    /// # Errors
    /// An estimate that is not finite.
    pub fn payload(&self) -> Result<Payload, online::Error> {
        self.estimator.payload()
    }

    /// Mass and its standard deviation, kg.
    ///
    /// # Errors
    /// An estimate that is not finite.
    pub fn mass(&self) -> Result<[f64; 2], online::Error> {
        let [_, _, _, mass] = self.estimator.filter().estimate()?;
        let [_, _, _, deviation] = self.estimator.filter().standard_deviations()?;
        Ok([mass, deviation])
    }
}
