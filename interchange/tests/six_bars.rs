//! The six-bar linkages of Watt and Stephenson on each ground link, with each driven joint on it.
//!
//! On a binary link of the longest path between Stephenson's ternary links, a link on three rods can
//! only be solved as a whole: two joints of the skeleton are dependent.

use overact_codegen::{Source, check};
use overact_interchange::{Options, import};
use std::collections::VecDeque;

/// A pin between two links, at a point of the plane.
struct Pin {
    links: [char; 2],
    at: [f64; 2],
}

const fn pin(a: char, b: char, x: f64, z: f64) -> Pin {
    Pin {
        links: [a, b],
        at: [x, z],
    }
}

/// The ternary links A and B are connected by x, by y, and by z and w.
const STEPHENSON: [Pin; 7] = [
    pin('A', 'x', 0.0, 0.0),
    pin('x', 'B', 0.02, 0.2),
    pin('A', 'y', 0.2, 0.03),
    pin('y', 'B', 0.22, 0.26),
    pin('A', 'z', 0.33, -0.05),
    pin('z', 'w', 0.5, 0.12),
    pin('w', 'B', 0.36, 0.33),
];

/// The ternary links A and B have a common pin, and are connected by x and y, and by z and w.
const WATT: [Pin; 7] = [
    pin('A', 'B', 0.2, 0.02),
    pin('A', 'x', 0.0, 0.0),
    pin('x', 'y', 0.03, 0.2),
    pin('y', 'B', 0.24, 0.27),
    pin('A', 'z', 0.45, -0.02),
    pin('z', 'w', 0.5, 0.22),
    pin('w', 'B', 0.3, 0.31),
];

/// A linkage with a ground link and a driven pin.
struct SixBar<'p> {
    pins: &'p [Pin; 7],
    ground: char,
    driven: usize,
    /// Links in the order of a search from the ground, each with the pin that carries it.
    tree: Vec<(char, Option<usize>)>,
}

impl<'p> SixBar<'p> {
    fn new(pins: &'p [Pin; 7], ground: char, driven: usize) -> Self {
        let mut tree = vec![(ground, None)];
        let mut queue = VecDeque::from([ground]);
        while let Some(link) = queue.pop_front() {
            // The driven pin is in the tree.
            let others = (0..7).filter(|&at| at != driven);
            for at in [driven].into_iter().chain(others) {
                let [a, b] = pins[at].links;
                let next = if a == link { b } else { a };
                let is_new = tree.iter().all(|(own, _)| *own != next);
                if pins[at].links.contains(&link) && is_new {
                    tree.push((next, Some(at)));
                    queue.push_back(next);
                }
            }
        }
        Self {
            pins,
            ground,
            driven,
            tree,
        }
    }

    /// Point at which the frame of a link is.
    fn origin(&self, link: char) -> [f64; 2] {
        let found = self.tree.iter().find(|(own, _)| *own == link);
        let pin = found.and_then(|(_, pin)| *pin);
        pin.map_or([0.0; 2], |at| self.pins[at].at)
    }

    /// MJCF of the links that a link carries.
    fn bodies(&self, link: char) -> String {
        let start = self.origin(link);
        let carried = self.tree.iter().filter_map(|&(next, pin)| {
            let at = pin?;
            (self.pins[at].links.contains(&link) && next != link).then_some((next, at))
        });
        // A pin carries the link that the search finds later.
        let place = |link| self.tree.iter().position(|(own, _)| *own == link);
        let carried = carried.filter(|&(next, _)| place(next) > place(link));
        carried
            .map(|(next, at)| {
                let [x, z] = self.pins[at].at;
                format!(
                    "<body name='{next}' pos='{} 0 {}'><joint name='j{at}' axis='0 1 0'/>\
                     <inertial pos='.05 0 .02' mass='1' diaginertia='.01 .02 .02'/>\n{}</body>\n",
                    x - start[0],
                    z - start[1],
                    self.bodies(next)
                )
            })
            .collect()
    }

    fn mjcf(&self) -> String {
        let is_cut = |at: &usize| self.tree.iter().all(|(_, pin)| *pin != Some(*at));
        let closures: String = (0..7)
            .filter(is_cut)
            .map(|at| {
                let [mut a, mut b] = self.pins[at].links;
                if a == self.ground {
                    (a, b) = (b, a);
                }
                let (start, [x, z]) = (self.origin(a), self.pins[at].at);
                let other = if b == self.ground {
                    String::new()
                } else {
                    format!(" body2='{b}'")
                };
                let anchor = format!("{} 0 {}", x - start[0], z - start[1]);
                format!("<connect body1='{a}'{other} anchor='{anchor}'/>\n")
            })
            .collect();
        format!(
            "<mujoco model='six'><worldbody>{}</worldbody><equality>{closures}</equality>\
             <actuator><motor joint='j{}'/></actuator></mujoco>",
            self.bodies(self.ground),
            self.driven
        )
    }
}

/// All ground links and driven pins of a linkage.
fn all(pins: &[Pin; 7]) -> Vec<(char, usize)> {
    let each = pins.iter().enumerate();
    each.flat_map(|(at, pin)| pin.links.map(|ground| (ground, at)))
        .collect()
}

#[test]
fn all_six_bars_are_described() {
    for (name, pins) in [("Stephenson", &STEPHENSON), ("Watt", &WATT)] {
        for (ground, driven) in all(pins) {
            let folder = tempfile::tempdir().expect("a folder");
            let file = folder.path().join("six.xml");
            let text = SixBar::new(pins, ground, driven).mjcf();
            std::fs::write(&file, &text).expect("a file");
            let what = format!("{name} on {ground}, driven by j{driven}");
            let found = import(&file, &Options::default());
            let found = found.unwrap_or_else(|errors| panic!("{what}: {errors:?}\n{text}"));
            let is_of_class_iii = name == "Stephenson" && ['z', 'w'].contains(&ground);
            let dependent = found.text.matches("\ndependent = true\n").count();
            let expected = if is_of_class_iii { 2 } else { 0 };
            assert_eq!(dependent, expected, "{what}");
            let source = Source::new("six.toml", found.text);
            let mechanism = match check(&source) {
                Ok(checked) => checked.mechanism,
                Err(errors) => panic!("{what}: {}", errors.render_plain(&source)),
            };
            assert_eq!(mechanism.dof(), 1, "{what}");
            if is_of_class_iii {
                let motor = format!("j{driven}");
                assert_eq!(mechanism.coordinates(), [motor], "{what}");
            }
        }
    }
}
