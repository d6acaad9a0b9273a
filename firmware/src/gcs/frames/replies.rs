//! What queries about frames answer.

use super::keyword::{KINDS, keyword};
use super::request::{FrameQuery, ListItem};
use crate::commander::axis::Axis;
use crate::commander::frames::{Frame, FrameKind, FrameName, FrameTree, Transform};
use crate::gcs::error::ErrorCode;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::{ReplyWriter, one_line};

/// Names of the centre of rotation's coordinates.
const CENTRE_AXES: [char; 3] = ['R', 'S', 'T'];

/// Answers a query; with an error number instead, and then nothing is written, when it asks for what is not there.
pub(in crate::gcs) fn reply_frames(
    frames: &FrameTree,
    query: FrameQuery,
    out: &mut Output<'_>,
) -> Result<Result<(), ErrorCode>, WriteFailed> {
    let good = match query {
        FrameQuery::Enabled(name) | FrameQuery::Chains(name) | FrameQuery::List(name, _) => {
            name.is_none_or(|name| frames.contains(name))
        }
        FrameQuery::Totals(start, end) => {
            start.is_none_or(|name| frames.contains(name))
                && end.is_none_or(|end| start.is_some_and(|start| frames.is_above(start, end)))
        }
        FrameQuery::Types(_) | FrameQuery::RotationCentre(_) => true,
    };
    if !good {
        return Ok(Err(ErrorCode::OutOfRange));
    }
    match query {
        FrameQuery::Enabled(Some(name)) => reply_enabled(frames, name, out)?,
        FrameQuery::Enabled(None) => reply_all_enabled(frames, out)?,
        FrameQuery::Types(kind) => reply_types(frames, kind, out)?,
        FrameQuery::Chains(name) => reply_chains(frames, name, out)?,
        FrameQuery::List(name, item) => reply_list(frames, name, item, out)?,
        FrameQuery::Totals(start, end) => reply_totals(frames, start, end, out)?,
        FrameQuery::RotationCentre(named) => reply_rotation_centre(frames, named, out)?,
    }
    Ok(Ok(()))
}

fn wanted(frames: &FrameTree, name: Option<FrameName>) -> impl Iterator<Item = FrameName> {
    frames
        .names()
        .filter(move |other| name.is_none_or(|name| name == *other))
}

fn reply_enabled(
    frames: &FrameTree,
    name: FrameName,
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let kind = if frames.is_enabled(name) {
        keyword(frames.kind(name))
    } else {
        ""
    };
    one_line(out, format_args!("{name}={kind}"))
}

fn reply_all_enabled(frames: &FrameTree, out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for name in frames.names().filter(|&name| frames.is_enabled(name)) {
        reply.line(format_args!("{name}={}", keyword(frames.kind(name))))?;
    }
    reply.end()
}

fn reply_types(
    frames: &FrameTree,
    wanted: Option<FrameKind>,
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for kind in KINDS {
        let mut names = frames.names();
        let name = names.find(|&name| frames.is_enabled(name) && frames.kind(name) == kind);
        match (name, wanted) {
            (_, Some(wanted)) if wanted != kind => {}
            (Some(name), _) => reply.line(format_args!("{}={name}", keyword(kind)))?,
            (None, Some(_)) => reply.line(format_args!("{}=", keyword(kind)))?,
            (None, None) => {}
        }
    }
    reply.end()
}

fn reply_chains(
    frames: &FrameTree,
    name: Option<FrameName>,
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for name in wanted(frames, name) {
        reply.line(format_args!("{name}="))?;
        for parent in frames.ancestry(name).filter_map(|frame| frame.parent) {
            reply.continue_line(format_args!("{parent} "))?;
        }
        reply.continue_line(format_args!("{}", FrameName::ZERO))?;
    }
    reply.end()
}

fn reply_list(
    frames: &FrameTree,
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
    for name in wanted(frames, name) {
        let frame = frames.find(name).unwrap_or(&zero);
        if all(ListItem::Type) {
            reply.line(format_args!("{name} TYPE={}", keyword(frame.kind)))?;
        }
        if all(ListItem::Parent) {
            let parent = frame.parent.unwrap_or(FrameName::ZERO);
            reply.line(format_args!("{name} PARENT={parent}"))?;
        }
        if all(ListItem::Enabled) {
            let enabled = u8::from(frames.is_enabled(name));
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
    frames: &FrameTree,
    start: Option<FrameName>,
    end: Option<FrameName>,
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for name in wanted(frames, start) {
        let total = frames
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
    frames: &FrameTree,
    named: [bool; 3],
    out: &mut Output<'_>,
) -> Result<(), WriteFailed> {
    let [r, s] = frames.rotation_centre();
    let all = named == [false; 3];
    let mut reply = ReplyWriter::new(out);
    for ((axis, value), named) in CENTRE_AXES.into_iter().zip([r, s, 0.0]).zip(named) {
        if named || all {
            reply.line(format_args!("{axis}={value}"))?;
        }
    }
    reply.end()
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
