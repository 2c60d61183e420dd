//! Choice of a robot's functions by name or purpose, with the functions that they call.
//!
//! A controller needs a few functions of dozens. Names are those of generated functions, those in
//! the function table (which may have several forms), or those of a [`Group`]. Called functions are
//! included: forward kinematics with its steps, Newton's method with the closure of the legs.

mod chosen;
mod function_forms;
mod group;
mod name;

pub(crate) use chosen::Chosen;
pub(crate) use function_forms::Missing;
pub use group::{Group, serves_model};
pub use name::UnknownFunction;

use crate::derivation::{FunctionForm, JointsBy, MotionInput};
use crate::mechanism::Mechanism;
use function_forms::Forms;
use name::{Meant, help, meant};
use overact_core::Columns;

/// The requested functions and their forms.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Choice {
    /// Empty for all functions.
    names: Vec<String>,
    /// Empty for each function's default.
    from: Vec<MotionInput>,
    columns: Option<Columns>,
}

impl Choice {
    /// Functions by name, and groups.
    ///
    /// # Errors
    /// All names that no robot's function has; also an empty list, which would select nothing, as
    /// an error with an empty name.
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, Vec<UnknownFunction>> {
        let names: Vec<String> = names
            .into_iter()
            .map(|name| name.trim().to_owned())
            .collect();
        let mut unknown = Vec::new();
        for (index, name) in names.iter().enumerate() {
            if meant(name, true).is_none() && meant(name, false).is_none() {
                unknown.push(UnknownFunction {
                    index,
                    name: name.clone(),
                    help: help(name),
                });
            }
        }
        if names.is_empty() {
            unknown.push(UnknownFunction {
                index: 0,
                name: String::new(),
                help: help(""),
            });
        }
        if unknown.is_empty() {
            Ok(Self {
                names,
                ..Self::default()
            })
        } else {
            Err(unknown)
        }
    }

    /// All functions, in all forms unless restricted.
    #[must_use]
    pub fn all() -> Self {
        Self::default()
    }

    /// Restricts the functions to forms that are evaluated from these inputs.
    ///
    /// A function named without its form, such as `inverse_dynamics`, is included in each of these
    /// forms. Called functions are included in any form. A robot without a platform has one form of
    /// each function, since its joints are its pose.
    #[must_use]
    pub fn evaluated_from(mut self, from: impl IntoIterator<Item = MotionInput>) -> Self {
        self.from = from.into_iter().collect();
        self
    }

    /// Restricts the functions to those with these columns, or with these parameters as input.
    ///
    /// Functions with neither stay. A function named without its columns, such as
    /// `inverse_dynamics`, means that with these.
    #[must_use]
    pub fn with_columns(mut self, columns: Columns) -> Self {
        self.columns = Some(columns);
        self
    }

    /// The names as given; empty for all functions.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The requested columns, if any.
    pub(crate) fn columns(&self) -> Option<Columns> {
        self.columns
    }

    /// The requested functions of a robot with this inventory, and those that they need.
    ///
    /// # Errors
    /// Every name without a function in this robot in the requested form.
    pub(crate) fn of_robot(
        &self,
        mechanism: &Mechanism,
        joints: JointsBy,
        inventory: &[FunctionForm],
    ) -> Result<Chosen, Vec<Missing>> {
        let forms = Forms {
            tree: mechanism.is_tree(),
            mechanism,
            from: &self.from,
            columns: self.columns,
            inventory,
        };
        let mut chosen = Chosen::default();
        let mut missing = Vec::new();
        if self.names.is_empty() {
            chosen.forward = forms.has_source(MotionInput::Actuators);
            match forms.all() {
                Ok(all) => chosen.functions.extend(all),
                Err(nothing) => missing.push(nothing),
            }
        }
        for name in &self.names {
            let found = meant(name, mechanism.is_tree());
            chosen.forward |= matches!(found, Some(Meant::Group(_) | Meant::Forward));
            match forms.wanted(name, found) {
                Ok(wanted) => chosen.functions.extend(wanted),
                Err(one) => missing.push(one),
            }
        }
        if !missing.is_empty() {
            return Err(missing);
        }
        chosen.complete(mechanism, joints, inventory);
        Ok(chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::{Choice, Group, Meant, meant};
    use crate::derivation::MotionInput;
    use crate::{Effort, Request, Source, compile_with};
    use overact_core::{Columns, Function};

    #[test]
    fn function_and_group_names_are_accepted() {
        let names = [
            "control",
            "inverse_dynamics",
            "idm_red_platform_base_from_joints",
            "legs_jacobian",
            "pose_from_actuators",
        ];
        assert_eq!(Choice::new(names).expect("known").names(), names);
        assert_eq!(
            meant("kinematics", true),
            Some(Meant::Group(Group::Kinematics))
        );
        assert!(matches!(
            meant("joints", false),
            Some(Meant::Form(form)) if form.function == Function::Joints
        ));
    }

    #[test]
    fn all_unknown_names_are_reported_with_suggestions() {
        let unknown = Choice::new(["inverse_dynamic", "joints", "nonsense", ""]).expect_err("two");
        let suggestions: Vec<(usize, &str)> =
            unknown.iter().map(|u| (u.index, u.help.as_str())).collect();
        assert_eq!(suggestions.len(), 3);
        assert_eq!(suggestions[0], (0, "did you mean `inverse_dynamics`?"));
        assert_eq!(suggestions[1].0, 2);
        assert!(
            suggestions[1].1.contains("`control`"),
            "{}",
            suggestions[1].1
        );
        assert_eq!(Choice::new([]).expect_err("nothing").len(), 1);
    }

    /// Names of the functions generated for a robot of the library, or the error.
    fn generated(robot: &str, choice: &Choice) -> Result<Vec<String>, String> {
        let text = match robot {
            "emps" => include_str!("../../../robots/emps.toml"),
            _ => include_str!("../../../robots/five_bar.toml"),
        };
        let source = Source::new("robot.toml", text);
        let request = Request {
            functions: Some(choice),
            ..Request::with_effort(Effort::None)
        };
        let compiled = compile_with(&source, &request);
        match compiled {
            Ok(robot) => Ok(robot.model.functions.into_iter().map(|f| f.name).collect()),
            Err(errors) => Err(errors.render_plain(&source)),
        }
    }

    fn named(name: &str) -> Choice {
        Choice::new([name]).expect("known")
    }

    #[test]
    fn forms_are_selected_by_motion_input_and_columns() {
        let idm = named("idm_red_platform");
        let forms = |choice: Choice| generated("five_bar", &choice).expect("a model");
        let joints = idm.clone().evaluated_from([MotionInput::Joints]);
        assert_eq!(forms(joints.clone()), ["idm_red_platform_from_joints"]);
        let base = joints.with_columns(Columns::Base);
        assert_eq!(forms(base), ["idm_red_platform_base_from_joints"]);
        let both = idm.evaluated_from([MotionInput::Pose, MotionInput::Joints]);
        assert_eq!(forms(both).len(), 2);
        let all = forms(Choice::all().evaluated_from([MotionInput::Joints]));
        let ends = |name: &String| name.ends_with("_from_joints");
        assert!(all.len() > 8 && all.iter().all(ends), "{all:?}");
        let control = forms(named("control").with_columns(Columns::Base));
        assert!(
            control.contains(&"mass_matrix_base".to_owned()),
            "{control:?}"
        );
        assert!(!control.contains(&"mass_matrix".to_owned()), "{control:?}");
        assert!(
            control.contains(&"inverse_jacobian".to_owned()),
            "{control:?}"
        );
        // The state of a robot without a platform is its joints, in any case.
        let tree = named("inverse_dynamics").evaluated_from([MotionInput::Pose]);
        assert_eq!(
            generated("emps", &tree),
            Ok(vec!["inverse_dynamics".to_owned()])
        );
    }

    #[test]
    fn unavailable_forms_are_reported_with_alternatives() {
        let cases = [
            (
                named("mass_matrix").evaluated_from([MotionInput::Joints]),
                [
                    "no function `mass_matrix` from joints",
                    "it is evaluated from pose",
                ],
            ),
            (
                named("idm_red_platform_from_joints").evaluated_from([MotionInput::Pose]),
                [
                    "can't have `idm_red_platform_from_joints` from pose",
                    "`idm_red_platform`",
                ],
            ),
            (
                named("bias_base").with_columns(Columns::Standard),
                [
                    "can't have `bias_base` with standard columns",
                    "ask for `bias`",
                ],
            ),
            (
                named("legs_jacobian").evaluated_from([MotionInput::Pose]),
                [
                    "no function `legs_jacobian` from pose",
                    "it is evaluated from joints",
                ],
            ),
        ];
        for (choice, wanted) in cases {
            let message = generated("five_bar", &choice).expect_err("nothing of this form");
            assert!(
                wanted.iter().all(|part| message.contains(part)),
                "{message}"
            );
        }
    }
}
