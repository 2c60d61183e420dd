//! Errors in the tables about experiments, data and identification.

use super::{good, listed, single};
use crate::diagnostic::Source;
use crate::{Clock, Factor, parse_parameters};

/// The errors of a robot of one joint with these tables, which start at line 2.
fn errors(tables: &str) -> Vec<String> {
    listed(&single(tables, ""))
}

#[test]
fn invalid_experiment_settings_are_rejected() {
    let tables = r#"[experiment]
sampling = "5 s"
duration = 0
bandwith = 3
encoder = [1, 2]
torque_limit = "127 N"
encoder_delay = "-1 ms"
[experiment.drives]
gain = [1, 2]
cogging = "0.3 N"
flexible_stiffness = "10 N/m"
back_emf = 1
[experiment.parameters]
zz_1 = "1 kg m"
zz_2 = 1
fv_1 = "0.1 N m s"
fs_1 = "0.1 N m s"
[[experiment.run]]
payload = true
fundamental = "1 Hz"
terms = [
  { coordinate = "2", harmonic = 0, amplitude = 1 },
  { coordinate = "1", harmonic = 1, amplitude = "1 m" },
]
[[experiment.run]]
name = "a"
[[experiment.run]]
name = "a"
fundamental = 1
terms = []
"#;
    let expected = [
        "3:12 `sampling`: expected a frequency (Hz), found a time (5 s)",
        "4:12 `duration`: expected a value greater than 0, found 0",
        "5:1 unknown key `bandwith`; did you mean `bandwidth`?",
        "6:11 `encoder`: expected one value or 1, one for each actuator, found 2",
        "7:16 `torque_limit`: expected a torque (N m), found a force (127 N)",
        "8:17 `encoder_delay`: expected a value at least 0, found -0.001 s",
        "10:8 `gain`: expected one value or 1, one for each actuator, found 2",
        "11:11 `cogging`: expected a torque (N m), found a force (0.3 N)",
        "12:22 `flexible_stiffness`: expected a stiffness (N m/rad), found a stiffness (10 N/m)",
        "13:1 unknown key `back_emf`; known keys: gain, delay, current_bandwidth, cogging, cogging_periods, flexible_frequency, flexible_damping, flexible_stiffness",
        "15:8 `zz_1`: expected a moment of inertia (kg m^2), found a first moment of mass (1 kg m)",
        "16:1 the robot has no parameter `zz_2`; did you mean `zz_1`?",
        "18:8 `fs_1`: expected a torque (N m), found a quantity in m^2 kg s^-1 (0.1 m^2 kg s^-1)",
        "19:1 a run has no `name`; for instance name = \"unloaded 1\"",
        "20:11 the robot has no payload; describe it as a joint of type \"fixed\" with the name `payload` on the last body",
        "23:18 the robot has no coordinate `2`; its coordinates are 1",
        "23:34 `harmonic`: expected an integer of at least 1, found 0",
        "24:49 `amplitude`: expected an angle (rad), found a length (1 m)",
        "26:1 a run has no `fundamental`; fundamental = \"0.1 Hz\", the frequency of the first harmonic",
    ];
    let found = errors(tables);
    for line in expected {
        assert!(found.iter().any(|f| f == line), "{line}\nnot in {found:#?}");
    }
    assert_eq!(found.len(), expected.len() + 1, "{found:#?}");
}

#[test]
fn invalid_excitation_settings_are_rejected() {
    let tables = r#"[excitation]
fundamental = "1 s"
harmonics = 31
runs = 0
position = [1, 2]
travel = "1 m"
velocity = "3 m/s"
acceleration = 0
condition = 0.5
amplitude = 1
"#;
    let expected = [
        "3:15 `fundamental`: expected a frequency (Hz), found a time (1 s)",
        "4:13 `harmonics`: expected at most 30, found 31",
        "5:8 `runs`: expected an integer of at least 1, found 0",
        "6:12 `position`: expected one value or 1, one for each coordinate, found 2",
        "7:10 `travel`: expected an angle (rad), found a length (1 m)",
        "8:12 `velocity`: expected an angular speed (rad/s), found a speed (3 m/s)",
        "9:16 `acceleration`: a limit of 0 leaves no motion; leave the key out if there is no limit",
        "10:13 a condition number can't be 0.5; it is at least 1; 10 is far from singular",
        "11:1 unknown key `amplitude`; known keys: position, condition, fundamental, harmonics, runs, travel, velocity, acceleration",
    ];
    let mut found = errors(tables);
    found.sort_by_key(|line| line.split(':').next().and_then(|n| n.parse::<u32>().ok()));
    assert_eq!(found, expected);
}

#[test]
fn incomplete_data_tables_are_rejected() {
    let found = errors("[data]\ntime = 1\npositions = [\"a\", \"b\"]\ntorque_gain = [0]");
    let expected = [
        "2:1 the table `[data]` has no `torques`; give one column for each actuator",
        "3:8 `time`: expected a string, found an integer",
        "4:13 `positions`: expected 1 entries, one for each actuator, found 2",
        "5:16 a factor of 0 loses the signal",
    ];
    assert_eq!(found, expected);
}

#[test]
fn torque_gains_need_the_unit_of_the_joint_type() {
    let columns = "[data]\ntime = \"t\"\npositions = [\"q\"]\ntorques = [\"i\"]\n";
    let found = |gain: &str| errors(&format!("{columns}torque_gain = {gain}"));
    for good in [
        "\"35 Nm/V\"",
        "[\"0.2 N m/A\"]",
        "3.5",
        "\"k\"",
        "\"1 mNm\"",
    ] {
        assert_eq!(found(good), Vec::<String>::new(), "{good}");
    }
    for bad in ["\"35 N/V\"", "[\"2 N/A\"]", "\"1 N\""] {
        let found = found(bad);
        assert_eq!(found.len(), 1, "{bad}: {found:?}");
        let expected = "`torque_gain`: the column of a revolute joint becomes a torque (N m), this makes a force (N) of it";
        assert!(found[0].contains(expected), "{found:?}");
    }
    let speed = found("\"3 rpm\"");
    assert_eq!(speed.len(), 1, "{speed:?}");
    assert!(
        speed[0].contains("this makes an angular speed (rad/s) of it"),
        "{speed:?}"
    );
}

#[test]
fn position_scales_need_the_unit_of_the_joint_type() {
    let columns = "[data]\ntime = \"t\"\npositions = [\"q\"]\ntorques = [\"i\"]\n";
    let found = |scale: &str| errors(&format!("{columns}position_scale = {scale}"));
    for good in [
        "\"1 deg\"",
        "[0.5]",
        "\"2*pi / 4096 * 1 rad\"",
        "\"0.3 rad/V\"",
    ] {
        assert_eq!(found(good), Vec::<String>::new(), "{good}");
    }
    for (bad, made) in [
        ("\"1 mm\"", "a length (m)"),
        ("[\"1 kg\"]", "a mass (kg)"),
        ("\"1 rad/s\"", "an angular speed (rad/s)"),
    ] {
        let found = found(bad);
        assert_eq!(found.len(), 1, "{bad}: {found:?}");
        let expected = format!(
            "`position_scale`: the column of a revolute joint becomes an angle (rad), this makes {made} of it"
        );
        assert!(found[0].contains(&expected), "{found:?}");
    }
    assert_eq!(found("\"1 foot\"").len(), 1);
}

#[test]
fn logs_need_a_time_column_or_a_sampling_frequency() {
    let columns = "positions = [\"$1\"]\ntorques = [\"$2\"]\n";
    let data = |text: &str| good(&single(text, "")).data.unwrap();
    let sampled = data(&format!("[data]\n{columns}sampling = \"5 kHz\""));
    assert_eq!(sampled.time, Clock::Frequency(5000.0));
    let timed = data(&format!(
        "[data]\n{columns}velocities = [\"$3\"]\ntime = \"t\""
    ));
    assert!(sampled.velocities.is_empty());
    assert_eq!(timed.velocities, ["$3"]);
    assert_eq!(timed.time, Clock::Column("t".to_owned()));
    assert_eq!(
        errors(&format!("[data]\n{columns}")),
        [
            "2:1 the table `[data]` has no `time`; time = \"t\", the column of the time, or sampling = \"1 kHz\" if there is none"
        ]
    );
    assert_eq!(
        errors(&format!("[data]\n{columns}time = \"t\"\nsampling = 1")),
        [
            "6:12 `sampling` is for logs without a column of the time; leave out one of `time` and `sampling`"
        ]
    );
    let zero = errors(&format!("[data]\n{columns}sampling = 0"));
    assert!(zero[0].starts_with("5:12 `sampling`: "), "{zero:?}");
}

#[test]
fn only_logs_with_a_time_column_may_be_resampled() {
    let columns = "positions = [\"$1\"]\ntorques = [\"$2\"]\n";
    let table = |text: &str| format!("[data]\n{columns}{text}");
    let rate = |text: &str| good(&single(&table(text), "")).data.unwrap().resample;
    assert_eq!(rate("time = \"t\""), None);
    assert_eq!(rate("time = \"t\"\nresample = \"1 kHz\""), Some(1000.0));
    assert_eq!(
        errors(&table("sampling = 10\nresample = 5")),
        [
            "6:12 `resample` is for logs with a column of the time; leave out `resample`: without such a column samples are uniform, and `decimation` keeps fewer"
        ]
    );
    let refused =
        |text: &str| errors(&table(&format!("time = \"t\"\nresample = {text}"))).remove(0);
    assert_eq!(
        refused("\"5 s\""),
        "6:12 `resample`: expected a frequency (Hz), found a time (5 s)"
    );
    assert!(
        refused("0").starts_with("6:12 `resample`: "),
        "{}",
        refused("0")
    );
    assert!(
        refused("true").starts_with("6:12 `resample`: "),
        "{}",
        refused("true")
    );
}

#[test]
fn standstill_velocities_need_the_unit_of_the_joint_type() {
    let limits = |text: &str| {
        let tables = format!("[identification]\nstandstill_velocity = {text}");
        good(&single(&tables, ""))
            .identification
            .standstill_velocity
    };
    assert_eq!(limits("\"5 deg/s\""), [5_f64.to_radians()]);
    assert_eq!(limits("[0.1]"), [0.1]);
    let refused = |text: &str| errors(&format!("[identification]\nstandstill_velocity = {text}"));
    assert_eq!(
        refused("[1, 2]"),
        ["3:23 `standstill_velocity`: expected 1 entries, one for each actuator, found 2"]
    );
    assert_eq!(
        refused("-1"),
        ["3:23 `standstill_velocity`: expected a value at least 0, found -1"]
    );
    let speed = refused("\"1 m/s\"");
    assert!(speed[0].contains("expected an angular speed"), "{speed:?}");
}

#[test]
fn torques_and_equations_are_not_filtered_twice() {
    let of = |text: &str| good(&single(&format!("[identification]\n{text}"), "")).identification;
    assert!(!of("").filter_equations && of("filter_equations = true").filter_equations);
    assert!(of("filter_torques = true\nfilter_equations = false").filter_torques);
    let both = errors("[identification]\nfilter_equations = true\nfilter_torques = true");
    assert_eq!(
        both,
        [
            "3:20 with `filter_torques` the torques would be filtered twice; `filter_equations` filters \
             torques and columns alike; leave out `filter_torques`"
        ]
    );
    let word = errors("[identification]\nfilter_equations = 6");
    assert!(word[0].starts_with("3:20 `filter_equations`: "), "{word:?}");
}

#[test]
fn scale_factors_are_numbers_expressions_or_variables() {
    let tables = "[constants]\nk = \"2 N m/A\"\n[data]\ntime = \"t\"\npositions = [\"q\"]\n\
                  torques = [\"i\"]\nposition_scale = \"1 deg\"\ntorque_gain = [\"k\"]";
    let data = good(&single(tables, "")).data.unwrap();
    assert_eq!(data.position_scale, [1_f64.to_radians()]);
    assert_eq!(data.torque_gain, [Factor::Value(2.0)]);
    assert_eq!(data.position_offset, [0.0]);
    let offset = tables.replace("torque_gain", "position_offset = \"0.5 deg\"\ntorque_gain");
    let data = good(&single(&offset, "")).data.unwrap();
    assert_eq!(data.position_offset, [0.5_f64.to_radians()]);
    let variable = tables.replace("[\"k\"]", "\"gtau\"");
    let data = good(&single(&variable, "")).data.unwrap();
    assert_eq!(data.torque_gain, [Factor::Variable("gtau".to_owned())]);
}

#[test]
fn invalid_identification_settings_are_rejected() {
    let tables = "[identification]\nfilter_order = 0\ndecimation = -1\nr_sigma = 0.5\n\
                  normalisation = \"n\"\nkept_actuators = [\"arn\"]\nweighted = 1\nessental = true";
    let expected = [
        "3:16 `filter_order`: expected an integer of at least 1, found 0",
        "4:14 `decimation`: expected an integer of at least 1, found -1",
        "5:11 `r_sigma` must be greater than 1; choose between 10 and 30",
        "6:17 `normalisation`: expected \"n-1\" or \"n-p\", found \"n\"",
        "7:19 there is no actuator `arn`; the actuators are 1",
        "8:12 `weighted`: expected true or false, found an integer",
        "9:1 unknown key `essental`; did you mean `essential`?",
    ];
    assert_eq!(errors(tables), expected);
}

#[test]
fn kept_actuators_are_resolved_or_rejected() {
    let text = include_str!("../../../robots/dualv.toml");
    let kept = |names: &str| text.replace(r#"["leg1", "leg2", "leg3"]"#, names);
    let robot = good(&kept(r#"["leg4", "leg2.1", "leg1"]"#));
    assert_eq!(robot.identification.kept_actuators, Some(vec![3, 1, 0]));
    let found = listed(&kept(r#"["leg4", "leg4", "lag1", "leg2.2"]"#));
    let messages: Vec<_> = found
        .iter()
        .filter_map(|f| f.split_once(' '))
        .map(|(_, m)| m)
        .collect();
    let expected = [
        "`kept_actuators`: expected 3 names, one for each degree of freedom, found 4",
        "the actuator `leg4` is listed twice",
        "there is no actuator `lag1`; did you mean `leg1`?",
        "there is no actuator `leg2.2`; did you mean `leg2`?",
    ];
    assert_eq!(messages, expected);
    let found = listed(&text.replace("zz_1_leg1 =", "zz_1_lag1 ="));
    assert!(
        found
            .concat()
            .ends_with("the robot has no parameter `zz_1_lag1`; did you mean `zz_1_leg1`?")
    );
}

#[test]
fn invalid_priors_are_rejected() {
    let tables = r#"[prior]
value = 1
[prior.values]
zz_1 = "2 kg"
zz_3 = 1
fv_1 = -2
[prior.bounds]
zz_1 = [0, 1]
fv_1 = [3, 1]
fs_1 = [-2, -1]
ia_1 = [1, 2, 3]
ia_2 = [1, 2]
"#;
    let expected = [
        "3:1 unknown key `value`; did you mean `values`?",
        "5:8 `zz_1`: expected a moment of inertia (kg m^2), found a mass (2 kg)",
        "6:1 the robot has no parameter `zz_3`; did you mean `zz_1`?",
        "7:1 a coefficient of friction must be positive, but `fv_1` is not; leave out unknown values: the closest value that the data allow is used",
        "9:8 `zz_1` can't be bounded; masses, friction, rotor inertias and offsets can be",
        "10:8 the smaller bound must be first; write [smallest, largest]",
        "11:8 these bounds exclude positive values of `fs_1`; it can't be negative",
        "12:8 3 numbers are not bounds; write [smallest, largest]",
        "13:1 the robot has no parameter `ia_2`; did you mean `ia_1`?",
    ];
    assert_eq!(errors(tables), expected);
}

#[test]
fn known_values_without_gains_are_warned_about() {
    let text = single("[identification]\nknown = { zz_1 = 0.5 }", "");
    let found = good(&text).warnings;
    assert_eq!(found.len(), 1);
    assert_eq!(&text[found[0].span.clone()], "known");
    assert!(found[0].value.contains("`gains = true`"), "{found:?}");
}

#[test]
fn gain_identification_needs_nonzero_known_parameters() {
    let tables = r#"[identification]
gains = true
[identification.known]
zz_3 = 1
fv_1 = 2
ia_1 = 0
zz_1 = "2 kg"
"#;
    let expected = [
        "3:9 gains are identified relative to known values, and there are none; give the mass of a payload that was weighed: [identification.known] m_payload = \"5 kg\"",
        "5:1 the robot has no parameter `zz_3`; did you mean `zz_1`?",
        "6:1 `fv_1` is friction or an offset, which are never known exactly; give masses, first moments, inertias or springs; friction is identified",
        "7:1 masses and moments of inertia are positive, but `ia_1` is not; leave out unknown values",
        "8:8 `zz_1`: expected a moment of inertia (kg m^2), found a mass (2 kg)",
    ];
    assert_eq!(errors(tables), expected);
    let tables = "[identification]\ngains = true\nknown = { zz_1 = 0.5 }";
    let good = good(&single(tables, ""));
    assert!(good.identification.gains);
    assert_eq!(good.identification.known, [(String::from("zz_1"), 0.5)]);
    assert_eq!(good.warnings, []);
}

#[test]
fn parameter_files_are_read_or_rejected() {
    let description = good(&single("", ""));
    let read = |text: &str| parse_parameters(&Source::new("parameters.toml", text), &description);
    let all = read("[parameters]\nzz_1 = 0.5\nfv_1 = \"0.1 N m s\"\n").expect("good");
    let values: Vec<f64> = all.iter().map(|one| one.value).collect();
    assert_eq!(values, [0.5, 0.1]);
    let own = read("robot = \"Arm\"\n[parameters]\nzz_1 = 0.5").expect("of this robot");
    assert_eq!(own.len(), 1);
    for (text, expected) in [
        ("zz_1 = 0.5", "unknown key `zz_1`"),
        (
            "[parameters]\nzz_9 = 0.5",
            "the robot has no parameter `zz_9`",
        ),
        ("[parameters]\nzz_1 = 1\nzz_1 = 2", "this is not valid TOML"),
        ("parameters = 3", "parameters.toml:1:14"),
        (
            "robot = \"Other\"\n[parameters]\nzz_9 = 0.5",
            "these are the parameters of `Other`, and the robot is `Arm`",
        ),
    ] {
        let errors = read(text).expect_err(text);
        let errors = errors.render_plain(&Source::new("parameters.toml", text));
        assert!(errors.contains(expected), "{text}: {errors}");
    }
}
