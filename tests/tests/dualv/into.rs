//! Functions that write into a caller's matrix.

use overact::block::array;
use overact_compiled::DualV;
use overact_tests::reference::robots;
use overact_tests::support::expected::Expected;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, dualv};

/// States of the comparison.
const STATES: usize = 20;

/// A function returns the numbers that its `into` variant writes, and the latter writes all of
/// them.
macro_rules! the_same {
    ($sample:ident: $($function:ident, $into:ident($($argument:ident),*);)*) => {$(
        let given = DualV::$function($(array($sample.input(stringify!($argument))?)?),*)?;
        let mut written = given.map(|row| row.map(|_| f64::NAN));
        DualV::$into($(array($sample.input(stringify!($argument))?)?,)* &mut written)?;
        assert_eq!(written, given, stringify!($function));
    )*};
}

#[test]
fn into_functions_write_what_the_others_return() -> Result<(), Failure> {
    let expected = Expected::new(dualv()?, robots::dualv())?;
    for sample in samples(&robots::dualv(), &expected.parameters(), STATES, 29, true)? {
        the_same! { sample:
            idm_red_platform, idm_red_platform_into(pose, twist, acceleration);
            idm_red_platform_from_joints, idm_red_platform_from_joints_into(pose, joints, twist, acceleration);
            idm_red_platform_from_actuators, idm_red_platform_from_actuators_into(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_platform_base, idm_red_platform_base_into(pose, twist, acceleration);
            idm_red_actuators, idm_red_actuators_into(pose, twist, acceleration);
            idm_red_actuators_base_from_joints, idm_red_actuators_base_from_joints_into(pose, joints, twist, acceleration);
            idm_red_payload, idm_red_payload_into(pose, twist, acceleration);
            idm_red_payload_actuators, idm_red_payload_actuators_into(pose, twist, acceleration);
        }
    }
    Ok(())
}

#[test]
fn into_functions_return_the_errors_of_the_others() {
    let still = [0.0; DualV::DOF];
    let mut written = [[0.0; DualV::PARAMETERS.len()]; DualV::DOF];
    let (far, none) = ([9.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]);
    for pose in [far, none] {
        let given = DualV::idm_red_platform(&pose, &still, &still).err();
        let done = DualV::idm_red_platform_into(&pose, &still, &still, &mut written).err();
        assert!(given.is_some() && done == given, "{done:?} and {given:?}");
    }
}
