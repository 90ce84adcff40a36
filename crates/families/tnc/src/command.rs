//! What an operator, a script or a screen asks the control to do.
//!
//! Decision: An operand that somebody sets from outside is set as in the table of the PLC menu; inputs are the
//! plant's

use std::fmt;
use std::str::FromStr;

use bahn_exchange::{Assignment, BitArea, Operand};
use bahn_parameters::ControlModel;
use bahn_parameters::technology::Technology;
use bahn_path::{Axis, Switch};
use bahn_plc::{DataLineEvent, TableKind};

use crate::dnc::Dnc;
use crate::plane_command::PlaneCommand;
use crate::probe_command::ProbeCommand;
use crate::screen_command::ScreenCommand;
use crate::test_command::TestCommand;

/// The machine operating modes, as W272 codes them [000:4680-4687].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// MANUAL OPERATION: direction keys and jog increment move the axes.
    #[default]
    Manual,
    /// ELECTRONIC HANDWHEEL: the handwheel moves an axis.
    Handwheel,
    /// POSITIONING WITH MANUAL DATA INPUT.
    Mdi,
    /// PROGRAM RUN SINGLE BLOCK.
    SingleBlock,
    /// PROGRAM RUN FULL SEQUENCE.
    FullSequence,
    /// PASS OVER REFERENCE MARKS.
    Reference,
}

impl Mode {
    /// All modes, in the order of their codes.
    pub const ALL: [Mode; 6] = [
        Mode::Manual,
        Mode::Handwheel,
        Mode::Mdi,
        Mode::SingleBlock,
        Mode::FullSequence,
        Mode::Reference,
    ];

    /// The code in W272 [000:4680-4687].
    pub fn code(self) -> i32 {
        match self {
            Mode::Manual => 1,
            Mode::Handwheel => 2,
            Mode::Mdi => 3,
            Mode::SingleBlock => 4,
            Mode::FullSequence => 5,
            Mode::Reference => 7,
        }
    }

    /// The name in commands: `manual`, `handwheel`, `mdi`, `single`, `full`, `reference`.
    pub fn name(self) -> &'static str {
        match self {
            Mode::Manual => "manual",
            Mode::Handwheel => "handwheel",
            Mode::Mdi => "mdi",
            Mode::SingleBlock => "single",
            Mode::FullSequence => "full",
            Mode::Reference => "reference",
        }
    }

    /// Blocks run in this mode: MDI, single block, full sequence.
    pub fn is_automatic(self) -> bool {
        matches!(self, Mode::Mdi | Mode::SingleBlock | Mode::FullSequence)
    }
}

/// One input of the operator at the control's keyboard. Keys of the machine operating panel are inputs of
/// the PLC and do not come this way.
///
/// The text form is that of scripts and command logs:
///
/// ```
/// use bahn_tnc::{Command, Mode};
/// let command: Command = "mode full".parse()?;
/// assert_eq!(command, Command::Mode(Mode::FullSequence));
/// assert_eq!(command.to_string(), "mode full");
/// assert_eq!("datum X -12.5".parse::<Command>()?.to_string(), "datum X -12.5");
/// # Ok::<(), bahn_tnc::CommandError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// `mode NAME`: an operating mode.
    Mode(Mode),
    /// `ce`: clears the message.
    Ce,
    /// `stop`: INTERNAL STOP of an interrupted run.
    InternalStop,
    /// `select NAME`: selects the program that runs.
    Select(String),
    /// `dnc ..`: a program that is executed while it is transferred [000:16951-16968].
    Dnc(Dnc),
    /// `goto N`: the run starts at this block of the main program.
    Goto(u32),
    /// `mdi BLOCKS`: the block of POSITIONING WITH MDI; `\n` separates several.
    Mdi(String),
    /// `m N`: an M function in MANUAL or HANDWHEEL, output with the next NC start [003:1103-1111].
    MFunction(u16),
    /// `s RPM`: a spindle speed in MANUAL or HANDWHEEL, output with the next NC start.
    Speed(f64),
    /// `datum AXIS VALUE`: the actual position of the axis becomes this value, mm or degrees.
    Datum(Axis, f64),
    /// `probe ..`: a function of the TOUCH PROBE menu [003:1226-1405].
    Probe(ProbeCommand),
    /// `tool-life T MIN`: the current life of a tool (CUR.TIME), minutes; 0 begins anew [000:9185].
    ToolLife(u32, f64),
    /// `q N VALUE`: a Q parameter, between runs or while a run is interrupted [003:4337-4344].
    Q(u16, f64),
    /// `axis-limit X 1 -100 250`, `axis-limit X 1 off`: AXIS LIMIT of MOD for a traverse range 1 to 3, from machine zero,
    /// mm or degrees [003:7115-7157].
    AxisLimit(Axis, u8, Option<[f64; 2]>),
    /// `table T 12 L 80.5`: the file of the tool table (`T`), datum table (`D`) or pocket table (`P`) says something else in a
    /// column of a line from now on. It counts with the next scan, as what module 9094 writes.
    Table(TableKind, i32, usize, f64),
    /// `jog MM`: the jog increment, mm.
    JogIncrement(f64),
    /// `output step FEED`, `output ramp`: what direction keys put out in MANUAL OPERATION on axes with digital speed
    /// controller, as OUTPUT of the oscilloscope says; the feed in mm/min [000:18737-18756].
    Output(Option<f64>),
    /// `oscilloscope start`, `oscilloscope stop`: the soft keys START and STOP after code number 688 379
    /// [000:18776-18778].
    Oscilloscope(Switch),
    /// `3d-rot on`, `3d-rot on B+30`, `3d-rot off`: by hand the axes move, are shown and get their datum in the plane of the
    /// swivel axes; `3d-rot run ..`: programs begin in it [000:4256].
    WorkingPlane(PlaneCommand),
    /// `screen EDITING MACHINE WINDOWS FILE UNITS`: what the screen shows, for module 9035.
    Screen(ScreenCommand),
    /// `handwheel AXIS FACTOR`: axis of the handwheel and its interpolation factor 0 to 10.
    Handwheel(Axis, u8),
    /// `pnt on`, `pnt off`: in POSITIONING WITH MDI the axes follow the stylus of a measuring probe, or do so no more
    /// [000:7907].
    Pnt(Switch),
    /// `axis-key AXIS`: an axis key of the keyboard: the axis is highlighted (M2096 ff.), and with MP7640 = 2 it is that of
    /// the handwheel, too [000:6425] [000:8139-8151].
    AxisKey(Axis),
    /// `manual-operation`: axes may be moved while a run is interrupted (M2018).
    ManualOperation,
    /// `restore-position`: return to the contour with NC start (M2019).
    RestorePosition,
    /// `restore-at N`: block scan to block N.
    RestoreAt(u32),
    /// `code N`: a code number [000:6928-6947].
    Code(u32),
    /// `key CODE`: a key by its code 58 to 127 [000:7338-7404], or what W516 calls else: `xx50` hexadecimal, M, S,
    /// TOUCH PROBE [000:7406-7436]; codes of other commands are read as these.
    Key(u16),
    /// `test NAME`: TEST RUN of a program beside what the machine does [003:1514-1535].
    Test(String),
    /// `test-run ..`: interrupts the test run, lets it go on, or changes a Q parameter of it.
    TestRun(TestCommand),
    /// `end-test`: breaks the test run off.
    EndTest,
    /// `offset adjust`, `offset off`: answers to code number 75 368 [000:5014-5020].
    OffsetAdjustment(Switch),
    /// `M100=1`, `W6=$10`, `S0="TEXT"`: an operand in the table of the PLC menu [000:11436-11460]; what the PLC program
    /// or the control writes later counts. `MP4110.2=4`: a machine parameter, while no program runs unless the list says
    /// that it may change then; what needs a reset makes the control begin anew, what needs the reference marks lets
    /// the axes traverse them again [000:10088].
    Set(Assignment),
    /// `rs422 received "TEXT"`, `lsv2 message 42` ..: something comes over a data interface to the PLC
    /// [000:15587-15905].
    DataLine(DataLineEvent),
    /// `power off`, `power on`: the supply of the control.
    Power(Switch),
}

/// Where CUR.TIME of a tool ends, minutes (inferred).
pub(crate) const CURRENT_MAX_MIN: f64 = 9999.0;
/// Greatest spindle speed that is entered, rpm [003:2180].
const SPEED_MAX: f64 = 99_999.999;
/// Greatest feed of a step, mm/min: that of MP1010.
const FEED_MAX: f64 = 300_000.0;
/// Greatest Q parameter [003:4290-4300].
const Q_MAX: f64 = 99_999.999_9;
/// Greatest AXIS LIMIT, mm or degrees [003:7121-7157].
const AXIS_LIMIT_MAX: f64 = 30_000.0;
/// Largest coordinate, mm or degrees: 99 999.9999.
const COORDINATE_MAX: f64 = 999_999_999.0 / 10_000.0;

/// A text is no command.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandError {
    /// There is none of this name.
    #[error("`{0}` is no command")]
    Unknown(String),
    /// What stands after its name is wrong.
    #[error("{0}")]
    Wrong(String),
}

impl Command {
    /// It acts on the program that runs, or puts another one in its place.
    pub(crate) fn needs_program(&self) -> bool {
        matches!(
            self,
            Command::InternalStop
                | Command::Select(_)
                | Command::Goto(_)
                | Command::Dnc(Dnc::Begin(_))
                | Command::RestoreAt(_)
                | Command::Q(..)
                | Command::WorkingPlane(PlaneCommand { run: true, .. })
        )
    }

    /// What a code of W516 calls: the soft keys INTERNAL STOP, PASS OVER REFERENCE and RESTORE POSITION are commands of
    /// their own [000:7424-7436], all else is a key.
    pub(crate) fn of_key_code(code: u16) -> Command {
        match code {
            0x0000 => Command::InternalStop,
            0x0400 => Command::Mode(Mode::Reference),
            0x0500 => Command::RestorePosition,
            code => Command::Key(code),
        }
    }

    /// It is entered for moving by hand.
    pub(crate) fn is_by_hand(&self) -> bool {
        matches!(
            self,
            Command::MFunction(_)
                | Command::Speed(_)
                | Command::JogIncrement(_)
                | Command::Handwheel(..)
                | Command::AxisKey(_)
        )
    }

    /// Whether what is entered by hand can be: an M function that the control has, a speed that it can have [003:2180]. What
    /// has a value of neither kind always can.
    pub fn can_be_entered(&self, model: ControlModel) -> bool {
        match self {
            Command::MFunction(m) => Technology::of_m(model, *m).is_some(),
            Command::Speed(rpm) => (0.0..=SPEED_MAX).contains(rpm),
            _ => true,
        }
    }

    /// It must wait until a probing by hand is over.
    pub(crate) fn needs_axes(&self) -> bool {
        matches!(self, Command::Mode(_) | Command::Probe(_) | Command::Datum(..))
    }
}

impl FromStr for Command {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Command, CommandError> {
        let text = text.trim();
        if Assignment::is_meant(text) {
            return assignment(text).map(Command::Set);
        }
        let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        let nothing = |command: Command| {
            if rest.is_empty() {
                Ok(command)
            } else {
                Err(CommandError::Wrong(format!("`{name}` takes nothing after it")))
            }
        };
        match name {
            "mode" => Mode::ALL
                .into_iter()
                .find(|mode| mode.name() == rest)
                .map(Command::Mode)
                .ok_or_else(|| {
                    let names = Mode::ALL.map(Mode::name).join(", ");
                    CommandError::Wrong(format!("there is no mode `{rest}`; modes are {names}"))
                }),
            "ce" => nothing(Command::Ce),
            "stop" => nothing(Command::InternalStop),
            "manual-operation" => nothing(Command::ManualOperation),
            "restore-position" => nothing(Command::RestorePosition),
            "end-test" => nothing(Command::EndTest),
            "test-run" => parsed(TestCommand::parse(rest), Command::TestRun),
            "test" if !rest.is_empty() => Ok(Command::Test(rest.to_owned())),
            "select" if !rest.is_empty() => Ok(Command::Select(rest.to_owned())),
            "mdi" if !rest.is_empty() => Ok(Command::Mdi(rest.replace("\\n", "\n"))),
            "goto" => number(name, rest, 0, u32::MAX).map(Command::Goto),
            "restore-at" => number(name, rest, 0, u32::MAX).map(Command::RestoreAt),
            "code" => number(name, rest, 0, u32::MAX).map(Command::Code),
            "m" => number(name, rest, 0, 999).map(Command::MFunction),
            "key" => key_code(rest).map(Command::of_key_code),
            "s" => value(name, rest, 0.0, SPEED_MAX).map(Command::Speed),
            "jog" => value(name, rest, 0.0, 50.0).map(Command::JogIncrement),
            "oscilloscope" => oscilloscope(rest),
            "output" if rest == "ramp" => Ok(Command::Output(None)),
            "output" => {
                let feed = rest.strip_prefix("step ").map(str::trim);
                let wrong =
                    || CommandError::Wrong("`output` takes `ramp`, or `step` and a feed in mm/min".into());
                value(name, feed.ok_or_else(wrong)?, 0.0, FEED_MAX).map(|feed| Command::Output(Some(feed)))
            }
            "q" => q_parameter(name, rest),
            "axis-limit" => axis_limit(rest),
            "table" => table_element(rest),
            "datum" => {
                let (axis, rest) = axis(name, rest)?;
                value(name, rest, -COORDINATE_MAX, COORDINATE_MAX).map(|value| Command::Datum(axis, value))
            }
            "dnc" => parsed(Dnc::parse(rest), Command::Dnc),
            "probe" => parsed(ProbeCommand::parse(rest), Command::Probe),
            "tool-life" => {
                let (tool, minutes) = rest.split_once(' ').unwrap_or((rest, ""));
                let tool = number(name, tool, 0, u32::MAX)?;
                value(name, minutes.trim(), 0.0, CURRENT_MAX_MIN)
                    .map(|minutes| Command::ToolLife(tool, minutes))
            }
            "handwheel" => {
                let (axis, rest) = axis(name, rest)?;
                number(name, rest, 0, 10).map(|factor| Command::Handwheel(axis, factor))
            }
            "axis-key" => axis_key(name, rest),
            "3d-rot" => parsed(PlaneCommand::parse(rest), Command::WorkingPlane),
            "screen" => parsed(ScreenCommand::parse(rest), Command::Screen),
            "offset" => switch(name, rest, "adjust").map(Command::OffsetAdjustment),
            "pnt" => switch(name, rest, "on").map(Command::Pnt),
            "power" => switch(name, rest, "on").map(Command::Power),
            _ if DataLineEvent::WORDS.contains(&name) => data_line(name, rest),
            "select" | "test" | "mdi" => {
                Err(CommandError::Wrong(format!("`{name}` needs something after it")))
            }
            _ => Err(CommandError::Unknown(name.to_owned())),
        }
    }
}

/// A command with what stands after its name.
fn parsed<T>(read: Result<T, String>, command: fn(T) -> Command) -> Result<Command, CommandError> {
    read.map(command).map_err(CommandError::Wrong)
}

/// An axis key of the keyboard.
fn axis_key(name: &str, rest: &str) -> Result<Command, CommandError> {
    match axis(name, rest)? {
        (axis, "") => Ok(Command::AxisKey(axis)),
        _ => Err(CommandError::Wrong(format!("`{name}` takes an axis"))),
    }
}

/// `start`, `stop`: begins or ends a recording of the oscilloscope.
fn oscilloscope(rest: &str) -> Result<Command, CommandError> {
    match rest {
        "start" => Ok(Command::Oscilloscope(Switch::On)),
        "stop" => Ok(Command::Oscilloscope(Switch::Off)),
        _ => Err(CommandError::Wrong(
            "`oscilloscope` takes `start` or `stop`".into(),
        )),
    }
}

/// What a word switches on, or `off`.
fn switch(name: &str, rest: &str, on: &str) -> Result<Switch, CommandError> {
    match rest {
        "off" => Ok(Switch::Off),
        _ if rest == on => Ok(Switch::On),
        _ => Err(CommandError::Wrong(format!("`{name}` takes `{on}` or `off`"))),
    }
}

/// An operand that can be set on a machine, or a machine parameter.
fn assignment(text: &str) -> Result<Assignment, CommandError> {
    let assignment = Assignment::parse(text).map_err(CommandError::Wrong)?;
    match &assignment {
        Assignment::Operand(operand @ Operand::Bit(bit), value) if bit.area() == BitArea::I => {
            Err(CommandError::Wrong(format!(
                "{operand} is read from the machine before each scan: `fault input {operand} {value}` lets it stick"
            )))
        }
        _ => Ok(assignment),
    }
}

/// An event at a data line, as `rs422 received "FA81"` names it.
fn data_line(name: &str, rest: &str) -> Result<Command, CommandError> {
    let wrong = || CommandError::Wrong(format!("nothing like `{rest}` happens at `{name}`"));
    DataLineEvent::parse(name, rest)
        .map(Command::DataLine)
        .ok_or_else(wrong)
}

fn axis<'a>(name: &str, text: &'a str) -> Result<(Axis, &'a str), CommandError> {
    let mut characters = text.chars();
    let axis = characters
        .next()
        .filter(char::is_ascii)
        .and_then(|letter| Axis::from_letter(letter.to_ascii_uppercase() as u8));
    match axis {
        Some(axis) => Ok((axis, characters.as_str().trim())),
        None => Err(CommandError::Wrong(format!(
            "`{name}` takes an axis and a value, as `{name} X 5`"
        ))),
    }
}

/// Number of the Q parameter and its value, as in `12 -0.5`.
fn q_parameter(name: &str, rest: &str) -> Result<Command, CommandError> {
    let (q, rest) = rest.split_once(' ').unwrap_or((rest, ""));
    let q = number(name, q, 0, u32::from(u16::MAX))?;
    value(name, rest.trim(), -Q_MAX, Q_MAX).map(|value| Command::Q(q, value))
}

/// `X 1 -100 250`, `X 1 off`.
fn axis_limit(rest: &str) -> Result<Command, CommandError> {
    let name = "axis-limit";
    let (axis, rest) = axis(name, rest)?;
    let (range, rest) = rest.split_once(' ').unwrap_or((rest, ""));
    let range = number(name, range, 1, 3)?;
    let rest = rest.trim();
    if rest == "off" {
        return Ok(Command::AxisLimit(axis, range, None));
    }
    let (least, greatest) = rest.split_once(' ').unwrap_or((rest, ""));
    let limit = |text: &str| value(name, text.trim(), -AXIS_LIMIT_MAX, AXIS_LIMIT_MAX);
    Ok(Command::AxisLimit(
        axis,
        range,
        Some([limit(least)?, limit(greatest)?]),
    ))
}

/// The tables by their letters.
const TABLES: [(&str, TableKind); 3] = [
    ("T", TableKind::Tool),
    ("D", TableKind::Datum),
    ("P", TableKind::Pocket),
];

/// `T 12 L 80.5`.
fn table_element(rest: &str) -> Result<Command, CommandError> {
    let wrong = || {
        CommandError::Wrong("`table` takes T, D or P, line, column and value, as `table T 12 L 80.5`".into())
    };
    let [table, line, column, value] = rest.split_whitespace().collect::<Vec<_>>()[..] else {
        return Err(wrong());
    };
    let (_, kind) = TABLES
        .into_iter()
        .find(|(letter, _)| *letter == table)
        .ok_or_else(wrong)?;
    let named = |own: &Option<bahn_plc::Column>| own.is_some_and(|own| own.name == column);
    let element = kind.columns().iter().position(named).ok_or_else(wrong)?;
    let line = line.parse().map_err(|_| wrong())?;
    let value = self::value("table", value, -COORDINATE_MAX, COORDINATE_MAX)?;
    Ok(Command::Table(kind, line, element, value))
}

fn number<T: TryFrom<u32>>(name: &str, text: &str, min: u32, max: u32) -> Result<T, CommandError> {
    text.parse::<u32>()
        .ok()
        .filter(|number| (min..=max).contains(number))
        .and_then(|number| T::try_from(number).ok())
        .ok_or_else(|| {
            CommandError::Wrong(format!(
                "`{name}` takes a number from {min} to {max}, not `{text}`"
            ))
        })
}

/// INTERNAL STOP, or what a table of codes has: the first is that of a key, the last one of the alphabetic keyboard
/// [000:7338-7440].
fn key_code(text: &str) -> Result<u16, CommandError> {
    let code = text.parse().ok().filter(|code| matches!(code, 0 | 58..=0xFF50));
    code.ok_or_else(|| CommandError::Wrong(format!("`key` takes 0 or a code from 58 to 65360, not `{text}`")))
}

fn value(name: &str, text: &str, min: f64, max: f64) -> Result<f64, CommandError> {
    text.parse::<f64>()
        .ok()
        .filter(|value| (min..=max).contains(value))
        .ok_or_else(|| {
            CommandError::Wrong(format!(
                "`{name}` takes a value from {min} to {max}, not `{text}`"
            ))
        })
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Command::Mode(mode) => write!(f, "mode {}", mode.name()),
            Command::Ce => write!(f, "ce"),
            Command::InternalStop => write!(f, "stop"),
            Command::Select(name) => write!(f, "select {name}"),
            Command::Goto(block) => write!(f, "goto {block}"),
            Command::Mdi(blocks) => write!(f, "mdi {}", blocks.trim().replace('\n', "\\n")),
            Command::MFunction(m) => write!(f, "m {m}"),
            Command::Speed(rpm) => write!(f, "s {rpm}"),
            Command::Datum(axis, value) => write!(f, "datum {axis} {value}"),
            Command::Probe(command) => write!(f, "probe {command}"),
            Command::ToolLife(tool, minutes) => write!(f, "tool-life {tool} {minutes}"),
            Command::Q(q, value) => write!(f, "q {q} {value}"),
            Command::AxisLimit(axis, range, None) => write!(f, "axis-limit {axis} {range} off"),
            Command::AxisLimit(axis, range, Some([least, greatest])) => {
                write!(f, "axis-limit {axis} {range} {least} {greatest}")
            }
            Command::Table(kind, line, element, value) => {
                let (letter, _) = TABLES
                    .into_iter()
                    .find(|(_, own)| own == kind)
                    .unwrap_or(TABLES[0]);
                let column = kind.columns().get(*element).and_then(Option::as_ref);
                let column = column.map_or("?", |column| column.name);
                write!(f, "table {letter} {line} {column} {value}")
            }
            Command::JogIncrement(mm) => write!(f, "jog {mm}"),
            Command::Oscilloscope(Switch::On) => write!(f, "oscilloscope start"),
            Command::Oscilloscope(Switch::Off) => write!(f, "oscilloscope stop"),
            Command::Output(Some(feed)) => write!(f, "output step {feed}"),
            Command::Output(None) => write!(f, "output ramp"),
            Command::WorkingPlane(plane) => write!(f, "3d-rot {plane}"),
            Command::Screen(screen) => write!(f, "screen {screen}"),
            Command::Handwheel(axis, factor) => write!(f, "handwheel {axis} {factor}"),
            Command::Pnt(switch) => write!(f, "pnt {switch}"),
            Command::AxisKey(axis) => write!(f, "axis-key {axis}"),
            Command::Dnc(dnc) => write!(f, "dnc {dnc}"),
            Command::ManualOperation => write!(f, "manual-operation"),
            Command::RestorePosition => write!(f, "restore-position"),
            Command::RestoreAt(block) => write!(f, "restore-at {block}"),
            Command::Code(code) => write!(f, "code {code}"),
            Command::Key(code) => write!(f, "key {code}"),
            Command::Test(name) => write!(f, "test {name}"),
            Command::TestRun(command) => write!(f, "test-run {command}"),
            Command::EndTest => write!(f, "end-test"),
            Command::OffsetAdjustment(Switch::On) => write!(f, "offset adjust"),
            Command::OffsetAdjustment(Switch::Off) => write!(f, "offset off"),
            Command::Set(assignment) => assignment.fmt(f),
            Command::DataLine(event) => event.fmt(f),
            Command::Power(switch) => write!(f, "power {switch}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_read_as_they_are_written() {
        for text in [
            "mode reference",
            "ce",
            "tool-life 12 0.5",
            "stop",
            "select 4711.H",
            "goto 12",
            "dnc begin 15.H",
            "dnc text L\\x20X+5;\\x20\\xc4\\\\\\r\\n",
            "dnc end",
            "dnc broken",
            "mdi L X+10 R0 F500\\nL Y+5",
            "m 3",
            "s 1500.5",
            "datum Z -0.25",
            "probe radius 25",
            "q 12 -0.5",
            "axis-limit X 1 -100 250.5",
            "axis-limit C 3 off",
            "table T 12 L 80.5",
            "table P 3 T 7",
            "jog 0.5",
            "output step 250",
            "output ramp",
            "oscilloscope start",
            "oscilloscope stop",
            "handwheel C 3",
            "3d-rot on",
            "pnt on",
            "pnt off",
            "manual-operation",
            "restore-position",
            "restore-at 7",
            "code 807667",
            "key 107",
            "test PART 1.H",
            "end-test",
            "offset off",
            "M100=1",
            "W6=-16",
            "S0=\"A=B\"",
            "MP1010.0=5000",
            "rs232 ready on",
            "rs232 taken off",
            "rs232 baud 9600",
            "rs232 sent",
            "rs422 not-sent",
            "rs422 received \"FA81 \\\"Q\\\" \\x1b\"",
            "rs422 faulty",
            "rs422 etx",
            "lsv2 connected",
            "lsv2 disconnected",
            "lsv2 taken",
            "lsv2 message -42",
            "lsv2 message \"PALLET 7\"",
            "power off",
        ] {
            let command = text.parse::<Command>();
            assert_eq!(command.map(|command| command.to_string()), Ok(text.to_owned()));
        }
    }

    #[test]
    fn faults_say_what_is_expected() {
        for (text, expected) in [
            ("", "no command"),
            ("mode auto", "modes are manual"),
            ("ce now", "nothing after"),
            ("s -1", "from 0 to 99999.999"),
            ("s nan", "not `nan`"),
            ("datum Q 5", "an axis and a value"),
            ("q 1 far", "not `far`"),
            ("axis-limit X 4 1 2", "from 1 to 3"),
            ("axis-limit X 1 1", "from -30000 to 30000"),
            ("table T 1 SHARP 2", "`table T 12 L 80.5`"),
            ("dnc text \\q", "escapes"),
            ("dnc", "`begin` and a name"),
            ("handwheel X 11", "from 0 to 10"),
            ("select", "needs something"),
            ("I4=1", "`fault input I4 1`"),
            ("M5=2", "takes 0 or 1"),
            ("output", "`step` and a feed"),
            ("oscilloscope on", "`start` or `stop`"),
            ("rs232 ready", "happens at `rs232`"),
            ("lsv2 message", "happens at `lsv2`"),
            ("3d-rot B", "`on` or `off`"),
            ("pnt", "`on` or `off`"),
            ("power up", "`on` or `off`"),
        ] {
            let error = text.parse::<Command>().map_err(|error| error.to_string());
            assert!(
                error.as_ref().is_err_and(|error| error.contains(expected)),
                "{text}: {error:?}"
            );
        }
    }
}
