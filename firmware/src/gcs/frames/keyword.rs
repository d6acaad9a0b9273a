//! The words for the kinds of frames: the commands that make them.

use crate::commander::frames::FrameKind;

/// All kinds, in the order in which they are listed.
pub(super) const KINDS: [FrameKind; 4] = [
    FrameKind::Directed,
    FrameKind::Here,
    FrameKind::Tool,
    FrameKind::Work,
];

/// The command that makes a frame of this kind, which is also the kind's name.
pub(super) const fn keyword(kind: FrameKind) -> &'static str {
    match kind {
        FrameKind::Directed => "KSD",
        FrameKind::Here => "KSF",
        FrameKind::Tool => "KST",
        FrameKind::Work => "KSW",
    }
}
