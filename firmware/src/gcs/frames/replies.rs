//! What queries about frames answer.

use crate::commander::axis::Axis;
use crate::commander::frames::{
    EnabledFrames, Frame, FrameKind, FrameName, FrameQuery, FrameTree, ListItem, Transform,
};
use crate::gcs::error::ErrorCode;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply::{ReplyWriter, one_line};

/// Names of the centre of rotation's coordinates.
const CENTRE_AXES: [char; 3] = ['R', 'S', 'T'];

impl FrameTree {
    /// Answers a query; with an error number instead, and then nothing is written, when it asks for what is not there.
    pub(in crate::gcs) fn reply(
        &self,
        query: FrameQuery,
        out: &mut Output<'_>,
    ) -> Result<Result<(), ErrorCode>, WriteFailed> {
        let good = match query {
            FrameQuery::Enabled(name) | FrameQuery::Chains(name) | FrameQuery::List(name, _) => {
                name.is_none_or(|name| self.contains(name))
            }
            FrameQuery::Totals(start, end) => {
                start.is_none_or(|name| self.contains(name))
                    && end.is_none_or(|end| start.is_some_and(|start| self.is_above(start, end)))
            }
            FrameQuery::Types(_) | FrameQuery::RotationCentre(_) => true,
        };
        if !good {
            return Ok(Err(ErrorCode::OutOfRange));
        }
        match query {
            FrameQuery::Enabled(Some(name)) => self.reply_enabled(name, out)?,
            FrameQuery::Enabled(None) => self.reply_all_enabled(out)?,
            FrameQuery::Types(kind) => self.reply_types(kind, out)?,
            FrameQuery::Chains(name) => self.reply_chains(name, out)?,
            FrameQuery::List(name, item) => self.reply_list(name, item, out)?,
            FrameQuery::Totals(start, end) => self.reply_totals(start, end, out)?,
            FrameQuery::RotationCentre(named) => self.reply_rotation_centre(named, out)?,
        }
        Ok(Ok(()))
    }

    fn contains(&self, name: FrameName) -> bool {
        name == FrameName::ZERO || self.find(name).is_some()
    }

    fn is_above(&self, start: FrameName, end: FrameName) -> bool {
        end == FrameName::ZERO || self.ancestry(start).any(|frame| frame.name == end)
    }

    fn is_enabled(&self, name: FrameName) -> bool {
        match self.selection.enabled {
            EnabledFrames::Zero => name == FrameName::ZERO,
            _ => self.enabled().any(|enabled| enabled == name),
        }
    }

    /// `ZERO` counts as a directed frame.
    fn kind(&self, name: FrameName) -> FrameKind {
        self.find(name)
            .map_or(FrameKind::Directed, |frame| frame.kind)
    }

    /// Every name that is there, `ZERO` first.
    fn names(&self) -> impl Iterator<Item = FrameName> {
        let defined = self.defined.iter().map(|frame| frame.name);
        core::iter::once(FrameName::ZERO).chain(defined)
    }

    fn wanted(&self, name: Option<FrameName>) -> impl Iterator<Item = FrameName> {
        self.names()
            .filter(move |other| name.is_none_or(|name| name == *other))
    }

    fn reply_enabled(&self, name: FrameName, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let kind = if self.is_enabled(name) {
            self.kind(name).word()
        } else {
            ""
        };
        one_line(out, format_args!("{name}={kind}"))
    }

    fn reply_all_enabled(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for name in self.names().filter(|&name| self.is_enabled(name)) {
            reply.line(format_args!("{name}={}", self.kind(name).word()))?;
        }
        reply.end()
    }

    fn reply_types(
        &self,
        wanted: Option<FrameKind>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for kind in FrameKind::ALL {
            let mut names = self.names();
            let name = names.find(|&name| self.is_enabled(name) && self.kind(name) == kind);
            match (name, wanted) {
                (_, Some(wanted)) if wanted != kind => {}
                (Some(name), _) => reply.line(format_args!("{}={name}", kind.word()))?,
                (None, Some(_)) => reply.line(format_args!("{}=", kind.word()))?,
                (None, None) => {}
            }
        }
        reply.end()
    }

    fn reply_chains(
        &self,
        name: Option<FrameName>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for name in self.wanted(name) {
            reply.line(format_args!("{name}="))?;
            for parent in self.ancestry(name).filter_map(|frame| frame.parent) {
                reply.continue_line(format_args!("{parent} "))?;
            }
            reply.continue_line(format_args!("{}", FrameName::ZERO))?;
        }
        reply.end()
    }

    fn reply_list(
        &self,
        name: Option<FrameName>,
        item: Option<ListItem>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let zero = Frame {
            name: FrameName::ZERO,
            kind: FrameKind::Directed,
            in_parent: Transform::IDENTITY,
            parent: None,
        };
        let all = |part: ListItem| item.is_none() || item == Some(part);
        let mut reply = ReplyWriter::new(out);
        for name in self.wanted(name) {
            let frame = self.find(name).unwrap_or(&zero);
            if all(ListItem::Type) {
                reply.line(format_args!("{name} TYPE={}", frame.kind.word()))?;
            }
            if all(ListItem::Parent) {
                let parent = frame.parent.unwrap_or(FrameName::ZERO);
                reply.line(format_args!("{name} PARENT={parent}"))?;
            }
            if all(ListItem::Enabled) {
                let enabled = u8::from(self.is_enabled(name));
                reply.line(format_args!("{name} ENABLED={enabled}"))?;
            }
            for axis in Axis::ALL {
                let named = all(ListItem::Position(None)) || all(ListItem::Position(Some(axis)));
                if named {
                    let value = along(&frame.in_parent, axis);
                    reply.line(format_args!("{name} POS {}={value}", axis.letter()))?;
                }
            }
        }
        reply.end()
    }

    fn reply_totals(
        &self,
        start: Option<FrameName>,
        end: Option<FrameName>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for name in self.wanted(start) {
            let total = self
                .ancestry(name)
                .take_while(|frame| Some(frame.name) != end)
                .fold(Transform::IDENTITY, |inner, frame| {
                    frame.in_parent.then(&inner)
                });
            for axis in Axis::ALL {
                let value = along(&total, axis);
                reply.line(format_args!("{name} {}={value}", axis.letter()))?;
            }
        }
        reply.end()
    }

    fn reply_rotation_centre(
        &self,
        named: [bool; 3],
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let [r, s] = self.rotation_centre();
        let all = named == [false; 3];
        let mut reply = ReplyWriter::new(out);
        for ((axis, value), named) in CENTRE_AXES.into_iter().zip([r, s, 0.0]).zip(named) {
            if named || all {
                reply.line(format_args!("{axis}={value}"))?;
            }
        }
        reply.end()
    }
}

/// A frame's coordinate along an axis, mm or deg.
fn along(at: &Transform, axis: Axis) -> f64 {
    match axis {
        Axis::X => at.x_mm,
        Axis::Y => at.y_mm,
        Axis::W => at.w_deg,
        Axis::Z | Axis::U | Axis::V => 0.0,
    }
}
