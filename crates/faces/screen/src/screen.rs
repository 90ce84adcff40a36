//! The screen as data: what every front end shows, a test reads and a screen reader speaks.
//!
//! Decision: A TNC 360 and older have a screen without colours and with one column: one operating mode at a time,
//! graphics in the place of the program (also `screen/src/colours.rs`)

use std::collections::BTreeMap;

use serde::Serialize;

use crate::texts::{Language, language_code};

/// Everything that is to be seen at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Screen {
    /// Counts the screens that were different from the one before.
    pub serial: u64,
    /// Time of the machine since power-on, s.
    pub time_s: f64,
    /// Heading of the side that has the keys, as it stands on the screen: `MANUAL OPERATION`.
    pub mode: String,
    /// The headings of both sides, that of the machine first [000:2784-2833].
    pub headings: Vec<Heading>,
    /// What the control asks, and what was typed.
    pub dialogue: Dialogue,
    /// Messages, the oldest first.
    pub messages: Vec<MessageLine>,
    /// The large window of the side that has the keys: program, table, menu.
    pub program: Window,
    /// The window of the other side, when the screen is split.
    pub beside: Option<Window>,
    /// Positions, tool, spindle, feed and what is in force.
    pub status: Status,
    /// Keys whose meaning the screen shows.
    pub soft_keys: SoftKeys,
    /// The window of the PLC program, when it has written something [000:6603-6617].
    pub plc_window: Option<Vec<PlcLine>>,
    /// The graphics, while the operator looks at them; the picture itself is made when somebody wants it.
    pub graphics: Option<GraphicsLine>,
    /// Lamps of the machine operating panel by name.
    pub lamps: BTreeMap<String, bool>,
    /// The machine operating panel and the simulation.
    pub machine: MachineState,
    /// What can be gone back to, s since power-on.
    pub timeline: TimeLine,
    /// Why something stands or waits, in words; empty while everything goes on, or nothing is to be done.
    pub why: Vec<String>,
    /// The lesson, while there is one.
    pub lesson: Option<LessonLine>,
    /// How the screen of the control is made.
    pub look: Look,
}

/// How the screen of a control model is made.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Look {
    /// What stands beside what.
    pub layout: Layout,
    /// The language of all that is written.
    #[serde(serialize_with = "code")]
    pub language: Language,
    /// The letters of the keyboard are in use: always where they have keys of their own, on a TNC 151/155 for DIN/ISO.
    pub letters: bool,
    /// MP7350 to MP7363 as `7352.1` and `#d28220`; none on a screen without colours.
    pub colours: BTreeMap<String, String>,
}

fn code<S: serde::Serializer>(language: &Language, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(language_code(*language))
}

/// What stands beside what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// Windows side by side, on the 14 inch screen of the TNC 407 and later [000:2784-2833].
    #[default]
    Windows,
    /// One column of text, on the 12 inch screens before: one operating mode at a time, and graphics in the place of the
    /// program (inferred).
    OneColumn,
    /// The same in one colour and without soft keys: a TNC 151/155 [001:186].
    Monochrome,
}

/// An operating mode in the header.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Heading {
    /// Its key: `MANUAL`, `HANDWHEEL`, `MDI`, `SINGLE`, `FULL`, `PROGRAM`, `TEST`.
    pub key: String,
    /// Its words in the language of the screen: `MANUAL OPERATION`.
    pub title: String,
    /// It has the keys of the keyboard.
    pub active: bool,
}

/// What the control asks for.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Dialogue {
    /// The question; empty when nothing is asked.
    pub prompt: String,
    /// What was typed so far.
    pub entry: String,
    /// Something is open and takes digits.
    pub open: bool,
}

/// A message under the header.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MessageLine {
    /// Its words, with block or axis.
    pub text: String,
    /// It flashes: CE does not clear it.
    pub flashing: bool,
    /// Where it comes from, when it names a block: program and block.
    pub place: Option<String>,
}

/// A window of lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Window {
    /// What it is about: the name of a program, of a table, of a menu.
    pub title: String,
    /// What kind of thing it shows.
    pub kind: WindowKind,
    /// The lines that are in sight.
    pub lines: Vec<Line>,
    /// Place of the first of them among all, from 0.
    pub first: usize,
    /// How many there are.
    pub total: usize,
}

/// What a window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WindowKind {
    /// It is not shown.
    #[default]
    Empty,
    /// Blocks of a program; the current one stands between two lines [003:574-588].
    Program,
    /// A list to choose from.
    List,
    /// A table to edit.
    Table,
    /// The position display in large letters.
    Positions,
    /// Lines to read, such as help.
    Text,
}

/// A line of a window.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Line {
    /// Its text as it stands on the screen.
    pub text: String,
    /// It is the current one.
    pub current: bool,
    /// Parts of it that stand out: from character, to character (exclusive), why.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<(usize, usize, Mark)>,
}

/// Why a part of a line stands out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mark {
    /// The highlighted word or cell.
    Cursor,
    /// What is being typed.
    Entry,
    /// Part of a marked section.
    Section,
    /// It cannot be read, or is refused.
    Fault,
    /// It is of less weight than the rest of the line.
    Quiet,
}

/// The status display [003:949-971].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Status {
    /// `ACTL`, `NOML`, `LAG`, `DIST` or `REF` [003:7081-7089].
    pub position_type: String,
    /// Positions are in inches.
    pub inch: bool,
    /// The axes that MP40 shows, and `S` with the angle of a spindle that stands.
    pub axes: Vec<AxisLine>,
    /// Tool in the spindle.
    pub tool: u32,
    /// The T before it is shown inverse (M2610) [000:10831].
    pub t_inverse: bool,
    /// The tool axis, when one was called.
    pub tool_axis: Option<String>,
    /// Programmed spindle speed, rpm.
    pub s: f64,
    /// Gear range, 1 to 8.
    pub gear: u8,
    /// Actual spindle speed, rpm, negative as M04.
    pub spindle_rpm: f64,
    /// Feed that is shown, mm/min or 0.1 inch/min as F stands on the screen.
    pub f: String,
    /// Actual speed along the path, mm/min.
    pub feed_mm_min: f64,
    /// F is highlighted: an axis has no feed enable [000:5352].
    pub f_inverse: bool,
    /// Programmed feed, mm/min, of which the bar graph shows the part; 0 in rapid traverse.
    pub programmed_feed_mm_min: f64,
    /// M functions as shown: `M5/9`.
    pub m: String,
    /// The M function of the spindle is shown inverse (M2608), that of the coolant (M2609).
    pub m_inverse: [bool; 2],
    /// Control in operation: `*` steady, blinking or not there [003:1594-1600].
    pub star: Star,
    /// `N`, `S`, `ROT`, `SCL` and what else is in force [003:1297].
    pub flags: Vec<String>,
    /// Overrides in force, %: feed and spindle.
    pub overrides: [f64; 2],
    /// What the machine waits for, in words; empty when it waits for nothing.
    pub waiting: String,
    /// Processing time of the PLC, %: latest and longest scan.
    pub plc_percent: [f64; 2],
}

/// `*` of the status display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Star {
    /// Nothing is on its way.
    #[default]
    Off,
    /// A program runs, or an M function or positioning is on its way.
    Steady,
    /// What was on its way is interrupted.
    Blinking,
}

/// A line of the position display.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AxisLine {
    /// Letter of the axis.
    pub letter: char,
    /// The letter between the marks of an open loop: `*X ` [000:5366], on a TNC 151/155 ` X.` [001:505-507], else ` X `.
    pub label: String,
    /// The position as it stands on the screen.
    pub value: String,
    /// The axis is locked, its loop is open.
    pub locked: bool,
    /// Its reference mark was passed.
    pub referenced: bool,
    /// Degrees instead of mm.
    pub degrees: bool,
    /// The electronic handwheel moves it [003:1051-1062].
    pub handwheel: bool,
}

/// The soft-key row below the screen.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SoftKeys {
    /// Texts of SK1 to SK8; empty ones do nothing.
    pub keys: Vec<String>,
    /// Which row is shown, from 0.
    pub row: usize,
    /// How many rows there are.
    pub rows: usize,
}

/// The graphics [003:854-945], or the curves of the oscilloscope [000:18638-18794].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GraphicsLine {
    /// How the part is shown.
    pub view: GraphicsView,
    /// A test is on its way, or a recording.
    pub running: bool,
    /// How far it has come, 0 to 1; 0 in a program run.
    pub progress: f64,
    /// Machining time of what was tested so far, s; none in a program run.
    pub machining_time_s: Option<f64>,
    /// How many times greater a detail is shown: 1, 2 or 4.
    pub magn: u8,
    /// From where the 3D view is seen, about the tool axis.
    pub azimuth_deg: f64,
    /// Where the sections lie, as part of the blank along its first and second axis.
    pub sections: [f64; 2],
    /// Counts the pictures: another number is another picture.
    pub serial: u64,
}

/// How the part is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GraphicsView {
    /// From above; the deeper, the darker.
    Plan,
    /// Projection in three planes.
    ThreePlanes,
    /// The part as a solid, turned at will.
    Solid,
    /// No part: the curves of the oscilloscope.
    Oscilloscope,
    /// No part: the lines of the program that is being written.
    Lines,
    /// No part: the drawing of the cycle whose words are asked for.
    Figure,
}

/// A line of the PLC window.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlcLine {
    /// Its text, 38 characters.
    pub text: String,
    /// The colour of each character, 0 to 15.
    pub colours: Vec<u8>,
    /// A bar chart in its left half: maximum, current, colour of bar and of scale.
    pub bar: Option<[u32; 4]>,
}

/// The machine operating panel, and how time passes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MachineState {
    /// The supply of the control is on.
    pub power: bool,
    /// The EMERGENCY STOP button is in.
    pub emergency_stop: bool,
    /// Potentiometers, %: feed and spindle.
    pub knobs: [f64; 2],
    /// Keys that are held.
    pub held: Vec<String>,
    /// Axis and factor of the handwheel.
    pub handwheel: (char, u8),
    /// How fast time passes; 1 is real time.
    pub speed: f64,
    /// Simulation time stands still.
    pub paused: bool,
}

/// The time line as the screen shows it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TimeLine {
    /// The first moment, s since power-on.
    pub from_s: f64,
    /// The last one of this way.
    pub to_s: f64,
    /// The moment that is shown; before the last one while the operator looks back.
    pub now_s: f64,
    /// What happened when, the oldest first.
    pub marks: Vec<TimeMark>,
    /// Other ways that can be gone back to.
    pub branches: Vec<BranchLine>,
}

/// Something that happened, for the time line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeMark {
    /// When, s since power-on.
    pub t: f64,
    /// What kind of thing.
    pub kind: MarkKind,
    /// Its words: message, program, action.
    pub text: String,
}

/// What kind of thing happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkKind {
    /// A message came up.
    Message,
    /// A program was started.
    Start,
    /// A program has come to its end.
    End,
    /// A program was interrupted or stopped.
    Stop,
    /// Something was done to the machine: a fault, a repair, a door, EMERGENCY STOP, power.
    Action,
}

/// A way that was left.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BranchLine {
    /// By this number it is gone back to.
    pub number: u32,
    /// Where it was left, s.
    pub from_s: f64,
    /// How far it goes, s.
    pub to_s: f64,
}

/// A lesson as the screen shows it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LessonLine {
    /// Name of its file without type; empty without a lesson.
    pub name: String,
    /// Its heading in the language of the screen.
    pub title: String,
    /// What is to be done.
    pub task: String,
    /// What helps, one after the other.
    pub hints: Vec<String>,
    /// What is looked at, in this order.
    pub checks: Vec<CheckLine>,
    /// Whether it goes on, was passed or failed.
    pub state: LessonState,
    /// Why it failed; empty otherwise.
    pub reason: String,
}

/// What is looked at.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckLine {
    /// What is to be so, in words.
    pub text: String,
    /// It was so at some time.
    pub done: bool,
}

/// Where a lesson stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LessonState {
    /// Something is left to be done.
    #[default]
    Running,
    /// All checks were met.
    Passed,
    /// It cannot be passed any more; `reason` says why.
    Failed,
}
