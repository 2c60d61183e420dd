//! The controller's constants compared with the simulation's: gains, filter, bandwidth.

use overact_controller::{BANDWIDTH_HZ, DAMPING, Load, SAMPLING_HZ, SMOOTHING, TORQUE_LIMIT};
use overact_robot::Robot;
use overact_simulation::actuator_inertias;

const DESCRIPTION: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/dualv.toml");

#[test]
fn controller_constants_match_the_description() {
    let robot = Robot::from_toml(DESCRIPTION).unwrap();
    let experiment = robot.experiment().unwrap();
    let plan = experiment.plan();
    assert_eq!(plan.sampling_hz, SAMPLING_HZ);
    assert_eq!(plan.bandwidth_hz, BANDWIDTH_HZ);
    assert_eq!(plan.damping, DAMPING);
    assert_eq!(
        plan.torque_limit.as_deref(),
        Some([TORQUE_LIMIT; 4].as_slice())
    );
    let smoothing = (-std::f64::consts::TAU * plan.derivative_cutoff_hz / SAMPLING_HZ).exp();
    assert!((smoothing - SMOOTHING).abs() < 1e-15, "{smoothing}");
    for (load, payload) in [(Load::Unloaded, false), (Load::Loaded, true)] {
        let mut smallest = [f64::INFINITY; 4];
        for run in plan.runs.iter().filter(|run| run.payload == payload) {
            let found = actuator_inertias(robot.model(), plan, run).unwrap();
            for (smallest, found) in smallest.iter_mut().zip(found) {
                *smallest = smallest.min(found);
            }
        }
        // Rounded down, so that every mode stays below the bandwidth.
        for (own, most) in load.inertia().iter().zip(smallest) {
            assert!(
                *own <= most && most - own < 1e-3 * most,
                "{load:?}: {smallest:?}"
            );
        }
    }
}
