//! Tables that modules 9092 to 9094 search, read and write [000:15375-15545].

use std::collections::BTreeMap;

/// A table for machining.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TableKind {
    /// Tool table (.T): lines are tool numbers.
    Tool,
    /// Datum table (.D): lines are vector numbers.
    Datum,
    /// Pocket table (.TCH): lines are pocket numbers.
    Pocket,
}

/// An element of the lines of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Its name in the table.
    pub name: &'static str,
    /// Places after the point.
    pub decimals: u8,
    /// Smallest value that it takes.
    pub min: f64,
    /// Greatest value that it takes.
    pub max: f64,
}

impl TableKind {
    /// The table of a number of the manual: 0, 1, 2.
    pub fn numbered(number: i32) -> Option<TableKind> {
        match number {
            0 => Some(TableKind::Tool),
            1 => Some(TableKind::Datum),
            2 => Some(TableKind::Pocket),
            _ => None,
        }
    }

    /// The elements in the order of their numbers; `None` for spare ones.
    pub fn columns(self) -> &'static [Option<Column>] {
        match self {
            TableKind::Tool => TOOL,
            TableKind::Datum => DATUM,
            TableKind::Pocket => POCKET,
        }
    }

    /// The element of a number.
    pub fn column(self, element: i32) -> Option<&'static Column> {
        self.columns().get(usize::try_from(element).ok()?)?.as_ref()
    }
}

/// A table as modules see it. Values are in mm, degrees, minutes or plain numbers.
pub trait TableFile {
    /// The first existing line from a number on.
    fn next_line(&self, from: i32) -> Option<i32>;

    /// An element of a line; `None` when line or element do not exist.
    fn value(&self, line: i32, element: usize) -> Option<f64>;

    /// Writes an element of an existing line; the value is within the range of its column.
    fn set_value(&mut self, line: i32, element: usize, value: f64);
}

/// A table in memory. Elements that were never written are 0, but tool numbers -1.
#[derive(Clone, Debug, PartialEq)]
pub struct MemoryTable {
    kind: TableKind,
    lines: BTreeMap<i32, Vec<f64>>,
}

impl MemoryTable {
    /// A table with lines from 0 on.
    pub fn new(kind: TableKind, lines: u16) -> MemoryTable {
        MemoryTable::with_lines(kind, 0..i32::from(lines))
    }

    /// A table with lines of these numbers.
    pub fn with_lines(kind: TableKind, lines: impl Iterator<Item = i32>) -> MemoryTable {
        let columns = kind.columns().iter();
        // Only tool numbers may be -1: there it means none [000:15412][000:15427].
        let empty: Vec<f64> = columns
            .map(|column| match column {
                Some(Column { min: -1.0, .. }) => -1.0,
                _ => 0.0,
            })
            .collect();
        MemoryTable {
            kind,
            lines: lines.map(|line| (line, empty.clone())).collect(),
        }
    }

    /// Line, element and value of everything in it.
    pub fn elements(&self) -> impl Iterator<Item = (i32, usize, f64)> {
        let values = |(line, values): (&i32, &Vec<f64>)| {
            let line = *line;
            let values: Vec<f64> = values.clone();
            values
                .into_iter()
                .enumerate()
                .map(move |(element, value)| (line, element, value))
        };
        self.lines.iter().flat_map(values)
    }

    /// Whether it holds tools, datums or pockets.
    pub fn kind(&self) -> TableKind {
        self.kind
    }
}

impl TableFile for MemoryTable {
    fn next_line(&self, from: i32) -> Option<i32> {
        self.lines.range(from..).next().map(|(line, _)| *line)
    }

    fn value(&self, line: i32, element: usize) -> Option<f64> {
        self.lines.get(&line)?.get(element).copied()
    }

    fn set_value(&mut self, line: i32, element: usize, value: f64) {
        let slot = self.lines.get_mut(&line).and_then(|line| line.get_mut(element));
        if let Some(slot) = slot {
            *slot = value;
        }
    }
}

/// Greatest coordinate in mm.
const COORDINATE_MAX: f64 = 99_999.999_9;
/// Greatest oversize in mm (inferred).
const OVERSIZE_MAX: f64 = 999.9999;
/// Greatest tolerance in mm (inferred).
const TOLERANCE_MAX: f64 = 0.9999;
/// Greatest tool number: MP7260 allows so many tools.
const TOOL_MAX: f64 = 254.0;
/// Greatest tool life in minutes (inferred).
const LIFE_MAX: f64 = 9999.0;

const fn length(name: &'static str, max: f64) -> Option<Column> {
    number(name, 4, -max, max)
}

const fn whole(name: &'static str, min: f64, max: f64) -> Option<Column> {
    number(name, 0, min, max)
}

const fn number(name: &'static str, decimals: u8, min: f64, max: f64) -> Option<Column> {
    Some(Column {
        name,
        decimals,
        min,
        max,
    })
}

/// [000:15431-15454]. Decimal places and ranges as on the control's tool table (inferred).
const TOOL: &[Option<Column>] = &[
    length("L", COORDINATE_MAX),
    length("R", COORDINATE_MAX),
    None,
    whole("RT", -1.0, TOOL_MAX),
    None,
    whole("TIME1", 0.0, LIFE_MAX),
    whole("TIME2", 0.0, LIFE_MAX),
    whole("CUR.TIME", 0.0, LIFE_MAX),
    length("R2", COORDINATE_MAX),
    length("DL", OVERSIZE_MAX),
    length("DR", OVERSIZE_MAX),
    length("DR2", OVERSIZE_MAX),
    whole("TL", 0.0, 1.0),
    whole("CUT.", 0.0, 20.0),
    number("LTOL", 4, 0.0, TOLERANCE_MAX),
    number("RTOL", 4, 0.0, TOLERANCE_MAX),
    whole("DIRECT.", 0.0, 1.0),
    whole("PLC", 0.0, 255.0),
    length("TT:L-OFFS", COORDINATE_MAX),
    length("TT:R-OFFS", COORDINATE_MAX),
    number("LBREAK", 4, 0.0, TOLERANCE_MAX),
    number("RBREAK", 4, 0.0, TOLERANCE_MAX),
];

/// Elements of a datum table by their numbers [000:15414-15420].
const DATUM: &[Option<Column>] = &[
    length("X", COORDINATE_MAX),
    length("Y", COORDINATE_MAX),
    length("Z", COORDINATE_MAX),
    length("4", COORDINATE_MAX),
    length("5", COORDINATE_MAX),
];

/// Elements of a pocket table by their numbers [000:15422-15429].
const POCKET: &[Option<Column>] = &[
    whole("T", -1.0, TOOL_MAX),
    whole("ST", 0.0, 1.0),
    whole("F", 0.0, 1.0),
    whole("L", 0.0, 1.0),
    whole("PLC", 0.0, 255.0),
];
