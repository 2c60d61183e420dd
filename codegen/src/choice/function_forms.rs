//! Forms of the named functions: their inputs and columns.

use super::group::Group;
use super::name::{Meant, meant, reason};
use crate::derivation::{FunctionForm, MotionInput, function_name, name_in_robot};
use crate::mechanism::Mechanism;
use overact_core::{Columns, Extent, FrameQuantity, Function};
use overact_description::diagnostic::did_you_mean;

/// A name without a function in this robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Missing {
    /// The missing function: `has no function ...`.
    pub(crate) sentence: String,
    /// A remedy.
    pub(crate) help: String,
}

impl Missing {
    /// Columns were requested, but no function has any.
    pub(crate) fn of_known_parameters() -> Self {
        Self {
            sentence: "has constant parameters, so `columns` has no function to select".to_owned(),
            help: "leave out `columns`, or the values of the parameters".to_owned(),
        }
    }

    /// With the general remedy.
    fn of(sentence: String) -> Self {
        Self {
            sentence,
            help: "`overact inspect` lists the functions that it has; those on request, such as `total_mass`, are in docs/functions.md".to_owned(),
        }
    }
}

/// The requested forms of a robot with this inventory.
pub(super) struct Forms<'a> {
    pub(super) mechanism: &'a Mechanism,
    pub(super) tree: bool,
    /// Empty for each function's default.
    pub(super) from: &'a [MotionInput],
    pub(super) columns: Option<Columns>,
    pub(super) inventory: &'a [FunctionForm],
}

impl Forms<'_> {
    /// Whether functions may be evaluated from this input. The state of a tree is its joints, in
    /// any case.
    pub(super) fn has_source(&self, from: MotionInput) -> bool {
        self.tree || self.from.is_empty() || self.from.contains(&from)
    }

    fn takes(&self, form: FunctionForm) -> bool {
        let is_wanted = |own| self.columns.is_none_or(|wanted| wanted == own);
        self.has_source(form.from) && kind(form.function).is_none_or(is_wanted)
    }

    /// All functions of the robot in the requested forms.
    ///
    /// # Errors
    /// No function has one of these forms.
    pub(super) fn all(&self) -> Result<Vec<FunctionForm>, Missing> {
        let all = self.filtered(|form| !form.function.is_on_request());
        if all.is_empty() {
            Err(Missing::of(format!("has no function {}", self.described())))
        } else {
            Ok(all)
        }
    }

    /// The functions of a name.
    ///
    /// # Errors
    /// A function that this robot does not have in the requested form.
    pub(super) fn wanted(
        &self,
        name: &str,
        found: Option<Meant>,
    ) -> Result<Vec<FunctionForm>, Missing> {
        let wanted = match found {
            Some(Meant::Forward) => return Ok(Vec::new()),
            Some(Meant::Group(group)) => self.filtered(|form| self.is_of(group, form)),
            Some(Meant::Form(form)) => return self.form(name, form),
            Some(Meant::Forms(function)) => self.filtered(|form| form.function == function),
            Some(Meant::OfFrame) => {
                let is_named = |form| name_in_robot(self.mechanism, form) == name;
                self.filtered(is_named)
            }
            None => Vec::new(),
        };
        match (found, wanted.is_empty()) {
            (_, false) => Ok(wanted),
            (Some(Meant::Group(_)), _) => {
                let sentence =
                    format!("has no function of the group `{name}` {}", self.described());
                Err(Missing::of(sentence))
            }
            (Some(Meant::Forms(function)), _) => Err(self.absent(name, function)),
            (Some(Meant::OfFrame), _) => Err(self.without_frame(name)),
            _ => {
                let reason = meant(name, !self.tree).map_or("", |m| reason(m, self.tree));
                Err(Missing::of(format!("has no function `{name}`{reason}")))
            }
        }
    }

    fn filtered(&self, is_wanted: impl Fn(FunctionForm) -> bool) -> Vec<FunctionForm> {
        let forms = self.inventory.iter().copied();
        forms
            .filter(|&form| self.takes(form) && is_wanted(form))
            .collect()
    }

    /// Groups contain plain forms with standard columns, which represent the requested forms.
    fn is_of(&self, group: Group, form: FunctionForm) -> bool {
        let function = match self.columns {
            Some(Columns::Base) => with(form.function, Columns::Standard).unwrap_or(form.function),
            _ => form.function,
        };
        let has = |from| group.has(self.mechanism, function, from);
        if self.from.is_empty() {
            has(form.from)
        } else {
            MotionInput::ALL.into_iter().any(has)
        }
    }

    /// The forms of a named function, or of one named with its form.
    fn form(&self, name: &str, form: FunctionForm) -> Result<Vec<FunctionForm>, Missing> {
        let FunctionForm { function, from } = form;
        let is_base = function.is_of_base_parameters();
        if is_base && self.columns == Some(Columns::Standard) {
            return Err(Missing {
                sentence: format!("can't have `{name}` with standard columns"),
                help: format!("leave out `columns`, or ask for `{}`", function.name()),
            });
        }
        let function = match (self.columns, kind(function)) {
            (Some(columns), Some(_)) => with(function, columns).ok_or_else(|| Missing {
                sentence: format!("has `{name}` with standard parameters only"),
                help:
                    "leave out `columns`, or name base forms one by one, as `inverse_dynamics_base`"
                        .to_owned(),
            })?,
            _ => function,
        };
        let plain = function_name(function, MotionInput::Joints, true);
        let is_plain = [plain.as_str(), function.name()].contains(&name);
        if !is_plain && !self.has_source(from) {
            return Err(Missing {
                sentence: format!("can't have `{name}` {}", self.sources()),
                help: format!("leave out `from`, or ask for `{plain}`"),
            });
        }
        let mut wanted = if is_plain && !self.tree && !self.from.is_empty() {
            self.from
                .iter()
                .map(|&from| FunctionForm { function, from })
                .collect()
        } else {
            vec![FunctionForm { function, from }]
        };
        wanted.retain(|form| self.inventory.contains(form));
        if wanted.is_empty() {
            Err(self.absent(name, function))
        } else {
            Ok(wanted)
        }
    }

    /// A function of a frame that the robot does not have.
    fn without_frame(&self, name: &str) -> Missing {
        let own = self.inventory.iter().copied();
        let own = own.map(|form| name_in_robot(self.mechanism, form));
        let own: Vec<String> = own.collect();
        let frame = FrameQuantity::in_name(name).map_or(name, |(frame, _)| frame);
        let describe = || format!("describe the frame in a table `[frame.{frame}]`");
        let known = own.iter().map(String::as_str);
        Missing {
            sentence: format!("has no function `{name}`: it has no frame `{frame}`"),
            help: did_you_mean(name, known).unwrap_or_else(describe),
        }
    }

    /// Why a function is missing: entirely, or for this input.
    fn absent(&self, name: &str, function: Function) -> Missing {
        let others = self
            .inventory
            .iter()
            .filter(|form| form.function == function);
        let others: Vec<&str> = others.map(|form| form.from.name()).collect();
        if others.is_empty() {
            let reason = reason(Meant::Forms(function), self.tree);
            Missing::of(format!("has no function `{name}`{reason}"))
        } else {
            Missing {
                sentence: format!("has no function `{name}` {}", self.sources()),
                help: format!("it is evaluated from {}", others.join(", ")),
            }
        }
    }

    /// The requested forms, in words.
    fn described(&self) -> String {
        let columns = self.columns.map(|c| format!("with {} columns", c.name()));
        let sources = (!self.from.is_empty()).then(|| self.sources());
        let both: Vec<String> = columns.into_iter().chain(sources).collect();
        both.join(" ")
    }

    fn sources(&self) -> String {
        let names: Vec<&str> = self.from.iter().map(|from| from.name()).collect();
        format!("from {}", names.join(", "))
    }
}

/// Standard or base: the type of its columns or of its parameter input. A payload's columns are
/// separate.
fn kind(function: Function) -> Option<Columns> {
    match function.extents().1 {
        Some(Extent::PayloadParameters) => None,
        _ => function.columns().or(function.parameters()),
    }
}

/// The function of the same name with other columns.
fn with(function: Function, columns: Columns) -> Option<Function> {
    let is_it = |other: &Function| other.name() == function.name() && kind(*other) == Some(columns);
    Function::ALL.into_iter().find(is_it)
}
