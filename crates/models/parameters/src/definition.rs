//! What the manuals' lists say of each machine parameter.

mod id;

use std::sync::OnceLock;

use crate::{ControlModel, ParameterError, meaning};

pub use id::ParameterId;
pub(crate) use id::parse_id;

/// The list of the TNC 407/415/425 [000:10068-10531].
const TNC_4XX: &str = include_str!("../data/machine-parameters.tsv");
/// What the TNC 360 prints differently: its user parameters [003:7160-7455]. The numbers and ranges of
/// its other parameters, for the machine builder only, are those of the TNC 407 (inferred).
const TNC_360: &str = include_str!("../data/machine-parameters-tnc360.tsv");
/// The list of the TNC 151/155 [001:3144-3369].
const TNC_15X: &str = include_str!("../data/machine-parameters-tnc151-155.tsv");

/// How a value is best written [000:10019-10046].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A decimal number, with as many decimals as the row allows.
    Decimal,
    /// Binary number of so many digits, `%00110`; bit 0 is the rightmost.
    Binary(usize),
    /// Hexadecimal number of so many digits, `$030200C`.
    Hexadecimal(usize),
}

/// When a changed value takes effect [000:10088].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// It acts at once.
    None,
    /// The control must be restarted.
    Reset,
    /// The reference marks must be traversed again.
    ReferenceMarks,
}

/// By what a value may be changed while the control runs [000:10088].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// In the list only.
    List,
    /// By the PLC while no program runs.
    PlcEdit,
    /// By the PLC, also while a program runs.
    PlcRun,
}

/// One row of the list of machine parameters.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Definition {
    /// Number, and index of axis or range where there is one.
    pub id: ParameterId,
    /// What it sets, in English, as lists show it.
    pub name: &'static str,
    /// Least value. Minus infinity where no range is printed.
    pub min: f64,
    /// Greatest value. Infinity where no range is printed.
    pub max: f64,
    /// Decimal places that are stored.
    pub decimals: u8,
    /// Unit, empty for a number without one.
    pub unit: &'static str,
    /// How it is best written.
    pub format: Format,
    /// Value that the manual recommends or uses as a standard, in its words.
    pub recommended: &'static str,
    /// By what it may be changed.
    pub change: Change,
    /// Whether the operator may change it, code number 123.
    pub user: bool,
    /// What a change needs.
    pub reaction: Reaction,
    /// What the index stands for: the axis, mostly.
    pub axis: &'static str,
    /// Meaning of values or bits.
    pub values: &'static str,
    /// Controls and software versions that have it.
    pub versions: &'static str,
    /// Where the manuals contradict each other, and what was decided.
    pub notes: &'static str,
    /// Where the manuals print it, as `000:10095`.
    pub source: &'static str,
    /// What may be entered, which a control may store coarser.
    entry: Entry,
}

/// Range and decimal places of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    min: f64,
    max: f64,
    decimals: u8,
}

impl Definition {
    /// All machine parameters of a model in ascending order.
    pub fn all(model: ControlModel) -> &'static [Definition] {
        static LISTS: [OnceLock<Vec<Definition>>; ControlModel::FAMILIES.len()] =
            [const { OnceLock::new() }; ControlModel::FAMILIES.len()];
        LISTS[model.place()].get_or_init(|| list(model.family()))
    }

    /// The machine parameter of a number and index. A parameter with one value only is found with
    /// index 0.
    pub fn find(model: ControlModel, number: u16, index: u8) -> Option<&'static Definition> {
        let all = Definition::all(model);
        Definition::position(model, number, index).and_then(|at| all.get(at))
    }

    /// What a value means in words of the list: the value's own, or those of its bits, one item each. Empty
    /// for a quantity.
    pub fn meaning(&self, value: f64) -> Vec<String> {
        meaning::of_value(self.values, value)
    }

    /// The items of the column of values and bits, as the list prints them.
    pub fn choices(&self) -> impl Iterator<Item = &'static str> {
        meaning::items(self.values)
    }

    /// Least and greatest value as they are best written; `None` where no range is printed.
    pub fn range_text(&self) -> Option<[String; 2]> {
        let hexadecimal = matches!(self.format, Format::Hexadecimal(_));
        let text = |value: f64| {
            if hexadecimal && self.max < 10.0 {
                value.to_string()
            } else {
                self.format_value(value)
            }
        };
        self.min.is_finite().then(|| [text(self.min), text(self.max)])
    }

    /// Where it stands in [`Definition::all`].
    pub(crate) fn position(model: ControlModel, number: u16, index: u8) -> Option<usize> {
        Definition::all(model)
            .binary_search_by_key(&(number, index), Definition::key)
            .ok()
    }

    /// The machine parameter that a text names: one with several indices must be named with its index.
    ///
    /// # Errors
    /// [`ParameterError::UnknownNumber`] when the model has no such parameter,
    /// [`ParameterError::IndexMissing`] when the number alone is ambiguous.
    pub fn named(model: ControlModel, id: ParameterId) -> Result<&'static Definition, ParameterError> {
        let found = Definition::find(model, id.number, id.index.unwrap_or(0));
        let has_indices = || {
            Definition::all(model)
                .iter()
                .any(|row| row.id.number == id.number)
        };
        match found {
            Some(definition) if id.index.is_none() && definition.id.index.is_some() => {
                Err(ParameterError::IndexMissing(id))
            }
            Some(definition) => Ok(definition),
            None if id.index.is_none() && has_indices() => Err(ParameterError::IndexMissing(id)),
            None => Err(ParameterError::UnknownNumber(id)),
        }
    }

    /// The value of the list that the control makes when none is entered: standard colours, a programming
    /// station, and the smallest value everywhere else [000:10066]. Whether the station is 1 or 2 is not
    /// said; with PLC (inferred).
    pub fn standard(&self) -> f64 {
        // MP7210, and MP170 of the TNC 151/155, whose numbers end at 263.
        let is_station = self.id.number == 7210 || self.id.number == 170;
        let colour = self.recommended.strip_prefix("std ").and_then(parse_number);
        if is_station {
            1.0
        } else {
            colour.unwrap_or(if self.min.is_finite() { self.min } else { 0.0 })
        }
    }

    /// Whether a list of the model may lack the parameter: those of certain software versions or options,
    /// and those that the manual's list does not print (inferred; the manual calls any missing entry a
    /// fault [000:10050-10062]).
    pub fn is_optional(&self) -> bool {
        const OF_SOFTWARE: [&str; 7] = ["from ", "only ", "243 ", "259 36", "dropped", "TT 110", "option"];
        OF_SOFTWARE.iter().any(|start| self.versions.starts_with(start))
            || self.versions.contains("; from ")
            || self.versions.contains("; only ")
            || self.versions.contains("; added ")
            || self.notes.starts_with("NOT IN THE PRINTED LIST")
    }

    /// The functional group of the number [000:9978-9990]; none on the TNC 151/155, whose numbers are not
    /// grouped.
    pub fn group(&self) -> Option<&'static str> {
        const GROUPS: [(u16, u16, &str); 15] = [
            (264, 999, "Measuring systems and machine"),
            (1000, 1399, "Positioning"),
            (1400, 1699, "Feed pre-control"),
            (1700, 1999, "Servo lag"),
            (3000, 3999, "Spindle"),
            (4000, 4999, "Integral PLC"),
            (5000, 5999, "Data interface"),
            (6000, 6199, "3D touch probe"),
            (6200, 6299, "Digitizing with TS 120"),
            (6300, 6499, "Digitizing with TM 110"),
            (6500, 6599, "Tool measurement with TT 110"),
            (7100, 7199, "Tapping"),
            (7200, 7399, "Display and programming"),
            (7400, 7599, "Machining and program run"),
            (7600, 7699, "Hardware"),
        ];
        // Numbers up to 263 mean something else in each list; only the new one has sources in manual 000.
        if self.id.number < 264 && self.source.starts_with("000") {
            return Some("Measuring systems and machine");
        }
        let found = GROUPS
            .iter()
            .find(|(first, last, _)| (*first..=*last).contains(&self.id.number));
        found.map(|(_, _, name)| *name)
    }

    /// A line of a list: number, value as it is written, name and what the index stands for.
    pub fn line(&self, value: &str) -> String {
        let axis = if self.axis.is_empty() {
            String::new()
        } else {
            format!(", {}", self.axis)
        };
        format!("{:<9}: {value:<12} ;{}{axis}", self.id.to_string(), self.name)
    }

    /// Checks a value and rounds it to the decimal places that are stored [000:10015].
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] for a value outside the range, [`ParameterError::NotWhole`] for a
    /// fraction where whole numbers or bits are meant, [`ParameterError::NoChoice`] for a number between those that
    /// there are.
    pub fn check(&self, value: f64) -> Result<f64, ParameterError> {
        let entered = self.check_entry(value)?;
        let scale = scale(self.decimals);
        // A list of a finer control may lie on the limit.
        let stored = ((entered * scale).round() / scale).clamp(self.min, self.max);
        Ok(stored + 0.0) // no negative zero
    }

    /// Checks a value as it may be entered.
    fn check_entry(&self, value: f64) -> Result<f64, ParameterError> {
        let Entry { min, max, decimals } = self.entry;
        let scale = scale(decimals);
        let rounded = (value * scale).round() / scale;
        // Binary and hexadecimal numbers have no sign.
        let unsigned = self.format != Format::Decimal && rounded < 0.0;
        if !rounded.is_finite() || unsigned || !(min..=max).contains(&rounded) {
            return Err(ParameterError::OutOfRange {
                id: self.id,
                value,
                min: self.min,
                max: self.max,
            });
        }
        // What has no printed range is stored in 32 bits (inferred).
        if min.is_infinite() && (rounded * scale).abs() > f64::from(u32::MAX) {
            return Err(ParameterError::NotStorable(self.id, value));
        }
        if decimals == 0 && rounded != value {
            return Err(ParameterError::NotWhole(self.id, value));
        }
        if self.has_only_choices() && !self.is_choice(rounded) {
            return Err(ParameterError::NoChoice(self.id, value));
        }
        Ok(rounded)
    }

    /// Whether the list names all values: MP340 takes 0, 1 and 5 [000:3238-3244].
    fn has_only_choices(&self) -> bool {
        self.values.ends_with("other values invalid")
    }

    fn is_choice(&self, value: f64) -> bool {
        let mut named = self.choices().filter_map(|choice| choice.split_once('='));
        named.any(|(number, _)| number.parse() == Ok(value))
    }

    /// A TNC 407 (and a TNC 360, which has its list) takes lengths and angles to 0.0001, and stores them to 0.001
    /// [000:10015].
    fn stored_by(mut self, model: ControlModel) -> Definition {
        const COARSE_DECIMALS: u8 = 3;
        let is_coarse = matches!(model.family(), ControlModel::Tnc407 | ControlModel::Tnc360);
        if is_coarse && self.decimals > COARSE_DECIMALS && matches!(self.unit, "mm" | "deg" | "mm or deg") {
            let scale = scale(COARSE_DECIMALS);
            self.decimals = COARSE_DECIMALS;
            self.min = (self.min * scale).ceil() / scale;
            self.max = (self.max * scale).floor() / scale;
        }
        self
    }

    /// Writes a value in the best format, without needless zeros.
    pub fn format_value(&self, value: f64) -> String {
        match self.format {
            Format::Binary(digits) => format!("%{:0digits$b}", value as u64),
            Format::Hexadecimal(digits) => format!("${:0digits$X}", value as u64),
            Format::Decimal => {
                let text = format!("{value:.*}", self.decimals.into());
                if text.contains('.') {
                    text.trim_end_matches('0').trim_end_matches('.').to_owned()
                } else {
                    text
                }
            }
        }
    }

    fn key(&self) -> (u16, u8) {
        (self.id.number, self.id.index.unwrap_or(0))
    }

    /// Whether the versions column gives the parameter to the model.
    fn exists_on(&self, model: ControlModel) -> bool {
        let versions = self.versions;
        match model.family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => true,
            ControlModel::Tnc360 => {
                !versions.starts_with("TNC 4")
                    && !versions.starts_with("not TNC 407")
                    && !self.axis.starts_with("5th")
                    // The TNC 360 has MP7470 itself [003:7424-7430].
                    && !self.notes.starts_with("replaces MP7470")
            }
            ControlModel::Tnc407 => {
                !versions.starts_with("TNC 425 only")
                    && !versions.starts_with("not TNC 407")
                    && !versions.contains("TNC 415/425")
            }
            ControlModel::Tnc415b => {
                !versions.starts_with("TNC 425 only")
                    && !versions.starts_with("TNC 407 only")
                    && !versions.starts_with("not TNC 415")
            }
            _ => !versions.starts_with("TNC 407 only") && !versions.starts_with("not TNC 415"),
        }
    }
}

/// The rows of a model: those of its own list, and the rest from the list of its family.
fn list(model: ControlModel) -> Vec<Definition> {
    let (own, family) = match model.family() {
        ControlModel::Tnc151 | ControlModel::Tnc155 => (TNC_15X, ""),
        ControlModel::Tnc360 => (TNC_360, TNC_4XX),
        _ => (TNC_4XX, ""),
    };
    let mut rows: Vec<Definition> = rows(own).collect();
    let numbers: Vec<u16> = rows.iter().map(|row| row.id.number).collect();
    rows.extend(self::rows(family).filter(|row| !numbers.contains(&row.id.number)));
    rows.retain(|row| row.exists_on(model));
    rows.sort_by_key(Definition::key);
    rows.into_iter().map(|row| row.stored_by(model)).collect()
}

fn scale(decimals: u8) -> f64 {
    10f64.powi(decimals.into())
}

fn rows(table: &'static str) -> impl Iterator<Item = Definition> {
    table.lines().skip(1).filter_map(row)
}

/// Reads one row; a test proves that every row can be read.
fn row(line: &'static str) -> Option<Definition> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let id = parse_id(next()?)?;
    let name = next()?;
    let (min_text, max_text) = (next()?, next()?);
    let unprinted = min_text.is_empty() && max_text.is_empty();
    let (min, max) = match unprinted {
        true => (f64::NEG_INFINITY, f64::INFINITY),
        false => (parse_number(min_text)?, parse_number(max_text)?),
    };
    let decimals = match next()? {
        "" => 0,
        digits => digits.parse().ok()?,
    };
    Some(Definition {
        id,
        name,
        min,
        max,
        decimals,
        entry: Entry { min, max, decimals },
        unit: next()?,
        format: match next()? {
            "bits" => Format::Binary(max_text.len().saturating_sub(1)),
            "hex" if max_text.starts_with('$') => Format::Hexadecimal(max_text.len() - 1),
            "hex" => Format::Hexadecimal(4),
            _ => Format::Decimal,
        },
        recommended: next()?,
        change: match next()? {
            "PLC RUN" => Change::PlcRun,
            "PLC EDIT" => Change::PlcEdit,
            _ => Change::List,
        },
        user: next()? == "yes",
        reaction: match next()? {
            "RESET" => Reaction::Reset,
            "REF" => Reaction::ReferenceMarks,
            _ => Reaction::None,
        },
        axis: next()?,
        values: next()?,
        versions: next()?,
        notes: next()?,
        source: next()?,
    })
}

/// Reads a decimal number with point or comma, `%` binary or `$` hexadecimal [000:10019-10046].
pub(crate) fn parse_number(text: &str) -> Option<f64> {
    let radix = |digits: &str, radix| {
        // The sign that `from_str_radix` would accept is none of the format's.
        let plain = digits.bytes().all(|byte| byte.is_ascii_alphanumeric());
        plain
            .then(|| u64::from_str_radix(digits, radix).ok())
            .flatten()
            .map(|number| number as f64)
    };
    if let Some(digits) = text.strip_prefix('%') {
        return radix(digits, 2);
    }
    if let Some(digits) = text.strip_prefix('$') {
        return radix(digits, 16);
    }
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let starts_with_digit = unsigned.starts_with(|c: char| c.is_ascii_digit());
    let decimal = unsigned
        .bytes()
        .all(|byte| byte.is_ascii_digit() || byte == b'.' || byte == b',');
    (starts_with_digit && decimal)
        .then(|| text.replace(',', ".").parse().ok())
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read() {
        for table in [TNC_4XX, TNC_360, TNC_15X] {
            for line in table.lines().skip(1) {
                assert_eq!(line.split('\t').count(), 16, "{line}");
                let row = row(line).unwrap_or_else(|| panic!("unreadable: {line}"));
                assert!(row.min <= row.max, "{line}");
                assert!(!row.name.is_empty() && !row.source.is_empty(), "{line}");
            }
        }
        assert_eq!(
            rows(TNC_4XX).count(),
            890 + 6,
            "six of them differ on the TNC 407"
        );
        assert_eq!(rows(TNC_15X).count(), 264, "MP0 to MP263 [001:3144-3369]");
    }

    #[test]
    fn a_number_has_either_indices_or_one_value() {
        for model in ControlModel::ALL {
            for pair in Definition::all(model).windows(2) {
                assert!(pair[0].key() < pair[1].key(), "{} twice on {model}", pair[1].id);
                if pair[0].id.number == pair[1].id.number {
                    assert!(
                        pair[0].id.index.is_some() && pair[1].id.index.is_some(),
                        "{}",
                        pair[0].id
                    );
                }
            }
        }
    }

    #[test]
    fn the_smallest_value_is_in_its_own_range() {
        for model in ControlModel::ALL {
            for row in Definition::all(model).iter().filter(|row| row.min.is_finite()) {
                assert_eq!(row.check(row.min), Ok(row.min), "{}", row.id);
                assert_eq!(row.check(row.max), Ok(row.max), "{}", row.id);
            }
        }
    }

    /// "With the TNC 407 you can enter to 0.0001 mm, but the entry value is rounded to 0.001 mm" [000:10015].
    #[test]
    fn entries_of_a_tnc_407_are_rounded() {
        use ControlModel::{Tnc407, Tnc415b};
        let stored = |model, number, value| Definition::find(model, number, 0).unwrap().check(value).ok();
        for (number, entered, coarse) in [
            (4210, 0.0006, 0.001),
            (4210, -0.0004, 0.0),
            // As a list of a TNC 415 B has it where there is no limit.
            (910, 99_999.999_9, 99_999.999),
            (1030, 0.0001, 0.001),
        ] {
            assert_eq!(stored(Tnc407, number, entered), Some(coarse), "MP{number}");
            assert_eq!(stored(Tnc415b, number, entered), Some(entered), "MP{number}");
        }
        assert_eq!(stored(Tnc407, 910, 100_000.0), None);
        // Neither length nor angle: mm/m [000:10123].
        assert_eq!(stored(Tnc407, 720, 0.0006), Some(0.0006));
    }

    /// MP340 takes 0, 1 and 5 [000:3238-3244]; steps of 0.0005 and 0.0001 [000:6447-6448] and a measuring probe [000:1763]
    /// are not for the TNC 407.
    #[test]
    fn values_that_a_control_does_not_have() {
        use ControlModel::{Tnc407, Tnc415b, Tnc425};
        let takes =
            |model, number, value: f64| Definition::find(model, number, 0).unwrap().check(value).is_ok();
        let taken: Vec<u8> = (0..=6)
            .filter(|value| takes(Tnc407, 340, f64::from(*value)))
            .collect();
        assert_eq!(taken, [0, 1, 5]);
        for model in [Tnc415b, Tnc425] {
            assert!(takes(model, 7290, 6.0) && takes(model, 6200, 1.0));
        }
        assert!(takes(Tnc407, 7290, 4.0) && !takes(Tnc407, 7290, 5.0) && !takes(Tnc407, 7290, 6.0));
        assert!(takes(Tnc407, 6200, 0.0) && !takes(Tnc407, 6200, 1.0));
    }

    #[test]
    fn a_row_of_the_list_reads_as_printed() {
        // "MP1060.0 Acceleration, Entry: 0.001 to 5.000 [m/s2]", PLC EDIT [000:10155].
        let row = Definition::find(ControlModel::Tnc415b, 1060, 0).unwrap();
        assert_eq!(
            (row.min, row.max, row.decimals, row.unit),
            (0.001, 5.0, 3, "m/s^2")
        );
        assert_eq!(
            (row.change, row.user, row.reaction),
            (Change::PlcEdit, false, Reaction::None)
        );
        // MP7440, five bits [000:10491].
        let row = Definition::find(ControlModel::Tnc407, 7440, 0).unwrap();
        assert_eq!((row.format, row.max), (Format::Binary(5), 31.0));
        assert_eq!(row.format_value(6.0), "%00110");
        // MP10 may be changed with a restart only [000:10095].
        assert_eq!(
            Definition::find(ControlModel::Tnc407, 10, 0).unwrap().reaction,
            Reaction::Reset
        );
    }

    #[test]
    fn models_have_their_own_parameters() {
        use ControlModel::{Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};
        let has = |model, number| Definition::find(model, number, 0).is_some();
        // Digital speed controller: TNC 425 only; swivel axes: not TNC 407; EXE factor: TNC 407 only.
        assert!(has(Tnc425, 1920) && !has(Tnc415b, 1920));
        assert!(has(Tnc415b, 7510) && !has(Tnc407, 7510));
        assert!(has(Tnc407, 340) && !has(Tnc415b, 340));
        // The TNC 360 adds up to 7 in MP7440 [003:7400].
        assert_eq!(Definition::find(Tnc360, 7440, 0).unwrap().max, 7.0);
        assert!(Definition::find(Tnc360, 1010, 3).is_some() && Definition::find(Tnc360, 1010, 4).is_none());
        assert!(has(Tnc155, 54) && !has(Tnc155, 1060));
    }

    #[test]
    fn numbers_in_three_formats() {
        // Disabling file types, one value in three spellings [000:10027-10046].
        assert_eq!(parse_number("%111000"), Some(56.0));
        assert_eq!(parse_number("$38"), Some(56.0));
        assert_eq!(parse_number("56"), Some(56.0));
        assert_eq!(parse_number("-0,5"), Some(-0.5));
        for wrong in [
            "", "-", ".", "1e3", "inf", "nan", "%2", "$", "%", "$+1", "1.2.3", "--1", "é",
        ] {
            assert_eq!(parse_number(wrong), None, "{wrong}");
        }
    }
}
