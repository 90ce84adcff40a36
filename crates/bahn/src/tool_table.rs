//! Tool tables: text with a line of column names and one line for each tool.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use bahn_control::{Tool, ToolLife};
use bahn_interpreter::{ToolState, tool_key};
use bahn_path::ToolShape;

use crate::{UsageError, files};

/// Reads the tool table of a file.
pub(crate) fn load(path: &Path) -> Result<BTreeMap<u32, Tool>, UsageError> {
    let bytes = files::read_table(path)?;
    parse(&String::from_utf8_lossy(&bytes)).map_err(|faults| {
        UsageError::new(format!(
            "{}: {}",
            path.display(),
            faults.first().map(TableFault::to_string).unwrap_or_default()
        ))
    })
}

/// The tools that must not be called.
pub(crate) fn barred<'a>(tools: impl Iterator<Item = (&'a u32, &'a Tool)>) -> BTreeMap<u32, ToolState> {
    tools
        .map(|(number, tool)| (*number, tool.state()))
        .filter(|(_, state)| *state != ToolState::Usable)
        .collect()
}

/// What is wrong in a line of a table, from 1; 0 is the table as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TableFault {
    pub line: u32,
    pub message: String,
}

impl fmt::Display for TableFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.message),
            line => write!(f, "line {line}: {}", self.message),
        }
    }
}

/// Faulty lines that are named; behind them reading ends.
const FAULTS_MAX: usize = 100;

/// Reads a tool table: see the help of `bahn test`. All faults are named, up to [`FAULTS_MAX`].
pub(crate) fn parse(text: &str) -> Result<BTreeMap<u32, Tool>, Vec<TableFault>> {
    let whole = |message: String| vec![TableFault { line: 0, message }];
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !is_comment(line))
        .peekable();
    let frame = lines.next_if(|(_, line)| first_word(line).eq_ignore_ascii_case("BEGIN"));
    let unit_mm = match frame {
        Some((_, line)) if line.to_ascii_uppercase().contains("INCH") => 25.4,
        _ => 1.0,
    };
    let Some((_, header)) = lines.next() else {
        return Err(whole("the table is empty".into()));
    };
    let columns = Columns::new(header, frame.is_some()).map_err(whole)?;
    let mut table = BTreeMap::new();
    let mut faults = Vec::new();
    for (number, line) in lines {
        if faults.len() == FAULTS_MAX {
            faults.push(TableFault {
                line: number,
                message: "too many faults: what follows is not read".to_owned(),
            });
            break;
        }
        if matches!(first_word(line).to_ascii_uppercase().as_str(), "[END]" | "END") {
            break;
        }
        let mut fault = |message| {
            faults.push(TableFault {
                line: number,
                message,
            })
        };
        match columns.tool(line, unit_mm) {
            Ok((number, tool)) => {
                if table.insert(number, tool).is_some() {
                    fault(format!("tool {number} is there twice"));
                }
            }
            Err(message) => fault(message),
        }
    }
    if faults.is_empty() { Ok(table) } else { Err(faults) }
}

/// Pockets of a magazine: MP7261 [000:10398]; 255 in W262 is a tool without one.
const POCKET_MAX: u16 = 254;

fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with([';', '#', '*'])
}

fn first_word(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or_default()
}

/// Where the columns are.
struct Columns {
    names: Vec<String>,
    layout: Layout,
}

enum Layout {
    /// A character stands between the columns.
    Separated(char),
    /// Blanks stand between the columns; the last one may contain blanks.
    Blanks,
    /// Columns begin under their names, counted in characters: a file of a control.
    Fixed(Vec<usize>),
}

impl Columns {
    fn new(header: &str, fixed: bool) -> Result<Columns, String> {
        let separator = ['\t', ';', ',']
            .into_iter()
            .find(|separator| header.contains(*separator));
        let (names, layout): (Vec<&str>, Layout) = match separator {
            Some(separator) => (header.split(separator).collect(), Layout::Separated(separator)),
            None if fixed => (
                header.split_whitespace().collect(),
                Layout::Fixed(column_starts(header)),
            ),
            None => (header.split_whitespace().collect(), Layout::Blanks),
        };
        let names: Vec<String> = names
            .into_iter()
            .map(|name| name.trim().to_ascii_uppercase())
            .collect();
        for needed in ["T", "R"] {
            if !names.iter().any(|name| name == needed) {
                return Err(format!(
                    "the first line must name the columns T L R R2; there is no column {needed}"
                ));
            }
        }
        Ok(Columns { names, layout })
    }

    fn tool(&self, line: &str, unit_mm: f64) -> Result<(u32, Tool), String> {
        let fields = self.fields(line)?;
        let length = |name: &str| self.length(&fields, name).map(|value| value * unit_mm);
        let shape = ToolShape {
            length: length("L")? + length("DL")?,
            radius: length("R")? + length("DR")?,
            corner_radius: length("R2")? + length("DR2")?,
            point_angle_deg: self.point_angle_deg(&fields)?,
        };
        if shape.corner_radius < 0.0 || length("R")? < 0.0 {
            return Err("a radius is negative".into());
        }
        let tool = self.field(&fields, "T");
        let tool = key(tool).ok_or_else(|| format!("T: `{tool}` is no tool number"))?;
        let pocket = match self.field(&fields, "P") {
            "" | "-" => None,
            text => Some(
                text.parse::<u16>()
                    .ok()
                    .filter(|pocket| *pocket <= POCKET_MAX)
                    .ok_or_else(|| format!("P: `{text}` is no pocket from 0 to {POCKET_MAX}"))?,
            ),
        };
        let special = match self.field(&fields, "ST").to_ascii_uppercase().as_str() {
            "" | "-" | "0" | "N" => false,
            "1" | "Y" | "J" | "S" | "ST" => true,
            text => return Err(format!("ST: `{text}` is neither empty nor S")),
        };
        // Tables of later controls write `DIRECT.` and `DIR.`; blank and - are M3 [000:15449].
        let direct = ["DIRECT", "DIRECT.", "DIR."].map(|name| self.field(&fields, name));
        let left_hand = match direct.into_iter().find(|text| !text.is_empty()) {
            None | Some("-") | Some("0") => false,
            Some("+") | Some("1") => true,
            Some(text) => return Err(format!("DIRECT: `{text}` is neither - (M3) nor + (M4)")),
        };
        let tool_data = Tool {
            shape,
            pocket,
            special,
            locked: !matches!(self.field(&fields, "TL"), "" | "-" | "0"),
            life: self.life(&fields)?,
            left_hand,
        };
        Ok((tool, tool_data))
    }

    /// T-ANGLE (later controls): the angle of a drill's point; missing, 0 and 180 are a flat end.
    fn point_angle_deg(&self, fields: &[String]) -> Result<f64, String> {
        let angle = self.length(fields, "T-ANGLE")?;
        if angle == 0.0 || angle == 180.0 {
            return Ok(0.0);
        }
        if !(ToolShape::POINT_ANGLE_MIN_DEG..180.0).contains(&angle) {
            let least = ToolShape::POINT_ANGLE_MIN_DEG;
            return Err(format!("T-ANGLE: a point has {least} to 180 degrees"));
        }
        Ok(angle)
    }

    fn fields(&self, line: &str) -> Result<Vec<String>, String> {
        Ok(match &self.layout {
            Layout::Separated(separator) => line
                .split(*separator)
                .map(|field| field.trim().to_owned())
                .collect(),
            Layout::Blanks => {
                let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
                if words.len() > self.names.len() {
                    let rest = words.split_off(self.names.len().saturating_sub(1));
                    words.push(rest.join(" "));
                }
                words
            }
            Layout::Fixed(starts) => {
                let characters: Vec<char> = line.chars().collect();
                let ends = starts.iter().skip(1).copied().chain([usize::MAX]);
                let cut = |(start, end): (&usize, usize)| {
                    let end = end.min(characters.len());
                    characters
                        .get(*start..end)
                        .unwrap_or_default()
                        .iter()
                        .collect::<String>()
                        .trim()
                        .to_owned()
                };
                starts.iter().zip(ends).map(cut).collect()
            }
        })
    }

    fn field<'a>(&self, fields: &'a [String], name: &str) -> &'a str {
        let at = self.names.iter().position(|column| column == name);
        at.and_then(|at| fields.get(at)).map_or("", String::as_str)
    }

    /// TIME1, TIME2 and CUR.TIME in minutes, RT [000:9021-9027].
    fn life(&self, fields: &[String]) -> Result<ToolLife, String> {
        let minutes = |name: &str| match self.length(fields, name)? {
            minutes if minutes < 0.0 => Err(format!("{name}: a tool life is not negative")),
            minutes => Ok(minutes),
        };
        let replacement = match self.field(fields, "RT") {
            "" | "-" | "0" | "-1" => None,
            text => Some(key(text).ok_or_else(|| format!("RT: `{text}` is no tool number"))?),
        };
        Ok(ToolLife {
            time1_min: minutes("TIME1")?,
            time2_min: minutes("TIME2")?,
            current_min: minutes("CUR.TIME")?,
            replacement,
        })
    }

    /// A length; a column that is missing, empty or `-` is 0. A decimal comma is a point.
    fn length(&self, fields: &[String], name: &str) -> Result<f64, String> {
        const GREATEST_MM: f64 = 100_000.0;
        let text = self.field(fields, name);
        if text.is_empty() || text == "-" {
            return Ok(0.0);
        }
        let value = text
            .replace(',', ".")
            .parse::<f64>()
            .map_err(|_| format!("{name}: `{text}` is no number"))?;
        if !(-GREATEST_MM..=GREATEST_MM).contains(&value) {
            return Err(format!("{name}: {text} is too large"));
        }
        Ok(value)
    }
}

/// Key of a tool number, with an index of one digit where later controls have one: 253.1.
fn key(text: &str) -> Option<u32> {
    let Some((number, index)) = text.split_once(['.', ',']) else {
        return text.parse().ok();
    };
    let number = number
        .parse()
        .ok()
        .filter(|number| *number <= u32::from(u16::MAX))?;
    let index = index.parse().ok().filter(|index| (1..=9).contains(index))?;
    Some(tool_key(number, index))
}

/// Character positions where the words of a line begin.
fn column_starts(line: &str) -> Vec<usize> {
    let mut before = ' ';
    let mut starts = Vec::new();
    for (at, character) in line.chars().enumerate() {
        if before.is_whitespace() && !character.is_whitespace() {
            starts.push(at);
        }
        before = character;
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(length: f64, radius: f64, corner_radius: f64) -> Tool {
        Tool {
            shape: ToolShape {
                length,
                radius,
                corner_radius,
                point_angle_deg: 0.0,
            },
            ..Tool::default()
        }
    }

    #[test]
    fn blanks_tabs_commas_and_semicolons_separate() {
        let expected = BTreeMap::from([(1, shape(80.5, 10.0, 0.0)), (2, shape(62.0, 4.0, 4.0))]);
        for text in [
            "T L R R2 NAME\n1 80.5 10 0 END MILL D20\n\n; a comment\n2 62 4 4\n",
            "T\tL\tR\tR2\tNAME\n1\t80.5\t10\t\tEND MILL\n2\t62\t4\t4\tBALL\n",
            "\u{feff}t,name,l,r,r2\r\n1,END MILL,80.5,10,\r\n2,BALL,62,4,4\r\n",
            "T;L;R;R2\n1;80,5;10;0\n2;62;4;4\n",
            "T L R R2 DL DR\n1 80 9.5 0 +0.5 0.5\n2 62 4 4",
        ] {
            assert_eq!(parse(text).as_ref(), Ok(&expected), "{text}");
        }
    }

    #[test]
    fn tables_of_controls_have_fixed_columns() {
        let text = "BEGIN TOOL  .T INCH\n\
                    T     NAME            L         R         R2   DL\n\
                    0                     +0        +0        +0\n\
                    5     MILL 1 IN       +4        +0.5      +0   +1\n\
                    6                               +0.25     +0.25\n\
                    [END]\n";
        let table = parse(text).unwrap();
        assert_eq!(table.get(&0), Some(&shape(0.0, 0.0, 0.0)));
        assert_eq!(table.get(&5), Some(&shape(127.0, 12.7, 0.0)));
        assert_eq!(table.get(&6), Some(&shape(0.0, 6.35, 6.35)));
        assert_eq!(table.len(), 3);
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text| parse(text).unwrap_err().first().unwrap().to_string();
        assert_eq!(error("T R\n1 5\n2 x"), "line 3: R: `x` is no number");
        assert_eq!(error("T R\n1 5\n1 6"), "line 3: tool 1 is there twice");
        assert_eq!(error("T R\n-1 5"), "line 2: T: `-1` is no tool number");
        assert_eq!(error("T R\n1 -5"), "line 2: a radius is negative");
        assert_eq!(error("\n"), "the table is empty");
        assert!(error("1 5 7").contains("no column T"));
        assert_eq!(
            error("T R P\n1 5 255"),
            "line 2: P: `255` is no pocket from 0 to 254"
        );
        let all = parse("T R ST\n1 x\n2 5 ?\n3 1\n3 1").unwrap_err();
        assert_eq!(all.iter().map(|fault| fault.line).collect::<Vec<_>>(), [2, 3, 5]);
    }

    #[test]
    fn locks_and_lives() {
        let text =
            "T;R;TL;TIME2;CUR.TIME;RT\n1;5;L;;;\n2;5;;20;20;\n3;5;-;20;20.1;-\n4;5;;20;21;7\n5;5;;0;99;\n";
        let table = parse(text).unwrap();
        let states: Vec<_> = table.values().map(Tool::state).collect();
        use ToolState::{Expired, Locked, Replaced, Usable};
        assert_eq!(states, [Locked, Usable, Expired, Replaced(7), Usable]);
        assert_eq!(barred(table.iter()).len(), 3);
        for wrong in ["T;R;TIME1\n1;5;-1", "T;R;CUR.TIME\n1;5;x", "T;R;RT\n1;5;y"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn points_of_drills_have_an_angle() {
        let table = parse("T;R;T-ANGLE\n1;5;118\n2;5;\n3;5;180\n").unwrap();
        let angles: Vec<f64> = table.values().map(|tool| tool.shape.point_angle_deg).collect();
        assert_eq!(angles, [118.0, 0.0, 0.0]);
        assert!(parse("T;R;T-ANGLE\n1;5;181").is_err() && parse("T;R;T-ANGLE\n1;5;-5").is_err());
    }

    #[test]
    fn left_hand_tools_are_marked_by_direct() {
        let table = parse("T;R;DIRECT\n1;5;-\n2;5;\n3;5;+\n").unwrap();
        let left: Vec<bool> = table.values().map(|tool| tool.left_hand).collect();
        assert_eq!(left, [false, false, true]);
        assert!(parse("T;R;DIRECT\n1;5;x").is_err());
    }

    #[test]
    fn pockets_and_special_tools() {
        let table = parse("T;L;R;P;ST\n1;80;5;12;\n2;60;50;3;S\n3;60;5;-;-\n").unwrap();
        let kinds: Vec<_> = table.values().map(|tool| (tool.pocket, tool.special)).collect();
        assert_eq!(kinds, [(Some(12), false), (Some(3), true), (None, false)]);
    }
}
