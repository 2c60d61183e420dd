//! Limits of motors as limits of joints.

use super::random::Random;
use overact::transmission::{Error, Interval, Transmission};

#[test]
fn a_factor_reaches_a_limit_and_exceeds_none() -> Result<(), Error> {
    let mut random = Random(8);
    for _ in 0..50 {
        let jacobian: [[f64; 3]; 4] = std::array::from_fn(|_| random.row());
        let own = Transmission::new(&jacobian)?;
        let limits: [Interval; 4] = std::array::from_fn(|_| Interval {
            least: -random.uniform(),
            most: random.uniform(),
        });
        let direction: [f64; 3] = random.row();
        let uses = |numbers: [f64; 4]| {
            let used = numbers
                .iter()
                .zip(&limits)
                .map(|(number, limit)| (number / limit.most).max(number / limit.least));
            used.fold(0.0, f64::max)
        };
        let factor = own.speed_factor(&direction, &limits)?;
        let speeds = own.motor_velocities(&direction.map(|x| factor * x))?;
        assert!((uses(speeds) - 1.0).abs() < 1e-12);
        let factor = own.torque_factor(&direction, &limits)?;
        let torques = own.motor_torques(&direction.map(|x| factor * x))?;
        assert!((uses(torques) - 1.0).abs() < 1e-12);
        // An interval has the factors along an axis, in both directions.
        let intervals = [
            own.speed_intervals(&limits)?,
            own.torque_intervals(&limits)?,
        ];
        for joint in 0..3 {
            let axis = |sign: f64| std::array::from_fn(|i| if i == joint { sign } else { 0.0 });
            let ahead = [
                own.speed_factor(&axis(1.0), &limits)?,
                own.torque_factor(&axis(1.0), &limits)?,
            ];
            let back = [
                own.speed_factor(&axis(-1.0), &limits)?,
                own.torque_factor(&axis(-1.0), &limits)?,
            ];
            for ((interval, ahead), back) in intervals.iter().zip(ahead).zip(back) {
                assert!((interval[joint].most - ahead).abs() < 1e-12 * ahead);
                assert!((interval[joint].least + back).abs() < 1e-12 * back);
            }
        }
    }
    Ok(())
}

#[test]
fn motors_without_a_limit_limit_nothing() -> Result<(), Error> {
    let own = Transmission::new(&[[1.0, 0.0], [0.0, 1.0]])?;
    let limits = [Interval::symmetric(2.0), Interval::symmetric(f64::INFINITY)];
    assert_eq!(own.speed_factor(&[0.0, 1.0], &limits)?, f64::INFINITY);
    assert_eq!(own.speed_factor(&[1.0, 1.0], &limits)?, 2.0);
    Ok(())
}
