//! Rate of false alarms and delay of detection of the change test.

use super::random::Random;
use overact::online::{Change, ChangeTest, Error, Whitening};
use overact_tier::by_tier;

#[test]
fn false_alarms_have_the_stated_rate() {
    for (shift, samples) in [(1.0, 200.0), (2.0, 1000.0), (0.5, 500.0)] {
        let mut test = ChangeTest::new(shift, samples).unwrap();
        let mut random = Random(11);
        let count = by_tier([200_000, 20_000_000]);
        let alarms = (0..count)
            .filter(|_| test.update(random.normal()).is_some())
            .count();
        let found = f64::from(count) / alarms as f64;
        println!("shift {shift}: {found:.0} samples between false alarms, stated {samples}");
        assert!(found > 0.8 * samples && found < 1.3 * samples, "{found}");
    }
}

#[test]
fn shifts_are_detected_with_their_sign() {
    for (mean, expected) in [(1.0, Change::Increase), (-1.0, Change::Decrease)] {
        let mut test = ChangeTest::new(1.0, 1e6).unwrap();
        let mut random = Random(12);
        let found = (0..200).find_map(|step| {
            let change = test.update(mean + random.normal())?;
            Some((step, change))
        });
        let (delay, change) = found.unwrap();
        assert_eq!(change, expected);
        assert!(delay < 60, "{delay}");
    }
}

#[test]
fn single_outliers_are_not_detected_as_changes() {
    let mut test = ChangeTest::new(1.0, 1e6).unwrap();
    for outlier in [1e300, -1e300, f64::NAN, f64::INFINITY] {
        assert_eq!(test.update(outlier), None);
        test.reset();
    }
}

#[test]
fn settings_out_of_range_are_errors() {
    for (shift, samples) in [
        (0.0, 1e3),
        (f64::NAN, 1e3),
        (1.0, 1.0),
        (1.0, f64::INFINITY),
    ] {
        let error = ChangeTest::new(shift, samples).unwrap_err();
        assert!(matches!(error, Error::Setting { .. }));
    }
    assert!(ChangeTest::<f32>::new(1.0, 1e6).is_ok());
}

#[test]
fn whitened_innovations_have_the_stated_false_alarm_rate() {
    let samples = 1000.0;
    for correlation in [0.9, -0.5] {
        let mut random = Random(13);
        let mut alarms = [0; 2];
        let mut tests = [ChangeTest::new(1.0, samples).unwrap(); 2];
        let (mut whitening, mut state) = (Whitening::new(), 0.0);
        let count = by_tier([200_000, 5_000_000]);
        for _ in 0..count {
            let scale = f64::sqrt(1.0 - correlation * correlation);
            state = correlation * state + scale * random.normal();
            let white = whitening.update(state);
            for ((test, number), alarms) in tests.iter_mut().zip([state, white]).zip(&mut alarms) {
                *alarms += u32::from(test.update(number).is_some());
            }
        }
        let found = f64::from(count) / f64::from(alarms[1]);
        println!("correlation {correlation}: {found:.0} samples, {alarms:?} alarms");
        assert!(found > 0.6 * samples && found < 1.6 * samples, "{found}");
        // Without whitening the rate would be off by far for positive correlation.
        assert!(correlation < 0.0 || alarms[0] > 10 * alarms[1]);
    }
}
