//! Names of actuators: one for output, logs and generated code, and alternative spellings for
//! input.

use crate::diagnostic::did_you_mean;

/// The names of a robot's actuators, in the order of q and τ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ActuatorNames {
    all: Vec<Names>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Names {
    /// The name for output.
    usual: String,
    /// Alternative spellings.
    others: Vec<String>,
}

impl ActuatorNames {
    /// Names from those of legs and actuated joints.
    ///
    /// The usual name is the leg's if it has one actuator, or the joint's in a robot of one leg
    /// without a platform (`single`). Otherwise it is `leg_joint`, or `leg.joint` if two actuators
    /// would have the same name.
    #[must_use]
    pub fn new<'a>(single: bool, actuators: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Self::with_motors(single, actuators, [])
    }

    /// Names from those of legs and actuated joints, then of motors and their legs.
    ///
    /// A motor without a leg has its own name.
    #[must_use]
    pub fn with_motors<'a>(
        single: bool,
        joints: impl IntoIterator<Item = (&'a str, &'a str)>,
        motors: impl IntoIterator<Item = (Option<&'a str>, &'a str)>,
    ) -> Self {
        let motors: Vec<(Option<&str>, &str)> = motors.into_iter().collect();
        let of_legs = motors
            .iter()
            .filter_map(|(leg, name)| Some(((*leg)?, *name)));
        let actuators: Vec<(&str, &str)> = joints.into_iter().chain(of_legs).collect();
        let alone = |leg: &str| actuators.iter().filter(|(other, _)| *other == leg).count() == 1;
        let short = |&(leg, joint): &(&str, &str)| match (single, alone(leg)) {
            (true, _) => joint.to_owned(),
            (false, true) => leg.to_owned(),
            (false, false) => format!("{leg}_{joint}"),
        };
        let names = |actuator: &(&str, &str)| {
            let (leg, joint) = *actuator;
            let short_name = short(actuator);
            let like = actuators.iter().filter(|other| short(other) == short_name);
            let dotted = format!("{leg}.{joint}");
            let usual = match like.count() {
                1 => short_name,
                _ => dotted.clone(),
            };
            let mut others = vec![dotted, format!("{leg}_{joint}")];
            if alone(leg) {
                others.push(leg.to_owned());
            }
            others.retain(|other| *other != usual);
            Names { usual, others }
        };
        let mut of_legs = actuators.iter().map(names);
        let joints = actuators.len() - motors.iter().filter(|(leg, _)| leg.is_some()).count();
        let mut all: Vec<Names> = of_legs.by_ref().take(joints).collect();
        for (leg, name) in motors {
            let of_robot = || Names {
                usual: name.to_owned(),
                others: Vec::new(),
            };
            let own = leg.and_then(|_| of_legs.next());
            all.push(own.unwrap_or_else(of_robot));
        }
        Self { all }
    }

    /// The usual names.
    pub fn usual(&self) -> impl Iterator<Item = &str> {
        self.all.iter().map(|names| names.usual.as_str())
    }

    /// The actuator of a name: the usual one, or an unambiguous alternative spelling.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<usize> {
        let usual = self.usual().position(|usual| usual == name);
        let spelt = |at: &usize| self.all[*at].others.iter().any(|other| other == name);
        usual.or_else(|| {
            let mut meant = (0..self.all.len()).filter(spelt);
            meant.next().filter(|_| meant.next().is_none())
        })
    }

    /// A remedy for an unknown or ambiguous name.
    #[must_use]
    pub fn help(&self, name: &str) -> String {
        did_you_mean(name, self.usual()).unwrap_or_else(|| {
            let all: Vec<&str> = self.usual().collect();
            format!("the actuators are {}", all.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::ActuatorNames;

    #[test]
    fn all_spellings_of_an_actuator_name_are_accepted() {
        let names = ActuatorNames::new(false, [("A", "1"), ("B", "1"), ("B", "2")]);
        assert_eq!(names.usual().collect::<Vec<_>>(), ["A", "B_1", "B_2"]);
        for (name, index) in [("A", 0), ("A.1", 0), ("A_1", 0), ("B.2", 2), ("B_2", 2)] {
            assert_eq!(names.find(name), Some(index), "{name}");
        }
        assert_eq!(names.find("B"), None, "which of two?");
        assert_eq!(names.find("B_3"), None);
        assert!(names.help("C7").contains("the actuators are A, B_1, B_2"));
        let arm = ActuatorNames::new(true, [("arm", "1"), ("arm", "2")]);
        assert_eq!(arm.usual().collect::<Vec<_>>(), ["1", "2"]);
        assert_eq!((arm.find("arm.2"), arm.find("arm_1")), (Some(1), Some(0)));
    }

    #[test]
    fn ambiguous_actuator_names_are_rejected() {
        let actuators = [("a", "b_c"), ("a", "d"), ("a_b", "c"), ("a_b", "d")];
        let names = ActuatorNames::new(false, actuators);
        let usual: Vec<&str> = names.usual().collect();
        assert_eq!(usual, ["a.b_c", "a_d", "a_b.c", "a_b_d"]);
        assert_eq!(names.find("a_b_c"), None);
        for (index, name) in usual.iter().enumerate() {
            assert_eq!(names.find(name), Some(index));
        }
        // A leg's name is that of its actuator, even if another leg and its joint could be spelt
        // so.
        let names = ActuatorNames::new(false, [("a", "1"), ("a", "2"), ("a_1", "x")]);
        assert_eq!(names.usual().collect::<Vec<_>>(), ["a.1", "a_2", "a_1.x"]);
    }
}
