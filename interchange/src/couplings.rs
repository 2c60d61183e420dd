//! Coupled joints: composes the relations of a file along chains.

use crate::{
    files::{Files, Place},
    model::{Follow, JointType, Model},
};

/// One relation of a file: follower = factor · leader + offset.
#[derive(Debug, Clone)]
pub(crate) struct Coupling {
    pub(crate) follower: usize,
    pub(crate) leader: usize,
    pub(crate) factor: f64,
    pub(crate) offset: f64,
    pub(crate) place: Place,
}

/// All relations of a file, in its order.
#[derive(Debug, Default)]
pub(crate) struct Couplings {
    all: Vec<Coupling>,
}

impl Coupling {
    /// The relation Σ factor · joint = `constant` of two joints, of which the first follows.
    ///
    /// Terms of one joint are added. `None` if these are not two joints.
    pub(crate) fn of_sum(terms: &[(usize, f64)], constant: f64, place: &Place) -> Option<Self> {
        let mut sums: Vec<(usize, f64)> = Vec::new();
        for &(joint, factor) in terms {
            match sums.iter_mut().find(|(own, _)| *own == joint) {
                Some((_, sum)) => *sum += factor,
                None => sums.push((joint, factor)),
            }
        }
        sums.retain(|(_, factor)| *factor != 0.0);
        let [(follower, own), (leader, other)] = sums[..] else {
            return None;
        };
        Some(Self {
            follower,
            leader,
            factor: -other / own,
            offset: constant / own,
            place: place.clone(),
        })
    }
}

/// Relation of each joint to its leader, if it is coupled.
type ByFollower = Vec<Option<Coupling>>;

impl Couplings {
    /// Adds a relation.
    pub(crate) fn add(&mut self, coupling: Coupling) {
        self.all.push(coupling);
    }

    /// Sets `Joint::follow` of every coupled joint, composed up to an independent joint.
    ///
    /// Reports joints with several leaders, cycles, and couplings of ball joints.
    pub(crate) fn resolve(self, files: &Files, model: &mut Model) {
        let relations = self.by_follower(files, model);
        if let Some(composed) = compose(files, model, &relations) {
            for (joint, follow) in model.joints.iter_mut().zip(composed) {
                joint.follow = follow;
            }
        }
    }

    /// Relations by follower, including those already in the model.
    fn by_follower(self, files: &Files, model: &Model) -> ByFollower {
        let known = model.joints.iter().enumerate();
        let known = known.filter_map(|(follower, joint)| {
            let follow = joint.follow?;
            Some(Coupling {
                follower,
                leader: follow.joint,
                factor: follow.factor,
                offset: follow.offset,
                place: joint.place.clone(),
            })
        });
        let mut relations: ByFollower = vec![None; model.joints.len()];
        for coupling in known.chain(self.all) {
            let name = |joint: usize| &model.joints[joint].name;
            let mut ends = [coupling.follower, coupling.leader].into_iter();
            if let Some(ball) = ends.find(|&joint| model.joints[joint].kind == JointType::Ball) {
                let message = format!("`{}` is a ball joint and cannot be coupled", name(ball));
                let help = "couple revolute and prismatic joints";
                files.report(&coupling.place, message, help);
                continue;
            }
            let slot = &mut relations[coupling.follower];
            if let Some(first) = slot {
                let (own, leader) = (name(coupling.follower), name(coupling.leader));
                let is_repeated = first.leader == coupling.leader;
                let (message, help) = if is_repeated {
                    (
                        format!("`{own}` is coupled to `{leader}` twice"),
                        "remove one of the two relations",
                    )
                } else {
                    let first = name(first.leader);
                    (
                        format!("`{own}` is coupled to two joints, `{first}` and `{leader}`"),
                        "couple each joint to one other joint: exchange the two joints in one of the relations",
                    )
                };
                files.report(&coupling.place, message, help);
                continue;
            }
            *slot = Some(coupling);
        }
        relations
    }
}

/// Composed relation of each joint to an independent joint; `None` after a cycle was reported.
fn compose(files: &Files, model: &Model, relations: &ByFollower) -> Option<Vec<Option<Follow>>> {
    let mut composed: Vec<Option<Follow>> = vec![None; relations.len()];
    let mut is_done: Vec<bool> = relations.iter().map(Option::is_none).collect();
    let mut has_cycle = false;
    // Start of the walk that last visited each joint.
    let mut reached_from: Vec<Option<usize>> = vec![None; relations.len()];
    for start in 0..relations.len() {
        let mut chain: Vec<&Coupling> = Vec::new();
        let mut at = start;
        while let Some(coupling) = relations[at].as_ref().filter(|_| !is_done[at]) {
            if reached_from[at] == Some(start) {
                report_cycle(files, model, &chain, at);
                has_cycle = true;
                break;
            }
            reached_from[at] = Some(start);
            chain.push(coupling);
            at = coupling.leader;
        }
        for coupling in chain.into_iter().rev() {
            is_done[coupling.follower] = true;
            composed[coupling.follower] = Some(match composed[coupling.leader] {
                Some(leader) => Follow {
                    joint: leader.joint,
                    factor: coupling.factor * leader.factor,
                    offset: coupling.factor * leader.offset + coupling.offset,
                },
                None => Follow {
                    joint: coupling.leader,
                    factor: coupling.factor,
                    offset: coupling.offset,
                },
            });
        }
    }
    (!has_cycle).then_some(composed)
}

/// Reports a cycle at its first relation in the file; `entry` is one of its joints.
fn report_cycle(files: &Files, model: &Model, chain: &[&Coupling], entry: usize) {
    let cycle = chain.iter().skip_while(|own| own.follower != entry);
    let mut cycle: Vec<&Coupling> = cycle.copied().collect();
    let place = |own: &Coupling| (own.place.file, own.place.span.start);
    let first = (0..cycle.len()).min_by_key(|&at| place(cycle[at]));
    cycle.rotate_left(first.unwrap_or(0));
    let Some(first) = cycle.first() else {
        return;
    };
    let names = cycle.iter().chain([first]);
    let names: Vec<String> = names
        .map(|own| format!("`{}`", model.joints[own.follower].name))
        .collect();
    let message = format!("joints are coupled in a cycle: {}", names.join(", "));
    let help = "remove one of these relations, so that one of the joints is independent";
    files.report(&first.place, message, help);
}
