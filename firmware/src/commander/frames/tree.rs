//! The frames there are: made, linked, forgotten.

use super::error::FrameError;
use super::frame::{Frame, FrameKind};
use super::name::FrameName;
use super::selection::{EnabledFrames, FrameSelection};
use super::transform::Transform;
use heapless::Vec;

/// Frames that can be there at a time, besides the base frame.
pub const FRAMES: usize = 16;

/// All frames there are.
pub struct FrameTree {
    /// All but the base frame, in the order in which they were made.
    pub(super) defined: Vec<Frame, FRAMES>,
    /// What is in force.
    pub selection: FrameSelection,
}

impl FrameTree {
    /// Only the base frame.
    pub(in crate::commander) const fn new() -> Self {
        Self {
            defined: Vec::new(),
            selection: FrameSelection {
                enabled: EnabledFrames::Zero,
                rotation_centre: [0.0; 2],
            },
        }
    }

    /// The frame of this name; the base frame is none.
    pub fn find(&self, name: FrameName) -> Option<&Frame> {
        self.defined.iter().find(|frame| frame.name == name)
    }

    /// Makes a frame in the base frame, or changes one that is not in use.
    pub fn define(
        &mut self,
        name: FrameName,
        kind: FrameKind,
        in_parent: Transform,
    ) -> Result<(), FrameError> {
        self.check_not_in_use(name)?;
        let frame = Frame {
            name,
            kind,
            in_parent,
            parent: None,
        };
        let other_kind = self.find(name).is_some_and(|old| old.kind != kind);
        if other_kind && self.has_children(name) {
            return Err(FrameError::HasChildren(name));
        }
        match self.defined.iter_mut().find(|frame| frame.name == name) {
            Some(old) => *old = frame,
            None => self.defined.push(frame).map_err(|_| FrameError::Full)?,
        }
        Ok(())
    }

    /// Forgets a frame.
    pub fn remove(&mut self, name: FrameName) -> Result<(), FrameError> {
        self.check_not_in_use(name)?;
        let place = self.defined.iter().position(|frame| frame.name == name);
        let place = place.ok_or(FrameError::Unknown(name))?;
        if self.has_children(name) {
            return Err(FrameError::HasChildren(name));
        }
        self.defined.remove(place);
        Ok(())
    }

    /// Makes `child` a frame in `parent`; in the base frame when that is the parent.
    pub fn link(&mut self, child: FrameName, parent: FrameName) -> Result<(), FrameError> {
        self.check_not_in_use(child)?;
        let kind = self.find(child).ok_or(FrameError::Unknown(child))?.kind;
        let mut wanted = None;
        if parent != FrameName::ZERO {
            let above = self.find(parent).ok_or(FrameError::Unknown(parent))?;
            // Its own ancestor, or itself.
            if self.ancestry(parent).any(|frame| frame.name == child) {
                return Err(FrameError::Circular);
            }
            if !kind.can_be_child_of(above.kind) {
                return Err(FrameError::KindsDoNotMix);
            }
            wanted = Some(parent);
        }
        if let Some(frame) = self.defined.iter_mut().find(|frame| frame.name == child) {
            frame.parent = wanted;
        }
        Ok(())
    }

    /// A frame and its ancestors, itself first.
    pub fn ancestry(&self, name: FrameName) -> impl Iterator<Item = &Frame> {
        let mut next = self.find(name);
        core::iter::from_fn(move || {
            let frame = next?;
            next = frame.parent.and_then(|parent| self.find(parent));
            Some(frame)
        })
        // No ancestry is longer: there are no cycles.
        .take(FRAMES)
    }

    /// Where a frame lies in the base frame.
    pub fn in_base(&self, name: FrameName) -> Transform {
        self.ancestry(name)
            .fold(Transform::IDENTITY, |inner, frame| {
                frame.in_parent.then(&inner)
            })
    }

    /// The names that are in force, a work frame before a tool frame.
    pub fn enabled(&self) -> impl Iterator<Item = FrameName> + use<> {
        let names = match self.selection.enabled {
            EnabledFrames::Zero => [None; 2],
            EnabledFrames::Alone(name) => [Some(name), None],
            EnabledFrames::Pair { work, tool } => [work, tool],
        };
        names.into_iter().flatten()
    }

    /// Whether there is a frame of this name.
    pub fn contains(&self, name: FrameName) -> bool {
        name == FrameName::ZERO || self.find(name).is_some()
    }

    /// Whether `end` is `start`, or one that it lies in.
    pub fn is_above(&self, start: FrameName, end: FrameName) -> bool {
        end == FrameName::ZERO || self.ancestry(start).any(|frame| frame.name == end)
    }

    /// Whether the frame is in force by itself.
    pub fn is_enabled(&self, name: FrameName) -> bool {
        match self.selection.enabled {
            EnabledFrames::Zero => name == FrameName::ZERO,
            _ => self.enabled().any(|enabled| enabled == name),
        }
    }

    /// What the frame is for; the base frame counts as a directed one.
    pub fn kind(&self, name: FrameName) -> FrameKind {
        self.find(name)
            .map_or(FrameKind::Directed, |frame| frame.kind)
    }

    /// Every name that is there, the base frame first.
    pub fn names(&self) -> impl Iterator<Item = FrameName> {
        let defined = self.defined.iter().map(|frame| frame.name);
        core::iter::once(FrameName::ZERO).chain(defined)
    }

    fn has_children(&self, name: FrameName) -> bool {
        let mut frames = self.defined.iter();
        frames.any(|frame| frame.parent == Some(name))
    }

    /// the base frame and what is in use stay as they are.
    fn check_not_in_use(&self, name: FrameName) -> Result<(), FrameError> {
        let in_use = |enabled| self.ancestry(enabled).any(|frame| frame.name == name);
        if name == FrameName::ZERO || self.enabled().any(in_use) {
            return Err(FrameError::InUse(name));
        }
        Ok(())
    }
}
