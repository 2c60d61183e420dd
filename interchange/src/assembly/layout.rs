//! Chooses the independent coordinates and the chains that they determine.
//!
//! The skeleton grows from the ground. A chain is added as soon as the known bodies determine it.
//! If there is none, the skeleton is extended by one joint. Among all such extensions, the search
//! keeps the layout whose chains are cheapest to solve.
//!
//! Bodies that alone connect others to the ground are reserved for the skeleton at first. If no
//! such skeleton exists, chains may carry branches, whose joints are coordinates as well.

use super::{
    motion::{State, rank},
    network::{Network, Origin},
    platform_search::platforms,
    solvable_chains::{SolvableChain, cheapest, follows, freedoms},
    unsolved::{self, Failure, Furthest},
};
use crate::{files::Files, model::JointType, options::Options};
use nalgebra::{DMatrix, Vector3};

/// Edges of a tree in order, each with the group that it starts from.
pub(crate) type Tree = Vec<(usize, usize)>;

/// Parts of the layout that do not belong to the skeleton.
#[derive(Debug, Clone)]
pub(crate) enum LayoutPiece {
    /// A chain, determined by the bodies that it connects.
    Chain(SolvableChain),
    /// A tree on a body of a chain.
    Branch(Tree),
}

/// Skeleton, branches and chains.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    /// Tree on the ground.
    pub(crate) skeleton: Tree,
    /// Chains in the order of their solution; each branch follows the chain that carries it.
    pub(crate) pieces: Vec<LayoutPiece>,
    /// Redundant edges: the others imply their constraints.
    pub(crate) redundant: Vec<usize>,
}

impl Layout {
    /// Edges whose joints are coordinates, in the order of the description.
    pub(crate) fn coordinates(&self) -> Tree {
        let branches = self.pieces.iter().filter_map(|piece| match piece {
            LayoutPiece::Branch(tree) => Some(tree),
            LayoutPiece::Chain(_) => None,
        });
        let trees = std::iter::once(&self.skeleton).chain(branches);
        trees.flatten().copied().collect()
    }
}

/// Largest number of extensions that are tried.
const TRIES: usize = 3000;

/// Largest number of paths that all searches for chains explore together.
const PATHS: usize = 3_000_000;

/// Finds skeleton and chains; `None` after an error.
///
/// Preferred are motors as coordinates, then the joints with the cheapest chains, then the
/// displacements of a platform.
pub(crate) fn find(files: &Files, network: &mut Network<'_>, options: &Options) -> Option<Layout> {
    let wanted = match &options.coordinates {
        None => None,
        Some(names) => Some(wanted(files, network, names)?),
    };
    match search_all(network, wanted) {
        Ok(found) => Some(found),
        Err(failure) => {
            unsolved::report(files, network, &failure, options.coordinates.is_some());
            None
        }
    }
}

/// Whether there are a skeleton and chains.
pub(crate) fn exists(network: &mut Network<'_>) -> bool {
    let found = search_all(network, None).is_ok();
    network.remove_platform();
    found
}

/// Searches with the wanted edges as coordinates, or with each kind of coordinates in turn.
fn search_all(network: &mut Network<'_>, wanted: Option<Vec<usize>>) -> Result<Layout, Failure> {
    let is_free = wanted.is_none() && !network.model.closures.is_empty();
    if is_free && let Ok(found) = search(network, Some(driven(network))) {
        return Ok(found);
    }
    let failure = match search(network, wanted) {
        Ok(found) => return Ok(found),
        Err(failure) => failure,
    };
    let candidates = if is_free {
        platforms(network)
    } else {
        Vec::new()
    };
    for platform in candidates {
        network.add_platform(platform);
        let edge = network.edges.len() - 1;
        match search(network, Some(vec![edge])) {
            Ok(found) => return Ok(found),
            Err(_) => network.remove_platform(),
        }
    }
    Err(failure)
}

/// Edges of motors that do not follow other joints.
fn driven(network: &Network<'_>) -> Vec<usize> {
    let joints = &network.model.joints;
    let is_driven = |edge: &usize| match network.edges[*edge].origin {
        Origin::Joint(joint) => joints[joint].actuated && joints[joint].follow.is_none(),
        Origin::Closure(_) | Origin::Platform => false,
    };
    (0..network.edges.len()).filter(is_driven).collect()
}

/// Searches skeleton and chains whose coordinates are some of the wanted edges, if given.
fn search(network: &Network<'_>, wanted: Option<Vec<usize>>) -> Result<Layout, Failure> {
    let mut search = Search {
        network,
        // Groups that alone connect others to the ground must be part of the skeleton, because the
        // groups behind them have their own coordinates.
        kept: network.blocks.is_cut.clone(),
        may_branch: false,
        wanted,
        best: None,
        furthest: Furthest::default(),
        tries: 0,
        paths: 0,
    };
    search.grow(PartialLayout::start(network));
    if search.best.is_none() {
        search.kept.fill(false);
        search.may_branch = true;
        search.tries = 0;
        search.paths = 0;
        search.grow(PartialLayout::start(network));
    }
    let is_exhausted = search.is_exhausted();
    let Search { best, furthest, .. } = search;
    match best {
        Some((_, found)) => Ok(found),
        None => Err(Failure {
            furthest,
            is_exhausted,
        }),
    }
}

fn wanted(files: &Files, network: &Network<'_>, names: &[String]) -> Option<Vec<usize>> {
    let mut found = Vec::new();
    for name in names {
        let at = network
            .edges
            .iter()
            .position(|edge| network.edge_name(edge) == name);
        match at {
            Some(at) => found.push(at),
            None => {
                let all = network.edges.iter().map(|edge| network.edge_name(edge));
                let message = format!("there is no joint `{name}` for a coordinate");
                files.refuse(message, files.joint_help(name, all));
            }
        }
    }
    (found.len() == names.len()).then_some(found)
}

/// Tree that a group belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LayoutPart {
    /// Tree on the ground.
    Skeleton,
    /// Index of the branch in `pieces`.
    Branch(usize),
}

#[derive(Debug, Clone)]
struct PartialLayout {
    solved: Vec<bool>,
    /// Tree of each group, if it has one.
    part: Vec<Option<LayoutPart>>,
    used: Vec<bool>,
    skeleton: Tree,
    pieces: Vec<LayoutPiece>,
    cost: usize,
}

impl PartialLayout {
    /// Partial layout with the ground only.
    fn start(network: &Network<'_>) -> Self {
        let count = network.groups.len();
        let mut own = Self {
            solved: vec![false; count],
            part: vec![None; count],
            used: vec![false; network.edges.len()],
            skeleton: Tree::new(),
            pieces: Vec::new(),
            cost: 0,
        };
        own.solved[0] = true;
        own.part[0] = Some(LayoutPart::Skeleton);
        own
    }

    /// Adds an edge to the tree of its start group, or to a new branch.
    fn push(&mut self, edge: usize, from: usize, to: usize) {
        let part = self.part[from].unwrap_or_else(|| {
            self.pieces.push(LayoutPiece::Branch(Tree::new()));
            LayoutPart::Branch(self.pieces.len() - 1)
        });
        match part {
            LayoutPart::Skeleton => self.skeleton.push((edge, from)),
            LayoutPart::Branch(at) => {
                if let LayoutPiece::Branch(tree) = &mut self.pieces[at] {
                    tree.push((edge, from));
                }
            }
        }
        self.used[edge] = true;
        self.solved[to] = true;
        self.part[to] = Some(part);
    }

    /// Layout in which the unused edges are redundant.
    fn layout(&self) -> Layout {
        let unused = self.used.iter().enumerate().filter(|(_, used)| !**used);
        Layout {
            skeleton: self.skeleton.clone(),
            pieces: self.pieces.clone(),
            redundant: unused.map(|(edge, _)| edge).collect(),
        }
    }
}

struct Search<'s, 'm> {
    network: &'s Network<'m>,
    kept: Vec<bool>,
    /// Whether bodies of chains may carry branches.
    may_branch: bool,
    wanted: Option<Vec<usize>>,
    best: Option<(usize, Layout)>,
    furthest: Furthest,
    tries: usize,
    /// Number of paths explored so far.
    paths: usize,
}

impl Search<'_, '_> {
    /// Whether the search has used up its extensions or paths.
    fn is_exhausted(&self) -> bool {
        self.tries > TRIES || self.paths > PATHS
    }

    fn grow(&mut self, mut partial: PartialLayout) {
        self.tries += 1;
        while !self.is_exhausted() {
            let (ear, paths) = cheapest(self.network, &partial.solved, &self.kept, &partial.used);
            self.paths += paths;
            let Some(ear) = ear else { break };
            for &group in &ear.groups {
                partial.solved[group] = true;
            }
            for &edge in &ear.edges {
                partial.used[edge] = true;
            }
            partial.cost += ear.cost();
            partial.pieces.push(LayoutPiece::Chain(ear));
        }
        let is_dear = self
            .best
            .as_ref()
            .is_some_and(|(cost, _)| partial.cost >= *cost);
        if is_dear || self.is_exhausted() {
            return;
        }
        let count = |solved: &[bool]| solved.iter().filter(|s| **s).count();
        if count(&partial.solved) > count(&self.furthest.solved) {
            let coordinates = partial.layout().coordinates();
            self.furthest = Furthest {
                solved: partial.solved.clone(),
                freedoms: skeleton_freedoms(self.network, &coordinates).iter().sum(),
                coordinates: coordinates.iter().map(|(edge, _)| *edge).collect(),
            };
        }
        if partial.solved.iter().all(|solved| *solved) {
            self.finish(partial);
            return;
        }
        for (edge, from, to) in self.candidates(&partial) {
            let mut next = partial.clone();
            next.push(edge, from, to);
            if !independent(self.network, &next.layout().coordinates()) {
                continue;
            }
            // On ties, prefer the skeleton with fewer joints.
            next.cost += 1;
            self.grow(next);
        }
    }

    /// Candidate edges for the skeleton; a single one if that edge is required.
    fn candidates(&self, partial: &PartialLayout) -> Vec<(usize, usize, usize)> {
        let mut all = Vec::new();
        for (index, edge) in self.network.edges.iter().enumerate() {
            let wanted = self.wanted.as_ref().is_none_or(|wanted| {
                wanted.contains(&index)
                    || follows(self.network, index)
                    || self.network.blocks.is_bridge[index]
            });
            if partial.used[index] || !wanted {
                continue;
            }
            for (from, to) in [
                (edge.groups[0], edge.groups[1]),
                (edge.groups[1], edge.groups[0]),
            ] {
                let may = partial.part[from].is_some() || self.may_branch && partial.solved[from];
                if may && !partial.solved[to] {
                    if self.network.blocks.is_bridge[index] {
                        return vec![(index, from, to)];
                    }
                    all.push((index, from, to));
                }
            }
        }
        // Complete one block of loops before the next.
        let Some(&(_, first, _)) = all.first() else {
            return all;
        };
        all.into_iter()
            .filter(|(_, from, _)| *from == first || self.network.blocks.are_together(first, *from))
            .collect()
    }

    fn finish(&mut self, partial: PartialLayout) {
        let layout = partial.layout();
        let coordinates: usize = skeleton_freedoms(self.network, &layout.coordinates())
            .iter()
            .sum();
        let is_complete = coordinates == self.network.mobility;
        if is_complete && keeps_couplings(self.network, &layout) {
            self.best = Some((partial.cost, layout));
        }
    }
}

/// Whether each coupled joint is in the same tree as its leader.
fn keeps_couplings(network: &Network<'_>, layout: &Layout) -> bool {
    let branches = layout.pieces.iter().filter_map(|piece| match piece {
        LayoutPiece::Branch(tree) => Some(tree),
        LayoutPiece::Chain(_) => None,
    });
    let tree_of = |joint: usize| {
        let mut trees = std::iter::once(&layout.skeleton).chain(branches.clone());
        trees.position(|tree| {
            let mut edges = tree.iter();
            edges.any(|(edge, _)| network.edges[*edge].origin == Origin::Joint(joint))
        })
    };
    let mut joints = network.model.joints.iter().enumerate();
    joints.all(|(at, joint)| {
        let leader = joint.follow.map(|follow| follow.joint);
        leader.is_none_or(|leader| {
            let own = tree_of(at);
            own.is_none() || own == tree_of(leader)
        })
    })
}

/// Number of one-degree-of-freedom joints for each edge of a skeleton.
pub(crate) fn skeleton_freedoms(network: &Network<'_>, skeleton: &[(usize, usize)]) -> Vec<usize> {
    let of = |&(edge, from): &(usize, usize)| {
        let groups = network.edges[edge].groups;
        freedoms(network, edge, groups[usize::from(groups[0] == from)], true)
    };
    skeleton.iter().map(of).collect()
}

/// Whether the skeleton's joints can move independently.
fn independent(network: &Network<'_>, skeleton: &[(usize, usize)]) -> bool {
    if network.model.closures.is_empty() {
        return true;
    }
    let freedoms: usize = skeleton_freedoms(network, skeleton).iter().sum();
    // Home may be singular; the skeleton must be independent in all other configurations.
    let looked_at = 1.min(network.states.len() - 1)..network.states.len();
    looked_at.into_iter().all(|state| {
        let twists = &network.twists[state];
        let rates = skeleton_rates(network, skeleton, &network.states[state], twists);
        rates.nrows() == freedoms && rank(&rates).0 == freedoms
    })
}

/// Rates of the skeleton's joints for each motion of the network, given the groups' `twists`.
pub(crate) fn skeleton_rates(
    network: &Network<'_>,
    skeleton: &[(usize, usize)],
    state: &State,
    twists: &[DMatrix<f64>],
) -> DMatrix<f64> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for &(index, from) in skeleton {
        let edge = &network.edges[index];
        if follows(network, index) {
            continue;
        }
        let (to, sign) = if edge.groups[0] == from {
            (edge.groups[1], 1.0)
        } else {
            (edge.groups[0], -1.0)
        };
        let relative = &twists[to] - &twists[from];
        let axis = network.axis(edge, state);
        if let (Origin::Platform, Some(platform)) = (edge.origin, &network.platform) {
            rows.extend(platform.rates(&platform.at(network, state), &relative));
            continue;
        }
        let turning = |e: &Vector3<f64>| {
            (relative.rows(3, 3).transpose() * e)
                .iter()
                .copied()
                .collect()
        };
        match edge.kind {
            JointType::Revolute => rows.push(turning(&(axis.direction * sign))),
            JointType::Prismatic => {
                let velocity = relative.rows(0, 3).transpose() * axis.direction * sign;
                rows.push(velocity.iter().copied().collect());
            }
            JointType::Ball if network.groups[to].spins => {
                let line = network.line(to, state);
                let across = if line.x.abs() < 0.7 {
                    Vector3::x()
                } else {
                    Vector3::y()
                };
                let first = line.cross(&across).normalize();
                rows.extend([first, line.cross(&first)].iter().map(turning));
            }
            JointType::Ball => rows.extend((0..3).map(|i| turning(&Vector3::ith(i, 1.0)))),
        }
    }
    let columns = twists.first().map_or(0, DMatrix::ncols);
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}
