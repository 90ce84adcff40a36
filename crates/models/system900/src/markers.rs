//! The markers of the PLC: which part of a parameter each is, and who gives it.
//!
//! The column `plc` of the table says which markers a parameter has; the table of this file says of each what it is when it is 1, and
//! in which direction it goes [002:3606-3816] [002:8015-8640]. A test holds both together.
//!
//! Decision: The number at the end of a marker is that of the channel, of the physical axis, of the spindle or of the coupling:
//! `SAFREK2` is P8706 of channel 2, `REPO+12` P12130 of physical axis 12
//!
//! Decision: P8750 to P8752 go from the PLC to the control: keys of a machine panel end at the PLC, those of the operating
//! panel at the control
//!
//! Decision: Of a parameter without a marker a status goes to the PLC; all others go to whoever did not write them last

use std::sync::LazyLock;

use crate::memory::{Memory, Place, SpaceError};
use crate::name::{Name, repeated};
use crate::numbers::{
    AXES, AXIS, AXIS_BLOCK, CHANNELS_MAX, COUPLING_BLOCK, COUPLINGS, COUPLINGS_MAX, FIXED, FIXED_COUNT,
    SHARED, SPINDLES,
};
use crate::table::row;

/// Who gives what is exchanged with the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The control, which the PLC cannot contradict.
    ToPlc,
    /// The PLC; where the control changes it itself, the PLC sees that.
    ToControl,
    /// Both: what was written last counts.
    Both,
}

/// What of a parameter a marker is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerPart {
    /// 1 while the parameter has one of these values; the PLC gives it the first one.
    Value(&'static [i32]),
    /// 1 for one PLC cycle after the parameter was given one of these values, also once more.
    Request(&'static [i32]),
    /// A byte of it is 1, from 0 on.
    Byte(u8),
    /// The whole parameter: it stands in a double word.
    Word,
}

/// A marker of the PLC at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marker {
    /// The parameter.
    pub place: Place,
    /// What of it.
    pub part: MarkerPart,
    /// Who gives it.
    pub direction: Direction,
}

/// Why there is no such marker.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoMarker {
    /// The table has none of that name.
    #[error("`{0}` is no marker of the PLC and no parameter")]
    Unknown(String),
    /// There is none of that number.
    #[error("`{0}`: {1}")]
    Number(String, String),
}

/// A line of the table.
#[derive(Debug)]
struct Line {
    /// The marker as the table writes it, that of channel, axis, spindle or coupling 1.
    name: &'static str,
    parameter: u32,
    direction: Direction,
    part: MarkerPart,
}

/// All lines.
fn lines() -> &'static [Line] {
    static LINES: LazyLock<Vec<Line>> = LazyLock::new(|| {
        let lines = include_str!("../data/markers.tsv").lines().skip(1);
        lines.filter_map(read).collect()
    });
    &LINES
}

/// Reads one line; a test proves that every line can be read.
fn read(line: &'static str) -> Option<Line> {
    let mut columns = line.split('\t');
    let name = columns.next()?;
    let parameter = columns.next()?.strip_prefix('P')?.parse().ok()?;
    let direction = match columns.next()? {
        "plc" => Direction::ToPlc,
        "control" => Direction::ToControl,
        _ => return None,
    };
    let (part, means) = (columns.next()?, columns.next()?);
    let values = || -> Option<&'static [i32]> {
        let values: Option<Vec<i32>> = means.split(' ').map(|value| value.parse().ok()).collect();
        Some(Vec::leak(values?))
    };
    let part = match part {
        "value" => MarkerPart::Value(values()?),
        "request" => MarkerPart::Request(values()?),
        "byte" => MarkerPart::Byte(means.parse::<u8>().ok()?.checked_sub(1)?),
        "word" => MarkerPart::Word,
        _ => return None,
    };
    Some(Line {
        name,
        parameter,
        direction,
        part,
    })
}

/// The names of all markers as the table writes them.
pub fn marker_names() -> impl Iterator<Item = &'static str> {
    lines().iter().map(|line| line.name)
}

impl Line {
    /// What stands before the number.
    fn stem(&self) -> &'static str {
        let stem = self.name.trim_end_matches('1');
        // SLOP11 is slope 1 of axis 1, and SZSA_01 has two digits.
        match self.name.strip_suffix("11") {
            Some(_) => self.name.get(..self.name.len() - 1).unwrap_or(stem),
            None => stem.strip_suffix('0').unwrap_or(stem),
        }
    }
}

impl Memory {
    /// The marker of a name, as `SAFREK2`; case does not count.
    ///
    /// ```
    /// use bahn_system900::{DataFile, Direction, MarkerPart};
    /// let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\n");
    /// let marker = file.memory().marker("safrek1")?;
    /// assert_eq!(file.memory().name_of(marker.place).to_string(), "P8706");
    /// assert_eq!((marker.part, marker.direction), (MarkerPart::Value(&[1]), Direction::ToControl));
    /// assert!(file.memory().marker("SAFREK2").is_err(), "there is one channel");
    /// # Ok::<(), bahn_system900::NoMarker>(())
    /// ```
    ///
    /// # Errors
    /// When the table has no such marker, or the machine no such channel, axis, spindle or coupling.
    pub fn marker(&self, name: &str) -> Result<Marker, NoMarker> {
        let upper = name.trim().to_ascii_uppercase();
        let found = lines().iter().find_map(|line| {
            let digits = upper.strip_prefix(line.stem())?;
            let all = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
            all.then(|| Some((line, digits.parse::<u32>().ok()?)))?
        });
        let (line, number) = found.ok_or_else(|| NoMarker::Unknown(repeated(name.trim())))?;
        let place = self
            .place_of_marker(line.parameter, number)
            .map_err(|why| NoMarker::Number(repeated(name.trim()), why))?;
        Ok(Marker {
            place,
            part: line.part,
            direction: line.direction,
        })
    }

    /// The parameter of channel, axis, spindle or coupling of a number that is one of the first.
    fn place_of_marker(&self, parameter: u32, number: u32) -> Result<Place, String> {
        let within = |most: u32, what: &str| match (1..=most).contains(&number) {
            true => Ok(number - 1),
            false => Err(format!("there is no {what} {number}, they are 1 to {most}")),
        };
        let shared = |first: u32| Place::Q(parameter - SHARED.0 + SHARED.1 + COUPLING_BLOCK * first);
        if (FIXED..FIXED + FIXED_COUNT).contains(&parameter) {
            within(self.channels().min(CHANNELS_MAX).into(), "channel")?;
            let channel = u8::try_from(number).unwrap_or(CHANNELS_MAX);
            return self
                .place(Name::P(channel, parameter))
                .map_err(|error: SpaceError| error.to_string());
        }
        if (COUPLINGS..COUPLINGS + COUPLING_BLOCK).contains(&parameter) {
            return within(COUPLINGS_MAX, "coupling").map(shared);
        }
        if (SPINDLES..SPINDLES + COUPLING_BLOCK).contains(&parameter) {
            return within(COUPLINGS_MAX, "spindle").map(shared);
        }
        let first = within(AXES.into(), "physical axis")?;
        Ok(Place::Q(parameter - AXIS.0 + AXIS.1 + AXIS_BLOCK * first))
    }

    /// Who gives a parameter that stands as a whole in the memory of the PLC.
    pub fn direction(&self, place: Place) -> Direction {
        let Some(row) = row(self.name_of(place)) else {
            return Direction::Both;
        };
        let by_marker = row
            .plc()
            .find_map(|marker| lines().iter().find(|line| line.name == marker));
        match by_marker {
            Some(line) => line.direction,
            None if row.kind == "status" => Direction::ToPlc,
            None => Direction::Both,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::rows;

    /// The column `plc` of the table and the table of the markers say the same.
    #[test]
    fn both_tables_have_the_same_markers() {
        let of_rows: Vec<(&str, String)> = rows()
            .iter()
            .flat_map(|row| row.plc().map(|marker| (marker, row.number.to_owned())))
            .collect();
        let own: Vec<(&str, String)> = lines()
            .iter()
            .map(|line| (line.name, format!("P{}", line.parameter)))
            .collect();
        assert_eq!(own, of_rows);
        let text = include_str!("../data/markers.tsv");
        assert_eq!(lines().len(), text.lines().count() - 1, "every line can be read");
    }

    /// No marker of the table is another one of another number.
    #[test]
    fn every_marker_is_itself() {
        let file = crate::DataFile::read(
            b"q2: 2\nq102: 10000\nq103: 5000\nq202: 20000\nq203: 5000\nq110: $01010058\nq210: $02020058\n",
        );
        let memory = file.memory();
        for line in lines() {
            let name = format!("{}2", line.stem());
            let marker = memory.marker(&name).unwrap();
            assert_eq!(
                (marker.part, marker.direction),
                (line.part, line.direction),
                "{name}"
            );
            let first = memory.marker(line.name).unwrap();
            assert_eq!(first.part, line.part, "{}", line.name);
            assert_ne!(first.place, marker.place, "{name}");
        }
        let said = |name: &str| memory.marker(name).map_err(|error| error.to_string());
        assert_eq!(
            said("REPO+12").map(|marker| marker.place),
            Ok(Place::Q(2000 + 11 * 200 + 130))
        );
        assert_eq!(said("SLOP212").map(|marker| marker.part), Ok(MarkerPart::Byte(1)));
        assert_eq!(said("SPIRE3").map(|marker| marker.place), Ok(Place::Q(1650 + 40)));
        assert_eq!(
            said("KOPSYN2").map(|marker| marker.place),
            Ok(Place::Q(1495 + 20))
        );
        assert_eq!(
            said("SAFREK3"),
            Err("`SAFREK3`: there is no channel 3, they are 1 to 2".to_owned())
        );
        assert_eq!(
            said("REF33"),
            Err("`REF33`: there is no physical axis 33, they are 1 to 32".to_owned())
        );
        assert_eq!(
            said("LUCK1"),
            Err("`LUCK1` is no marker of the PLC and no parameter".to_owned())
        );
    }

    #[test]
    fn parameters_go_where_the_table_says() {
        let memory = Memory::new();
        let of = |name: &str| memory.direction(memory.place(name.parse().unwrap()).unwrap());
        assert_eq!(of("q2130"), Direction::ToControl);
        assert_eq!(of("q2180"), Direction::ToPlc);
        // The message number of a channel, a status without marker; and a free parameter.
        assert_eq!(of("q1261"), Direction::Both);
        assert_eq!(of("q1"), Direction::ToPlc);
        assert_eq!(of("q9000"), Direction::Both);
    }
}
