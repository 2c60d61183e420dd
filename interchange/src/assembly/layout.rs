//! Chooses the independent coordinates and the chains that they determine.
//!
//! The skeleton grows from the ground. A chain is added as soon as the known bodies determine it.
//! If there is none, the skeleton is extended by one joint. Among all such extensions, the search
//! keeps the layout whose chains are cheapest to solve.
//!
//! Bodies that alone connect others to the ground are reserved for the skeleton at first. If no
//! such skeleton exists, chains may carry branches, whose joints are coordinates as well.
//!
//! If no chains solve the robot one after the other, the skeleton may have joints that they
//! determine together (`coordinates.rs`), in exchange for chains of fewer joints.

use super::{
    coordinates::{self, Tree, skeleton_freedoms, surplus},
    network::{Network, Origin},
    platform_search::platforms,
    solvable_chains::{Known, SolvableChain, UNKNOWNS, cheapest, follows},
    unsolved::{self, Failure, Furthest},
};
use crate::{files::Files, options::Options};

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
    /// Edges of skeleton and branches whose joints the chains determine.
    pub(crate) dependent: Vec<usize>,
    /// Redundant edges: the others imply their constraints.
    pub(crate) redundant: Vec<usize>,
    /// Approximate cost of solving the chains.
    cost: usize,
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

    /// Edges whose joints are independent coordinates, in the order of the description.
    pub(crate) fn independent(&self) -> Tree {
        let mut all = self.coordinates();
        all.retain(|(edge, _)| !self.dependent.contains(edge));
        all
    }
}

/// Largest number of extensions that are tried.
const TRIES: usize = 3000;

/// Largest number of paths that all searches for chains explore together.
const PATHS: usize = 3_000_000;

/// Part of both limits for each of the searches with dependent joints, of which there are many.
const SHARE: usize = 10;

/// Finds skeleton and chains; `None` after an error.
///
/// Preferred are motors as coordinates, then the joints with the cheapest chains, then the
/// displacements of a platform.
pub(crate) fn find(files: &Files, network: &mut Network<'_>, options: &Options) -> Option<Layout> {
    let wanted = match &options.coordinates {
        None => None,
        Some(names) => Some(wanted(files, network, names)?),
    };
    let failure = match search_all(network, wanted.clone()) {
        Ok(found) => return Some(found),
        Err(failure) => failure,
    };
    match with_dependent(network, wanted.as_deref()) {
        Some(found) => Some(found),
        None => {
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
    if is_free && let Ok(found) = search(network, Some(driven(network)), DependentJoints::NONE) {
        return Ok(found);
    }
    let failure = match search(network, wanted, DependentJoints::NONE) {
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
        match search(network, Some(vec![edge]), DependentJoints::NONE) {
            Ok(found) => return Ok(found),
            Err(_) => network.remove_platform(),
        }
    }
    Err(failure)
}

/// Searches with dependent joints and chains of few joints; the wanted edges are independent ones.
///
/// A chain of several joints is singular where it is stretched, even if the robot is not there. A
/// rod between two bodies of the skeleton is never singular.
fn with_dependent(network: &Network<'_>, wanted: Option<&[usize]>) -> Option<Layout> {
    let is_held = |edge: usize| {
        matches!(network.edges[edge].origin, Origin::Joint(_)) && network.is_held(edge)
    };
    // Folded loops need another home, and joints that closures hold are no coordinates.
    if network.model.closures.is_empty()
        || network.mobility == 0
        || network.has_singular_home()
        || (0..network.edges.len()).any(is_held)
    {
        return None;
    }
    let independent = wanted.unwrap_or_default();
    coordinates::CHAIN_JOINTS.into_iter().find_map(|most| {
        let found = (1..=coordinates::MOST).filter_map(|count| {
            let dependent = DependentJoints {
                count,
                most,
                independent,
            };
            let mut found = search(network, None, dependent).ok()?;
            found.dependent = coordinates::choose(network, &found.coordinates(), independent)?;
            Some(found)
        });
        found.min_by_key(|layout| layout.cost)
    })
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
fn search(
    network: &Network<'_>,
    wanted: Option<Vec<usize>>,
    dependent: DependentJoints<'_>,
) -> Result<Layout, Failure> {
    let mut search = Search::new(network, wanted, dependent);
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
            dependent: Vec::new(),
            redundant: unused.map(|(edge, _)| edge).collect(),
            cost: self.cost,
        }
    }
}

/// Joints of skeleton and branches that the chains determine.
#[derive(Debug, Clone, Copy)]
struct DependentJoints<'s> {
    /// Their number.
    count: usize,
    /// Largest number of unknown joints of a chain.
    most: usize,
    /// Edges that have to be independent coordinates.
    independent: &'s [usize],
}

impl DependentJoints<'_> {
    const NONE: Self = Self {
        count: 0,
        most: UNKNOWNS,
        independent: &[],
    };
}

struct Search<'s, 'm> {
    network: &'s Network<'m>,
    kept: Vec<bool>,
    /// Whether bodies of chains may carry branches.
    may_branch: bool,
    wanted: Option<Vec<usize>>,
    dependent: DependentJoints<'s>,
    best: Option<(usize, Layout)>,
    furthest: Furthest,
    tries: usize,
    /// Number of paths explored so far.
    paths: usize,
}

impl<'s, 'm> Search<'s, 'm> {
    /// Search before its first step.
    fn new(
        network: &'s Network<'m>,
        wanted: Option<Vec<usize>>,
        dependent: DependentJoints<'s>,
    ) -> Self {
        Self {
            network,
            // Groups that alone connect others to the ground must be part of the skeleton, because
            // the groups behind them have their own coordinates.
            kept: network.blocks.is_cut.clone(),
            may_branch: false,
            wanted,
            dependent,
            best: None,
            furthest: Furthest::default(),
            tries: 0,
            paths: 0,
        }
    }

    /// Whether the search has used up its extensions or paths.
    fn is_exhausted(&self) -> bool {
        let share = if self.dependent.count > 0 { SHARE } else { 1 };
        self.tries > TRIES / share || self.paths > PATHS / share
    }

    fn grow(&mut self, mut partial: PartialLayout) {
        self.tries += 1;
        while !self.is_exhausted() {
            let known = Known {
                solved: &partial.solved,
                kept: &self.kept,
                used: &partial.used,
                needs_all: self.dependent.count > 0,
                most: self.dependent.most,
            };
            let (ear, paths) = cheapest(self.network, known);
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
            if !self.network.model.closures.is_empty()
                && surplus(self.network, &next.layout().coordinates()) > self.dependent.count
            {
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
        let all = layout.coordinates();
        let coordinates: usize = skeleton_freedoms(self.network, &all).iter().sum();
        let DependentJoints {
            count, independent, ..
        } = self.dependent;
        let is_there = |edge: &usize| all.iter().any(|(own, _)| own == edge);
        // With dependent joints, a constraint that is left out would not determine them.
        let is_complete = coordinates == self.network.mobility + count
            && (count == 0 || layout.redundant.is_empty())
            && independent.iter().all(is_there);
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
