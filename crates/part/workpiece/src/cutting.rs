//! The part while the path runs: what a program does with blank, tools and spindle, for whoever follows it.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use bahn_path::{
    At, Axis, Blank, BlockRef, Curve, Function, OverrideLaw, PathElement, Position, SpindleOrder,
    TechnologyFunction, ToolShape, Touch,
};

use crate::event::EventKind;
use crate::grid::Resolution;
use crate::part::Part;
use crate::workpiece::{Workpiece, WorkpieceError};

/// Something that whoever runs a program should know of the cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remark {
    /// It happened while material was removed.
    Cut(EventKind),
    /// The same, once for each tool.
    Tool {
        /// `None` before the first TOOL CALL.
        tool: Option<u32>,
        /// What happened as the tool moved.
        kind: EventKind,
    },
    /// The tool was below the blank, last in this block.
    BelowBlank {
        /// `None` before the first TOOL CALL.
        tool: Option<u32>,
        /// The last block with the tool below the blank.
        last: BlockRef,
    },
    /// A second, different BLK FORM after the first movement.
    BlankRedefined,
}

/// Who gets the events of the cut.
pub trait Hears {
    /// It happened in a block, so many times.
    fn hear(&mut self, block: BlockRef, remark: Remark, count: u64);
}

/// What columns the part is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Columns {
    /// As many as a picture needs.
    BySize,
    /// Of this side, mm.
    Millimetres(f64),
    /// About so many columns.
    About(f64),
}

impl Columns {
    fn resolution(self, blank: &Blank) -> Resolution {
        match self {
            Columns::BySize => Resolution::BySize,
            Columns::Millimetres(side) => Resolution::Millimetres(side),
            Columns::About(count) => {
                let side = |axis: Axis| {
                    let corner = |of: &[f64; 3]| of.get(axis.index()).copied().unwrap_or_default();
                    corner(&blank.max) - corner(&blank.min)
                };
                let area = side(blank.plane.first) * side(blank.plane.second);
                Resolution::Millimetres((area / count).sqrt())
            }
        }
    }
}

/// What a picture needs to know beside the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Which tool cut what.
    pub tools: bool,
    /// The tool path is kept for pictures.
    pub path: bool,
}

/// The part, once BLK FORM gives a blank.
pub struct Cutting {
    columns: Columns,
    memory: Memory,
    workpiece: Option<(Blank, Workpiece)>,
    /// Tool in the spindle; `None` before the first TOOL CALL.
    tool: Option<u32>,
    shape: ToolShape,
    tool_axis: Axis,
    moved: bool,
    spindle: Spindle,
    /// How the spindle of a machine really turns: that counts, whatever the program says.
    seen: Option<Spindle>,
    /// Tools that cut with M4.
    left_hand: BTreeSet<u32>,
    /// What was said of a tool already.
    reported: HashSet<(Option<u32>, EventKind)>,
    /// Where each tool was below the blank: first and last block, elements.
    below: BTreeMap<Option<u32>, (BlockRef, BlockRef, u64)>,
}

/// Slower than this the spindle of a machine stands still, rpm (inferred).
const STANDS_RPM: f64 = 1.0;

/// What the program did with the spindle, or the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spindle {
    turns: Option<Turn>,
    speed_rpm: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    Clockwise,
    CounterClockwise,
}

impl Spindle {
    /// Takes a function of the program.
    fn take(&mut self, function: &TechnologyFunction) {
        match function.spindle {
            Some(SpindleOrder::Clockwise) => self.turns = Some(Turn::Clockwise),
            Some(SpindleOrder::CounterClockwise) => self.turns = Some(Turn::CounterClockwise),
            Some(SpindleOrder::Stop | SpindleOrder::StopWithRun) => self.turns = None,
            None => {}
        }
        match &function.function {
            Function::Tool(call) => self.speed_rpm = call.speed_rpm,
            Function::SpindleSpeed(speed_rpm) => self.speed_rpm = *speed_rpm,
            _ => {}
        }
    }

    /// How the spindle of a machine turns, rpm, positive as M03; and whether it does not because its programmed speed
    /// is 0.
    pub fn seen(rpm: f64, without_speed: bool) -> Spindle {
        let turn = if rpm < 0.0 {
            Turn::CounterClockwise
        } else {
            Turn::Clockwise
        };
        let stands = rpm.abs() < STANDS_RPM;
        Spindle {
            turns: (!stands || without_speed).then_some(turn),
            speed_rpm: if stands { 0.0 } else { rpm.abs() },
        }
    }

    /// What is wrong when a tool cuts now.
    fn fault(&self, left_hand: bool) -> Option<EventKind> {
        let right = if left_hand {
            Turn::CounterClockwise
        } else {
            Turn::Clockwise
        };
        match self.turns {
            None => Some(EventKind::SpindleStopped),
            Some(_) if self.speed_rpm == 0.0 => Some(EventKind::SpindleWithoutSpeed),
            Some(turn) if turn != right => Some(EventKind::SpindleWrongWay),
            Some(_) => None,
        }
    }
}

impl Cutting {
    /// For tools of which some cut with M4.
    pub fn new(columns: Columns, memory: Memory, left_hand: BTreeSet<u32>) -> Cutting {
        Cutting {
            columns,
            memory,
            workpiece: None,
            tool: None,
            shape: ToolShape::default(),
            tool_axis: Axis::Z,
            moved: false,
            spindle: Spindle::default(),
            seen: None,
            left_hand,
            reported: HashSet::new(),
            below: BTreeMap::new(),
        }
    }

    /// How the spindle of the machine turned on the next element.
    pub fn see(&mut self, spindle: Spindle) {
        if self.seen.replace(spindle) != Some(spindle) {
            self.watch();
        }
    }

    /// Takes an element that was executed.
    ///
    /// # Errors
    /// When there can be no workpiece of the blank with these columns.
    #[inline]
    pub fn element(&mut self, element: &PathElement, hears: &mut impl Hears) -> Result<(), WorkpieceError> {
        if element.functions.is_some() {
            self.functions(element, false, hears)?;
        }
        if element.curve != Curve::Hold {
            self.moved = true;
            if let Some((_, workpiece)) = &mut self.workpiece {
                // The spindle of rigid tapping is turned by the cycle itself [003:5106].
                let tapping = matches!(element.override_law, OverrideLaw::Spindle(_));
                if tapping {
                    workpiece.note_cut(None);
                }
                workpiece.cut(element, &self.shape, self.tool_axis);
                if tapping {
                    self.watch();
                }
            }
        }
        if element.functions.is_some() {
            self.functions(element, true, hears)?;
        }
        Ok(())
    }

    /// Takes the functions at the end of an element, or all others.
    fn functions(
        &mut self,
        element: &PathElement,
        at_end: bool,
        hears: &mut impl Hears,
    ) -> Result<(), WorkpieceError> {
        let before = self.spindle;
        for function in element.functions() {
            // What is output before the end, as M05 in tapping, acts on the distance to the end and not before.
            if matches!(function.at, At::End | At::BeforeEnd(_)) != at_end {
                continue;
            }
            self.spindle.take(function);
            match &function.function {
                Function::Tool(call) => {
                    self.tell(hears);
                    (self.tool, self.shape, self.tool_axis) = (Some(call.tool), call.shape, call.axis);
                    if let Some((_, workpiece)) = &mut self.workpiece {
                        workpiece.take_tool(self.tool);
                    }
                    self.watch();
                }
                Function::Blank(blank) => self.blank(blank, element.block, hears)?,
                _ => {}
            }
        }
        if self.spindle != before {
            self.watch();
        }
        Ok(())
    }

    /// Lets the workpiece note the first cut of the tool with which something is wrong.
    fn watch(&mut self) {
        let left_hand = self.tool.is_some_and(|tool| self.left_hand.contains(&tool));
        let fault = self
            .seen
            .unwrap_or(self.spindle)
            .fault(left_hand)
            .filter(|kind| !self.reported.contains(&(self.tool, *kind)));
        if let Some((_, workpiece)) = &mut self.workpiece {
            workpiece.note_cut(fault);
        }
    }

    /// Says what happened with the tool in the spindle so far; nobody need ask before a tool change, or the end.
    pub fn tell(&mut self, hears: &mut impl Hears) {
        let Some((_, workpiece)) = &mut self.workpiece else {
            return;
        };
        for event in workpiece.take_events() {
            match event.kind {
                EventKind::BelowBlank => {
                    let (_, last, count) =
                        self.below
                            .entry(self.tool)
                            .or_insert((event.block, event.block, 0));
                    *last = event.block.max(*last);
                    *count += event.count;
                }
                EventKind::SpindleStopped
                | EventKind::SpindleWithoutSpeed
                | EventKind::SpindleWrongWay
                | EventKind::NoRadius => {
                    if self.reported.insert((self.tool, event.kind)) {
                        let tool = self.tool;
                        hears.hear(
                            event.block,
                            Remark::Tool {
                                tool,
                                kind: event.kind,
                            },
                            1,
                        );
                    }
                }
                kind => hears.hear(event.block, Remark::Cut(kind), event.count),
            }
        }
    }

    /// BLK FORM: counts until something moves; the same again, in a repeat, changes nothing.
    fn blank(
        &mut self,
        blank: &Blank,
        block: BlockRef,
        hears: &mut impl Hears,
    ) -> Result<(), WorkpieceError> {
        match &self.workpiece {
            Some((first, _)) if first == blank => return Ok(()),
            Some(_) if self.moved => {
                hears.hear(block, Remark::BlankRedefined, 1);
                return Ok(());
            }
            _ => {}
        }
        self.whole(blank)
    }

    /// A blank of which nothing is removed.
    fn whole(&mut self, blank: &Blank) -> Result<(), WorkpieceError> {
        let mut workpiece = Workpiece::new(blank, self.columns.resolution(blank))?;
        if self.memory.tools {
            workpiece.remember_tools();
            workpiece.take_tool(self.tool);
        }
        if self.memory.path {
            workpiece.remember_path();
        }
        self.workpiece = Some((*blank, workpiece));
        self.watch();
        Ok(())
    }

    /// The blank is whole again.
    ///
    /// # Errors
    /// None that the first one had not.
    pub fn restore(&mut self) -> Result<(), WorkpieceError> {
        if let Some((blank, _)) = self.workpiece.take() {
            self.moved = false;
            self.whole(&blank)?;
        }
        Ok(())
    }

    /// Where a probing movement touches the part as machined so far.
    pub fn touch(&mut self, from: &Position, to: &Position, stylus_radius: f64) -> Option<Touch> {
        let (_, workpiece) = self.workpiece.as_mut()?;
        let position = workpiece.part().touch(from, to, stylus_radius)?;
        Some(Touch { position })
    }

    /// The part as it is now; `None` without a blank.
    pub fn part(&mut self) -> Option<&Part> {
        self.workpiece.as_mut().map(|(_, workpiece)| workpiece.part())
    }

    /// Whether there is a blank.
    pub fn has_part(&self) -> bool {
        self.workpiece.is_some()
    }

    /// The part at the end of the run; `None` without a blank.
    pub fn finish(mut self, hears: &mut impl Hears) -> Option<Part> {
        self.tell(hears);
        for (tool, (first, last, count)) in std::mem::take(&mut self.below) {
            hears.hear(first, Remark::BelowBlank { tool, last }, count);
        }
        self.workpiece.map(|(_, workpiece)| workpiece.finished())
    }
}
