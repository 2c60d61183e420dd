//! List of the faults.

use super::{
    alter,
    known_fault::{KnownFault, Place},
};
use overact_identification::FaultKind;
use overact_simulation::{Experiment, Record};

/// Change of records.
pub type Change = dyn Fn(&mut Vec<Record>) + Sync;

/// Change of an experiment.
pub type PlanChange = dyn Fn(&mut Experiment) + Sync;

/// A fault.
pub struct Trap {
    /// Name of the fault.
    pub name: String,
    /// Replacements in the description of the recorded robot; empty if only records are changed.
    pub plant: Vec<(String, String)>,
    /// Change of the experiment, before it is simulated.
    pub plan: Option<Box<PlanChange>>,
    /// Change of the records.
    pub alter: Box<Change>,
    /// Why no data can reveal it, if so.
    pub assumed: Option<&'static str>,
    /// The faults for which a report states detection limits, if it is some of these.
    pub known: Vec<KnownFault>,
}

impl Trap {
    pub(super) fn new(name: &str, alter: impl Fn(&mut Vec<Record>) + Sync + 'static) -> Self {
        Self {
            name: name.to_owned(),
            plant: Vec::new(),
            plan: None,
            alter: Box::new(alter),
            assumed: None,
            known: Vec::new(),
        }
    }

    /// No fault.
    #[must_use]
    pub fn none() -> Self {
        Self::new("none", |_| ())
    }

    /// Fault of every record separately.
    pub(super) fn each(name: &str, alter: impl Fn(&mut Record) + Sync + 'static) -> Self {
        Self::new(name, move |records| records.iter_mut().for_each(&alter))
    }

    /// Experiment that differs from the described one.
    pub(super) fn plan(name: &str, change: impl Fn(&mut Experiment) + Sync + 'static) -> Self {
        Self {
            plan: Some(Box::new(change)),
            ..Self::new(name, |_| ())
        }
    }

    /// Robot that differs from the description.
    fn plant(name: &str, from: &str, to: &str) -> Self {
        Self {
            plant: vec![(from.to_owned(), to.to_owned())],
            ..Self::new(name, |_| ())
        }
    }

    fn assumed(self, why: &'static str) -> Self {
        Self {
            assumed: Some(why),
            ..self
        }
    }

    pub(super) fn known(self, known: impl IntoIterator<Item = KnownFault>) -> Self {
        Self {
            known: known.into_iter().collect(),
            ..self
        }
    }
}

/// Traps for a robot.
#[must_use]
pub fn traps(robot: &str) -> Vec<Trap> {
    let mut all = timing();
    all.extend(drives());
    all.extend(encoders());
    all.extend(missing());
    all.extend(labels(robot));
    all.extend(geometry(robot));
    all
}

fn timing() -> Vec<Trap> {
    vec![
        Trap::each("torques 1 ms late", |run| alter::late(run, 1e-3))
            .known([KnownFault::of_robot(FaultKind::Delay, 1e-3)]),
        Trap::each("torques 5 ms late", |run| alter::late(run, 5e-3))
            .known([KnownFault::of_robot(FaultKind::Delay, 5e-3)]),
        Trap::each("torques behind a first-order lag of 5 ms", |run| {
            alter::lag(run, 5e-3);
        }),
        Trap::each("torques smoothed by a mean over 20 ms", |run| {
            alter::smooth(run, 20e-3);
        }),
        Trap::each("torques interpolated between samples 10 ms apart", |run| {
            alter::interpolate(run, 10e-3);
        }),
        Trap::each("positions 2 ms late", |run| alter::late(run, -2e-3)),
        Trap::each("torque of drive 2 alone 2 ms late", |run| {
            alter::late_drive(run, 1, 2e-3);
        })
        .known([KnownFault::of_actuator(FaultKind::DriveDelay, 1, 2e-3)]),
        Trap::each("3 % of the samples dropped and restamped", |run| {
            alter::drop_samples(run, 0.03);
        }),
        Trap::each("sampling frequency 5 % too high", |run| {
            run.sampling_hz *= 1.05;
        })
        .assumed("a clock that is wrong by one factor")
        .known([KnownFault::of_robot(FaultKind::Clock, 0.05)]),
    ]
}

fn drives() -> Vec<Trap> {
    vec![
        Trap::each("gain of drive 1 10 % low", |run| {
            alter::torque(run, 0, |torque| 0.9 * torque);
        })
        .known([KnownFault::of_actuator(FaultKind::Gain, 0, 0.1)]),
        Trap::each("gain of drive 2 3 % low", |run| {
            alter::torque(run, 1, |torque| 0.97 * torque);
        })
        .known([KnownFault::of_actuator(FaultKind::Gain, 1, 0.03)]),
        Trap::each("all gains 5 % high", |run| {
            run.torques.iter_mut().for_each(|torque| *torque *= 1.05);
        })
        .assumed("gains that are wrong by one factor"),
        Trap::each("torques in mN m", |run| {
            run.torques.iter_mut().for_each(|torque| *torque *= 1e3);
        }),
        Trap::each("torque of drive 2 alone in mN m", |run| {
            alter::torque(run, 1, |torque| 1e3 * torque);
        }),
        Trap::each("torque of drive 2 ten times as large", |run| {
            alter::torque(run, 1, |torque| 10.0 * torque);
        }),
        Trap::each("torque of drive 2 reversed", |run| {
            alter::torque(run, 1, |torque| -torque);
        }),
        Trap::each("torques of drives 1 and 2 swapped", |run| {
            let n = run.actuators.len();
            run.torques
                .chunks_exact_mut(n)
                .for_each(|row| row.swap(0, 1));
        }),
        Trap::each("torque of drive 1 saturated at 60 % of its peak", |run| {
            alter::saturate(run, 0, 0.6);
        }),
        Trap::each("torque of drive 1 all zero", |run| {
            alter::torque(run, 0, |_| 0.0);
        }),
        Trap::each("all torques zero", |run| run.torques.fill(0.0)),
        Trap::each("gain of drive 1 falls by 10 % during each run", |run| {
            alter::torque_in_time(run, 0, |torque, part| torque * (1.0 - 0.1 * part));
        })
        .known([KnownFault::torque("gain-time", 0, None)]),
        Trap::each("torque of drive 1 zero for 1 % of the time", |run| {
            alter::torque_in_time(run, 0, |torque, part| {
                if (0.40..0.41).contains(&part) {
                    0.0
                } else {
                    torque
                }
            });
        }),
        Trap::each("a collision at drive 1, for 1 % of the time", |run| {
            let peak = run
                .torques
                .iter()
                .fold(0.0, |most: f64, t| most.max(t.abs()));
            alter::torque_in_time(run, 0, |torque, part| {
                if (0.60..0.61).contains(&part) {
                    torque + peak
                } else {
                    torque
                }
            });
        }),
        Trap::each("torque of drive 2 in the column of drive 1, too", |run| {
            let n = run.actuators.len();
            run.torques
                .chunks_exact_mut(n)
                .for_each(|row| row[0] = row[1]);
        }),
    ]
}

fn encoders() -> Vec<Trap> {
    let degree = 1_f64.to_radians();
    let first = |fault: FaultKind, size: f64| [KnownFault::of_actuator(fault, 0, size)];
    vec![
        Trap::each("encoder 1 off by 0.2 deg", move |run| {
            alter::position(run, 0, |q| q + 0.2 * degree);
        })
        .known(first(FaultKind::EncoderOffset, 0.2 * degree)),
        Trap::each("encoder 1 off by 1 deg", move |run| {
            alter::position(run, 0, |q| q + degree);
        })
        .known(first(FaultKind::EncoderOffset, degree)),
        Trap::each("positions of actuator 1 1 % too large", |run| {
            alter::position(run, 0, |q| 1.01 * q);
        })
        .known(first(FaultKind::EncoderScale, 0.01)),
        Trap::each("encoder 1 out of centre by 0.01 rad", |run| {
            alter::position(run, 0, |q| q + 0.01 * q.sin());
        })
        .known(first(FaultKind::Eccentricity, 0.01)),
        Trap::each("encoders of 12 bits", |run| {
            let step = std::f64::consts::TAU / 4096.0;
            run.positions
                .iter_mut()
                .for_each(|q| *q = (*q / step).round() * step);
        }),
        Trap::each("backlash of 0.2 deg at encoder 1", move |run| {
            alter::backlash(run, 0, 0.2 * degree);
        })
        .known(first(FaultKind::Play, 0.1 * degree)),
        Trap::each("positions in degrees", move |run| {
            run.positions.iter_mut().for_each(|q| *q /= degree);
        }),
        Trap::each("positions of the motors, ratio 50", |run| {
            run.positions.iter_mut().for_each(|q| *q *= 50.0);
        }),
        Trap::each("encoder 1 counts backwards", |run| {
            alter::position(run, 0, |q| -q)
        }),
        Trap::each("positions of actuators 1 and 2 swapped", |run| {
            let n = run.actuators.len();
            run.positions
                .chunks_exact_mut(n)
                .for_each(|row| row.swap(0, 1));
        }),
        Trap::each("actuators 1 and 2 swapped, positions and torques", |run| {
            let n = run.actuators.len();
            let both = [&mut run.positions, &mut run.torques];
            let rows = both.into_iter().flat_map(|all| all.chunks_exact_mut(n));
            rows.for_each(|row| row.swap(0, 1));
        }),
        Trap::each(
            "position of actuator 1 in the column of actuator 2, too, behind another gear",
            |run| {
                let n = run.actuators.len();
                run.positions
                    .chunks_exact_mut(n)
                    .for_each(|row| row[1] = 0.7 * row[0]);
            },
        ),
    ]
}

fn missing() -> Vec<Trap> {
    vec![
        Trap::new("a spring at actuator 1", |runs| {
            alter::add(runs, 0, |at| at.position, 0.2);
        })
        .known([KnownFault::torque("position", 0, None)]),
        Trap::new("friction of actuator 1 grows with time", |runs| {
            alter::add(runs, 0, |at| at.velocity.signum() * at.time, 0.1);
        }),
        Trap::new("friction of actuator 1 rises towards standstill", |runs| {
            alter::add(
                runs,
                0,
                |at| at.velocity.signum() * (-5.0 * at.velocity.abs()).exp(),
                0.1,
            );
        }),
        Trap::new(
            "drag with the square of the velocity at actuator 2",
            |runs| {
                alter::add(runs, 1, |at| at.velocity * at.velocity.abs(), 0.1);
            },
        )
        .known([KnownFault::torque("drag", 1, None)]),
        Trap::new("cogging at actuator 1", |runs| {
            alter::add(runs, 0, |at| (24.0 * at.position).sin(), 0.1);
        })
        .known([KnownFault::torque("waves", 0, None)]),
        Trap::new("torque 1 drifts with time", |runs| {
            alter::add(runs, 0, |at| at.time, 0.1);
        })
        .known([KnownFault::torque("time", 0, None)]),
    ]
}

fn labels(robot: &str) -> Vec<Trap> {
    let mut all = vec![
        Trap::each("every run at a standstill", alter::stand_still),
        Trap::new("one run at a standstill", |runs| {
            if runs.len() > 1 {
                alter::stand_still(&mut runs[0]);
            }
        }),
    ];
    if robot != "Rx90" {
        all.push(Trap::each("every run labelled unloaded", |run| {
            run.payload = false
        }));
        all.push(Trap::new("one loaded run labelled unloaded", |runs| {
            if let Some(run) = runs.iter_mut().find(|run| run.payload) {
                run.payload = false;
            }
        }));
        all.push(Trap::new("one unloaded run labelled loaded", |runs| {
            if let Some(run) = runs.iter_mut().find(|run| !run.payload) {
                run.payload = true;
            }
        }));
    }
    all
}

fn geometry(robot: &str) -> Vec<Trap> {
    let upwards = Trap::plant(
        "gravity described upwards",
        "gravity = [0, 0, \"-9.81 m/s^2\"]",
        "gravity = [0, 0, \"9.81 m/s^2\"]",
    );
    let weightless = Trap::plant(
        "gravity compensated by the drives, and not in the log",
        "gravity = [0, 0, \"-9.81 m/s^2\"]",
        "gravity = [0, 0, 0]",
    );
    match robot {
        "DualV" => vec![
            Trap::plant("links 1 % long", "l_bc = \"0.28 m\"", "l_bc = \"0.2828 m\""),
            Trap::plant(
                "attachment of leg 1 2 mm off",
                "at = \"r_p\"",
                "at = \"112 mm\"",
            ),
        ],
        "Delta" => vec![
            Trap::plant("rods 1 % long", "rod = \"0.56 m\"", "rod = \"0.5656 m\"")
                .assumed("lengths of loops without redundancy"),
            Trap::plant(
                "platform 2 mm large",
                "r_p = \"0.05 m\"",
                "r_p = \"0.052 m\"",
            )
            .assumed("lengths of loops without redundancy"),
            Trap::plant(
                "gravity tilted by 5 deg",
                "gravity = [0, 0, \"-9.81 m/s^2\"]",
                "gravity = [\"0.855 m/s^2\", 0, \"-9.773 m/s^2\"]",
            ),
            upwards,
            weightless,
        ],
        "Rx90" => vec![
            Trap::plant("upper arm 1 % long", "d3 = \"0.45 m\"", "d3 = \"0.4545 m\"").known([
                KnownFault {
                    fault: FaultKind::Length,
                    shape: None,
                    place: Place::Length("d_3_arm"),
                    size: Some(0.0045),
                },
            ]),
            Trap::plant(
                "gravity tilted by 5 deg",
                "gravity = [0, 0, \"-9.81 m/s^2\"]",
                "gravity = [\"0.855 m/s^2\", 0, \"-9.773 m/s^2\"]",
            ),
            upwards,
            weightless,
        ],
        _ => Vec::new(),
    }
}
