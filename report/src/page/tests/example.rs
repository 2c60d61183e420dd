//! Artificial identification with hostile names.

use crate::{
    Published, Units,
    published::{PublishedEstimate, PublishedParameter, PublishedTorques, PublishedTracking},
};
use overact::{Info, Sizes};
use overact_identification::{
    About, ActuatorRange, Axis, BaseParameter, Check, CheckKind, ConditionSeries, Consistent,
    ConsistentBody, ConsistentParameter, CorrelationFigures, CrossValidation, Curve, Drift,
    Estimate, Estimator, Evidence, Figures, Grade, Identification, Instruments, LineError,
    LineNorms, LineResidual, ModelKind, Normalisation, OnlineChange, OnlineEstimate,
    ParameterEstimate, PartitionCondition, PredictionFigures, Prior, Regrouping, Removal,
    ResidualFigures, ResidualSeries, RunFigures, RunSummary, Series, Settings, Stage, StageVerdict,
    Thresholds, TorqueComparison, TrackingError, VelocitySeries, Verdict,
};

/// Name that breaks unescaped output.
pub(super) const HOSTILE: &str = "a<b>&\"'\u{1}</table><script>x</script>\u{1b}[31m\n\u{202e}`";

pub(super) fn series(name: &str) -> Series {
    let time: Vec<f64> = (0..400).map(|index| f64::from(index) * 0.01).collect();
    let measured: Vec<f64> = time.iter().map(|t| (6.0 * t).sin()).collect();
    // The largest residual is at 3 s.
    let predicted = time
        .iter()
        .map(|t| (6.0 * t).sin() - if (t - 3.0).abs() < 0.005 { 0.5 } else { 0.01 });
    Series {
        name: name.to_owned(),
        predicted: predicted.collect(),
        time: time.clone(),
        measured,
    }
}

fn parameter(name: &str, value: f64) -> ParameterEstimate {
    ParameterEstimate {
        name: name.to_owned(),
        unit: String::from("kg m^2"),
        column: 0,
        value,
        standard_deviation: 0.01 * value.abs(),
        relative_standard_deviation_percent: 1.0,
        correlated_standard_deviation: 0.02 * value.abs(),
        interval_95: [value - 0.04 * value.abs(), value + 0.04 * value.abs()],
        outside: false,
        true_value: Some(1.01 * value),
        error_percent: Some(-1.0),
    }
}

fn removal(name: &str, accepted: bool) -> Removal {
    Removal {
        name: name.to_owned(),
        column: 1,
        value: 0.1,
        relative_standard_deviation_percent: 80.0,
        deviation_ratio: 80.0,
        relative_error_before_percent: 2.0,
        relative_error_after_percent: 2.1,
        f_statistic: 1.5,
        significant: false,
        held_out_before_percent: Some(2.2),
        held_out_after_percent: None,
        drift: Some(Drift {
            parameter: HOSTILE.to_owned(),
            percent: 3.0,
            deviations: 0.5,
            inputs_percent: 3.0,
        }),
        accepted,
        reason: String::from("it is <needless>"),
    }
}

fn estimate(model: ModelKind, stage: Stage) -> Estimate {
    Estimate {
        model,
        kept_actuators: vec![HOSTILE.to_owned()],
        stage,
        estimator: Estimator::LeastSquares,
        weighted: true,
        parameters: if stage == Stage::Essential {
            // Elimination has moved it out of its interval.
            vec![ParameterEstimate {
                value: -2.2,
                ..parameter("m_platformR", -1.92)
            }]
        } else {
            vec![parameter(HOSTILE, 0.0445), parameter("m_platformR", -1.92)]
        },
        residual_norm: 1.0,
        relative_error_percent: 2.4,
        condition_number: f64::INFINITY,
        equations: 1000,
        residual_deviation: 1.0,
        lines: vec![line_error("x", "N", [1.0, 40.0], 1000)],
        weights: vec![1.0],
        partition: Some(PartitionCondition {
            crossings: 0,
            largest: 31.0,
            run: HOSTILE.to_owned(),
            sample: 3,
            time: 0.1,
        }),
        removals: if stage == Stage::Essential {
            vec![removal(HOSTILE, true), removal("fv_1", false)]
        } else {
            Vec::new()
        },
        stop: (stage == Stage::Essential).then(|| String::from("the next step was refused")),
    }
}

fn cross_validation(model: ModelKind) -> CrossValidation {
    CrossValidation {
        run: String::from("held out"),
        payload: false,
        payload_name: None,
        model,
        stage: Stage::Recommended,
        residual_norm: 1.0,
        relative_error_percent: 3.0,
        lines: Vec::new(),
        torques: vec![line_error("leg1", "N m", [1.0, 20.0], 100)],
        projected_torques: vec![line_error("leg1", "N m", [0.9, 20.0], 100)],
        table: vec![TorqueComparison {
            actuator: String::from("leg1"),
            least_norm_percent: 5.0,
            closure_percent: Some(5.5),
        }],
        line_series: Vec::new(),
        torque_series: Vec::new(),
    }
}

fn figures() -> Figures {
    let run = |name: &str, identified| RunFigures {
        run: name.to_owned(),
        identified,
        payload: identified,
        time: vec![0.0, 1.0, 2.0],
        coordinates: vec![String::from("x"), String::from("phi")],
        pose: vec![vec![0.0, 0.1, 0.0], vec![0.0, f64::NAN, 1.0]],
        velocities: vec![VelocitySeries {
            actuator: HOSTILE.to_owned(),
            velocity: vec![0.0, f64::NAN, -0.5],
            largest_velocity: 0.5,
            largest_acceleration: 3.0,
        }],
        conditions: vec![
            ConditionSeries {
                kept_actuators: Vec::new(),
                condition: vec![2.0, 3.0, 2.0],
                determinant: Vec::new(),
            },
            ConditionSeries {
                kept_actuators: vec![String::from("leg1")],
                condition: vec![2.0, f64::INFINITY, 40.0],
                determinant: vec![0.1, -0.1, -0.2],
            },
        ],
    };
    let prediction = |name: &str, identified, model| PredictionFigures {
        run: name.to_owned(),
        identified,
        model,
        stage: Stage::Recommended,
        lines: vec![series("x"), series("phi")],
        torques: vec![series("leg1")],
    };
    let residual = |model, name: &str| ResidualFigures {
        model,
        stage: Stage::Recommended,
        lines: vec![LineResidual {
            name: name.to_owned(),
            runs: vec![ResidualSeries {
                run: HOSTILE.to_owned(),
                time: vec![0.0, 1.0],
                residual: vec![0.1, -0.1],
            }],
            lag_s: 0.01,
            autocorrelation: vec![1.0, 0.5, 0.1],
            white_bound: 0.06,
            within_bound: 0.3,
            frequency_hz: vec![0.0, 1.0],
            power: vec![1.0, 0.0],
        }],
    };
    Figures {
        runs: vec![run(HOSTILE, true), run("held out", false)],
        predictions: vec![
            prediction(HOSTILE, true, ModelKind::Platform),
            prediction("held out", false, ModelKind::Platform),
            prediction(HOSTILE, true, ModelKind::Actuators),
        ],
        residuals: vec![
            residual(ModelKind::Platform, "x"),
            residual(ModelKind::Actuators, HOSTILE),
        ],
        correlations: vec![CorrelationFigures {
            model: ModelKind::Platform,
            stage: Stage::Recommended,
            names: vec![HOSTILE.to_owned(), String::from("m_platformR")],
            correlation: vec![vec![1.0, -0.87], vec![-0.87, 1.0]],
        }],
        ranges: vec![ActuatorRange {
            actuator: HOSTILE.to_owned(),
            unit: "rad",
            position: [-0.5, 1.5],
            velocity: 0.5,
            acceleration: 3.0,
            position_limits: Some([-2.0, 2.0]),
            velocity_limit: Some(4.0),
            acceleration_limit: None,
        }],
    }
}

pub(super) fn settings() -> Settings {
    Settings {
        filter_order: 4,
        filter_cutoff_hz: 100.0,
        difference_order: 4,
        decimation: 50,
        skip_start: 0,
        velocity_dead_band: 0.0,
        standstill_velocity: Vec::new(),
        averaged_reversals: false,
        skip_end: 0,
        r_sigma: 10.0,
        keep_significant: true,
        normalisation: Normalisation::Unbiased,
        asymmetric_friction: false,
        weighted: true,
        instruments: Instruments::None,
        gear_friction: Vec::new(),
        stribeck_velocities: std::collections::BTreeMap::new(),
        checks: overact_identification::CheckScope::All,
        period_s: None,
        prior: Prior::default(),
        known: std::collections::BTreeMap::new(),
        filter_torques: false,
        filter_equations: false,
        validation_samples: None,
        kept_actuators: vec![0],
        seed: 1,
        online: None,
    }
}

/// Estimates over time of a replay, with a change.
fn online() -> Vec<OnlineEstimate> {
    let point = |step: u32| {
        let time = f64::from(step);
        let deviation = 0.5 / time;
        OnlineEstimate {
            run: HOSTILE.to_owned(),
            time,
            values: vec![(step > 2).then_some(0.0445), Some(-1.9)],
            standard_deviations: vec![(step > 2).then_some(0.01 * deviation), Some(deviation)],
            change: (step == 7).then(|| OnlineChange {
                line: HOSTILE.to_owned(),
                increase: true,
            }),
        }
    };
    (1..=50).map(point).collect()
}

fn consistent() -> Consistent {
    let parameter = |name: &str, value, determined| ConsistentParameter {
        name: name.to_owned(),
        unit: String::from("kg"),
        value,
        prior: 1.0,
        determined,
    };
    Consistent {
        model: ModelKind::Platform,
        parameters: vec![parameter(HOSTILE, 1.2, 0.99), parameter("m_2", 0.8, 0.1)],
        bodies: vec![ConsistentBody {
            mass: HOSTILE.to_owned(),
            mass_kg: 1.2,
            definiteness: 0.02,
        }],
        base_values: vec![1.2, 0.8],
        residual_norm: 2.0,
        relative_error_percent: 1.52,
        base_relative_error_percent: 1.5,
        lines: Vec::new(),
    }
}

pub(super) fn identification() -> Identification {
    let base = |name: &str, terms: &[(&str, f64)]| BaseParameter {
        name: name.to_owned(),
        parameter: String::from("zz_1"),
        unit: String::from("kg m^2"),
        regrouping: terms
            .iter()
            .map(|(parameter, coefficient)| Regrouping {
                parameter: (*parameter).to_owned(),
                coefficient: *coefficient,
            })
            .collect(),
        true_value: Some(1.0),
    };
    Identification {
        robot: HOSTILE.to_owned(),
        runs: vec![RunSummary {
            payload_name: None,
            session: None,
            name: HOSTILE.to_owned(),
            samples: 5000,
            sampling_frequency: 1000.0,
            payload: true,
            closure_residual: 1e-5,
            standstill_equations: Vec::new(),
        }],
        base_parameters: vec![
            base(HOSTILE, &[(HOSTILE, 0.0784), ("m_2", -1.0)]),
            base("fv_1", &[]),
        ],
        without_effect: vec![HOSTILE.to_owned()],
        estimates: vec![
            estimate(ModelKind::Platform, Stage::Base),
            estimate(ModelKind::Platform, Stage::Recommended),
            estimate(ModelKind::Platform, Stage::Essential),
            estimate(ModelKind::Actuators, Stage::Base),
            estimate(ModelKind::Actuators, Stage::Recommended),
            estimate(ModelKind::Actuators, Stage::Essential),
        ],
        consistent: vec![consistent()],
        cross_validation: vec![
            cross_validation(ModelKind::Platform),
            cross_validation(ModelKind::Actuators),
        ],
        warnings: vec![format!("beware of {HOSTILE}"), String::from("clipped")],
        checks: checks(),
        calibration: None,
        gravity: None,
        gains: Vec::new(),
        gain_parameters: Vec::new(),
        gear_friction: Vec::new(),
        stribeck_velocities: Vec::new(),
        motors: Vec::new(),
        functions_base: Vec::new(),
        timings: Vec::new(),
        assumptions: vec![String::from("the gains are right")],
        unseen: Vec::new(),
        verdicts: vec![
            verdict(ModelKind::Platform, Grade::UseListed, &["m_platformR"]),
            verdict(ModelKind::Actuators, Grade::DoNotUse, &[]),
        ],
        thresholds: Thresholds::default(),
        tracking: ["pd", "computed torque, platform projection"]
            .iter()
            .zip([8e-3, 2e-3])
            .map(|(controller, largest)| TrackingError {
                run: String::from("held out"),
                controller: (*controller).to_owned(),
                actuators: vec![String::from("leg1")],
                largest: vec![largest],
            })
            .collect(),
        online: online(),
        errors_in_regressor: Vec::new(),
        settings: settings(),
        figures: figures(),
    }
}

fn verdict(model: ModelKind, grade: Grade, listed: &[&str]) -> Verdict {
    Verdict {
        subject: model.label().to_owned(),
        model,
        stage: Stage::Recommended,
        grade,
        trusted: grade == Grade::Use,
        listed: listed.iter().map(|name| (*name).to_owned()).collect(),
        reasons: vec![HOSTILE.to_owned()],
        rests_on: None,
        stages: vec![StageVerdict {
            stage: Stage::Base,
            grade: Grade::Use,
            listed: Vec::new(),
            reasons: Vec::new(),
        }],
    }
}

/// One check of each outcome: failed for the actuator projection, failed for one parameter, passed.
fn checks() -> Vec<Check> {
    let curve = |name: &str| Curve::new(name, &[0.0, 1.0, 2.0], &[0.1, f64::NAN, 0.3]);
    let evidence = Evidence {
        title: HOSTILE.to_owned(),
        x: Axis::new("t", "s"),
        y: Axis::new(HOSTILE, "N m"),
        lines: vec![curve(HOSTILE), curve("other")],
        points: vec![curve("points")],
        limits: vec![0.2, -0.2],
    };
    vec![
        Check::new(
            CheckKind::RelativeError,
            About::Fit,
            "the error 2.4 % is < 50 %",
        )
        .measured(2.4, "%")
        .against(50.0, "a published rule")
        .shown_by(evidence.clone()),
        Check::new(
            CheckKind::RegressorErrors,
            About::Model,
            "one parameter is biased",
        )
        .of_model(ModelKind::Platform)
        .measured(0.001, "probability")
        .against(0.01, "false alarms in 1 % of all reports")
        .with_unusable_parameters(vec![HOSTILE.to_owned()])
        .with_grade(Grade::UseListed),
        Check::new(CheckKind::ClippedTorque, About::Data, "clipped")
            .in_run(HOSTILE)
            .of_actuator("leg1")
            .of_model(ModelKind::Actuators)
            .with_grade(Grade::DoNotUse)
            .shown_by(evidence),
    ]
}

pub(super) fn published() -> Published {
    Published {
        source: HOSTILE.to_owned(),
        note: Some(HOSTILE.to_owned()),
        actuators: vec![String::from("leg1")],
        estimates: vec![PublishedEstimate {
            model: ModelKind::Platform,
            relative_error_percent: Some(11.0),
            parameters: [(
                String::from("m_platformR"),
                PublishedParameter {
                    value: 1.93,
                    deviation_percent: Some(1.08),
                },
            )]
            .into(),
        }],
        cross_validation: vec![PublishedTorques {
            run: String::from("trajectory 1"),
            model: ModelKind::Platform,
            torques_percent: vec![9.1],
        }],
        tracking: vec![PublishedTracking {
            run: String::from("trajectory 1"),
            controller: String::from("case a"),
            largest: vec![6.35e-3],
        }],
    }
}

pub(super) fn units() -> Units {
    Units::new(&Info {
        name: "robot",
        sizes: Sizes {
            pose: 2,
            dof: 2,
            actuators: 1,
            joints: 1,
            parameters: 0,
            base_parameters: 0,
            payload_parameters: 0,
        },
        legs: &[],
        actuators: &["leg1"],
        actuated_joints: &[0],
        actuator_is_revolute: &[true],
        coordinates: &["x", "phi"],
        parameters: &[],
        payload_parameters: &[],
        home_pose: &[],
        home_joints: &[],
        kept_actuators: &[],
    })
}

/// Error of a line; norms are `[residual, measured]`.
fn line_error(name: &str, unit: &'static str, norms: [f64; 2], equations: usize) -> LineError {
    let norms = LineNorms {
        residual: norms[0],
        measured: norms[1],
        variation: norms[1],
    };
    LineError::new(name, unit, &norms, equations)
}
