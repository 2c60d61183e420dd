//! The search of exciting trajectories.

mod support;

use overact_simulation::{Error, Search, search};
use support::{Robot, mechanisms::DualV, mechanisms::Tripod};

fn dual_v() -> Search {
    Search {
        fundamental_hz: 0.5,
        harmonics: 4,
        amplitude_limits: vec![0.08, 0.08, 0.5],
        candidates: 200,
        samples: 60,
        ..Search::default()
    }
}

#[test]
fn the_found_trajectory_is_reachable_well_conditioned_and_repeatable() {
    let model = Robot::new(DualV);
    let found = search(&model, &dual_v(), &|_| ()).unwrap();
    assert!(found.worst_partition <= 30.0);
    assert!(found.reciprocal_condition > 0.0);
    // Four legs with ia, fv, fs and a platform with m, mx, my, zz: all independent.
    assert_eq!(found.base_parameters.len(), 16);
    assert_eq!(search(&model, &dual_v(), &|_| ()).unwrap(), found);
}

#[test]
fn few_parameters_are_excited_better_than_all() {
    let model = Robot::new(DualV);
    let found = search(&model, &dual_v(), &|_| ()).unwrap();
    let some = Search {
        parameters: vec!["m_platform".into(), "zz_platform".into()],
        ..dual_v()
    };
    let few = search(&model, &some, &|_| ()).unwrap();
    assert_eq!(few.base_parameters, some.parameters);
    assert!(few.reciprocal_condition > found.reciprocal_condition);
}

#[test]
fn a_payload_cannot_be_told_from_the_platform_in_one_run() {
    // Its columns are the platform's, so they depend on earlier ones and are left out.
    let with = Search {
        payload: true,
        amplitude_limits: vec![0.2, 0.2],
        candidates: 20,
        ..dual_v()
    };
    let found = search(&Robot::new(Tripod), &with, &|_| ()).unwrap();
    assert!(found.base_parameters.contains(&"m_platform".to_string()));
    assert!(!found.base_parameters.contains(&"m_payload".to_string()));
}

#[test]
fn impossible_searches_say_why() {
    let model = Robot::new(DualV);
    let tight = Search {
        condition_bound: 1.0,
        candidates: 20,
        ..dual_v()
    };
    assert!(matches!(
        search(&model, &tight, &|_| ()),
        Err(Error::NoTrajectory {
            candidates: 20,
            reachable: 1..
        })
    ));
    let bad = Search {
        amplitude_limits: vec![0.1],
        parameters: vec!["m_9".into()],
        ..dual_v()
    };
    let Err(Error::Experiment(problems)) = search(&model, &bad, &|_| ()) else {
        panic!()
    };
    assert_eq!(problems.len(), 2);
}
