//! Sizes, names and home configuration of a robot.

use super::lines::string;
use super::naming::Naming;
use crate::derivation::BodyParameter;
use crate::mechanism::Mechanism;
use crate::model::RobotModel;

/// The macros of sizes.
#[must_use]
pub fn sizes(model: &RobotModel, naming: &Naming) -> String {
    let mechanism = &model.mechanism;
    let (actuators, dof) = (mechanism.actuator_count(), mechanism.dof());
    let mut sizes = vec![
        ("POSE", mechanism.pose_len(), "numbers in a pose"),
        ("DOF", dof, "r, independent platform coordinates"),
        (
            "ACTUATORS",
            actuators,
            if mechanism.motors.is_empty() {
                "n, actuated joints"
            } else {
                "n, actuators"
            },
        ),
        (
            "REDUNDANCY",
            actuators.saturating_sub(dof),
            "n - r, independent internal torques",
        ),
        (
            "JOINTS",
            mechanism.joints().len(),
            "n_t, joints of all legs",
        ),
        ("LEGS", mechanism.legs.len(), "legs"),
    ];
    if mechanism.is_parasitic() {
        sizes.extend([
            ("FREE", 6, "velocities of the platform as a free body"),
            ("BLOCKED", 6 - dof, "directions that the legs block"),
        ]);
    }
    if mechanism.has_dependent_joints() {
        let count = mechanism.pose_len() - dof;
        sizes.push(("DEPENDENT", count, "dependent joints in the pose"));
    }
    if let Some(values) = &model.selection.values {
        sizes.push(("PARAMETER_VALUES", values.len(), "known parameters"));
    }
    sizes.push((
        "PARAMETERS",
        model.selection.standard.len(),
        "standard parameters: columns that are not identically zero",
    ));
    sizes.push((
        "BASE_PARAMETERS",
        model.base.len(),
        "base parameters: independent columns",
    ));
    sizes.push((
        "PAYLOAD_PARAMETERS",
        model.selection.payload.len(),
        "the payload's parameters",
    ));
    let line = |(name, value, comment): &(&str, usize, &str)| {
        format!(
            "#define {} {value} /**< {comment} */\n",
            naming.constant(name)
        )
    };
    let lines: String = sizes.iter().map(line).collect();
    format!("{lines}\n")
}

/// A table: its declaration, its description, and its elements.
struct Table {
    /// Type and name as C declares them, without length.
    element: &'static str,
    name: &'static str,
    length: String,
    comment: &'static str,
    elements: Vec<String>,
}

fn tables(model: &RobotModel) -> Vec<Table> {
    let mut tables = names(model);
    tables.extend(configuration(model));
    match &model.selection.values {
        Some(values) => tables.push(Table {
            element: "rob_value",
            name: "parameter_values",
            length: "ROB_PARAMETER_VALUES".to_owned(),
            comment: "Values of the base parameters and of the payload parameters (SI), which the functions contain as constants.",
            elements: values
                .iter()
                .map(|&(parameter, value)| {
                    let base = model.base.iter().find(|base| base.parameter == parameter);
                    let name = base.map_or_else(
                        || model.parameter_name(parameter),
                        |base| model.base_name(base),
                    );
                    format!("{{ {}, {} }}", string(&name), number(value))
                })
                .collect(),
        }),
        None => tables.extend(parameters(model)),
    }
    // C has no arrays of length 0.
    tables.retain(|table| !table.elements.is_empty());
    tables
}

fn names(model: &RobotModel) -> Vec<Table> {
    let mechanism = &model.mechanism;
    let table = |name, length: &str, comment, names: Vec<String>| Table {
        element: "char *const",
        name,
        length: length.to_owned(),
        comment,
        elements: names.iter().map(|name| string(name)).collect(),
    };
    let legs = mechanism.legs.iter().map(|leg| leg.name.clone());
    let joints = mechanism.joints();
    let joints = joints.iter().map(|&at| mechanism.joint_name(at));
    vec![
        table(
            "leg_names",
            "ROB_LEGS",
            "Names of the legs.",
            legs.collect(),
        ),
        table(
            "actuator_names",
            "ROB_ACTUATORS",
            "Names of the actuators, in the order of q and tau.",
            mechanism.actuator_names(),
        ),
        table(
            "joint_names",
            "ROB_JOINTS",
            "Names of the joints, in the order of q_t.",
            joints.collect(),
        ),
        table(
            "coordinates",
            "ROB_DOF",
            "Names of the independent coordinates, in the order of the twist.",
            mechanism.coordinates(),
        ),
        table(
            "pose_coordinates",
            "ROB_POSE",
            "Names of the pose coordinates.",
            mechanism.pose_coordinates(),
        ),
    ]
}

fn configuration(model: &RobotModel) -> Vec<Table> {
    let mechanism = &model.mechanism;
    let table = |element, name, length: &str, comment, elements| Table {
        element,
        name,
        length: length.to_owned(),
        comment,
        elements,
    };
    let turns = mechanism.actuator_is_revolute().into_iter();
    let turns = turns.map(|turns| u8::from(turns).to_string());
    let numbers = |values: &[f64]| values.iter().map(|&value| number(value)).collect();
    let indices = |values: &[usize]| values.iter().map(ToString::to_string).collect();
    let has_motors = !mechanism.motors.is_empty();
    let mut tables = vec![
        table(
            "int",
            "actuated_joints",
            "ROB_ACTUATORS",
            if has_motors {
                "Index of each actuator's joint among all joints; of a motor that drives several joints the first."
            } else {
                "Indices of the actuated joints among all joints."
            },
            indices(&mechanism.first_joints()),
        ),
        table(
            "int",
            "actuator_is_revolute",
            "ROB_ACTUATORS",
            "1 for each actuator that turns (rad, N m), 0 for one that slides (m, N).",
            turns.collect(),
        ),
        table(
            "int",
            "kept_actuators",
            &mechanism.kept_actuators.len().to_string(),
            "Kept actuators of the actuator projection (case 2).",
            indices(&mechanism.kept_actuators),
        ),
        table(
            "double",
            "home_pose",
            "ROB_POSE",
            "Pose of the home configuration (m, rad).",
            numbers(&mechanism.home.pose),
        ),
        table(
            "double",
            "home_joints",
            "ROB_JOINTS",
            "Joint positions of the home configuration, which defines the working mode (m, rad).",
            numbers(&mechanism.home.joints),
        ),
    ];
    if has_motors {
        tables.push(table(
            "double",
            "transmission",
            "ROB_ACTUATORS * ROB_JOINTS",
            "Transmission T, row by row: the positions of the actuators are T q_t.",
            numbers(&transmission(mechanism)),
        ));
    }
    tables
}

/// The matrix T with the actuators' positions T q_t, row by row.
fn transmission(mechanism: &Mechanism) -> Vec<f64> {
    let count = mechanism.joints().len();
    let actuators = mechanism.actuators().into_iter();
    let rows = actuators.map(|actuator| {
        let mut row = vec![0.0; count];
        for (joint, factor) in mechanism.actuator_terms(actuator) {
            row[joint] = factor.value();
        }
        row
    });
    rows.flatten().collect()
}

fn parameters(model: &RobotModel) -> Vec<Table> {
    let entry = |&parameter: &BodyParameter| {
        let (name, unit) = (
            model.parameter_name(parameter),
            model.parameter_unit(parameter),
        );
        format!("{{ {}, {} }}", string(&name), string(unit))
    };
    let table = |name, length: &str, comment, of: &[BodyParameter]| Table {
        element: "rob_parameter",
        name,
        length: length.to_owned(),
        comment,
        elements: of.iter().map(entry).collect(),
    };
    let regrouped = model.base.iter().flat_map(|base| &base.regrouped);
    let count = regrouped.clone().count();
    let terms = regrouped.map(|(parameter, coefficient)| {
        let name = model.parameter_name(*parameter);
        format!("{{ {}, {} }}", string(&name), number(*coefficient))
    });
    let mut first = 0;
    let base = model.base.iter().map(|base| {
        let (name, kept) = (model.base_name(base), model.parameter_name(base.parameter));
        let (name, kept) = (string(&name), string(&kept));
        let (from, count) = (first, base.regrouped.len());
        first += count;
        format!("{{ {name}, {kept}, {from}, {count} }}")
    });
    let mut tables = vec![
        table(
            "parameters",
            "ROB_PARAMETERS",
            "The standard parameters whose columns are not identically zero, in column order.",
            &model.selection.standard,
        ),
        table(
            "payload_parameters",
            "ROB_PAYLOAD_PARAMETERS",
            "The payload's parameters, in column order.",
            &model.selection.payload,
        ),
    ];
    tables.push(Table {
        element: "rob_value",
        name: "regrouped",
        length: count.to_string(),
        comment: "Standard parameters that are regrouped into base parameters, with their coefficients.",
        elements: terms.collect(),
    });
    tables.push(Table {
        element: "rob_base_parameter",
        name: "base_parameters",
        length: "ROB_BASE_PARAMETERS".to_owned(),
        comment: "The base parameters in the order of the functions' inputs.",
        elements: base.collect(),
    });
    tables
}

/// The types of tables, and their declarations in the header.
#[must_use]
pub fn declarations(model: &RobotModel, naming: &Naming) -> String {
    let mut out = String::from(
        "/** A standard parameter: its name and SI unit. */\n\
         typedef struct rob_parameter {\n    const char *name;\n    const char *unit;\n} rob_parameter;\n\n\
         /** A name and a number. */\n\
         typedef struct rob_value {\n    const char *name;\n    double value;\n} rob_value;\n\n\
         /** A base parameter: an independent column, and the standard parameters that are regrouped into it. */\n\
         typedef struct rob_base_parameter {\n\
         \x20   const char *name;      /**< the kept parameter's; `R` at its end where others are regrouped into it */\n\
         \x20   const char *parameter; /**< the standard parameter whose column is kept */\n\
         \x20   int first;             /**< index of the first of rob_regrouped that belongs to it */\n\
         \x20   int count;             /**< how many belong to it */\n\
         } rob_base_parameter;\n\n",
    );
    for table in tables(model) {
        let Table {
            element,
            name,
            length,
            comment,
            ..
        } = table;
        out += &format!("/** {comment} */\nextern const {element} rob_{name}[{length}];\n\n");
    }
    naming.apply(&out)
}

/// The tables.
#[must_use]
pub fn definitions(model: &RobotModel, naming: &Naming) -> String {
    let mut out = String::new();
    for table in tables(model) {
        let head = format!(
            "const {} rob_{}[{}]",
            table.element, table.name, table.length
        );
        // Names come from the description, so the prefix is inserted in the head only.
        out += &naming.apply(&head);
        out += " = {\n";
        let last = table.elements.len() - 1;
        for (at, element) in table.elements.iter().enumerate() {
            let comma = if at < last { "," } else { "" };
            out += &format!("    {element}{comma}\n");
        }
        out += "};\n\n";
    }
    out
}

/// A number in C notation, of the same value.
#[must_use]
pub fn number(value: f64) -> String {
    // A number that is not finite does not compile, so that it does not reach a user.
    if value.is_finite() {
        format!("{value:?}")
    } else {
        "internal_error_of_overact_a_constant_is_not_finite".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_round_trip_and_have_a_point_or_an_exponent() {
        for value in [0.0, 1.0, -2.5, 0.1 + 0.2, 1e-300, f64::MAX, 1e22] {
            let text = number(value);
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
            assert!(text.contains(['.', 'e']), "{text}");
        }
        assert!(number(f64::NAN).contains("internal_error"));
    }
}
