//! The report of a test run: what is collected while it runs, and what of it is handed out as JSON.

use bahn_reader::{Reader, WarningKind};
use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use bahn_interpreter::Interpreter;
use bahn_motion::Planned;
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::{Axis, BlockRef, Curve, FeedRate, Function, PathElement, Position};
use bahn_program::{Program, Unit};
use bahn_text::Diagnostic;
use bahn_workpiece::{EventKind, Hears, Remark};
use serde::ser::{Serialize, SerializeMap, Serializer};

use bahn_host::files::short_name;

/// Distinct warnings that are kept; a program with more has the same few in many blocks.
const MAX_WARNINGS: usize = 1000;
/// Tool calls, stops and printed lines that are listed, each.
const MAX_LISTED: usize = 10_000;

/// What is known of a run while it runs. Its size is bounded however long the run is.
pub struct Record {
    /// Time of machining so far, s; infinite when the path does not move.
    pub machining_time_s: f64,
    feed_mm: f64,
    rapid_mm: f64,
    position: Position,
    /// Count of executed blocks up to and with the one of the last element.
    blocks: u64,
    tool: Option<u32>,
    tool_calls: Vec<(BlockRef, Option<u32>, f64)>,
    stops: Vec<(BlockRef, &'static str)>,
    /// Lines that FN15 has printed, with their blocks.
    printed: Vec<(BlockRef, String)>,
    /// Tool calls, stops and lines beyond [`MAX_LISTED`].
    not_listed: u64,
    warnings: Vec<(BlockRef, Notice, u64)>,
    warning_index: HashMap<(BlockRef, Notice), usize>,
    /// Occurrences of warnings beyond [`MAX_WARNINGS`].
    more_warnings: u64,
}

/// What a warning is about.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Notice {
    /// Found by the interpreter.
    Program(WarningKind),
    /// Found while removing material.
    Cut(EventKind),
    /// Found while removing material, once for each tool.
    Tool {
        /// `None` before the first TOOL CALL.
        tool: Option<u32>,
        /// What happened as it moved.
        kind: EventKind,
    },
    /// The tool was below the blank, last in this block.
    BelowBlank {
        /// `None` before the first TOOL CALL.
        tool: Option<u32>,
        /// The last of its blocks.
        last: BlockRef,
    },
    /// A second, different BLK FORM after the first movement.
    BlankRedefined,
    /// TCH PROBE without a part.
    NothingToProbe,
    /// A tool is to be measured: a test run has no tool probe.
    NoToolProbe,
    /// Digitized points that no folder takes.
    Digitized {
        /// How many points were digitized.
        points: u64,
    },
    /// The drawing of the path has too many elements.
    DrawingIncomplete,
}

impl Record {
    /// Of a run that begins at a position.
    pub fn new(start: Position) -> Record {
        Record {
            machining_time_s: 0.0,
            feed_mm: 0.0,
            rapid_mm: 0.0,
            position: start,
            blocks: 0,
            tool: None,
            tool_calls: Vec::new(),
            stops: Vec::new(),
            printed: Vec::new(),
            not_listed: 0,
            warnings: Vec::new(),
            warning_index: HashMap::new(),
            more_warnings: 0,
        }
    }

    /// Takes an element that was executed.
    #[inline]
    pub fn element(&mut self, planned: &Planned) {
        self.machining_time_s += planned.duration_s();
        self.path(&planned.element);
    }

    /// Takes the way and the functions of an element.
    pub fn path(&mut self, element: &PathElement) {
        self.blocks = element.sequence;
        if element.curve != Curve::Hold {
            let length = element.curve.linear_length(&element.start, &element.end);
            match element.feed {
                FeedRate::Rapid => self.rapid_mm += length,
                FeedRate::Programmed(_) => self.feed_mm += length,
            }
            self.position = element.end;
        }
        if element.functions.is_some() {
            self.functions(element);
        }
    }

    fn functions(&mut self, element: &PathElement) {
        for function in element.functions() {
            match &function.function {
                Function::Tool(call) => {
                    self.tool = Some(call.tool);
                    self.tool_call(element.block, call.speed_rpm);
                }
                Function::SpindleSpeed(speed_rpm) => self.tool_call(element.block, *speed_rpm),
                Function::Print(line) if self.printed.len() < MAX_LISTED => {
                    self.printed.push((element.block, line.to_string()));
                }
                Function::Print(_) => self.not_listed += 1,
                _ => {}
            }
        }
    }

    /// Lists a programmed stop.
    pub fn stop(&mut self, block: BlockRef, function: &'static str) {
        if self.stops.len() < MAX_LISTED {
            self.stops.push((block, function));
        } else {
            self.not_listed += 1;
        }
    }

    fn tool_call(&mut self, block: BlockRef, speed_rpm: f64) {
        if self.tool_calls.len() < MAX_LISTED {
            self.tool_calls.push((block, self.tool, speed_rpm));
        } else {
            self.not_listed += 1;
        }
    }

    /// Notes a warning, so many times more for this block.
    pub fn warn(&mut self, block: BlockRef, notice: Notice, count: u64) {
        let key = (block, notice);
        if let Some(at) = self.warning_index.get(&key) {
            if let Some((_, _, total)) = self.warnings.get_mut(*at) {
                *total += count;
            }
        } else if self.warnings.len() < MAX_WARNINGS {
            self.warning_index.insert(key.clone(), self.warnings.len());
            self.warnings.push((key.0, key.1, count));
        } else {
            self.more_warnings += count;
        }
    }

    /// Closes the record: what it holds as JSON and people read it.
    pub fn report(
        mut self,
        run: &dyn Reader,
        end: End,
        removed_mm3: Option<f64>,
        model: ControlModel,
    ) -> Report {
        let place = |block: BlockRef| Place::of(run, block);
        self.warnings.sort_by_key(|(block, ..)| *block);
        let warnings = self
            .warnings
            .into_iter()
            .map(|(block, notice, count)| WarningReport {
                at: Some(block),
                ..WarningReport::new(place(block), notice.text(model, block), count)
            });
        let tool_calls = self.tool_calls.into_iter();
        let tool_calls = tool_calls.map(|(block, tool, rpm)| ToolCallReport::new(place(block), tool, rpm));
        let stops = self.stops.into_iter();
        let stops = stops.map(|(block, function)| StopReport::new(place(block), function));
        let printed = self.printed.into_iter();
        let printed = printed.map(|(block, text)| PrintReport::new(place(block), text));
        let completed = end == End::Completed;
        let stopped = end == End::Stopped;
        let unit = run.program(0).map_or(Unit::Mm, |program| program.unit());
        Report {
            program: run
                .program(0)
                .map(|program| short_name(program).to_owned())
                .unwrap_or_default(),
            unit: unit_name(unit),
            completed,
            error: if let End::Failed(error) = end {
                Some(*error)
            } else {
                None
            },
            machining_time_s: self
                .machining_time_s
                .is_finite()
                .then(|| tidy(self.machining_time_s)),
            path_mm: PathReport {
                feed: tidy(self.feed_mm),
                rapid: tidy(self.rapid_mm),
            },
            // The blocks after a stop may have been read already.
            blocks_executed: if stopped {
                self.blocks
            } else {
                run.blocks_executed()
            },
            tool_calls: tool_calls.collect(),
            final_position: Axes(if completed { run.position() } else { self.position }),
            q: QParameters(Interpreter::of(run).map_or_else(Vec::new, |run| run.q_values().to_vec())),
            removed_mm3: removed_mm3.map(tidy),
            warnings: warnings.chain(further("warnings", self.more_warnings)).collect(),
            stops: stops.collect(),
            printed: printed.collect(),
            not_listed: self.not_listed,
        }
    }
}

impl Hears for Record {
    fn hear(&mut self, block: BlockRef, remark: Remark, count: u64) {
        let notice = match remark {
            Remark::Cut(kind) => Notice::Cut(kind),
            Remark::Tool { tool, kind } => Notice::Tool { tool, kind },
            Remark::BelowBlank { tool, last } => Notice::BelowBlank { tool, last },
            Remark::BlankRedefined => Notice::BlankRedefined,
        };
        self.warn(block, notice, count);
    }
}

/// Says that there is more than is listed.
fn further(what: &str, count: u64) -> Option<WarningReport> {
    (count > 0).then(|| WarningReport {
        message: format!("further {what} are not listed"),
        program: String::new(),
        block: 0,
        line: 0,
        count,
        at: None,
    })
}

impl Notice {
    /// What is shown at a block.
    fn text(&self, model: ControlModel, block: BlockRef) -> String {
        let named = |tool: &Option<u32>| tool.map_or("no tool".into(), |tool| format!("tool {tool}"));
        match self {
            Notice::Program(kind) => kind.to_string(),
            Notice::Cut(EventKind::RapidCut) => "material is removed in rapid traverse".into(),
            Notice::BelowBlank { tool, last } if *last == block => {
                format!("{} is below the blank", named(tool))
            }
            Notice::BelowBlank { tool, last } => {
                format!("{} is below the blank, last in block {}", named(tool), last.block)
            }
            Notice::Tool {
                tool: None,
                kind: EventKind::NoRadius,
            } => "no tool is called: the path through the blank removes nothing".into(),
            Notice::Tool { tool, kind } => format!("{} {}", named(tool), what_a_tool_does(*kind)),
            Notice::Cut(
                kind @ (EventKind::BelowBlank
                | EventKind::SpindleStopped
                | EventKind::SpindleWithoutSpeed
                | EventKind::SpindleWrongWay
                | EventKind::NoRadius),
            ) => format!("a tool {}", what_a_tool_does(*kind)),
            Notice::DrawingIncomplete | Notice::Cut(EventKind::PathIncomplete) => {
                "the drawing of the path ends here, it has too many elements".into()
            }
            Notice::Cut(EventKind::ToolAxisNotShown) => {
                format!(
                    "{}: the tool axis is not that of BLK FORM",
                    MessageId::PgmSectionCannotBeShown.text(model)
                )
            }
            Notice::Cut(EventKind::RotaryAxisNotShown) => {
                format!(
                    "{}: a rotary axis moves",
                    MessageId::PgmSectionCannotBeShown.text(model)
                )
            }
            Notice::Cut(EventKind::TiltedNotShown) => {
                format!(
                    "{}: the tool leans",
                    MessageId::PgmSectionCannotBeShown.text(model)
                )
            }
            Notice::BlankRedefined => "another BLK FORM after the first movement: the first one stays".into(),
            Notice::Digitized { points } => {
                format!("{points} points are digitized and written nowhere: --digitized names a folder")
            }
            Notice::NothingToProbe => {
                "there is no part to touch: the program needs a BLK FORM, and graphics".into()
            }
            Notice::NoToolProbe => "a test run has no tool probe: the tool is that of the tool table".into(),
        }
    }
}

/// What is said once of a tool.
fn what_a_tool_does(kind: EventKind) -> &'static str {
    match kind {
        EventKind::SpindleStopped => "cuts while the spindle stands still",
        EventKind::SpindleWithoutSpeed => "cuts with spindle speed 0",
        EventKind::SpindleWrongWay => "cuts while the spindle turns the wrong way for it",
        EventKind::NoRadius => "has no radius: it moves through the blank and removes nothing",
        _ => "is below the blank",
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// At the end of the program.
    Completed,
    /// At a programmed stop, as wanted.
    Stopped,
    /// Ctrl-C broke it off.
    Interrupted,
    /// By the time limit.
    Late,
    /// By an error of the program.
    Failed(Box<ErrorReport>),
}

/// The report as JSON has it; the fields are documented in the help and the README.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Report {
    /// The program, without folders.
    pub program: String,
    /// Unit of the main program: `mm` or `inch`.
    pub unit: &'static str,
    /// It came to its end.
    pub completed: bool,
    /// The error that ended it; `None` where it came to its end.
    pub error: Option<ErrorReport>,
    /// s; `None` when the feed is 0.
    pub machining_time_s: Option<f64>,
    /// How far the tool went.
    pub path_mm: PathReport,
    /// Blocks that were executed.
    pub blocks_executed: u64,
    /// Tools and spindle speeds.
    pub tool_calls: Vec<ToolCallReport>,
    /// Where the axes stand in the end, mm or degrees.
    pub final_position: Axes,
    /// The Q parameters in the end.
    pub q: QParameters,
    /// mm³; `None` without a blank.
    pub removed_mm3: Option<f64>,
    /// What is not as it should be.
    pub warnings: Vec<WarningReport>,
    /// Stops that the program asked for, in their order.
    pub stops: Vec<StopReport>,
    /// Lines that FN15 has printed.
    pub printed: Vec<PrintReport>,
    /// Tool calls, stops and printed lines that are not listed, there were too many.
    #[serde(skip)]
    pub not_listed: u64,
}

/// An error of a program, with its block.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ErrorReport {
    /// What the control says.
    pub message: String,
    /// The program that it stands in.
    pub program: String,
    /// Number of the block in that program.
    pub block: u32,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
    /// What is wrong, in words; may be empty.
    pub detail: String,
    /// Where it stands, for people.
    #[serde(skip)]
    pub at: BlockRef,
    /// What to do about it.
    #[serde(skip)]
    pub remedy: Option<&'static str>,
}

impl ErrorReport {
    /// As people get it; `program` is the one that it stands in, `file` where that lies.
    pub fn diagnostic(&self, program: &Program, file: &Path) -> Diagnostic {
        let span = program.span_of(self.at.block);
        Diagnostic::error(span, self.message.as_str())
            .in_block(self.block.to_string())
            .with_detail(self.detail.as_str())
            .with_help(self.remedy)
            .at(file, program.text_of_line(span.line))
    }
}

/// How far the tool went, mm.
#[derive(Clone, Debug, serde::Serialize)]
pub struct PathReport {
    /// Distance in feed, mm.
    pub feed: f64,
    /// Distance in rapid traverse, mm.
    pub rapid: f64,
}

/// A tool or a spindle speed, with its block.
#[derive(Clone, Debug, serde::Serialize)]
pub struct ToolCallReport {
    /// Number of the block in that program.
    pub block: u32,
    /// `None` before the first TOOL CALL.
    pub tool: Option<u32>,
    /// Programmed spindle speed, rpm.
    pub speed_rpm: f64,
    /// The program that it stands in.
    pub program: String,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
}

impl ToolCallReport {
    fn new(Place { program, block, line }: Place, tool: Option<u32>, speed_rpm: f64) -> ToolCallReport {
        ToolCallReport {
            block,
            tool,
            speed_rpm: tidy(speed_rpm),
            program,
            line,
        }
    }
}

/// A warning, with its block.
#[derive(Clone, Debug, serde::Serialize)]
pub struct WarningReport {
    /// What is not as it should be, in words.
    pub message: String,
    /// The program that it stands in.
    pub program: String,
    /// Number of the block in that program.
    pub block: u32,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
    /// How often it came up.
    pub count: u64,
    /// Its block, where it is about one.
    #[serde(skip)]
    pub at: Option<BlockRef>,
}

impl WarningReport {
    fn new(Place { program, block, line }: Place, message: String, count: u64) -> WarningReport {
        WarningReport {
            message,
            program,
            block,
            line,
            count,
            at: None,
        }
    }
}

/// A programmed stop, with its block.
#[derive(Clone, Debug, serde::Serialize)]
pub struct StopReport {
    /// Number of the block in that program.
    pub block: u32,
    /// The function that stops: `M0`, `STOP` ..
    pub function: &'static str,
    /// The program that it stands in.
    pub program: String,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
}

impl StopReport {
    fn new(Place { program, block, line }: Place, function: &'static str) -> StopReport {
        StopReport {
            block,
            function,
            program,
            line,
        }
    }
}

/// A line of FN15.
#[derive(Clone, Debug, serde::Serialize)]
pub struct PrintReport {
    /// Number of the block in that program.
    pub block: u32,
    /// The line as the data interface gets it.
    pub text: String,
    /// The program that it stands in.
    pub program: String,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
}

impl PrintReport {
    fn new(Place { program, block, line }: Place, text: String) -> PrintReport {
        PrintReport {
            block,
            text,
            program,
            line,
        }
    }
}

/// Where a block stands.
#[derive(Default)]
pub struct Place {
    /// The program that it stands in.
    pub program: String,
    /// Number of the block in that program.
    pub block: u32,
    /// Its line there, from 1; 0 where nobody knows it.
    pub line: u32,
}

impl Place {
    /// Program, number and line of a block; empty and 0 where nobody knows the program.
    pub fn of(run: &dyn Reader, block: BlockRef) -> Place {
        let program = run.program(block.program);
        Place {
            program: program
                .map(|program| short_name(program).to_owned())
                .unwrap_or_default(),
            block: program.map_or(block.block, |program| program.number_of(block.block)),
            line: program.map_or(0, |program| program.line_of(block.block)),
        }
    }
}

/// The axes that have a position, in the order of the control.
#[derive(Clone, Copy, Debug)]
pub struct Axes(pub Position);

impl Serialize for Axes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for axis in Axis::ALL {
            if let Some(value) = self.0.get(axis) {
                map.serialize_entry(&axis.letter(), &tidy(value))?;
            }
        }
        map.end()
    }
}

/// The Q parameters of the control by number.
#[derive(Clone, Debug)]
pub struct QParameters(pub Vec<f64>);

impl Serialize for QParameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(
            self.0
                .iter()
                .enumerate()
                .map(|(number, value)| (number, value + 0.0)),
        )
    }
}

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut blank = "";
        for axis in Axis::ALL {
            if let Some(value) = self.0.get(axis) {
                write!(f, "{blank}{axis}{:+.3}", tidy(value))?;
                blank = "  ";
            }
        }
        if blank.is_empty() {
            f.write_str("-")
        } else {
            Ok(())
        }
    }
}

/// The unit as reports name it: `mm` or `inch`.
pub fn unit_name(unit: Unit) -> &'static str {
    match unit {
        Unit::Mm => "mm",
        Unit::Inch => "inch",
    }
}

/// Rounds to nine decimals, far below any resolution, so that 30.000000000000004 is 30; never -0.
pub fn tidy(value: f64) -> f64 {
    const DECIMALS: f64 = 1e9;
    let rounded = (value * DECIMALS).round() / DECIMALS;
    if rounded.is_finite() { rounded + 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_tidy() {
        assert_eq!(tidy(0.1 + 0.2), 0.3);
        assert!(tidy(-1e-12).is_sign_positive());
        assert_eq!(tidy(f64::MAX), f64::MAX);
    }

    #[test]
    fn repeated_and_too_many_warnings_are_counted() {
        let mut record = Record::new(Position::UNKNOWN);
        let block = |block| BlockRef { program: 0, block };
        for _ in 0..3 {
            record.warn(block(1), Notice::NothingToProbe, 2);
        }
        for number in 0..2000 {
            record.warn(
                block(number),
                Notice::Program(WarningKind::BlankInCalledProgram),
                1,
            );
        }
        assert_eq!(
            record.warnings.first(),
            Some(&(block(1), Notice::NothingToProbe, 6))
        );
        assert_eq!(record.warnings.len(), MAX_WARNINGS);
        assert_eq!(record.more_warnings, 1001);
    }
}
