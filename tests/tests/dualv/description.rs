//! The description of the DualV equals the hand-written reference robot.

use overact_tests::reference::closure::joint_positions;
use overact_tests::reference::robots;
use overact_tests::support::{Failure, conversion, dualv};

#[test]
fn description_and_reference_have_the_same_geometry() -> Result<(), Failure> {
    let by_hand = robots::dualv();
    let described = conversion::reference(&dualv()?.mechanism, by_hand.workspace.clone());
    let distance = conversion::distance(&described, &by_hand);
    assert!(distance < 1e-15, "largest difference {distance:e}");
    Ok(())
}

#[test]
fn the_home_configuration_has_the_working_mode_of_the_reference() -> Result<(), Failure> {
    let by_hand = robots::dualv();
    let expected = joint_positions(&by_hand, &by_hand.home)?;
    let found = &dualv()?.mechanism.home.joints;
    for (at, (found, expected)) in found.iter().zip(&expected).enumerate() {
        // The description's home is closed to 1e-10.
        let gap = (found - expected).abs();
        assert!(gap < 1e-10, "joint {at}: {found} against {expected}");
    }
    Ok(())
}
