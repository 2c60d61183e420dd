// Part of a library without standard library, which `tests/panics.rs` links.

use overact::StandardParameter;
use overact::float::Float;
use overact::online::{
    ChangeTest, Error, Filter, Forgetting, Innovation, PayloadEstimator, PayloadSize, SliceFilter,
    StateVariableFilter, Whitening,
};
use overact::transmission::{self, Interval, Transmission, curvature};

/// Numbers from the caller, which the compiler does not know.
#[repr(C)]
pub struct Numbers<T> {
    jacobian: [[T; 3]; 4],
    joints: [T; 3],
    motors: [T; 4],
    gains: [[T; 3]; 3],
    limits: [[T; 2]; 4],
    rows: [[T; 3]; 2],
    inertial: [[T; 10]; 2],
    number: T,
    index: usize,
}

fn transmissions<T: Float>(given: &Numbers<T>) -> Result<T, transmission::Error> {
    let one = Transmission::new(&given.jacobian)?;
    let (joints, motors) = (&given.joints, &given.motors);
    let limits = given.limits.map(|[least, most]| Interval { least, most });
    let second = curvature(|twist| one.motor_velocities(twist))?;
    one.in_mode_of(&Transmission::new(&given.jacobian)?)?;
    let mut sum = one.condition() + one.inverse()[0][0] + one.jacobian()[0][0];
    let all_motors = [
        one.motor_velocities(joints)?,
        one.motor_accelerations(joints, motors)?,
        one.motor_torques(joints)?,
        one.diagonal_motor_gains(&given.gains)?,
        one.motor_gains(&given.gains)?[1],
        one.motor_stiffness(&given.gains, motors, &second)?[2],
    ];
    let all_joints = [
        one.joint_velocities(motors)?,
        one.joint_accelerations(motors, motors)?,
        one.joint_torques(motors)?,
        one.reflected_inertia(motors)?[0],
        one.joint_gains(motors)?[1],
        one.joint_stiffness(motors, motors, &second)?[2],
    ];
    for number in all_motors
        .as_flattened()
        .iter()
        .chain(all_joints.as_flattened())
    {
        sum += *number;
    }
    for interval in one
        .speed_intervals(&limits)?
        .iter()
        .chain(&one.torque_intervals(&limits)?)
    {
        sum += interval.least + interval.most;
    }
    Ok(sum + one.speed_factor(joints, &limits)? + one.torque_factor(joints, &limits)?)
}

fn estimators<T: Float>(given: &Numbers<T>) -> Result<T, Error> {
    let Numbers {
        joints,
        rows,
        number,
        index,
        ..
    } = *given;
    let sigma = [number; 2];
    let mut filter =
        Filter::new(joints, given.gains)?.with_forgetting(Forgetting::Directional(number))?;
    let other = Filter::from_covariance(joints, given.gains)?;
    filter.update_block(&rows, &[number; 2], &sigma)?;
    filter.update(&joints, number, number)?;
    let mut innovations = [Innovation::default(); 2];
    filter.update_slices(
        rows.get(..index).unwrap_or(&rows),
        &sigma,
        &sigma,
        &mut innovations,
    )?;
    filter.discount(number)?;
    let covariance = filter.covariance()?;
    let mut sum = covariance[0][1] + filter.estimate()?[0] + other.standard_deviations()?[1];
    sum += filter.residual_deviation().unwrap_or(T::ZERO);

    let (mut factor, mut vectors) = ([T::ZERO; 9], [T::ZERO; 12]);
    let square_root = given.gains.as_flattened();
    let mut slices = SliceFilter::with_prior(&mut factor, &mut vectors, &joints, square_root)?;
    slices.set_forgetting(Forgetting::Exponential(number))?;
    slices.update(&joints, number, number)?;
    let state = slices.state();
    let mut slices = SliceFilter::resume(&mut factor, &mut vectors, state)?;
    slices.update_block(rows.as_flattened(), &sigma, &sigma, &mut innovations)?;
    slices.discount(number)?;
    let (mut values, mut deviations, mut all) = ([T::ZERO; 3], [T::ZERO; 3], [T::ZERO; 9]);
    slices.estimate(&mut values)?;
    slices.standard_deviations(&mut deviations)?;
    slices.determined(&mut values, &mut deviations)?;
    slices.covariance(&mut all)?;
    sum += values[0] + deviations[1] + all[5] + innovations[1].normalised;

    let size = PayloadSize {
        mass: number,
        length: number,
    };
    let mut payload = PayloadEstimator::new(StandardParameter::INERTIA, size)?
        .with_forgetting(Forgetting::Exponential(number))?;
    payload.update(&given.inertial, &sigma, &sigma)?;
    payload.update_slices(&given.inertial, &sigma, &sigma, &mut innovations)?;
    payload.discount(number)?;
    sum += payload.payload()?.inertia[0][1];

    let mut test = ChangeTest::new(number, number)?;
    let mut whitening = Whitening::new();
    if test.update(whitening.update(number)).is_some() {
        test.reset();
    }
    let mut signals = StateVariableFilter::<3, T>::new(number, number)?;
    signals.restart(number);
    Ok(sum + signals.update(number)?.acceleration + signals.delay())
}

#[unsafe(no_mangle)]
pub extern "C" fn transmissions_of_doubles(given: &Numbers<f64>) -> f64 {
    transmissions(given).unwrap_or(0.0)
}

#[unsafe(no_mangle)]
pub extern "C" fn transmissions_of_singles(given: &Numbers<f32>) -> f32 {
    transmissions(given).unwrap_or(0.0)
}

#[unsafe(no_mangle)]
pub extern "C" fn estimators_of_doubles(given: &Numbers<f64>) -> f64 {
    estimators(given).unwrap_or(0.0)
}

#[unsafe(no_mangle)]
pub extern "C" fn estimators_of_singles(given: &Numbers<f32>) -> f32 {
    estimators(given).unwrap_or(0.0)
}
