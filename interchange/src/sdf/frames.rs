//! Frame graph of SDFormat and the relative poses of its frames.
//!
//! Every link, joint, model and `<frame>` is a frame. Its pose is relative to another frame, which
//! may be defined anywhere in the file. All frames are therefore collected before the first one is
//! resolved. Relative poses are composed along the path between two frames, not through the world
//! frame. This keeps right angles of the file exact.

use crate::{
    files::{Files, Place},
    model::Pose,
};
use std::collections::BTreeMap;

/// Reference to a frame by name, with the scope in which the name is looked up.
#[derive(Debug, Clone)]
pub(super) struct FrameName {
    pub(super) scope: usize,
    pub(super) text: String,
    pub(super) place: Place,
}

/// Reference to a frame, by index or by name.
#[derive(Debug, Clone)]
pub(super) enum FrameReference {
    Frame(usize),
    Named(FrameName),
}

/// What a frame is attached to and moves with.
#[derive(Debug, Clone)]
pub(super) enum Attachment {
    World,
    Link(usize),
    Other(FrameReference),
    /// A model without links.
    Nothing,
}

/// One frame of the file.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// Name in messages.
    pub(super) name: String,
    pub(super) place: Place,
    /// Pose in the frame `to`, as written in the file.
    pub(super) pose: Pose,
    pub(super) to: FrameReference,
    pub(super) attachment: Attachment,
    /// Inner frame that the model's pose applies to (`placement_frame`).
    pub(super) placed_by: Option<FrameName>,
}

/// Name scope: one model, or the world.
#[derive(Debug, Clone)]
pub(super) struct Scope {
    /// Prefix of the scope's names in the file, such as `outer::inner::`.
    pub(super) prefix: String,
    /// Frame of the model.
    pub(super) model: usize,
    /// SDFormat version of the file that contains the scope.
    pub(super) version: (u32, u32),
}

/// All frames of the file; the first is the world.
#[derive(Debug)]
pub(super) struct Frames {
    pub(super) all: Vec<Frame>,
    pub(super) scopes: Vec<Scope>,
    by_name: BTreeMap<String, usize>,
    /// Index of each frame's reference frame, known after `resolve`.
    to: Vec<usize>,
}

impl Frames {
    /// Creates the graph with the world frame only.
    pub(super) fn new(place: Place, version: (u32, u32)) -> Self {
        let world = Frame {
            name: "world".to_owned(),
            place,
            pose: Pose::identity(),
            to: FrameReference::Frame(0),
            attachment: Attachment::World,
            placed_by: None,
        };
        let scope = Scope {
            prefix: String::new(),
            model: 0,
            version,
        };
        Self {
            all: vec![world],
            scopes: vec![scope],
            by_name: BTreeMap::new(),
            to: Vec::new(),
        }
    }

    /// Adds a frame under its full name.
    ///
    /// Up to SDFormat 1.6, a joint and a link may share a name; the first one keeps it.
    pub(super) fn add(&mut self, files: &Files, frame: Frame, whole: &str, version: (u32, u32)) {
        let at = self.all.len();
        if self.by_name.contains_key(whole) {
            if version >= (1, 7) {
                let message = format!("two elements have the name `{}`", frame.name);
                let help = "give each link, joint, frame and model a name of its own in its model";
                files.report(&frame.place, message, help);
            }
        } else {
            self.by_name.insert(whole.to_owned(), at);
        }
        self.all.push(frame);
    }

    /// Finds a frame by its name in a scope.
    pub(super) fn find(&self, scope: usize, name: &str) -> Option<usize> {
        let scope = self.scopes.get(scope)?;
        let whole = |name: &str| {
            self.by_name
                .get(&format!("{}{name}", scope.prefix))
                .copied()
        };
        match name {
            "world" => Some(0),
            "__model__" => Some(scope.model),
            _ => match name.strip_suffix("::__model__") {
                Some(model) => whole(model),
                None => whole(name),
            },
        }
    }

    /// Finds a frame by its name; reports an error if it does not exist.
    pub(super) fn find_or_report(&self, files: &Files, name: &FrameName) -> Option<usize> {
        let found = self.find(name.scope, &name.text);
        if found.is_none() {
            let scope = &self.scopes[name.scope];
            let own = self.by_name.keys();
            let own = own.filter_map(|whole| whole.strip_prefix(scope.prefix.as_str()));
            let near = files.did_you_mean(&name.text, own);
            let message = format!("there is no link, joint, frame or model `{}`", name.text);
            let help =
                "name one of the same model, one of a model in it as `model::name`, or `__model__`";
            files.report(
                &name.place,
                message,
                near.unwrap_or_else(|| help.to_owned()),
            );
        }
        found
    }

    /// Finds the frame of a reference; `None` after an error.
    fn resolve_one(&self, files: &Files, to: &FrameReference) -> Option<usize> {
        match to {
            FrameReference::Frame(frame) => Some(*frame),
            FrameReference::Named(name) => self.find_or_report(files, name),
        }
    }

    /// Resolves the reference frame of each pose; `None` after an error.
    pub(super) fn resolve(&mut self, files: &Files) -> Option<()> {
        let to: Vec<Option<usize>> = self
            .all
            .iter()
            .map(|frame| self.resolve_one(files, &frame.to))
            .collect();
        self.to = to.into_iter().collect::<Option<_>>()?;
        self.check_cycles(files)?;
        self.place_models(files)
    }

    /// Checks that every chain of reference frames ends at the world.
    fn check_cycles(&self, files: &Files) -> Option<()> {
        let mut ends_at_world = vec![false; self.all.len()];
        ends_at_world[0] = true;
        for start in 1..self.all.len() {
            let (mut path, mut at) = (Vec::new(), start);
            while !ends_at_world[at] && path.len() <= self.all.len() {
                path.push(at);
                at = self.to[at];
            }
            if path.len() > self.all.len() {
                // The walk took as many steps as there are frames, so `at` lies on the cycle. The
                // message names the cycle's first frame in the file.
                let mut first = at;
                let mut other = self.to[at];
                while other != at {
                    first = first.min(other);
                    other = self.to[other];
                }
                let frame = &self.all[first];
                let message = format!("the pose of `{}` refers to frames in a cycle", frame.name);
                let help = "break the cycle: remove one `relative_to` or `attached_to`";
                files.report(&frame.place, message, help);
                return None;
            }
            path.into_iter().for_each(|at| ends_at_world[at] = true);
        }
        Some(())
    }

    /// Computes the poses of models that are placed by an inner frame (`placement_frame`).
    ///
    /// Inner models follow their outer models in the list, so the reverse order places inner models
    /// first.
    fn place_models(&mut self, files: &Files) -> Option<()> {
        for model in (0..self.all.len()).rev() {
            let Some(name) = self.all[model].placed_by.clone() else {
                continue;
            };
            let frame = self.find_or_report(files, &name)?;
            let mut inside = Pose::identity();
            let mut at = frame;
            while at != model {
                if at == 0 {
                    let message =
                        format!("`{}` is not placed relative to its own model", name.text);
                    let help = "place a model by a frame with a pose in the model";
                    files.report(&name.place, message, help);
                    return None;
                }
                inside = self.all[at].pose * inside;
                at = self.to[at];
            }
            self.all[model].pose *= inside.inverse();
        }
        Some(())
    }

    /// Pose of `frame` relative to the frame `from`.
    pub(super) fn relative_pose(&self, frame: usize, from: usize) -> Pose {
        let path_to_world = |start: usize| {
            let (mut path, mut at) = (vec![start], start);
            while at != 0 {
                at = self.to[at];
                path.push(at);
            }
            path
        };
        let (mut of, mut to) = (path_to_world(frame), path_to_world(from));
        // Remove the common end of both paths.
        while of.len() > 1 && to.len() > 1 && of[of.len() - 2] == to[to.len() - 2] {
            of.pop();
            to.pop();
        }
        let pose_along = |path: &[usize]| {
            path.iter()
                .rev()
                .skip(1)
                .fold(Pose::identity(), |pose, &at| pose * self.all[at].pose)
        };
        pose_along(&to).inv_mul(&pose_along(&of))
    }

    /// Link that a frame moves with; `Some(None)` for the world, `None` after an error.
    pub(super) fn link(
        &self,
        files: &Files,
        frame: usize,
        asked: &FrameName,
    ) -> Option<Option<usize>> {
        let mut at = frame;
        for _ in 0..=self.all.len() {
            match &self.all[at].attachment {
                Attachment::World => return Some(None),
                Attachment::Link(link) => return Some(Some(*link)),
                Attachment::Other(to) => at = self.resolve_one(files, to)?,
                Attachment::Nothing => {
                    let message = format!("the model `{}` has no link", self.all[at].name);
                    files.report(&asked.place, message, "name a link");
                    return None;
                }
            }
        }
        let message = format!("`{}` is attached to frames in a cycle", asked.text);
        let help = "attach one of them to a link";
        files.report(&asked.place, message, help);
        None
    }
}
