use super::{Kinds, Powers, Quantity, Range, UnitError, explanation, time_of_sampling};

const BOTH: Kinds = Kinds {
    revolute: true,
    prismatic: true,
};

fn quantity(value: f64, possible: Range, usual: Range, powers: [i32; 3]) -> Quantity {
    let [time, positions, torques] = powers;
    Quantity {
        name: String::from("a quantity"),
        value,
        unit: "",
        possible,
        usual,
        powers: Powers {
            time,
            positions,
            torques,
        },
        is_by_weight: false,
    }
}

/// Sampling frequency (Hz), acceleration of the tip (m/s²) and density (kg/m³) of a log.
fn quantities(sampling: f64, acceleration: f64, density: f64) -> Vec<Quantity> {
    let any = Range::new(0.0, f64::INFINITY);
    vec![
        quantity(sampling, any, Range::new(100.0, 2e4), [-1, 0, 0]),
        quantity(
            acceleration,
            Range::new(0.0, 2000.0),
            Range::new(0.05, 300.0),
            [-2, 1, 0],
        ),
        quantity(
            density,
            Range::new(0.0, 2e4),
            Range::new(0.5, 3e3),
            [2, -1, 1],
        ),
    ]
}

fn unit(quantities: &[Quantity], is_single: bool) -> Option<&'static str> {
    explanation(quantities, BOTH, is_single).map(|unit_error: &UnitError| unit_error.unit)
}

#[test]
fn masses_that_gravity_determines_do_not_hide_a_unit_of_time() {
    // In milliseconds the motion is quasi-static, and a mass of usual density is weighed.
    let mut quantities = quantities(1.0, 6e-6, 6.0);
    quantities[1].possible.low = 1e-3;
    quantities[2].possible.low = 0.01;
    assert_eq!(unit(&quantities, false), None);
    quantities[2].is_by_weight = true;
    assert_eq!(unit(&quantities, false), Some("milliseconds"));
}

#[test]
fn the_unit_that_makes_all_quantities_plausible_is_found() {
    let (sampling, acceleration, density) = (2e3, 5.0, 40.0);
    let time = |factor: f64| {
        quantities(
            sampling / factor,
            acceleration / factor.powi(2),
            density * factor.powi(2),
        )
    };
    assert_eq!(unit(&time(1e3), false), Some("milliseconds"));
    assert_eq!(unit(&time(1e6), false), Some("microseconds"));
    assert_eq!(unit(&time(1e9), false), Some("nanoseconds"));
    assert_eq!(unit(&time(1.0 / 60.0), false), Some("minutes"));
    let torques = quantities(sampling, acceleration, density * 1e3);
    assert_eq!(unit(&torques, false), Some("mN m (or mN, mA)"));
    let positions = quantities(sampling, acceleration * 1e3, density / 1e3);
    // Degrees make these quantities usual, too, and come first.
    assert_eq!(unit(&positions, false), Some("degrees"));
}

#[test]
fn plausible_quantities_have_no_unit_error() {
    assert_eq!(unit(&quantities(2e3, 5.0, 40.0), false), None);
    // A quantity that no unit makes possible.
    let nowhere = [quantity(
        5.0,
        Range::new(0.0, 1.0),
        Range::new(0.0, 1.0),
        [0, 0, 0],
    )];
    assert_eq!(unit(&nowhere, false), None);
}

#[test]
fn time_units_are_common_to_all_drives() {
    let slow = quantities(2.0, 5e-6, 4e7);
    assert_eq!(unit(&slow, false), Some("milliseconds"));
    assert_ne!(unit(&slow, true), Some("milliseconds"));
}

#[test]
fn low_sampling_frequencies_reveal_the_unit_of_time() {
    let unit =
        |frequency, cutoff| time_of_sampling(frequency, cutoff).map(|unit_error| unit_error.unit);
    assert_eq!(unit(2.0, 100.0), Some("milliseconds"));
    assert_eq!(unit(0.002, 100.0), Some("microseconds"));
    assert_eq!(unit(2e-6, 100.0), Some("nanoseconds"));
    assert_eq!(unit(90.0, 1e6), None);
}
