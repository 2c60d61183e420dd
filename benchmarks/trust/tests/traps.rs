//! Every trap of the DualV: verdicts on data with one known fault.
//!
//! It takes some forty identifications, so only the full tier runs it;
//! `identification/tests/bad_data.rs` tests the clearest faults in either tier.

use overact_identification::Grade;
use overact_tier::{is_full, of_many};
use overact_trust::{
    Subject,
    traps::{Standing, identified, outcome, prepared, traps},
};
use std::path::Path;

/// Faults with a usable result: no data can reveal them, or they are harmless.
const USED: [&str; 5] = [
    "sampling frequency 5 % too high",
    "all gains 5 % high",
    "torque of drive 1 zero for 1 % of the time",
    "a collision at drive 1, for 1 % of the time",
    "encoders of 12 bits",
];

/// Known misses: faults that no check names, and their largest error in standard deviations.
const MISSED: [(&str, f64); 1] = [("encoders of 12 bits", 3.1)];

/// Fraction of each run's duration, as in `docs/traps.md`.
const PART: f64 = 0.25;

#[test]
fn every_dualv_trap_is_refused_reported_or_a_listed_assumption() {
    if !is_full() {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/dualv.toml");
    let mut subject = Subject::load(&path).expect("the DualV");
    subject.shorten(PART);
    let records = prepared(&subject, &subject.experiment).expect("records");
    let faultless = identified(&subject, records.clone()).expect("an identification");
    assert_eq!(faultless.grade(), Grade::Use);
    for trap in of_many(traps(subject.info().name)) {
        let mut own = records.clone();
        if !trap.plant.is_empty() {
            let mut plant = Subject::altered(&path, &trap.plant).expect("the DualV");
            plant.shorten(PART);
            own = prepared(&plant, &plant.experiment).expect("records");
        }
        (trap.alter)(&mut own);
        let result = outcome(&subject, &trap, own, &faultless);
        let used = result.grade == Some(Grade::Use);
        assert_eq!(used, USED.contains(&trap.name.as_str()), "{result:?}");
        let known = MISSED.iter().find(|(name, _)| *name == trap.name);
        let error = result.worst_listed.as_ref().map_or(0.0, |(size, _)| *size);
        let is_known = known.is_some_and(|(_, most)| error < *most);
        assert!(
            is_known || result.standing() != Standing::Missed,
            "{result:?}"
        );
    }
}
