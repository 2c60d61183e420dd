//! The power of the motors is the rate of change of the energy, for every robot of `robots/`.
//!
//! Energy comes from positions and velocities and is differentiated along a path through the state.
//! Torques and actuator velocities come from the compiled functions and from evaluation, without
//! friction. Seven-point differences over 0.3 ms, less for fast joints, leave about 1e-11 of the
//! largest power.

use nalgebra::{DMatrix, DVector};
use overact::Model;
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::trajectory;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Backend, Evaluated, Failure, Sample, Served};
use overact_tier::by_tiers;

const TOLERANCE: f64 = 1e-9;
/// Rounding of the energy in its differences, in units of the last place.
const ROUNDING: f64 = 16.0;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [6, 40, 200];

overact_tests::library!(balance);

fn balance(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let backends: [&dyn Backend; 2] = [&Served(compiled), &Evaluated(model)];
    let mut worst = [0.0_f64; 2];
    let columns = expected.parameters();
    let least = expected.mechanism.least_tensions();
    let pulls: Vec<bool> = least.iter().map(Option::is_some).collect();
    let all = samples(&expected.mechanism, &columns, by_tiers(STATES), 17, false)?;
    for sample in all {
        let (sample, chi) = without_friction(expected, &sample);
        let energy =
            |state: &_| DVector::from_element(1, total_energy(&expected.mechanism, state, &chi));
        let (change, _) = trajectory::derivatives(&expected.mechanism, &sample.state, energy)?;
        // Near standstill the power is smaller than the rounding of energy differences.
        let step = trajectory::step(&sample.state);
        let rounding = ROUNDING * f64::EPSILON * energy(&sample.state)[0].abs() / step;
        for (worst, backend) in worst.iter_mut().zip(&backends) {
            let torques = backend.call("inverse_dynamics", &sample)?;
            let rates = backend.call("inverse_jacobian", &sample)? * twist(&sample);
            // A tension pulls against the length of its cable.
            let forces = DMatrix::from_fn(torques.nrows(), 1, |i, _| {
                if pulls[i] { -torques[i] } else { torques[i] }
            });
            let powers = forces.component_mul(&rates);
            let scale = powers.abs().sum().max(change[0].abs());
            *worst = worst.max(((powers.sum() - change[0]).abs() - rounding).max(0.0) / scale);
        }
    }
    println!(
        "{stem}: compiled {:.1e}, evaluated {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst.iter().all(|w| *w < TOLERANCE), "{stem}: {worst:?}");
    Ok(())
}

fn twist(sample: &Sample) -> DMatrix<f64> {
    let twist = &sample.state.twist;
    DMatrix::from_column_slice(twist.len(), 1, twist.as_slice())
}

/// The sample with frictionless parameters, and these in the reference's order.
fn without_friction(expected: &Expected, sample: &Sample) -> (Sample, DVector<f64>) {
    let chi = frictionless(&expected.mechanism, &sample.all_parameters);
    let parameters = expected.parameters().iter().map(|&at| chi[at]).collect();
    let sample = Sample {
        parameters,
        ..sample.clone()
    };
    (sample, chi)
}
