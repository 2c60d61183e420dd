//! Reader of OpenSYMORO's .par files.
//!
//! A .par file is a table of modified Denavit-Hartenberg constants and body parameters, as numbers
//! or symbols.

mod expression;
mod symbols;
mod text;

use crate::{
    account::{PAR, Use},
    files::{Files, Place},
    frames::step::Step,
    geometry::exact,
    model::{Body, Closure, ClosureKind, Follow, Inertia, Joint, JointType, Model, Pose},
    options::Options,
    prune::record_key,
};
use expression::{Fault, symbols, value};
use nalgebra::{Matrix3, Point3, Vector3};
use std::collections::BTreeMap;
use text::{Entries, entries, robot_name};

/// Keys with one value for each link, each joint, and each frame.
const KEYS: [&str; 3] = [
    "XX XY XZ YY YZ ZZ MX MY MZ M",
    "IA FV FS MU",
    "ANT SIGMA B D R GAMMA ALPHA THETA",
];

/// Tolerance of linear positions, rad or m; larger than the rounding of right angles.
const LINEAR: f64 = 1e-6;

/// Largest number of frames.
const FRAMES: usize = 1000;

/// Reads a robot; errors are recorded in `files`.
pub(crate) fn read(files: &Files, file: usize, options: &Options) -> Option<Model> {
    let text = files.text(file);
    let entries = entries(files, file, &text)?;
    for (key, (place, values)) in &entries {
        let values: Vec<&str> = values.iter().map(|(text, _)| text.as_str()).collect();
        record_key(files, &PAR, "par", key, &values.join(" "), place);
    }
    symbols::check(files, &entries, options)?;
    let reader = Reader {
        files,
        entries,
        file,
        symbols: options.values.iter().cloned().collect(),
    };
    let mut model = Model::new(robot_name(&text).unwrap_or("robot"));
    reader.robot(&mut model, options)?;
    files.is_clean().then_some(model)
}

struct Reader<'f> {
    files: &'f Files,
    entries: Entries,
    file: usize,
    /// Symbol values given by the user.
    symbols: BTreeMap<String, f64>,
}

/// A row of the frame table.
struct Frame {
    antecedent: usize,
    /// 0 revolute, 1 prismatic, 2 fixed.
    sigma: usize,
    place: Place,
}

impl Reader<'_> {
    fn robot(&self, model: &mut Model, options: &Options) -> Option<()> {
        let Some(links) = self.count("NL") else {
            if self.files.is_clean() {
                let message = "the table does not say how many links the robot has";
                let help =
                    "write NL = …, NJ = … and NF = …: the numbers of links, joints and frames";
                self.files.report(&self.place("NJ"), message, help);
            }
            return None;
        };
        let joints = self
            .count("NJ")
            .or_else(|| self.files.is_clean().then_some(links))?;
        let usual = joints.saturating_mul(2).saturating_sub(links);
        let frames = self.count("NF").unwrap_or(usual);
        self.check_counts(links, joints, frames)?;
        for key in ["is_floating", "is_mobile"] {
            let floats = self
                .entries
                .get(&key.to_ascii_uppercase())
                .and_then(|(_, values)| values.first());
            if let Some((_, place)) = floats
                .filter(|(text, _)| !["0", "False"].contains(&text.as_str()) && !options.fix_base)
            {
                let help =
                    "a floating base has no motor to identify it with: `--fix-base` fixes it";
                self.files
                    .report(place, "a moving base is not supported", help);
            }
        }
        self.gravity(model);
        self.report_further_values([links, joints, frames]);
        let table = self.table(frames)?;
        let mut variables = BTreeMap::new();
        model.says_motors = self.entries.contains_key("MU");
        for (at, frame) in table.iter().enumerate() {
            // The second frame of a loop-closing joint is fixed to the body where the loop ends.
            if at >= joints {
                self.close(at, at - (joints - links), &table, model);
                continue;
            }
            let number = at + 1;
            let (placement, joint) = self.joint(at, frame, &mut variables, model)?;
            let (inertia, is_unknown) = if at < links {
                self.inertia(at)?
            } else {
                (None, false)
            };
            let joint = joint.map(|mut joint| {
                joint.actuated = self.is_driven(at);
                self.torques(at, &mut joint);
                model.joints.push(joint);
                model.joints.len() - 1
            });
            model.bodies.push(Body {
                name: format!("link{number}"),
                parent: frame.antecedent,
                placement,
                place: Some(frame.place.clone()),
                joint,
                inertia,
                has_unknown_inertia: is_unknown,
            });
        }
        self.files.is_clean().then_some(())
    }

    /// Reports numbers of links, joints and frames that do not match; `None` after an error.
    fn check_counts(&self, links: usize, joints: usize, frames: usize) -> Option<()> {
        let usual = joints.saturating_mul(2).saturating_sub(links);
        let (key, message, help) = if links == 0 {
            let message = "the robot has no links: NL = 0".to_owned();
            (
                "NL",
                message,
                "NL is the number of links that move".to_owned(),
            )
        } else if joints < links {
            let message =
                format!("the robot has fewer joints than links: NJ = {joints}, NL = {links}");
            let help = format!("each link has a joint: NJ is at least {links}");
            ("NJ", message, help)
        } else if joints > FRAMES {
            let message = format!("the robot has {joints} joints, more than {FRAMES}");
            ("NJ", message, "import the robot in parts".to_owned())
        } else if frames != usual {
            let message = format!(
                "the table has NF = {frames} frames; NL = {links} links and NJ = {joints} joints have {usual}"
            );
            let help = format!(
                "each joint in excess of the links closes a loop and has two frames: NF = 2 NJ - NL = {usual}"
            );
            ("NF", message, help)
        } else {
            return Some(());
        };
        self.files.report(&self.place(key), message, help);
        None
    }

    /// Reports nonzero values beyond the last link, joint or frame.
    fn report_further_values(&self, counts: [usize; 3]) {
        for (keys, most) in KEYS.iter().zip(counts) {
            for key in keys.split_whitespace() {
                let values = self.entries.get(key).map(|(_, values)| values.as_slice());
                for (text, place) in values.unwrap_or_default().iter().skip(most) {
                    if value(text, &self.symbols).is_ok_and(|value| value != 0.0) {
                        let reason = "values beyond the last link, joint or frame are not used";
                        self.files
                            .record(Use::Reported, place, "par", Some(key), reason);
                    }
                }
            }
        }
    }

    /// Antecedents and types of the frames.
    fn table(&self, frames: usize) -> Option<Vec<Frame>> {
        let mut table = Vec::new();
        for at in 0..frames {
            let antecedent = self.whole("ANT", at)?;
            let sigma = self.whole("SIGMA", at)?;
            let place = self.entry("ANT", at)?.1.clone();
            if antecedent > at || sigma > 2 {
                let message = format!(
                    "frame {} has the antecedent {antecedent} and sigma {sigma}",
                    at + 1
                );
                let help = "ant is an earlier frame, or 0 for the base; sigma is 0, 1 or 2";
                self.files.report(&place, message, help);
                return None;
            }
            table.push(Frame {
                antecedent,
                sigma,
                place,
            });
        }
        Some(table)
    }

    /// Adds a closure between the body of the cut joint and the body of its second frame.
    fn close(&self, at: usize, cut: usize, table: &[Frame], model: &mut Model) {
        let Some((body, placement)) = self.on_body(at, table, model.bodies.len()) else {
            return;
        };
        model.closures.push(Closure {
            name: format!("j{}", cut + 1),
            kind: ClosureKind::Weld {
                bodies: [body, cut + 1],
                at: [placement, Pose::identity()],
            },
            place: table[at].place.clone(),
        });
    }

    /// Body that a second frame is fixed to (below `bodies`), and the frame's pose in it.
    ///
    /// Intermediate frames must be fixed too; `None` after an error.
    fn on_body(&self, at: usize, table: &[Frame], bodies: usize) -> Option<(usize, Pose)> {
        let mut placement = self.step(at, &BTreeMap::new())?.frame();
        let mut antecedent = table[at].antecedent;
        while antecedent >= bodies {
            let before = antecedent - 1;
            placement = self.step(before, &BTreeMap::new())?.frame() * placement;
            antecedent = table[before].antecedent;
        }
        Some((antecedent, placement))
    }

    /// Pose at joint position zero, and the joint; `None` after an error.
    fn joint(
        &self,
        at: usize,
        frame: &Frame,
        variables: &mut BTreeMap<String, usize>,
        model: &Model,
    ) -> Option<(Pose, Option<Joint>)> {
        let name = format!("j{}", at + 1);
        let key = match frame.sigma {
            0 => "THETA",
            1 => "R",
            _ => return Some((self.step(at, &BTreeMap::new())?.frame(), None)),
        };
        let kind = if frame.sigma == 0 {
            JointType::Revolute
        } else {
            JointType::Prismatic
        };
        let (text, place) = self.entry(key, at)?;
        let mut free = symbols(text);
        free.retain(|symbol| !self.symbols.contains_key(symbol));
        let [variable] = &free[..] else {
            let message = format!(
                "the position of joint {} is `{text}`, which has {} variables",
                at + 1,
                free.len()
            );
            let help = "a joint's position is its own variable, or a multiple of another joint's, plus a constant: give the values of other symbols, `--value NAME=NUMBER`";
            self.files.report(place, message, help);
            return None;
        };
        let zero = self.step(at, &BTreeMap::from([(variable.clone(), 0.0)]))?;
        let one = self.step(at, &BTreeMap::from([(variable.clone(), 1.0)]))?;
        let two = self.step(at, &BTreeMap::from([(variable.clone(), 2.0)]))?;
        let factor = one.theta - zero.theta + one.r - zero.r;
        let next_factor = two.theta - one.theta + two.r - one.r;
        if (next_factor - factor).abs() > LINEAR {
            let message = format!(
                "the position of joint {} is `{text}`, which is not linear",
                at + 1
            );
            let help = "a joint's position is a variable, or a multiple of another joint's, plus a constant";
            self.files.report(place, message, help);
            return None;
        }
        let mut joint = Joint::new(&name, kind, place.clone());
        match variables.get(variable) {
            Some(&leader) => {
                joint.follow = Some(Follow {
                    joint: leader,
                    factor,
                    offset: 0.0,
                });
            }
            None if (factor - 1.0).abs() < 1e-12 => {
                variables.insert(variable.clone(), model.joints.len());
            }
            None => {
                let message = format!(
                    "the position of joint {} is `{text}`, not a variable plus a constant",
                    at + 1
                );
                self.files.report(
                    place,
                    message,
                    "write the joint's variable with the factor 1",
                );
                return None;
            }
        }
        Some((zero.frame(), Some(joint)))
    }

    /// The six constants of a frame for a value of its variable.
    fn step(&self, at: usize, variable: &BTreeMap<String, f64>) -> Option<Step> {
        let mut symbols = self.symbols.clone();
        symbols.extend(variable.clone());
        let of = |key: &str| self.number(key, at, &symbols);
        let (gamma, b, alpha) = (of("GAMMA"), of("B"), of("ALPHA"));
        let (d, theta, r) = (of("D"), of("THETA"), of("R"));
        Some(Step {
            gamma: exact::angle(gamma?),
            b: b?,
            alpha: exact::angle(alpha?),
            d: d?,
            theta: exact::angle(theta?),
            r: r?,
        })
    }

    /// Inertia of a body, and whether it has inertia without values.
    fn inertia(&self, at: usize) -> Option<(Option<Inertia>, bool)> {
        let keys = ["XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M"];
        let mut values = [0.0; 10];
        for (value, key) in values.iter_mut().zip(keys) {
            match self.optional(key, at)? {
                Some(known) => *value = known,
                None => return Some((None, true)),
            }
        }
        let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = values;
        let first = Vector3::new(mx, my, mz);
        let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        if mass == 0.0 {
            // Base parameters are moments without mass and cannot serve as a prior.
            let is_empty = first == Vector3::zeros() && about == Matrix3::zeros();
            return Some((None, !is_empty));
        }
        if mass < 0.0 {
            let (_, place) = self.entry("M", at)?;
            let help = "give a mass that is zero or more, or a symbol if it is unknown";
            self.files.report(place, "a mass is negative", help);
        }
        let centre = Point3::from(first / mass);
        let own = Inertia {
            mass,
            centre,
            tensor: Matrix3::zeros(),
        };
        Some((
            Some(Inertia {
                tensor: about - own.about_origin(),
                ..own
            }),
            false,
        ))
    }

    /// Friction and rotor inertia of a joint, if they are numbers.
    fn torques(&self, at: usize, joint: &mut Joint) {
        let own = |key: &str| self.optional(key, at).flatten().unwrap_or(0.0);
        (joint.armature, joint.damping, joint.friction) = (own("IA"), own("FV"), own("FS"));
    }

    fn is_driven(&self, at: usize) -> bool {
        self.entries
            .get("MU")
            .and_then(|(_, values)| values.get(at))
            .is_some_and(|(text, _)| text == "1")
    }

    /// Reads gravity; symbols mean 9.81 m/s² along −z.
    fn gravity(&self, model: &mut Model) {
        let Some((_, values)) = self.entries.get("G") else {
            return;
        };
        let numbers: Vec<Option<f64>> = values
            .iter()
            .map(|(text, _)| value(text, &self.symbols).ok())
            .collect();
        match numbers[..] {
            [Some(x), Some(y), Some(z)] => model.gravity = [x, y, z],
            _ => {
                let list: Vec<&str> = values.iter().map(|(text, _)| text.as_str()).collect();
                let reason = "gravity has no value: 9.81 m/s² against z in the model";
                self.files
                    .demote(&self.place("G"), "par", Some("G"), reason);
                model.notes.push(format!(
                    "Gravity is {{{}}} in the file, and 9.81 m/s² against z here.",
                    list.join(", ")
                ));
            }
        }
    }

    fn place(&self, key: &str) -> Place {
        let start = Place {
            file: self.file,
            span: 0..1,
        };
        self.entries
            .get(key)
            .map_or(start, |(place, _)| place.clone())
    }

    /// Value of a list; reports an error if it is missing.
    fn entry(&self, key: &str, at: usize) -> Option<&(String, Place)> {
        let found = self.entries.get(key).and_then(|(_, values)| values.get(at));
        if found.is_none() {
            let message = if self.entries.contains_key(key) {
                format!("`{key}` has no value for frame {}", at + 1)
            } else {
                format!("the table has no `{key}`")
            };
            let help = "geometric parameters have NF values, dynamic ones NL";
            self.files.report(&self.place(key), message, help);
        }
        found
    }

    /// Reads a single integer.
    fn count(&self, key: &str) -> Option<usize> {
        let (text, place) = self
            .entries
            .get(key)
            .and_then(|(_, values)| values.first())?;
        let found = text.parse().ok();
        if found.is_none() {
            self.files.report(
                place,
                format!("`{key}` is not an integer"),
                "write for instance NL = 6",
            );
        }
        found
    }

    fn whole(&self, key: &str, at: usize) -> Option<usize> {
        let (text, place) = self.entry(key, at)?;
        let found = text.parse().ok();
        if found.is_none() {
            self.files.report(
                place,
                format!("`{text}` is not an integer"),
                "write 0, 1, 2, …",
            );
        }
        found
    }

    /// Reads a number; reports an error if a symbol has no value.
    fn number(&self, key: &str, at: usize, symbols: &BTreeMap<String, f64>) -> Option<f64> {
        let (text, place) = self.entry(key, at)?;
        match value(text, symbols) {
            Ok(value) => Some(value),
            Err(Fault::Unknown(symbol)) => {
                let message = format!("`{symbol}` has no value");
                let help = format!("give it, in m or rad: `--value {symbol}=NUMBER`");
                self.files.report(place, message, help);
                None
            }
            Err(Fault::Unreadable) => {
                let message = format!("`{text}` is not an expression");
                let help = "numbers, symbols, pi, + - * / ** ^, parentheses, sqrt, sin, cos, tan, asin, acos, atan and atan2 are allowed; lengths are in m and angles in rad";
                self.files.report(place, message, help);
                None
            }
        }
    }

    /// Reads a dynamic parameter: `Some(None)` if its symbol has no value, zero if it is absent.
    fn optional(&self, key: &str, at: usize) -> Option<Option<f64>> {
        let found = self.entries.get(key).and_then(|(_, values)| values.get(at));
        let Some((text, _)) = found else {
            return Some(Some(0.0));
        };
        match value(text, &self.symbols) {
            Ok(value) => Some(Some(value)),
            Err(Fault::Unknown(_)) => Some(None),
            Err(Fault::Unreadable) => self.number(key, at, &self.symbols).map(Some),
        }
    }
}
