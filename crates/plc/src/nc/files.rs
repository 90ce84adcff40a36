//! Files that modules read and select.

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

/// How large a compensation table (.COM) is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompensationSize {
    /// Axes that depend on the one that it is assigned to.
    pub dependencies: usize,
    /// Points of each dependency.
    pub points: usize,
}

/// What there is too much of in the compensation tables of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompensationExcess {
    /// A dependency has more than 256 points.
    PointsOfDependency,
    /// There are more than ten dependencies.
    Dependencies,
    /// There are more than 640 points.
    Points,
}

impl CompensationExcess {
    /// What tables that shall be active together have too much of: at most ten dependencies and 640 points, 256 for each
    /// dependency [000:3770].
    ///
    /// ```
    /// use bahn_plc::{CompensationExcess, CompensationSize};
    /// let table = CompensationSize { dependencies: 3, points: 200 };
    /// assert_eq!(CompensationExcess::of(&[table]), None);
    /// assert_eq!(CompensationExcess::of(&[table, table]), Some(CompensationExcess::Points));
    /// ```
    pub fn of(tables: &[CompensationSize]) -> Option<CompensationExcess> {
        const POINTS_OF_DEPENDENCY_MAX: usize = 256;
        const DEPENDENCIES_MAX: usize = 10;
        const POINTS_MAX: usize = 640;
        let dependencies: usize = tables.iter().map(|table| table.dependencies).sum();
        let points: usize = tables.iter().map(|table| table.dependencies * table.points).sum();
        if tables.iter().any(|table| table.points > POINTS_OF_DEPENDENCY_MAX) {
            Some(CompensationExcess::PointsOfDependency)
        } else if dependencies > DEPENDENCIES_MAX {
            Some(CompensationExcess::Dependencies)
        } else if points > POINTS_MAX {
            Some(CompensationExcess::Points)
        } else {
            None
        }
    }
}

/// Why a line of a file cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFault {
    /// No file is selected.
    NoFile,
    /// The file has no such line.
    NoLine,
}
