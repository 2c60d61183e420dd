//! Legs of a description with constants, parameters and values, from skeleton and chains.

mod joints;
mod motors;
mod names;
mod platform;
mod screws;
mod springs;

use crate::{
    assembly::{
        coordinates::Tree,
        layout::{Layout, LayoutPiece},
        misfit,
        network::Network,
        solvable_chains::{Ending, SolvableChain},
    },
    files::Files,
    frames::{leg, step::Step},
    model::Pose,
};
use joints::Draft;
use nalgebra::{Point3, Vector3};
use names::Names;

pub(crate) use names::word;
pub(crate) use platform::PlanPlatform;
pub(crate) use springs::Spring;

/// A leg.
#[derive(Debug)]
pub(crate) struct Leg {
    pub(crate) name: String,
    /// Comment lines.
    pub(crate) comment: Vec<String>,
    /// Body that carries it and its base frame there; `None` for the identity on the ground.
    pub(crate) base: Option<(Option<String>, Pose)>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) end: Option<End>,
    /// Motors, if one of them turns several joints.
    pub(crate) motors: Vec<Motor>,
}

/// A motor.
#[derive(Debug)]
pub(crate) struct Motor {
    pub(crate) name: String,
    /// The combination of joints that it turns, as an expression.
    pub(crate) turns: String,
    pub(crate) ratio: f64,
    /// Parameter values by symbol.
    pub(crate) values: Vec<(&'static str, f64)>,
}

/// A joint.
#[derive(Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    /// `revolute`, `prismatic`, `helical` or `fixed`.
    pub(crate) kind: &'static str,
    /// Pitch of a helical joint, m for each turn.
    pub(crate) pitch: Option<f64>,
    /// Joint that carries it if not the previous one; `base` for none.
    pub(crate) antecedent: Option<String>,
    pub(crate) step: Step,
    /// Expression of its coupling; its own variable if `None`.
    pub(crate) follows: Option<String>,
    /// Whether the chains determine its position, in a skeleton or branch.
    pub(crate) is_dependent: bool,
    pub(crate) actuated: bool,
    /// Its parameters; the default set if `None`.
    pub(crate) parameters: Option<Vec<&'static str>>,
    /// Parameter values by symbol.
    pub(crate) values: Vec<(&'static str, f64)>,
    /// Rest position of its spring.
    pub(crate) spring: Option<f64>,
    pub(crate) home: f64,
    /// Joint of the file.
    pub(crate) of: Option<usize>,
    /// Group of bodies that it carries, and the joint's frame in the world at home.
    pub(crate) carries: Option<(usize, Pose)>,
    pub(crate) comment: Vec<String>,
}

/// End of a chain.
#[derive(Debug)]
pub(crate) struct End {
    /// Name of the body; empty for the platform.
    pub(crate) body: String,
    pub(crate) is_rigid: bool,
    /// Closure point or frame in the body's frame.
    pub(crate) at: Pose,
}

/// All legs.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) legs: Vec<Leg>,
    /// Motors that turn several joints, in a robot with loops.
    pub(crate) motors: Vec<Motor>,
    /// Springs and dampers between two points.
    pub(crate) springs: Vec<Spring>,
    /// Axes of the skeleton's joints in the world at home, including coupled joints.
    pub(crate) axes: Vec<Vector3<f64>>,
    /// Platform on which the legs end; `None` if they end on bodies.
    pub(crate) platform: Option<PlanPlatform>,
    /// Comments for the head of the description.
    pub(crate) notes: Vec<String>,
}

/// Name of each group in the description, and its frame in the world at home.
type Bodies = Vec<Option<(String, Pose)>>;

impl Plan {
    /// Legs of a layout; `None` after an error.
    pub(crate) fn new(files: &Files, network: &Network<'_>, layout: &Layout) -> Option<Self> {
        let mut bodies: Bodies = vec![None; network.groups.len()];
        bodies[0] = Some(("ground".to_owned(), Pose::identity()));
        let mut names = Names::default();
        let (leg, mut axes) = skeleton(files, network, layout, &mut bodies, &mut names);
        let mut legs = vec![leg];
        if network.model.closures.is_empty() {
            legs[0].motors = motors::of_leg(network.model, &legs[0]);
        }
        for piece in &layout.pieces {
            legs.push(match piece {
                LayoutPiece::Chain(ear) => chain(files, network, ear, &mut bodies, &mut names)?,
                LayoutPiece::Branch(tree) => {
                    let (leg, own) = branch(files, network, layout, tree, &mut bodies, &mut names)?;
                    axes.extend(own);
                    leg
                }
            });
        }
        let motors = if network.model.closures.is_empty() {
            Vec::new()
        } else {
            motors::of_robot(network.model, &legs)
        };
        let springs = springs::between_points(files, network, &bodies);
        let notes = notes(network, layout);
        Some(Self {
            legs,
            motors,
            springs,
            axes,
            platform: None,
            notes,
        })
    }
}

fn skeleton(
    files: &Files,
    network: &Network<'_>,
    layout: &Layout,
    bodies: &mut Bodies,
    names: &mut Names,
) -> (Leg, Vec<Vector3<f64>>) {
    let is_tree = layout.pieces.is_empty();
    let mut draft = Draft::new(files, network, &layout.dependent);
    draft.push_tree(&layout.skeleton, !is_tree);
    let framed = leg::framed(&draft.nodes, &Pose::identity(), None);
    for (at, group) in draft.groups.iter().enumerate() {
        if let Some(group) = group {
            bodies[*group] = Some((draft.names[at].clone(), framed[at].frame));
        }
    }
    let name = names.unique(if is_tree { "robot" } else { "skeleton" });
    let comment = if is_tree {
        Vec::new()
    } else {
        vec![independent(network, layout)]
    };
    let joints = draft.joints(&framed);
    let axes = draft.nodes.iter().map(|node| node.direction).collect();
    let leg = Leg {
        name,
        comment,
        base: None,
        joints,
        end: None,
        motors: Vec::new(),
    };
    (leg, axes)
}

/// Comment on the independent coordinates.
fn independent(network: &Network<'_>, layout: &Layout) -> String {
    let has_branches = layout.coordinates().len() > layout.skeleton.len();
    let branches = if has_branches {
        " and those of branches"
    } else {
        ""
    };
    if !layout.dependent.is_empty() {
        let others = match network.mobility {
            1 => "the other is the independent coordinate".to_owned(),
            count => format!("the others{branches} are the {count} independent coordinates"),
        };
        return format!("The skeleton: the chains determine its `dependent` joints; {others}.");
    }
    if network.mobility == 1 {
        return "The skeleton: its joint is the independent coordinate, which determines the chains.".to_owned();
    }
    format!(
        "The skeleton: its joints{branches} are the {} independent coordinates, which determine the chains.",
        network.mobility
    )
}

/// Builds a tree on a body of a chain, and the axes of its joints.
fn branch(
    files: &Files,
    network: &Network<'_>,
    layout: &Layout,
    tree: &Tree,
    bodies: &mut Bodies,
    names: &mut Names,
) -> Option<(Leg, Vec<Vector3<f64>>)> {
    let &(first, carrier) = tree.first()?;
    let mut draft = Draft::new(files, network, &layout.dependent);
    draft.push_tree(tree, true);
    let (base_name, base_frame) = bodies[carrier].clone()?;
    let base = leg::base(&draft.nodes, &base_frame, None);
    let framed = leg::framed(&draft.nodes, &base, None);
    let groups = network.edges[first].groups;
    let carried = groups[usize::from(groups[0] == carrier)];
    let name = names.unique(network.group_name(carried));
    for (at, group) in draft.groups.iter().enumerate() {
        if let Some(group) = group {
            bodies[*group] = Some((format!("{name}.{}", draft.names[at]), framed[at].frame));
        }
    }
    let joints = draft.joints(&framed);
    let axes = draft.nodes.iter().map(|node| node.direction).collect();
    let comment = format!(
        "A branch on `{}`, a body of a chain: its joints are also independent coordinates.",
        network.group_name(carrier)
    );
    let leg = Leg {
        name,
        comment: vec![comment],
        base: Some((Some(base_name), base_frame.inv_mul(&base))),
        joints,
        end: None,
        motors: Vec::new(),
    };
    Some((leg, axes))
}

fn chain(
    files: &Files,
    network: &Network<'_>,
    ear: &SolvableChain,
    bodies: &mut Bodies,
    names: &mut Names,
) -> Option<Leg> {
    let (first, last) = (*ear.groups.first()?, *ear.groups.last()?);
    let mut draft = Draft::new(files, network, &[]);
    let is_point = ear.ending == Ending::Point;
    let count = if is_point {
        ear.edges.len() - 1
    } else {
        ear.edges.len()
    };
    for at in 0..count {
        draft.push(ear.edges[at], ear.groups[at], ear.groups[at + 1], true);
    }
    if !is_point {
        draft.end_without_body();
    }
    let closing = &network.edges[*ear.edges.last()?];
    let point = network.axis(closing, &network.states[0]).point;
    let end_point = is_point.then_some(point);
    let (base_name, base_frame) = bodies[first].clone()?;
    let base = leg::base(&draft.nodes, &base_frame, end_point);
    let framed = leg::framed(&draft.nodes, &base, end_point);
    let inner = ear.groups[1..ear.groups.len() - 1].first().copied();
    let own = inner.map_or_else(
        || network.edge_name(closing),
        |group| network.group_name(group),
    );
    let name = names.unique(own);
    for (at, group) in draft.groups.iter().enumerate() {
        if let Some(group) = group {
            bodies[*group] = Some((format!("{name}.{}", draft.names[at]), framed[at].frame));
        }
    }
    let mut joints = draft.joints(&framed);
    let (end_name, end_frame) = bodies[last].clone()?;
    let last_frame = framed.last()?.frame;
    if let Some(point) = end_point {
        joints.extend(joints::tip(&last_frame, &point, &mut draft.used));
    }
    let at = match end_point {
        Some(point) => {
            let inside: Point3<f64> = end_frame.inverse_transform_point(&point);
            Pose::from_parts(inside.coords.into(), nalgebra::Rotation3::identity())
        }
        None => end_frame.inv_mul(&last_frame),
    };
    let body = (first != 0).then_some(base_name);
    let comment = joints::chain_comment(network, ear);
    Some(Leg {
        name,
        comment,
        base: Some((body, base_frame.inv_mul(&base))),
        joints,
        end: Some(End {
            body: end_name,
            is_rigid: !is_point,
            at,
        }),
        motors: Vec::new(),
    })
}

fn notes(network: &Network<'_>, layout: &Layout) -> Vec<String> {
    let mut notes = network.model.notes.clone();
    for own in &network.model.misfits {
        let amount = misfit::amount(own.length, own.angle);
        notes.push(format!(
            "Misfit of the loops: `{}` is changed by {amount} here.",
            own.name
        ));
    }
    for (at, group) in network.groups.iter().enumerate() {
        let others: Vec<String> = group.bodies[1..]
            .iter()
            .map(|&body| network.model.bodies[body].name.as_str())
            .filter(|name| !name.is_empty())
            .map(|name| format!("`{name}`"))
            .collect();
        if !others.is_empty() {
            let own = network.group_name(at);
            let list = others.join(", ");
            notes.push(format!(
                "One body here, fixed together: `{own}` and {list}."
            ));
        }
    }
    for name in network.spins() {
        notes.push(format!(
            "`{name}` can rotate about the line between its ball joints without effect; by convention it does not."
        ));
    }
    for &edge in &layout.redundant {
        let name = network.edge_name(&network.edges[edge]);
        notes.push(format!(
            "`{name}` is redundant with the other closures and omitted."
        ));
    }
    notes
}
