//! Errors for robots without a skeleton and chains: names the joints that no chain determines.

use super::network::{Network, Origin};
use crate::listing::listed;
use crate::{
    files::{Files, Place},
    model::JointType,
};

/// The partial layout of a search that determines most bodies.
#[derive(Debug, Default)]
pub(super) struct Furthest {
    /// Groups that are determined.
    pub(super) solved: Vec<bool>,
    /// Edges whose joints are coordinates.
    pub(super) coordinates: Vec<usize>,
    /// Number of these coordinates.
    pub(super) freedoms: usize,
}

/// Reason why a search found no layout.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) furthest: Furthest,
    pub(super) is_exhausted: bool,
}

/// Reports the joints that stay undetermined, at the first of them.
pub(super) fn report(files: &Files, network: &Network<'_>, failure: &Failure, was_told: bool) {
    let Furthest {
        solved,
        coordinates,
        freedoms,
    } = &failure.furthest;
    let is_open = |group: &usize| !solved.get(*group).copied().unwrap_or(false);
    let open: Vec<usize> = (0..network.edges.len())
        .filter(|&edge| network.edges[edge].groups.iter().any(is_open))
        .collect();
    if open.is_empty() {
        report_couplings(files, network);
        return;
    }
    let count = network.mobility;
    if count == 0 {
        report_rigid(files, network, &open);
        return;
    }
    if report_held(files, network, &open).is_some() {
        return;
    }
    let unit = if count == 1 {
        "coordinate"
    } else {
        "coordinates"
    };
    let joints = listed(
        open.iter()
            .map(|&edge| network.edge_name(&network.edges[edge])),
    );
    let given = listed(
        coordinates
            .iter()
            .map(|&edge| network.edge_name(&network.edges[edge])),
    );
    let with = if given.is_empty() {
        String::new()
    } else {
        format!("with {given} ")
    };
    let is_folded = network.has_singular_home();
    let together = if is_folded {
        " at home, where loops are folded"
    } else if *freedoms == count && open.len() > 1 {
        ", which can only be solved together"
    } else {
        ""
    };
    let message = format!(
        "no skeleton of {count} {unit} was found: {with}no chain determines {joints}{together}"
    );
    let help = match (was_told, failure.is_exhausted) {
        (_, _) if is_folded => {
            "start in a configuration in which these joints are not in line, `--home JOINT=POSITION,JOINT=POSITION`; it also chooses between mirrored configurations"
        }
        (true, _) => {
            "leave `--coordinates` out, or name as many joints as there are degrees of freedom, each connected to the ground by such joints"
        }
        (false, true) => "name the coordinates: `--coordinates a,b,c`",
        (false, false) if has_platform_on_balls(network, &open) => {
            "the platform's directions of motion change with its pose. Import describes such a platform by `independent` coordinates if its legs have no branches and it carries no joint: fix the other joints in the file, or describe the robot by hand as robots/spatial_3rps.toml"
        }
        (false, false) => {
            "a chain leads from one known body to another through at most six joints, or three and a ball joint. All choices of coordinates were tried, also with joints that several chains determine together: fix one of these joints in the file, or remove a closure, and identify the other bodies"
        }
    };
    match open.first().and_then(|&edge| place(network, edge)) {
        Some(place) => files.report(place, message, help),
        None => files.refuse(message, help),
    }
}

/// Whether three or more legs with ball joints hold one of the bodies that these edges connect.
fn has_platform_on_balls(network: &Network<'_>, edges: &[usize]) -> bool {
    let mut groups = { edges.iter() }.flat_map(|&edge| network.edges[edge].groups);
    groups.any(|group| {
        let own = network.edges_at[group].iter();
        let is_ball = |edge: &&usize| network.edges[**edge].kind == JointType::Ball;
        group != 0 && own.filter(is_ball).count() > 2
    })
}

/// Reports loops whose closures leave no motion.
fn report_rigid(files: &Files, network: &Network<'_>, open: &[usize]) {
    let names = { open.iter() }.map(|&edge| network.edge_name(&network.edges[edge]));
    let message = format!(
        "the closures leave no motion: {} are held by the loops",
        listed(names)
    );
    let help = "check the axes of these joints, remove a closure that repeats another one, or close the loop by points (`connect`) instead of frames; axes and points that rounding moves are aligned within `--closure-tolerance`";
    match open.first().and_then(|&edge| place(network, edge)) {
        Some(place) => files.report(place, message, help),
        None => files.refuse(message, help),
    }
}

/// Reports joints that the closures hold in place although others move; `None` if there are none.
fn report_held(files: &Files, network: &Network<'_>, open: &[usize]) -> Option<()> {
    let is_held = |edge: &&usize| network.is_held(**edge);
    let joint = |&edge: &usize| match network.edges[edge].origin {
        Origin::Joint(joint) => Some(&network.model.joints[joint]),
        Origin::Closure(_) | Origin::Platform => None,
    };
    let held: Vec<_> = { open.iter() }.filter(is_held).filter_map(joint).collect();
    let first = held.first()?;
    let names = listed(held.iter().map(|joint| joint.name.as_str()));
    let message = format!("the closures hold {names} in place while other joints move");
    let help = "fix it in the file: remove the joint, and the closure if it then connects a body to itself";
    files.report(&first.place, message, help);
    Some(())
}

/// Reports coupled joints that are in another tree than their leaders, although all bodies are
/// determined.
fn report_couplings(files: &Files, network: &Network<'_>) {
    let joints = &network.model.joints;
    let mut coupled = joints.iter().filter(|joint| joint.follow.is_some());
    let names = listed(coupled.clone().map(|joint| joint.name.as_str()));
    let message =
        format!("no skeleton was found that contains the coupled joints {names} and their leaders");
    let help = "name as coordinates leaders on the path from the ground to the coupled joints, `--coordinates a,b,c`, or drive the leaders, `--actuated JOINT,JOINT`";
    match coupled.next() {
        Some(joint) => files.report(&joint.place, message, help),
        None => files.refuse(message, help),
    }
}

/// Location of a joint or closure in its file.
fn place<'m>(network: &Network<'m>, edge: usize) -> Option<&'m Place> {
    match network.edges[edge].origin {
        Origin::Joint(joint) => Some(&network.model.joints[joint].place),
        Origin::Closure(closure) => Some(&network.model.closures[closure].place),
        Origin::Platform => None,
    }
}
