//! Collects links, joints and frames from nested models and included files.

use super::{
    frames::{Attachment, Frame, FrameName, FrameReference, Frames, Scope},
    include::{self, Included, Source},
    value::{flag, pose, reference_frame, text},
};
use crate::{
    account::Use,
    files::{Files, Place},
    xml::Element,
};
use std::{collections::BTreeSet, path::PathBuf};

/// Largest depth of nested models, including those of included files.
const DEPTH: usize = 60;
/// Largest number of models and of scopes.
const MODELS: usize = 20_000;

/// Model that a link or joint belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// The robot.
    Robot,
    /// A static model, fixed to the world.
    Ground,
    /// Another model of the same world.
    Stranger,
}

/// A link with its XML element.
#[derive(Debug)]
pub(super) struct Link {
    pub(super) name: String,
    pub(super) frame: usize,
    pub(super) owner: Owner,
    pub(super) element: Element,
}

/// A joint with its XML element.
#[derive(Debug)]
pub(super) struct JointItem {
    pub(super) name: String,
    pub(super) frame: usize,
    pub(super) scope: usize,
    pub(super) owner: Owner,
    pub(super) parent: FrameName,
    pub(super) child: FrameName,
    pub(super) element: Element,
}

/// Contents of an SDFormat file: its frames, links and joints.
#[derive(Debug)]
pub(super) struct SdfContents<'f> {
    pub(super) files: &'f Files,
    pub(super) frames: Frames,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<JointItem>,
    models: usize,
    /// Depth of the current model.
    depth: usize,
    /// Full names of the links and joints read so far, by element.
    taken: BTreeSet<(&'static str, String)>,
    /// Files that are being read, the innermost last.
    open: Vec<PathBuf>,
    /// Prefix of the robot's names that the description omits.
    shown_without: String,
}

impl<'f> SdfContents<'f> {
    pub(super) fn new(
        files: &'f Files,
        place: Place,
        version: (u32, u32),
        open: PathBuf,
        shown_without: String,
    ) -> Self {
        Self {
            files,
            frames: Frames::new(place, version),
            links: Vec::new(),
            joints: Vec::new(),
            models: 0,
            depth: 0,
            taken: BTreeSet::new(),
            open: vec![open],
            shown_without,
        }
    }

    /// Name in messages and descriptions, without the robot's own model prefix.
    fn shown(&self, whole: &str) -> String {
        let own = whole.strip_prefix(self.shown_without.as_str());
        own.unwrap_or(whole).to_owned()
    }

    /// Reads a model and its contents.
    pub(super) fn model(
        &mut self,
        element: &Element,
        source: Source,
        scope: usize,
        owner: Owner,
    ) -> Option<()> {
        self.models += 1;
        if self.frames.scopes.len() > MODELS || self.models > MODELS || self.depth > DEPTH {
            let message = format!("more than {MODELS} models, or {DEPTH} nested");
            let help = "describe the robot in fewer parts";
            self.files.report(&element.place, message, help);
            return None;
        }
        let name = element.required(self.files, "name")?.to_owned();
        if flag(self.files, element, "static") && owner == Owner::Robot {
            let message = format!("the model `{name}` is static");
            let help = "remove <static>, and fix its base by a joint of type fixed whose parent is `world`";
            self.files.report(&element.place, message, help);
            return None;
        }
        let frame = self.frames.all.len();
        let outer = self.frames.scopes[scope].clone();
        let whole = if source.is_merged {
            format!("{}_merged__{name}__model__", outer.prefix)
        } else {
            format!("{}{name}", outer.prefix)
        };
        self.frame(element, &name, &whole, scope, Attachment::Nothing);
        let prefix = if source.is_merged {
            outer.prefix
        } else {
            format!("{whole}::")
        };
        let own = self.frames.scopes.len();
        self.frames.scopes.push(Scope {
            prefix,
            model: frame,
            version: source.version,
        });
        let placed_by = element.attribute("placement_frame");
        self.frames.all[frame].placed_by =
            placed_by
                .filter(|(name, _)| !name.is_empty())
                .map(|(name, place)| FrameName {
                    scope: own,
                    text: name.to_owned(),
                    place: place.clone(),
                });
        let is_from_file = source.from.is_some();
        self.open.extend(source.from);
        self.depth += 1;
        let read = self.inside(element, own, frame, owner);
        self.depth -= 1;
        if is_from_file {
            self.open.pop();
        }
        read
    }

    /// Reads the contents of a model and sets its canonical link.
    ///
    /// The canonical link is the one that `canonical_link` names, else the first.
    fn inside(
        &mut self,
        element: &Element,
        scope: usize,
        frame: usize,
        owner: Owner,
    ) -> Option<()> {
        let first_link = self.links.len();
        self.parts(element, scope, owner)?;
        let canonical = element.attribute("canonical_link");
        self.frames.all[frame].attachment = match canonical.filter(|(name, _)| !name.is_empty()) {
            Some((name, place)) => Attachment::Other(FrameReference::Named(FrameName {
                scope,
                text: name.to_owned(),
                place: place.clone(),
            })),
            None if owner == Owner::Ground => Attachment::World,
            None if self.links.len() > first_link => Attachment::Link(first_link),
            None => Attachment::Nothing,
        };
        Some(())
    }

    /// Reads the links, joints, frames and models of a model or of the world.
    pub(super) fn parts(&mut self, element: &Element, scope: usize, owner: Owner) -> Option<()> {
        let version = self.frames.scopes[scope].version;
        for child in &element.children {
            match child.name.as_str() {
                "link" => self.link(child, scope, owner)?,
                "joint" => self.joint(child, scope, owner)?,
                "frame" => self.named_frame(child, scope)?,
                "plugin" if scope > 0 && owner == Owner::Robot => {
                    let name = child.get("filename").or_else(|| child.get("name"));
                    let name = name.unwrap_or("plugin");
                    let reason =
                        format!("`{name}` is not read, so the joints that it drives are unknown");
                    let place = &child.place;
                    self.files
                        .record(Use::Reported, place, "plugin", None, &reason);
                }
                "model" if scope > 0 => {
                    let source = Source {
                        version,
                        from: None,
                        is_merged: false,
                    };
                    self.model(child, source, scope, owner)?;
                }
                "include" if scope > 0 => match include::read(self.files, child, &self.open) {
                    Included::Model(model, source) => self.model(&model, source, scope, owner)?,
                    Included::Elsewhere(uri, place) => {
                        include::refuse(self.files, &uri, &place);
                        return None;
                    }
                    Included::Error => return None,
                },
                _ => {}
            }
        }
        Some(())
    }

    /// Adds the frame of an element; by default its pose is relative to the model.
    fn frame(
        &mut self,
        element: &Element,
        name: &str,
        whole: &str,
        scope: usize,
        attachment: Attachment,
    ) -> usize {
        let own = element.child("pose");
        let to = reference_frame(own).map_or(
            FrameReference::Frame(self.frames.scopes[scope].model),
            |(text, place)| named(scope, text, place),
        );
        let frame = Frame {
            name: name.to_owned(),
            place: element.place.clone(),
            pose: pose(self.files, own),
            to,
            attachment,
            placed_by: None,
        };
        let version = self.frames.scopes[scope].version;
        self.frames.add(self.files, frame, whole, version);
        self.frames.all.len() - 1
    }

    /// Name and full name of an element; `None` after an error.
    fn names(&self, element: &Element, scope: usize) -> Option<(String, String)> {
        let name = element.required(self.files, "name")?;
        if name.trim().is_empty() || name == "world" || name.starts_with("__") {
            let message = format!("`{name}` can't be the name of a {}", element.name);
            let help =
                "choose a name that is neither empty nor `world` and does not begin with `__`";
            self.files.report(&element.place, message, help);
            return None;
        }
        let prefix = &self.frames.scopes[scope].prefix;
        Some((name.to_owned(), format!("{prefix}{name}")))
    }

    fn link(&mut self, element: &Element, scope: usize, owner: Owner) -> Option<()> {
        let (name, whole) = self.names(element, scope)?;
        let attachment = match owner {
            Owner::Ground => Attachment::World,
            _ => Attachment::Link(self.links.len()),
        };
        let frame = self.frame(element, &name, &whole, scope, attachment);
        if owner == Owner::Ground {
            return Some(());
        }
        let shown = self.shown(&whole);
        if !self.taken.insert(("link", shown.clone())) {
            let message = format!("two links have the name `{name}`");
            let help = "give each link a name of its own";
            self.files.report(&element.place, message, help);
        }
        self.links.push(Link {
            name: shown,
            frame,
            owner,
            element: element.clone(),
        });
        Some(())
    }

    fn joint(&mut self, element: &Element, scope: usize, owner: Owner) -> Option<()> {
        let (name, whole) = self.names(element, scope)?;
        let end = |tag: &str| {
            let found = text(element, tag);
            if found.is_none() {
                let message = format!("the joint `{name}` has no <{tag}>");
                let help = format!("write <{tag}>NAME OF A LINK</{tag}>");
                self.files.report(&element.place, message, help);
            }
            let (text, place) = found?;
            Some(FrameName {
                scope,
                text: text.to_owned(),
                place: place.clone(),
            })
        };
        let (parent, child) = (end("parent")?, end("child")?);
        let attachment = Attachment::Other(FrameReference::Named(child.clone()));
        let frame = self.frame(element, &name, &whole, scope, attachment);
        if reference_frame(element.child("pose")).is_none() {
            self.frames.all[frame].to = FrameReference::Named(child.clone());
        }
        if owner == Owner::Ground {
            return Some(());
        }
        let shown = self.shown(&whole);
        if !self.taken.insert(("joint", shown.clone())) {
            let message = format!("two joints have the name `{name}`");
            let help = "give each joint a name of its own";
            self.files.report(&element.place, message, help);
        }
        self.joints.push(JointItem {
            name: shown,
            frame,
            scope,
            owner,
            parent,
            child,
            element: element.clone(),
        });
        Some(())
    }

    /// Reads a `<frame>`.
    ///
    /// By default it is attached to the model, and its pose is relative to the frame that it is
    /// attached to.
    fn named_frame(&mut self, element: &Element, scope: usize) -> Option<()> {
        let (name, whole) = self.names(element, scope)?;
        let attached = element.attribute("attached_to");
        let attached = attached.filter(|(name, _)| !name.is_empty());
        let to = attached.map_or(
            FrameReference::Frame(self.frames.scopes[scope].model),
            |(text, place)| named(scope, text, place),
        );
        let frame = self.frame(element, &name, &whole, scope, Attachment::Other(to.clone()));
        if reference_frame(element.child("pose")).is_none() {
            self.frames.all[frame].to = to;
        }
        Some(())
    }
}

fn named(scope: usize, text: &str, place: &Place) -> FrameReference {
    FrameReference::Named(FrameName {
        scope,
        text: text.to_owned(),
        place: place.clone(),
    })
}
