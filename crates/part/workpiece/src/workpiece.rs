//! The workpiece while it is machined.
//!
//! Decision: While the tool leans the height map is left as it is: PGM SECTION CANNOT BE SHOWN

use std::collections::HashMap;

use bahn_path::{Axis, Blank, BlockRef, FeedRate, PathElement, ToolShape};
use thiserror::Error;

use crate::batch::Batch;
use crate::chords;
use crate::cutters::Cutters;
use crate::event::{Event, EventKind, EventLog};
use crate::grid::{Grid, Resolution};
use crate::part::Part;
use crate::setup::{Local, Setup};
use crate::tool::Tool;
use crate::track::{Segment, Start};

/// Why there can be no workpiece.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum WorkpieceError {
    /// A side of the blank has no length, or its plane is not one of linear axes.
    #[error("the blank has a side without length")]
    Blank,
    /// The resolution is not a positive length.
    #[error("the resolution must be greater than 0 mm")]
    Resolution,
    /// The height map would have more than [`MAX_CELLS`](crate::MAX_CELLS) columns.
    #[error("the resolution is too fine for the blank, the finest is {finest_mm:.4} mm")]
    TooFine {
        /// A resolution that works, mm.
        finest_mm: f64,
    },
}

/// Segments that are cut at once: enough work for all cores, and so few that their tracks stay in the caches while one
/// band after the other is cut.
const BATCH_SEGMENTS: usize = 1024;

/// How far chords may deviate from an arc, as part of the resolution.
const CHORD_TOLERANCE: f64 = 0.05;

/// Tips that are this much below the lower face do not count as below the blank, mm.
const BELOW_BLANK_MM: f64 = 1e-6;

/// A blank and what the tool leaves of it.
///
/// Movements are collected and cut in batches over all cores; [`Workpiece::part`] and
/// [`Workpiece::take_events`] cut what still waits. The order of calls is the order of machining.
#[derive(Clone, Debug)]
pub struct Workpiece {
    part: Part,
    batch: Batch,
    /// Origin of every segment of the batch.
    origins: Vec<Origin>,
    /// What the next cut is noted as, see [`Workpiece::note_cut`].
    noted: Option<EventKind>,
    events: EventLog,
    /// Count of elements, to count an event once for each.
    elements: u64,
    /// Tip and tool at the end of the last segment, when it was cut there.
    last: Option<(Local, Tool)>,
    /// Angles of the rotary axes at which the blank is shown, degrees.
    rotary: HashMap<Axis, f64>,
}

/// Where a segment comes from, and what it is when it removes material.
#[derive(Clone, Copy, Debug)]
struct Origin {
    block: BlockRef,
    element: u64,
    rapid: bool,
    noted: Option<EventKind>,
}

impl Workpiece {
    /// A workpiece that is the whole blank.
    ///
    /// # Errors
    /// When the blank has no volume, or for a resolution that is not positive or too fine.
    pub fn new(blank: &Blank, resolution: Resolution) -> Result<Workpiece, WorkpieceError> {
        let setup = Setup::new(blank).ok_or(WorkpieceError::Blank)?;
        if let Resolution::Millimetres(mm) = resolution
            && !(mm.is_finite() && mm > 0.0)
        {
            return Err(WorkpieceError::Resolution);
        }
        let grid =
            Grid::new(&setup.size, resolution).map_err(|finest_mm| WorkpieceError::TooFine { finest_mm })?;
        Ok(Workpiece {
            part: Part::new(setup, grid),
            batch: Batch::default(),
            origins: Vec::new(),
            noted: None,
            events: EventLog::default(),
            elements: 0,
            last: None,
            rotary: HashMap::new(),
        })
    }

    /// Removes what the tool sweeps along the element. Positions are those of the centre of the tool's
    /// tip. Nothing is removed while an axis of the blank has no position, with a tool that has no
    /// radius, or where the element cannot be shown (see [`EventKind`]).
    pub fn cut(&mut self, element: &PathElement, tool: &ToolShape, tool_axis: Axis) {
        self.elements += 1;
        self.follow(element);
        if let Some(kind) = self.not_shown(element, tool_axis) {
            self.events.add(element.block, self.elements, kind);
            self.last = None;
            return;
        }
        let Some(tool) = Tool::new(tool, &self.part.grid) else {
            return self.pass_without_radius(element);
        };
        let rapid = element.feed == FeedRate::Rapid;
        let tolerance = CHORD_TOLERANCE * self.part.grid.cell();
        let setup = self.part.setup;
        let reach = tool.radius + self.part.grid.cell();
        let push = |from, to| self.push(from, to, tool, rapid, element.block);
        chords::chop(element, &setup, tolerance, reach, push);
    }

    /// Notes the next cut, and only that, as an event of this kind: the caller knows what is wrong with it.
    pub fn note_cut(&mut self, kind: Option<EventKind>) {
        if self.noted.is_some() {
            self.flush();
        }
        self.noted = kind;
    }

    /// From now on the part remembers which tool cut each column last, for pictures.
    pub fn remember_tools(&mut self) {
        let columns = self.part.heights.len();
        self.part.cutters.get_or_insert_with(|| Cutters::new(columns));
    }

    /// From now on the part remembers the tool path, for pictures.
    pub fn remember_path(&mut self) {
        self.part.trail.get_or_insert_default();
    }

    /// The number of the tool that cuts from now on, for pictures.
    pub fn take_tool(&mut self, number: Option<u32>) {
        if let Some(cutters) = &mut self.part.cutters {
            cutters.take_tool(number);
        }
    }

    /// The material as it is now.
    pub fn part(&mut self) -> &Part {
        self.flush();
        &self.part
    }

    /// The material at the end.
    pub fn finished(mut self) -> Part {
        self.flush();
        self.part
    }

    /// What happened since the last call, in the order of the first occurrence.
    pub fn take_events(&mut self) -> Vec<Event> {
        self.flush();
        self.events.take()
    }

    /// Keeps the tool path when it is remembered.
    fn follow(&mut self, element: &PathElement) {
        // Coordinates of a tilted plane are not those of the blank.
        let Some(trail) = self.part.trail.as_mut().filter(|_| element.placement.is_none()) else {
            return;
        };
        let rapid = element.feed == FeedRate::Rapid;
        let size = self.part.setup.size;
        let (mut whole, tolerance) = (true, 0.5 * self.part.grid.cell());
        let reach = size.into_iter().fold(0.0, f64::max);
        chords::chop(element, &self.part.setup, tolerance, reach, |from, to| {
            whole &= trail.push(from, to, rapid);
        });
        if !whole {
            self.events
                .add(element.block, self.elements, EventKind::PathIncomplete);
        }
    }

    /// A tool without a radius goes through the blank in feed.
    fn pass_without_radius(&mut self, element: &PathElement) {
        if element.feed == FeedRate::Rapid {
            return;
        }
        let (setup, mut inside) = (self.part.setup, false);
        chords::chop(element, &setup, self.part.grid.cell(), 0.0, |from, to| {
            inside |= chords::clip(from, to, &setup.size, 0.0).is_some();
        });
        if inside {
            self.events.add(element.block, self.elements, EventKind::NoRadius);
        }
    }

    fn push(&mut self, from: Local, to: Local, tool: Tool, rapid: bool, block: BlockRef) {
        let size = self.part.setup.size;
        let margin = tool.radius + self.part.grid.cell();
        let start_is_cut = self.last == Some((from, tool));
        self.last = None;
        let Some((a, b)) = chords::clip(from, to, &size, margin) else {
            return;
        };
        if a[2].min(b[2]) < -BELOW_BLANK_MM && reaches_below(a, b, &size, tool.radius) {
            self.events.add(block, self.elements, EventKind::BelowBlank);
        }
        self.batch.push(
            Segment {
                from: a,
                to: b,
                tool,
                start: if start_is_cut && a == from {
                    Start::Cut
                } else {
                    Start::Uncut
                },
                followed: false,
            },
            rapid || self.noted.is_some(),
            self.part
                .cutters
                .as_ref()
                .map_or(0, |cutters| cutters.mark(rapid)),
        );
        self.origins.push(Origin {
            block,
            element: self.elements,
            rapid,
            noted: self.noted,
        });
        self.last = (b == to).then_some((to, tool));
        if self.batch.len() >= BATCH_SEGMENTS {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let Part {
            grid,
            heights,
            cutters,
            ..
        } = &mut self.part;
        let marked = cutters.as_mut().map(|cutters| cutters.marks.as_mut_slice());
        let hits = self.batch.cut(grid, heights, marked);
        for hit in hits {
            let Some(origin) = self.origins.get(hit as usize) else {
                continue;
            };
            if origin.rapid {
                self.events.add(origin.block, origin.element, EventKind::RapidCut);
            }
            if let Some(kind) = origin.noted.filter(|_| self.noted == origin.noted) {
                self.events.add(origin.block, origin.element, kind);
                self.noted = None;
            }
        }
        self.origins.clear();
    }

    /// Why an element cannot be shown [003:7967-7971].
    fn not_shown(&mut self, element: &PathElement, tool_axis: Axis) -> Option<EventKind> {
        let mut turned = false;
        for axis in [Axis::A, Axis::B, Axis::C] {
            let (start, end) = (element.start.get(axis), element.end.get(axis));
            let Some(first) = start.or(end) else { continue };
            let shown = *self.rotary.entry(axis).or_insert(first);
            turned |= [start, end]
                .into_iter()
                .flatten()
                .any(|angle| !same_angle(angle, shown));
        }
        if element.placement.is_some() {
            Some(EventKind::TiltedNotShown)
        } else if turned {
            Some(EventKind::RotaryAxisNotShown)
        } else if tool_axis.main() != Some(self.part.setup.axes[2]) {
            Some(EventKind::ToolAxisNotShown)
        } else {
            None
        }
    }
}

fn same_angle(a: f64, b: f64) -> bool {
    const RESOLUTION_DEG: f64 = 1e-6;
    let difference = (a - b).rem_euclid(360.0);
    difference.min(360.0 - difference) < RESOLUTION_DEG
}

/// Whether a disc that moves from `a` to `b` is over the blank while it is below the lower face.
fn reaches_below(a: Local, b: Local, size: &Local, radius: f64) -> bool {
    // The part of the movement below the lower face; one end surely is.
    let at = |t: f64| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
    let crossing = if a[2] == b[2] {
        0.0
    } else {
        (a[2] / (a[2] - b[2])).clamp(0.0, 1.0)
    };
    let p = if a[2] < 0.0 { [a[0], a[1]] } else { at(crossing) };
    let q = if b[2] < 0.0 { [b[0], b[1]] } else { at(crossing) };
    distance_to_rectangle(p, q, size) < radius
}

/// Distance of a straight line from the rectangle between the origin and `size`: the distance is
/// convex along the line, so thirds of it can be thrown away.
fn distance_to_rectangle(p: [f64; 2], q: [f64; 2], size: &Local) -> f64 {
    const STEPS: usize = 60;
    let distance = |t: f64| {
        let outside = |k: usize| {
            let value = p[k] + (q[k] - p[k]) * t;
            (-value).max(value - size[k]).max(0.0)
        };
        outside(0).hypot(outside(1))
    };
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..STEPS {
        let (t1, t2) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if distance(t1) <= distance(t2) {
            to = t2;
        } else {
            from = t1;
        }
    }
    distance(0.5 * (from + to)).min(distance(0.0)).min(distance(1.0))
}
