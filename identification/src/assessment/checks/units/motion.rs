//! Quantities of a run's raw numbers: sampling, speeds, accelerations, travels, torques.

use overact::Model;

use super::Finding;
use crate::units::{Kinds, Powers, Quantity, Range};
use overact_logs::{Scales, called, monitor::Monitor};

/// Speed of sound in air, m/s.
const SOUND: f64 = 343.0;

/// Largest acceleration of a tip, m/s²: 200 g, ten times that of the fastest Delta robots.
const LARGEST_ACCELERATION: f64 = 2000.0;

/// A run below this tip acceleration (m/s²) and sampling frequency (Hz) shows no inertia.
const SMALLEST_ACCELERATION: f64 = 1e-3;
const SLOW_SAMPLING: f64 = 20.0;

/// Longest travel of a linear drive, in m and in reaches of the robot.
///
/// Of a large robot it may be longer than the first one, up to some reaches.
const LONGEST_TRAVEL: f64 = 30.0;
const LONGEST_BY_REACH: f64 = 100.0;
const LONGEST_OF_LARGE: f64 = 3.0;

/// Largest ratio of a travel, or a torque, to the described one.
const BY_DESCRIBED_TRAVEL: f64 = 30.0;
const BY_DESCRIBED_TORQUE: f64 = 10.0;

/// Distance (m) from a revolute drive to the tip if no lengths are described.
const ARM: f64 = 0.3;

/// Motion quantities of a run.
pub(super) struct RunMotion {
    pub(super) name: String,
    sampling: Vec<Quantity>,
    drives: Vec<DriveMotion>,
    pub(super) has_revolute: bool,
    pub(super) has_prismatic: bool,
    /// Longest travel of a linear drive, m.
    pub(super) travel: f64,
}

/// Motion quantities of a drive in a run.
struct DriveMotion {
    actuator: String,
    is_revolute: bool,
    /// Travel, speed and acceleration.
    motion: Vec<Quantity>,
    /// Ratio of the largest torque to its limit.
    torque: Option<Quantity>,
}

impl RunMotion {
    pub(super) fn new(model: &dyn Model, scales: &Scales, name: &str, monitor: &Monitor) -> Self {
        let info = model.info();
        let frequency = monitor.frequency();
        let (ranges, speeds) = (monitor.ranges(), monitor.usual_speeds());
        let peaks = monitor.torque_peaks();
        let drives = info.actuators.iter().enumerate().map(|(index, actuator)| {
            let drive = Drive {
                name: called(actuator),
                is_revolute: info.actuator_is_revolute[index],
                range: ranges[index],
                speed: speeds[index],
                frequency,
            };
            let torque = scales.torque.get(index).filter(|limit| **limit > 0.0);
            let torque = torque.map(|limit| by_limit(&drive.name, peaks[index] / limit));
            DriveMotion {
                actuator: (*actuator).to_owned(),
                is_revolute: drive.is_revolute,
                motion: drive.quantities(scales, index),
                torque: torque.filter(|one| one.value > 0.0),
            }
        });
        let revolute = info.actuator_is_revolute;
        let linear = ranges.iter().zip(revolute).filter(|(_, is)| !**is);
        Self {
            name: name.to_owned(),
            sampling: sampling(frequency, scales),
            drives: drives.collect(),
            has_revolute: revolute.contains(&true),
            has_prismatic: revolute.contains(&false),
            travel: linear.fold(0.0, |most, (range, _)| most.max(*range)),
        }
    }

    /// All quantities; those of drives only for the drive with the largest value.
    pub(super) fn quantities(&self) -> impl Iterator<Item = &Quantity> {
        let count = self.drives.iter().map(|drive| drive.motion.len()).max();
        let most = (0..count.unwrap_or(0)).filter_map(|place| {
            let own = self
                .drives
                .iter()
                .filter_map(move |drive| drive.motion.get(place));
            own.max_by(|a, b| (a.value / a.usual.high).total_cmp(&(b.value / b.usual.high)))
        });
        let torques = self.drives.iter().filter_map(|drive| drive.torque.as_ref());
        let torque = torques.max_by(|a, b| a.value.total_cmp(&b.value));
        self.sampling.iter().chain(most).chain(torque)
    }

    /// Kinds of the drives.
    pub(super) fn kinds(&self) -> Kinds {
        Kinds {
            revolute: self.has_revolute,
            prismatic: self.has_prismatic,
        }
    }

    /// Drives with impossible motion while others are possible; likewise for torques.
    pub(super) fn single_drives(&self) -> Vec<Finding> {
        let is_moving = |drive: &&DriveMotion| !drive.motion.is_empty();
        let moving = self.drives.iter().filter(is_moving);
        let contradicts = |all: &[Quantity]| all.iter().any(|one| !one.is_possible());
        let (bad, good): (Vec<_>, Vec<_>) = moving.partition(|drive| contradicts(&drive.motion));
        let mut found = Vec::new();
        if !good.is_empty() {
            found.extend(
                bad.iter()
                    .filter_map(|drive| self.of_drive(drive, &drive.motion)),
            );
        }
        let torques = self.drives.iter().filter(|drive| drive.torque.is_some());
        let is_bad = |drive: &&DriveMotion| {
            let torque = drive.torque.as_ref();
            torque.is_some_and(|torque| !torque.is_possible())
        };
        let (bad, good): (Vec<_>, Vec<_>) = torques.partition(is_bad);
        if !good.is_empty() {
            let own = |drive: &&DriveMotion| self.of_drive(drive, drive.torque.as_slice());
            found.extend(bad.iter().filter_map(own));
        }
        found
    }

    /// The finding from quantities of a drive.
    fn of_drive(&self, drive: &DriveMotion, quantities: &[Quantity]) -> Option<Finding> {
        let own = Self {
            name: self.name.clone(),
            sampling: Vec::new(),
            drives: Vec::new(),
            has_revolute: drive.is_revolute,
            has_prismatic: !drive.is_revolute,
            travel: 0.0,
        };
        Finding::of(&own, Some(&drive.actuator), quantities)
    }
}

/// The sampling frequency, in Hz and relative to that of the virtual experiment.
fn sampling(frequency: f64, scales: &Scales) -> Vec<Quantity> {
    let powers = Powers {
        time: -1,
        ..Powers::default()
    };
    let own = Quantity {
        name: String::from("the sampling frequency"),
        value: frequency,
        unit: "Hz",
        possible: Range::new(0.2, 5e6),
        usual: Range::new(100.0, 2e4),
        powers,
        is_by_weight: false,
    };
    let described = scales.sampling.map(|described| Quantity {
        name: String::from("the sampling frequency by that of [experiment]"),
        value: frequency / described,
        unit: "",
        possible: Range::new(0.0, f64::INFINITY),
        usual: Range::new(0.1, 10.0),
        powers,
        is_by_weight: false,
    });
    std::iter::once(own).chain(described).collect()
}

/// The ratio of a drive's largest torque to its limit.
fn by_limit(drive: &str, ratio: f64) -> Quantity {
    Quantity {
        name: format!("the largest torque of {drive} by its `torque_limit`"),
        value: ratio,
        unit: "",
        possible: Range::new(0.0, BY_DESCRIBED_TORQUE),
        usual: Range::new(1e-3, 1.5),
        powers: Powers {
            torques: 1,
            ..Powers::default()
        },
        is_by_weight: false,
    }
}

/// Raw numbers of a drive in a run.
struct Drive {
    name: String,
    is_revolute: bool,
    /// Largest minus smallest position, rad or m.
    range: f64,
    /// Speed, rad/s or m/s.
    speed: f64,
    /// Sampling frequency, Hz.
    frequency: f64,
}

impl Drive {
    /// Travel, speed and acceleration; empty for a drive that does not move.
    fn quantities(&self, scales: &Scales, index: usize) -> Vec<Quantity> {
        if !(self.range > 0.0 && self.speed > 0.0) {
            return Vec::new();
        }
        let arm = if self.is_revolute {
            scales.reach().unwrap_or(ARM)
        } else {
            1.0
        };
        let powers = |time| Powers {
            time,
            positions: 1,
            torques: 0,
        };
        // A sine of amplitude R/2 and peak speed v has the peak acceleration 2 v²/R.
        let acceleration = 2.0 * self.speed.powi(2) / self.range * arm;
        let least = if self.frequency < SLOW_SAMPLING {
            SMALLEST_ACCELERATION
        } else {
            0.0
        };
        let speed = arm * self.speed;
        vec![
            self.travel(scales, index),
            Quantity {
                name: format!("the speed of the tip by {}", self.name),
                value: speed,
                unit: "m/s",
                possible: Range::new(0.0, SOUND),
                usual: Range::new(0.01, 20.0),
                powers: powers(-1),
                is_by_weight: false,
            },
            Quantity {
                name: format!("the acceleration of the tip by {}", self.name),
                value: acceleration,
                unit: "m/s²",
                possible: Range::new(least, LARGEST_ACCELERATION),
                usual: Range::new(0.05, 300.0),
                powers: powers(-2),
                is_by_weight: false,
            },
        ]
    }

    /// Travel of the drive.
    fn travel(&self, scales: &Scales, index: usize) -> Quantity {
        let described = scales.travel.get(index).map(|travel| 2.0 * travel);
        let described = described.filter(|travel| *travel > 0.0);
        let longest = if self.is_revolute {
            f64::INFINITY
        } else {
            scales.reach().map_or(LONGEST_TRAVEL, |reach| {
                let longest = LONGEST_TRAVEL.max(LONGEST_OF_LARGE * reach);
                longest.min(LONGEST_BY_REACH * reach)
            })
        };
        let longest = described.map_or(longest, |own| longest.min(BY_DESCRIBED_TRAVEL * own));
        let (unit, usual) = if self.is_revolute {
            ("rad", Range::new(0.02, 7.0))
        } else {
            ("m", Range::new(0.002, 3.0))
        };
        let usual = described.map_or(usual, |own| Range::new(0.1 * own, 3.0 * own));
        Quantity {
            name: format!("the travel of {}", self.name),
            value: self.range,
            unit,
            possible: Range::new(0.0, longest),
            usual,
            powers: Powers {
                positions: 1,
                ..Powers::default()
            },
            is_by_weight: false,
        }
    }
}
