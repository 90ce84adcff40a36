//! What the operator should know about the cut.

use std::collections::HashMap;

use bahn_path::BlockRef;

/// Something that happened while the tool moved, with the block that moved it. Repeated events of a
/// block are counted, not repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// The block of the movement.
    pub block: BlockRef,
    /// What happened as the tool moved.
    pub kind: EventKind,
    /// How many path elements of the block did it.
    pub count: u64,
}

/// What can happen while the tool moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EventKind {
    /// Material was removed in rapid traverse. Walls that the tool passes nearer than the resolution
    /// are not reported.
    RapidCut,
    /// The tool tip was lower than the lower face of the blank while a part of the tool was over the
    /// blank (inferred).
    BelowBlank,
    /// The tool cut while the spindle stood still, as reported by [`Workpiece::note_cut`](crate::Workpiece::note_cut).
    SpindleStopped,
    /// The tool cut while the speed of the spindle was 0, likewise.
    SpindleWithoutSpeed,
    /// The tool cut while the spindle turned the wrong way for it, likewise.
    SpindleWrongWay,
    /// There are too many movements for a picture of the path: the rest is not drawn.
    PathIncomplete,
    /// A tool without a radius was moved through the blank in feed: it removes nothing.
    NoRadius,
    /// `PGM SECTION CANNOT BE SHOWN`: the tool axis is not the one of BLK FORM. Nothing is removed
    /// [003:7967-7971].
    ToolAxisNotShown,
    /// `PGM SECTION CANNOT BE SHOWN`: a rotary axis moves, or stands at another angle than in the
    /// beginning. Nothing is removed until it is back (inferred) [003:876-877] [003:7967-7971].
    RotaryAxisNotShown,
    /// `PGM SECTION CANNOT BE SHOWN`: the working plane is tilted, or the tool leans while swivel axes are compensated. A
    /// height map has only one direction: nothing is removed (inferred).
    TiltedNotShown,
}

impl EventKind {
    /// Whether the control says `PGM SECTION CANNOT BE SHOWN`.
    pub const fn is_not_shown(self) -> bool {
        matches!(
            self,
            EventKind::ToolAxisNotShown | EventKind::RotaryAxisNotShown | EventKind::TiltedNotShown
        )
    }
}

/// Events in the order of their first occurrence. Its size is bounded by the blocks of the program,
/// however often they run.
#[derive(Clone, Debug, Default)]
pub(crate) struct EventLog {
    events: Vec<Event>,
    /// Index into `events`, and the sequence of the last counted element.
    index: HashMap<(BlockRef, EventKind), (usize, u64)>,
}

impl EventLog {
    /// Counts an event of the element with this sequence number (as the log numbers elements).
    pub fn add(&mut self, block: BlockRef, element: u64, kind: EventKind) {
        let (at, last) = self.index.entry((block, kind)).or_insert_with(|| {
            self.events.push(Event {
                block,
                kind,
                count: 0,
            });
            (self.events.len() - 1, u64::MAX)
        });
        if *last == element {
            return;
        }
        *last = element;
        if let Some(event) = self.events.get_mut(*at) {
            event.count += 1;
        }
    }

    pub fn take(&mut self) -> Vec<Event> {
        self.index.clear();
        std::mem::take(&mut self.events)
    }
}
