//! Singular poses, ambiguous gains and invalid numbers.

use overact::transmission::{Error, Interval, Transmission};

#[test]
fn a_singular_pose_is_refused_in_both_precisions() {
    let double = [[1.0, 2.0], [0.5, 1.0 + 1e-12]];
    let Err(Error::Singular { condition }) = Transmission::new(&double) else {
        panic!("a singular Jacobian");
    };
    assert!(condition > 1e11, "{condition:e}");
    let single = [[1.0_f32, 2.0], [0.5, 1.0 + 1e-6]];
    assert!(matches!(
        Transmission::new(&single),
        Err(Error::Singular { .. })
    ));
    assert!(Transmission::new(&[[1.0_f64, 2.0], [0.5, 1.0 + 1e-6]]).is_ok());
    // A joint that no motor moves, and fewer motors than joints.
    for jacobian in [[[1.0, 0.0], [2.0, 0.0]], [[0.0; 2]; 2]] {
        assert!(matches!(
            Transmission::new(&jacobian),
            Err(Error::Singular { .. })
        ));
    }
    assert!(matches!(
        Transmission::new(&[[1.0, 0.5]]),
        Err(Error::Singular { .. })
    ));
}

/// Metres and millimetres have the same condition number.
#[test]
fn the_condition_number_does_not_depend_on_units() -> Result<(), Error> {
    let metres = Transmission::new(&[[1.0, 0.3], [0.2, 1.0], [0.1, -0.4]])?;
    let other = Transmission::new(&[[1e-3, 0.3], [2e-4, 1.0], [1e-4, -0.4]])?;
    assert!((metres.condition() / other.condition() - 1.0_f64).abs() < 1e-12);
    let orthogonal = Transmission::new(&[[3.0, 0.0], [0.0, 0.1]])?;
    assert!((orthogonal.condition() - 1.0_f64).abs() < 1e-15);
    Ok(())
}

#[test]
fn a_pose_beyond_a_singularity_is_in_another_mode() -> Result<(), Error> {
    let home = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
    let near = Transmission::new(&[[0.7, 0.1], [0.9, -0.1]])?;
    assert_eq!(near.in_mode_of(&home), Ok(()));
    let beyond = Transmission::new(&[[0.7, -0.1], [0.9, 0.1]])?;
    assert_eq!(beyond.in_mode_of(&home), Err(Error::AnotherMode));
    Ok(())
}

#[test]
fn motors_that_act_alike_have_no_unique_gains() -> Result<(), Error> {
    let own = Transmission::new(&[[1.0, 0.0], [0.0, 1.0], [2.0, 0.0]])?;
    let found = own.diagonal_motor_gains(&[[1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(found, Err(Error::Ambiguous));
    // Four motors and two joints: three numbers do not determine four gains.
    let own = Transmission::new(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -2.0]])?;
    let found = own.diagonal_motor_gains(&[[1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(found, Err(Error::Ambiguous));
    Ok(())
}

#[test]
fn invalid_numbers_are_named() -> Result<(), Error> {
    let broken = Transmission::new(&[[f64::NAN, 0.0], [0.0, 1.0]]);
    let input = "jacobian";
    assert_eq!(broken, Err(Error::NotFinite { input }));
    let own = Transmission::new(&[[1.0, 0.0], [0.0, 1.0]])?;
    let input = "motor_torques";
    assert_eq!(
        own.joint_torques(&[f64::INFINITY, 0.0]),
        Err(Error::NotFinite { input })
    );
    let sum = Transmission::new(&[[1.0, 1.0], [1.0, -1.0]])?;
    assert_eq!(sum.motor_velocities(&[f64::MAX; 2]), Err(Error::Overflow));
    let limits = [
        Interval {
            least: 0.1,
            most: 1.0,
        },
        Interval::symmetric(1.0),
    ];
    assert!(matches!(
        own.speed_intervals(&limits),
        Err(Error::Setting { .. })
    ));
    let nan = [Interval::symmetric(f64::NAN); 2];
    assert!(matches!(
        own.torque_intervals(&nan),
        Err(Error::Setting { .. })
    ));
    let good = [Interval::symmetric(1.0); 2];
    assert!(matches!(
        own.torque_factor(&[0.0; 2], &good),
        Err(Error::Setting { .. })
    ));
    let all = [
        Error::NotFinite { input },
        Error::Singular { condition: 1e12 },
        Error::Singular {
            condition: f64::INFINITY,
        },
        Error::AnotherMode,
        Error::Ambiguous,
        Error::Setting {
            setting: "direction",
            condition: "different from zero",
        },
        Error::Overflow,
    ];
    let mut texts = all.map(|error| error.to_string());
    texts.sort();
    assert!(texts.windows(2).all(|pair| pair[0] != pair[1]));
    Ok(())
}
