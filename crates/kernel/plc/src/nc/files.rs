//! Files that modules read and select.
//!
//! Decision: Ten dependencies and 640 points of compensation are those of the active line; at power-on it must keep
//! to them

/// Why a value of the edited machine parameter list cannot be read [000:14874-14879].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterFault {
    /// The model has no such number.
    NoSuchNumber,
    /// Its line has no separator.
    NoSeparator,
    /// Its value is out of range.
    OutOfRange,
    /// The list has no line for it.
    NotInFile,
    /// There is no list.
    NoFile,
}

/// A machine parameter could not be stored: the checksum of the memory is wrong now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotSaved;

/// Why a machine parameter list cannot be selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterFileFault {
    /// There is no such file in the RAM.
    NotFound,
    /// It has an error.
    Faulty,
}

/// A text file of the PLC [000:14079-14084].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextFile {
    /// PLC error messages, a line each.
    Messages,
    /// Dialogues of the PLC, a line each.
    Dialogues,
}

/// A line of a pallet file [000:15332-15340].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PalletLine {
    /// The NC program, perhaps without extension.
    pub program: String,
    /// The datum table; without one the selected table stays.
    pub datum_table: Option<String>,
}

/// Why a line of a file cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFault {
    /// No file is selected.
    NoFile,
    /// The file has no such line.
    NoLine,
}
