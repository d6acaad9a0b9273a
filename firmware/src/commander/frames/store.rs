//! The frames there are: made, linked, forgotten.

use super::{EnabledFrames, Frame, FrameKind, FrameName, FrameSelection, Transform};
use crate::gcs::error::ErrorCode;
use heapless::Vec;

/// FrameTree that can be there at a time, besides `ZERO`.
pub const FRAMES: usize = 16;

/// All frames there are.
pub struct FrameTree {
    pub(crate) defined: Vec<Frame, FRAMES>,
    /// What is in force.
    pub selection: FrameSelection,
}

impl FrameTree {
    /// Only `ZERO`.
    pub const fn new() -> Self {
        Self {
            defined: Vec::new(),
            selection: FrameSelection {
                enabled: EnabledFrames::Zero,
                rotation_centre: [0.0; 2],
            },
        }
    }

    pub(crate) fn find(&self, name: FrameName) -> Option<&Frame> {
        self.defined.iter().find(|frame| frame.name == name)
    }

    /// Makes a frame in `ZERO`, or changes one that is not in use.
    pub fn define(
        &mut self,
        name: FrameName,
        kind: FrameKind,
        in_parent: Transform,
    ) -> Result<(), ErrorCode> {
        self.check_not_in_use(name)?;
        let frame = Frame {
            name,
            kind,
            in_parent,
            parent: None,
        };
        let other_kind = self.find(name).is_some_and(|old| old.kind != kind);
        if other_kind && self.has_children(name) {
            return Err(ErrorCode::NotForStage);
        }
        match self.defined.iter_mut().find(|frame| frame.name == name) {
            Some(old) => *old = frame,
            None => self
                .defined
                .push(frame)
                .map_err(|_| ErrorCode::OutOfRange)?,
        }
        Ok(())
    }

    /// Forgets a frame.
    pub fn remove(&mut self, name: FrameName) -> Result<(), ErrorCode> {
        self.check_not_in_use(name)?;
        let place = self.defined.iter().position(|frame| frame.name == name);
        let place = place.ok_or(ErrorCode::OutOfRange)?;
        if self.has_children(name) {
            return Err(ErrorCode::NotForStage);
        }
        self.defined.remove(place);
        Ok(())
    }

    /// Makes `child` a frame in `parent`; in `ZERO` when that is the parent.
    pub fn link(&mut self, child: FrameName, parent: FrameName) -> Result<(), ErrorCode> {
        self.check_not_in_use(child)?;
        let kind = self.find(child).ok_or(ErrorCode::OutOfRange)?.kind;
        let mut wanted = None;
        if parent != FrameName::ZERO {
            let above = self.find(parent).ok_or(ErrorCode::OutOfRange)?;
            // Its in_parent ancestor, or itself.
            if self.ancestry(parent).any(|frame| frame.name == child) {
                return Err(ErrorCode::OutOfRange);
            }
            if !kind.can_be_child_of(above.kind) {
                return Err(ErrorCode::NotForStage);
            }
            wanted = Some(parent);
        }
        if let Some(frame) = self.defined.iter_mut().find(|frame| frame.name == child) {
            frame.parent = wanted;
        }
        Ok(())
    }

    /// A frame and its ancestors, itself first.
    pub(crate) fn ancestry(&self, name: FrameName) -> impl Iterator<Item = &Frame> {
        let mut next = self.find(name);
        core::iter::from_fn(move || {
            let frame = next?;
            next = frame.parent.and_then(|parent| self.find(parent));
            Some(frame)
        })
        // No ancestry is longer: there are no cycles.
        .take(FRAMES)
    }

    /// Where a frame lies in `ZERO`.
    pub(crate) fn in_base(&self, name: FrameName) -> Transform {
        self.ancestry(name)
            .fold(Transform::IDENTITY, |inner, frame| {
                frame.in_parent.then(&inner)
            })
    }

    /// The names that are in force, a work frame before a tool frame.
    pub(crate) fn enabled(&self) -> impl Iterator<Item = FrameName> + use<> {
        let names = match self.selection.enabled {
            EnabledFrames::Zero => [None; 2],
            EnabledFrames::Alone(name) => [Some(name), None],
            EnabledFrames::Pair { work, tool } => [work, tool],
        };
        names.into_iter().flatten()
    }

    fn has_children(&self, name: FrameName) -> bool {
        let mut frames = self.defined.iter();
        frames.any(|frame| frame.parent == Some(name))
    }

    /// `ZERO` and what is in use stay as they are.
    fn check_not_in_use(&self, name: FrameName) -> Result<(), ErrorCode> {
        let in_use = |enabled| self.ancestry(enabled).any(|frame| frame.name == name);
        if name == FrameName::ZERO || self.enabled().any(in_use) {
            return Err(ErrorCode::NotForStage);
        }
        Ok(())
    }
}
