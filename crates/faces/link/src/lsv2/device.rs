//! What the server asks of the machine.

use bahn_store::Store;

use super::{ErrorNumber as Refused, Features};

/// How the machine is operated; numbers are those of telegram `R_RI` 23 (public).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Execution {
    /// The operating mode MANUAL OPERATION.
    #[default]
    Manual = 0,
    /// By single blocks that are entered.
    Mdi = 1,
    /// The axes pass their reference marks.
    Reference = 2,
    /// Program run, single block.
    SingleBlock = 3,
    /// Program run, full sequence.
    Automatic = 4,
}

/// What the program does; numbers are those of telegram `R_RI` 26 (public).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProgramState {
    /// The program run is started.
    Started = 0,
    /// The program run is stopped.
    Stopped = 1,
    /// It has come to its end.
    Finished = 2,
    /// It was broken off.
    Cancelled = 3,
    /// The program run is interrupted.
    Interrupted = 4,
    /// A fault has interrupted it.
    Error = 5,
    /// The fault was cleared.
    ErrorCleared = 6,
    /// There is none, or it was not started yet.
    #[default]
    Idle = 7,
}

/// The run as `R_RI` reports it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// How the machine is operated.
    pub execution: Execution,
    /// What the program does.
    pub state: ProgramState,
    /// Block that is executed.
    pub block: u32,
    /// Name of the program that was chosen; empty without one.
    pub main: String,
    /// Name of the program that the block is of.
    pub current: String,
    /// Letter and actual position of each axis, mm or degrees.
    pub axes: Vec<(char, f64)>,
    /// Overrides of feed, spindle and rapid traverse, %.
    pub overrides: [f64; 3],
    /// The tool in the spindle.
    pub tool: Tool,
    /// Messages that are shown, the oldest first.
    pub messages: Vec<Message>,
}

/// The tool in the spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tool {
    /// Its number in the tool table.
    pub number: u32,
    /// Its axis: 0 X, 1 Y, 2 Z.
    pub axis: u16,
    /// Length of the tool, mm.
    pub length: f64,
    /// Radius of the tool, mm.
    pub radius: f64,
}

/// A message of the control.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Message {
    /// Class: 1 an error that CE does not clear, 2 one that it clears (inferred).
    pub class: u16,
    /// The number of the message.
    pub number: u32,
    /// The text of the message as the screen shows it.
    pub text: String,
}

/// A kind of memory of the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Area {
    /// Markers M, single bits.
    Markers,
    /// Inputs I, single bits.
    Inputs,
    /// Outputs O, single bits.
    Outputs,
    /// Counters C, single bits.
    Counters,
    /// Timers T, single bits.
    Timers,
    /// Bytes, of which words and doublewords are made.
    Bytes,
    /// Strings of the PLC.
    Strings,
}

/// An event of the log book.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// When, in seconds since 1970.
    pub time: u32,
    /// Key or message.
    pub kind: EventKind,
    /// Name of the key, or text of the message.
    pub text: String,
}

/// Kind of an event of the log book.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// A key was pressed.
    Key = 0,
    /// A message came up.
    Message = 1,
}

/// Events that the log book keeps [000:17526].
pub const EVENTS: usize = 100;

/// A message between host and PLC (modules 9110 and 9111).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlcMessage {
    /// The value of a doubleword.
    Double(i32),
    /// The bytes of a string.
    Text(Vec<u8>),
}

/// A machine as the server sees it. Everything may be asked from any thread; what is given holds for this moment.
pub trait Device: Send + Sync {
    /// What `R_VR` says of the control and of the PLC program.
    fn identity(&self) -> Identity;

    /// The file service of the device.
    fn store(&self) -> &Store;

    /// The run.
    ///
    /// # Errors
    /// When the machine does not answer.
    fn run(&self) -> Result<Run, Refused>;

    /// How many elements an area of the PLC's memory has: bits, bytes, strings.
    fn elements(&self, area: Area) -> u32;

    /// Elements of the PLC's memory: a byte for each bit, bytes in the order of their addresses, 128 bytes for each string.
    ///
    /// # Errors
    /// When the area has no such elements.
    fn memory(&self, area: Area, first: u32, count: u32) -> Result<Vec<u8>, Refused>;

    /// A value of the tool table as it is written there, by the number of the tool and the name of the column.
    fn tool_value(&self, tool: u32, column: &str) -> Option<String>;

    /// The value of a machine parameter as it is written in its list.
    fn parameter(&self, number: u16, index: u8) -> Option<String>;

    /// Changes a machine parameter, for good or until power-off.
    ///
    /// # Errors
    /// When the parameter does not exist, does not take the value, or not now.
    fn set_parameter(&self, number: u16, index: u8, value: &str, for_good: bool) -> Result<(), Refused>;

    /// Presses a key by its name, or enters a character.
    ///
    /// # Errors
    /// When there is no such key.
    fn press(&self, key: &str) -> Result<(), Refused>;

    /// The screen as a BMP file.
    ///
    /// # Errors
    /// When the device has no screen.
    fn screen(&self) -> Result<Vec<u8>, Refused>;

    /// The last [`EVENTS`] events, the oldest first.
    fn log_book(&self) -> Vec<Event>;

    /// Whether a host is logged in that takes messages of the PLC.
    fn host_is_there(&self, is_there: bool);

    /// A message to the PLC.
    ///
    /// # Errors
    /// When its buffer is full.
    fn to_plc(&self, message: PlcMessage) -> Result<(), Refused>;

    /// The next message of the PLC.
    fn plc_message(&self) -> Option<PlcMessage>;

    /// Files were changed: whoever keeps what it has read reads again.
    fn files_changed(&self);
}

/// What the control says that it is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// The control: `BAHN TNC 415`.
    pub control: String,
    /// What a control of this kind can do.
    pub features: Features,
    /// NC software: six digits and two.
    pub nc_software: String,
    /// Version of the PLC software.
    pub plc_software: String,
    /// Identification number of the control.
    pub id: String,
}
