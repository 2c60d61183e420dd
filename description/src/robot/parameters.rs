//! Lists of standard parameters: symbols, and groups of them.

use crate::diagnostic::{Code, did_you_mean};
use crate::robot::friction;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;
use overact_core::StandardParameter as P;

/// The kind of body to which a list of parameters belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Owner {
    /// A body that is moved by a joint of this kind.
    Joint(JointKind),
    /// A motor that drives joints.
    Motor,
    /// A cable, whose drive acts on its length.
    Cable,
    /// The platform or the payload.
    FreeBody,
}

impl Owner {
    /// The parameters of `"all"`.
    fn all(self) -> &'static [P] {
        match self {
            Self::FreeBody | Self::Joint(JointKind::Fixed) => &P::INERTIA,
            Self::Motor | Self::Cable => &P::DRIVE,
            Self::Joint(_) => &P::ALL,
        }
    }

    /// Whether a parameter is possible.
    fn can_have(self, parameter: P) -> bool {
        let moves = !matches!(self, Self::FreeBody | Self::Joint(JointKind::Fixed));
        self.all().contains(&parameter) || moves && P::OPTIONAL.contains(&parameter)
    }

    /// The default parameters of a body.
    pub(crate) fn default(self, actuated: bool) -> Vec<P> {
        let all = self.all().iter().copied();
        all.filter(|p| actuated || *p != P::Ia).collect()
    }
}

impl Item<'_, '_> {
    /// The parameters of a list, sorted and unique; a single string is a list of one.
    pub(crate) fn parameters(&self, owner: Owner) -> Option<Vec<P>> {
        let names = if self.value.is_str() {
            vec![self.clone()]
        } else {
            self.list()?
        };
        let mut all = Vec::new();
        for item in names {
            all.extend(item.parameter_group(owner).unwrap_or_default());
        }
        all.sort_unstable();
        all.dedup();
        friction::check(self, &all);
        Some(all)
    }

    fn parameter_group(&self, owner: Owner) -> Option<Vec<P>> {
        let name = self.string()?.value;
        let group = match name.as_str() {
            "all" => owner.all().to_vec(),
            "inertia" => P::INERTIA.to_vec(),
            "friction" => P::FRICTION.to_vec(),
            "friction by direction" => P::DIRECTED.to_vec(),
            symbol => {
                let Some(parameter) = P::from_name(symbol) else {
                    self.unknown_parameter(symbol);
                    return None;
                };
                vec![parameter]
            }
        };
        if let Some(wrong) = group.iter().find(|p| !owner.can_have(**p)) {
            let ten = "its parameters are the ten of \"inertia\"";
            let (body, help) = match owner {
                Owner::FreeBody => ("a free body", ten),
                Owner::Joint(_) => ("a fixed joint", ten),
                Owner::Motor | Owner::Cable => (
                    if owner == Owner::Cable {
                        "a cable"
                    } else {
                        "a motor"
                    },
                    "its parameters are \"ia\", \"fv\", \"fs\", \"off\", \"fq\" and those of \"friction by direction\"",
                ),
            };
            let message = format!("{body} has no parameter `{}`", wrong.name());
            self.context
                .report(self.error(Code::PARAMETER_GROUPS, message).help(help));
        }
        Some(group)
    }

    fn unknown_parameter(&self, symbol: &str) {
        let with_key = [
            (P::K, "spring = \"q - 20 deg\""),
            (P::Fl, "friction_load = \"40 N m * cos(q)\""),
            (P::Fst, "stribeck = \"0.05 rad/s\""),
        ];
        if let Some((_, key)) = with_key.iter().find(|(one, _)| one.name() == symbol) {
            let error = self.error(Code::PARAMETER_GROUPS, format!("`{symbol}` is not listed"));
            let help = format!("the key {key} of the joint adds it");
            self.context.report(error.help(help));
            return;
        }
        let known = || {
            P::listed()
                .map(P::name)
                .chain(["all", "inertia", "friction", "friction by direction"])
        };
        let help = did_you_mean(symbol, known());
        let list = || format!("known: {}", known().collect::<Vec<_>>().join(", "));
        let message = format!("unknown parameter `{symbol}`");
        self.context.report(
            self.error(Code::PARAMETER_GROUPS, message)
                .help(help.unwrap_or_else(list)),
        );
    }
}
