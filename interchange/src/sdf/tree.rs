//! Spanning tree of bodies from joints between any two links; the other joints close loops.
//!
//! The axes of a loop-closing joint carry a massless body, which is welded to the joint's child
//! link. The choice of these joints does not change the model.

use super::{
    contents::{JointItem, Link, Owner, SdfContents},
    frames::FrameName,
    joints::{self, Axis},
    links,
};
use crate::{
    model::{Body, Closure, ClosureKind, Follow, Model, Pose},
    options::Options,
};
use nalgebra::Point3;
use std::collections::BTreeMap;

/// Joint of the model for each axis of the file, by joint number and element.
pub(super) type Axes = BTreeMap<(usize, &'static str), usize>;

/// A joint between two links; `None` is the ground.
pub(super) struct Edge {
    pub(super) item: usize,
    pub(super) ends: [Option<usize>; 2],
    pub(super) axes: Vec<Axis>,
}

/// Builds the bodies and joints of the model; `None` after an error.
pub(super) fn build(
    contents: &SdfContents<'_>,
    options: &Options,
    model: &mut Model,
) -> Option<(Vec<Edge>, Axes)> {
    let links = contents.links.iter().enumerate();
    let own: Vec<usize> = links
        .filter(|(_, link)| link.owner == Owner::Robot)
        .map(|(at, _)| at)
        .collect();
    let edges = edges(contents)?;
    let mut tree = Tree {
        contents,
        edges: &edges,
        at: vec![Vec::new(); contents.links.len() + 1],
        bodies: vec![None; contents.links.len()],
        used: vec![false; edges.len()],
        cuts: Vec::new(),
        axes: Axes::new(),
    };
    for (at, edge) in edges.iter().enumerate() {
        for end in edge.ends {
            tree.at[node(end)].push(at);
        }
    }
    tree.grow(None, model);
    for &link in &own {
        if tree.bodies[link].is_none() {
            let base = tree.base_of(link);
            tree.float(base, options, model)?;
            tree.grow(Some(base), model);
        }
    }
    for cut in std::mem::take(&mut tree.cuts) {
        tree.close(cut, model);
    }
    let axes = tree.axes;
    links::notes(contents, &own, model);
    links::gravity(contents, &own, model);
    contents.files.is_clean().then_some((edges, axes))
}

/// Node number of a link; the ground is 0.
fn node(link: Option<usize>) -> usize {
    link.map_or(0, |link| link + 1)
}

fn edges(contents: &SdfContents<'_>) -> Option<Vec<Edge>> {
    let mut edges = Vec::new();
    for (at, item) in contents.joints.iter().enumerate() {
        if item.owner == Owner::Stranger || joints::is_coupling(item) {
            continue;
        }
        let ends = [end(contents, &item.parent)?, end(contents, &item.child)?];
        if item.child.text == "world" {
            let message = format!("the child of the joint `{}` is the world", item.name);
            let help = "the world is fixed: write it as <parent>";
            contents.files.report(&item.child.place, message, help);
            continue;
        }
        if ends[0] == ends[1] {
            let message = format!("the joint `{}` connects a body to itself", item.name);
            let help = "name two different links that are not both fixed in the world";
            contents.files.report(&item.element.place, message, help);
            continue;
        }
        let Some(axes) = joints::axes(contents, item) else {
            continue;
        };
        edges.push(Edge {
            item: at,
            ends,
            axes,
        });
    }
    contents.files.is_clean().then_some(edges)
}

/// Link at a joint's end; `Some(None)` for the ground.
pub(super) fn end(contents: &SdfContents<'_>, name: &FrameName) -> Option<Option<usize>> {
    let frame = contents.frames.find_or_report(contents.files, name)?;
    let link = contents.frames.link(contents.files, frame, name)?;
    if link.is_some_and(|link| contents.links[link].owner == Owner::Stranger) {
        let message = format!("`{}` is of another model of the world", name.text);
        let help = "put both into one model: only one model of a world is read";
        contents.files.report(&name.place, message, help);
        return None;
    }
    Some(link)
}

struct Tree<'t, 'f> {
    contents: &'t SdfContents<'f>,
    edges: &'t [Edge],
    /// Edges of the ground and of each link.
    at: Vec<Vec<usize>>,
    /// Body of each link.
    bodies: Vec<Option<usize>>,
    used: Vec<bool>,
    /// Edges that close loops.
    cuts: Vec<usize>,
    axes: Axes,
}

impl Tree<'_, '_> {
    fn link(&self, link: usize) -> &Link {
        &self.contents.links[link]
    }

    fn body(&self, link: Option<usize>) -> Option<usize> {
        link.map_or(Some(0), |link| self.bodies[link])
    }

    fn frame(&self, link: Option<usize>) -> usize {
        link.map_or(0, |link| self.link(link).frame)
    }

    /// Adds all bodies that joints reach from a link, depth first, in file order.
    fn grow(&mut self, from: Option<usize>, model: &mut Model) {
        let mut open = vec![from];
        while let Some(at) = open.pop() {
            let mut next = Vec::new();
            for edge in self.at[node(at)].clone() {
                if std::mem::replace(&mut self.used[edge], true) {
                    continue;
                }
                let ends = self.edges[edge].ends;
                let is_against = ends[1] == at;
                let other = if is_against { ends[0] } else { ends[1] };
                match (self.body(other), other) {
                    (None, Some(link)) => {
                        let body = self.hang(edge, is_against, model);
                        self.fill(body, link, model);
                        next.push(other);
                    }
                    _ => self.cuts.push(edge),
                }
            }
            open.extend(next.into_iter().rev());
        }
    }

    /// Adds the bodies that the axes of an edge carry, all at the pose of the last one.
    ///
    /// If the edge is traversed from child to parent, the motions are inverted and in reverse
    /// order.
    fn hang(&mut self, edge: usize, is_against: bool, model: &mut Model) -> usize {
        let Edge { item, ends, axes } = &self.edges[edge];
        let [carrier, carried] = if is_against {
            [ends[1], ends[0]]
        } else {
            *ends
        };
        let frames = &self.contents.frames;
        let to = self.frame(carried);
        let mut placement = frames.relative_pose(to, self.frame(carrier));
        let joint_in = frames.relative_pose(self.contents.joints[*item].frame, to);
        let mut parent = self.body(carrier).unwrap_or(0);
        let mut order: Vec<&Axis> = axes.iter().collect();
        if is_against && axes.iter().all(|axis| axis.lead.is_none()) {
            order.reverse();
        }
        let name = carried.map_or("", |link| self.contents.links[link].name.as_str());
        for (at, axis) in order.iter().enumerate() {
            let mut joint = axis.joint.clone();
            let direction = joint_in.rotation * joint.axis;
            joint.axis = if is_against { -direction } else { direction };
            joint.at = Point3::from(joint_in.translation.vector);
            if axis.lead.is_none() {
                self.axes.insert((*item, axis.element), model.joints.len());
            }
            model.joints.push(joint);
            let is_last = at + 1 == order.len();
            let own = if is_last {
                name.to_owned()
            } else {
                format!("{name}_{}", at + 1)
            };
            let joint = Some(model.joints.len() - 1);
            parent = push(model, own, parent, placement, joint);
            placement = Pose::identity();
        }
        if order.is_empty() {
            parent = push(model, name.to_owned(), parent, placement, None);
        }
        self.follow(*item, axes, model);
        parent
    }

    /// Couples the slide of a screw to its rotation.
    fn follow(&self, item: usize, axes: &[Axis], model: &mut Model) {
        let Some(lead) = axes.iter().find_map(|axis| axis.lead) else {
            return;
        };
        let Some(&turn) = self.axes.get(&(item, "axis")) else {
            return;
        };
        model.joints[turn - 1].follow = Some(Follow {
            joint: turn,
            factor: lead,
            offset: 0.0,
        });
    }

    /// Copies the inertia and location of a link to its body.
    fn fill(&mut self, body: usize, link: usize, model: &mut Model) {
        let (inertia, is_unknown) = links::inertia(self.contents, self.link(link));
        let own = &mut model.bodies[body];
        (own.inertia, own.has_unknown_inertia) = (inertia, is_unknown);
        own.place = Some(self.link(link).element.place.clone());
        self.bodies[link] = Some(body);
    }

    /// Base link of a floating group of links: one that no joint carries, else the given link.
    fn base_of(&self, link: usize) -> usize {
        let (mut seen, mut open) = (vec![false; self.bodies.len()], vec![link]);
        seen[link] = true;
        while let Some(at) = open.pop() {
            for &edge in &self.at[at + 1] {
                for other in self.edges[edge].ends.into_iter().flatten() {
                    if !std::mem::replace(&mut seen[other], true) {
                        open.push(other);
                    }
                }
            }
        }
        let is_carried = |link: usize| {
            let mut own = self.at[link + 1].iter();
            own.any(|&edge| self.edges[edge].ends[1] == Some(link))
        };
        let mut all = (0..seen.len()).filter(|&link| seen[link] && !is_carried(link));
        all.next().unwrap_or(link)
    }

    /// Adds links without a connection to the world: they float, or are fixed with `fix_base`.
    fn float(&mut self, base: usize, options: &Options, model: &mut Model) -> Option<()> {
        let link = self.link(base);
        if !options.fix_base {
            let message = format!(
                "no joint leads from the world to `{}`: it floats",
                link.name
            );
            let help = "a floating base has no motor to identify it with: fix it with `--fix-base`, or with a joint of type fixed whose <parent> is world";
            self.contents
                .files
                .report(&link.element.place, message, help);
            return None;
        }
        model.notes.push(format!(
            "No joint leads from the world to `{}`; it is fixed here at its position.",
            link.name
        ));
        let placement = self.contents.frames.relative_pose(link.frame, 0);
        let body = push(model, link.name.clone(), 0, placement, None);
        self.fill(body, base, model);
        Some(())
    }

    /// Adds a loop-closing joint between two existing bodies.
    fn close(&mut self, edge: usize, model: &mut Model) {
        let [parent, child] = self.edges[edge].ends;
        let item: &JointItem = &self.contents.joints[self.edges[edge].item];
        let (Some(from), Some(to)) = (self.body(parent), self.body(child)) else {
            return;
        };
        let (first, at) = if self.edges[edge].axes.is_empty() {
            let seen = self
                .contents
                .frames
                .relative_pose(self.frame(child), self.frame(parent));
            (from, seen)
        } else {
            let body = self.hang(edge, false, model);
            model.bodies[body].name.clear();
            (body, Pose::identity())
        };
        model.closures.push(Closure {
            name: item.name.clone(),
            kind: ClosureKind::Weld {
                bodies: [first, to],
                at: [at, Pose::identity()],
            },
            place: item.element.place.clone(),
        });
    }
}

/// Adds a massless body.
fn push(
    model: &mut Model,
    name: String,
    parent: usize,
    placement: Pose,
    joint: Option<usize>,
) -> usize {
    model.bodies.push(Body {
        name,
        parent,
        placement,
        place: None,
        joint,
        inertia: None,
        has_unknown_inertia: false,
    });
    model.bodies.len() - 1
}
