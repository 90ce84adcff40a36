//! Tool tables: text with a line of column names and one line for each tool.
//!
//! Decision: A tool table whose RT names no other tool of it, whose T0 has a size or whose numbers go beyond the
//! control's is refused at its line

use std::collections::BTreeMap;
use std::path::Path;

use bahn_interpreter::{ToolState, tool_key};
use bahn_parameters::operation::ToolParameters;
use bahn_parameters::{ControlModel, Definition};
use bahn_path::{Oversize, ToolShape};
use bahn_text::{Diagnostic, decode};
use bahn_tnc::{Edges, Tool, ToolLife};

use crate::columns::{self, Form, Row, RowFault};
use crate::{HostError, files};

/// Reads the tool table of a file for a control, which has as many tools as MP7260 (old MP225) can be: 254, or 99
/// [000:10397] [003:7299].
///
/// # Errors
/// When it cannot be read; its first fault.
pub fn load(path: &Path, model: ControlModel) -> Result<BTreeMap<u32, Tool>, HostError> {
    let bytes = files::read_table(path)?;
    let text = decode(&bytes);
    let size = [7260, 225]
        .into_iter()
        .find_map(|number| Definition::find(model, number, 0));
    let most = size.map_or(TOOL_MAX, |size| size.max as u32);
    parse(&text)
        .and_then(|table| ends_with(&text, most).map(|()| table))
        .map_err(|faults| {
            HostError::new(format!(
                "{}: {}",
                path.display(),
                faults.first().map(Diagnostic::at_line).unwrap_or_default()
            ))
        })
}

/// Whether no tool of a table lies after the last one that a control can have.
fn ends_with(text: &str, most: u32) -> Result<(), Vec<Diagnostic>> {
    columns::read(text, &FORM, |row| match tool(row)? {
        (number, _) if number & NUMBER_MASK > most => Err(row.fault(
            "T",
            &format!("the tool table of this control ends with tool {most}"),
        )),
        _ => Ok(()),
    })
}

/// The tools that must not be called.
pub fn barred<'a>(tools: impl Iterator<Item = (&'a u32, &'a Tool)>) -> BTreeMap<u32, ToolState> {
    tools
        .map(|(number, tool)| (*number, tool.state()))
        .filter(|(_, state)| *state != ToolState::Usable)
        .collect()
}

/// What a tool table needs.
const FORM: Form = Form {
    needed: &["T", "R"],
    known: None,
    example: "T L R R2",
};

/// Reads a tool table. All faults are named, up to a limit.
///
/// # Errors
/// The faults with their lines.
pub fn parse(text: &str) -> Result<BTreeMap<u32, Tool>, Vec<Diagnostic>> {
    let mut table = BTreeMap::new();
    columns::read(text, &FORM, |row| {
        let (number, tool) = tool(row)?;
        match table.insert(number, tool) {
            Some(_) => Err(format!("tool {number} is there twice").into()),
            None => Ok(()),
        }
    })?;
    // A tool may stand in front of the one that replaces it.
    columns::read(text, &FORM, |row| match tool(row)? {
        (number, Tool { life, .. }) if life.replacement == Some(number) => {
            Err(row.fault("RT", "a tool does not replace itself"))
        }
        (_, Tool { life, .. }) if life.replacement.is_some_and(|tool| !table.contains_key(&tool)) => {
            Err(row.fault("RT", &format!("the table has no tool {}", row.text("RT"))))
        }
        _ => Ok(()),
    })?;
    Ok(table)
}

/// Whether a tool table fits the sizes of the machine: its tools MP7260, its pockets MP7261 [000:9103-9113].
///
/// # Errors
/// What does not fit, with its line.
pub fn fits(text: &str, sizes: &ToolParameters) -> Result<(), Vec<Diagnostic>> {
    columns::read(text, &FORM, |row| {
        let (number, tool) = tool(row)?;
        let number = number & NUMBER_MASK;
        if number > sizes.table_size {
            return Err(match sizes.table_size {
                0 => row.fault("T", "the control has no tool table (MP7260 = 0)"),
                most => row.fault("T", &format!("the tool table ends with tool {most} (MP7260)")),
            });
        }
        match tool.pocket {
            Some(pocket) if u32::from(pocket) > sizes.pockets => Err(match sizes.pockets {
                0 => row.fault("P", "the magazine has no pockets (MP7261 = 0)"),
                most => row.fault("P", &format!("the magazine has {most} pockets (MP7261)")),
            }),
            _ => Ok(()),
        }
    })
}

/// Pockets of a magazine: MP7261 [000:10398]; 255 in W262 is a tool without one.
pub(crate) const POCKET_MAX: u16 = 254;
/// Greatest tool number of a control: MP7260 [000:10397].
const TOOL_MAX: u32 = 254;
/// Bits of a key that are the number of the tool; above them is the index of later controls.
const NUMBER_MASK: u32 = 0xFFFF;
/// Edges of a tool (inferred).
const EDGES_MAX: f64 = 20.0;
/// Greatest tolerance, mm, and oversize in the table of a control (inferred).
const TOLERANCE_MAX: f64 = 100.0;

fn tool(row: &Row<'_>) -> Result<(u32, Tool), RowFault> {
    let length = |name: &str| row.number(name).map(|value| value * row.unit_mm);
    let oversize = Oversize {
        length: length("DL")?,
        radius: length("DR")?,
        corner_radius: length("DR2")?,
    };
    let shape = ToolShape {
        length: length("L")? + oversize.length,
        radius: length("R")? + oversize.radius,
        corner_radius: length("R2")? + oversize.corner_radius,
        point_angle_deg: point_angle_deg(row)?,
        oversize,
    };
    if shape.corner_radius < 0.0 || length("R")? < 0.0 {
        return Err("a radius is negative".to_owned().into());
    }
    let tool = row.text("T");
    let tool = key(tool).ok_or_else(|| row.fault("T", &format!("`{tool}` is no tool number")))?;
    if tool & NUMBER_MASK > TOOL_MAX {
        return Err(row.fault("T", &format!("tool numbers go from 0 to {TOOL_MAX}")));
    }
    let has_size = shape.length != 0.0 || shape.radius != 0.0 || shape.corner_radius != 0.0;
    if tool == 0 && has_size {
        return Err(row.fault("T", "tool 0 has length and radius 0"));
    }
    let pocket = match row.text("P") {
        "" | "-" => None,
        text => Some(
            text.parse::<u16>()
                .ok()
                .filter(|pocket| *pocket <= POCKET_MAX)
                .ok_or_else(|| row.fault("P", &format!("`{text}` is no pocket from 0 to {POCKET_MAX}")))?,
        ),
    };
    // Blank and - are M3 [000:15449].
    let left_hand = match row.text("DIRECT") {
        "" | "-" | "0" => false,
        "+" | "1" => true,
        text => return Err(row.fault("DIRECT", &format!("`{text}` is neither - (M3) nor + (M4)"))),
    };
    let tool_data = Tool {
        shape,
        pocket,
        special: row.mark("ST")?,
        fixed: false,
        locked: !matches!(row.text("TL"), "" | "-" | "0"),
        life: life(row)?,
        left_hand,
        edges: edges(row)?,
        plc: row.byte("PLC")?,
    };
    Ok((tool, tool_data))
}

/// CUT, LTOL, RTOL, the offsets and LBREAK, RBREAK [000:9025-9033].
fn edges(row: &Row<'_>) -> Result<Edges, RowFault> {
    let tolerance = |name: &str| row.up_to(name, TOLERANCE_MAX).map(|value| value * row.unit_mm);
    let offset = |name: &str| row.number(name).map(|value| value * row.unit_mm);
    let count = row.up_to("CUT", EDGES_MAX)?;
    if count.fract() != 0.0 {
        return Err(row.fault("CUT", "edges are counted in whole numbers"));
    }
    Ok(Edges {
        count: count as u8,
        length_wear: tolerance("LTOL")?,
        radius_wear: tolerance("RTOL")?,
        length_offset: offset("L-OFFS")?,
        // R in later tables: the radius of the tool.
        radius_offset: match row.text("R-OFFS") {
            "R" => row.number("R")? * row.unit_mm,
            _ => offset("R-OFFS")?,
        },
        length_break: tolerance("LBREAK")?,
        radius_break: tolerance("RBREAK")?,
    })
}

/// T-ANGLE (later controls): the angle of a drill's point; missing, 0 and 180 are a flat end.
fn point_angle_deg(row: &Row<'_>) -> Result<f64, RowFault> {
    let angle = row.number("T-ANGLE")?;
    if angle == 0.0 || angle == 180.0 {
        return Ok(0.0);
    }
    if !(ToolShape::POINT_ANGLE_MIN_DEG..180.0).contains(&angle) {
        let least = ToolShape::POINT_ANGLE_MIN_DEG;
        return Err(row.fault("T-ANGLE", &format!("a point has {least} to 180 degrees")));
    }
    Ok(angle)
}

/// TIME1, TIME2 and CUR.TIME in minutes, RT [000:9021-9027].
fn life(row: &Row<'_>) -> Result<ToolLife, RowFault> {
    let minutes = |name: &str| match row.number(name)? {
        minutes if minutes < 0.0 => Err(row.fault(name, "a tool life is not negative")),
        minutes => Ok(minutes),
    };
    let replacement = match row.text("RT") {
        "" | "-" | "0" | "-1" => None,
        text => Some(key(text).ok_or_else(|| row.fault("RT", &format!("`{text}` is no tool number")))?),
    };
    Ok(ToolLife {
        time1_min: minutes("TIME1")?,
        time2_min: minutes("TIME2")?,
        current_min: minutes("CUR.TIME")?,
        replacement,
    })
}

/// Key of a tool number, with an index of one digit where later controls have one: 253.1.
pub(crate) fn key(text: &str) -> Option<u32> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(length: f64, radius: f64, corner_radius: f64) -> Tool {
        Tool {
            shape: ToolShape {
                length,
                radius,
                corner_radius,
                ..ToolShape::default()
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
        ] {
            assert_eq!(parse(text).as_ref(), Ok(&expected), "{text}");
        }
        let mut oversize = expected;
        if let Some(tool) = oversize.get_mut(&1) {
            tool.shape.oversize = Oversize {
                length: 0.5,
                radius: 0.5,
                corner_radius: 0.0,
            };
        }
        let text = "T L R R2 DL DR\n1 80 9.5 0 +0.5 0.5\n2 62 4 4";
        assert_eq!(parse(text).as_ref(), Ok(&oversize));
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
        let mut fifth = shape(127.0, 12.7, 0.0).shape;
        fifth.oversize.length = 25.4;
        assert_eq!(table[&5].shape, fifth);
        assert_eq!(table.get(&6), Some(&shape(0.0, 6.35, 6.35)));
        assert_eq!(table.len(), 3);
    }

    /// The first fault with its line, where it has one.
    fn first(faults: Vec<Diagnostic>) -> String {
        let fault = faults.first().unwrap();
        match fault.span.line {
            0 => fault.words(),
            line => format!("line {line}: {}", fault.words()),
        }
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text| first(parse(text).unwrap_err());
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
        assert_eq!(
            all.iter().map(|fault| fault.span.line).collect::<Vec<_>>(),
            [2, 3, 5]
        );
    }

    /// RT names another tool of the table; numbers end with 254 [000:10397] [003:7785].
    #[test]
    fn replacement_tools_and_numbers() {
        assert!(parse("T;R;RT\n1;5;2\n2;5;1").is_ok());
        let error = |text| first(parse(text).unwrap_err());
        assert_eq!(
            error("T;R;RT\n1;5;2\n2;5;2"),
            "line 3: RT: a tool does not replace itself"
        );
        assert_eq!(
            error("T;R;RT\n1;5;2\n2;5;7"),
            "line 3: RT: the table has no tool 7"
        );
        assert!(parse("T;R\n254;5\n253.1;5").is_ok());
        assert_eq!(error("T;R\n255;5"), "line 2: T: tool numbers go from 0 to 254");
        assert_eq!(error("T;R\n300.1;5"), "line 2: T: tool numbers go from 0 to 254");
        // "In tool tables, T0 should also be defined with L=0 and R=0" [003:1816].
        assert!(parse("T;L;R\n0;+0;0").is_ok());
        for sized in ["T;L;R\n0;1;0", "T;L;R\n0;0;1", "T;L;R;DR\n0;0;0;1"] {
            assert_eq!(error(sized), "line 2: T: tool 0 has length and radius 0");
        }
        // The table of a TNC 360 has 99 tools at most.
        let path = std::env::temp_dir().join(format!("bahn-tools-{}.t", std::process::id()));
        std::fs::write(&path, "T;R\n99;5\n100;5").unwrap();
        assert_eq!(
            load(&path, ControlModel::Tnc415b)
                .map(|table| table.len())
                .unwrap(),
            2
        );
        let error = load(&path, ControlModel::Tnc360).unwrap_err().to_string();
        std::fs::remove_file(&path).unwrap();
        assert!(
            error.ends_with("line 3: T: the tool table of this control ends with tool 99"),
            "{error}"
        );
    }

    #[test]
    fn locks_and_lives() {
        let text =
            "T;R;TL;TIME2;CUR.TIME;RT\n1;5;L;;;\n2;5;;20;20;\n3;5;-;20;20.1;-\n4;5;;20;21;5\n5;5;;0;99;\n";
        let table = parse(text).unwrap();
        let states: Vec<_> = table.values().map(Tool::state).collect();
        use ToolState::{Expired, Locked, Replaced, Usable};
        assert_eq!(states, [Locked, Usable, Expired, Replaced(5), Usable]);
        assert_eq!(barred(table.iter()).len(), 3);
        for wrong in ["T;R;TIME1\n1;5;-1", "T;R;CUR.TIME\n1;5;x", "T;R;RT\n1;5;y"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }

    /// All columns of MP7266, with the names of the control and of later ones [000:9010-9033].
    #[test]
    fn all_columns_of_the_tool_table() {
        let text = "BEGIN TOOL  .T MM\n\
            T    NAME             L        R        DL      DR       TL RT  CUT. LTOL   RTOL   DIRECT. PLC       \
            TT:R-OFFS TT:L-OFFS LBREAK RBREAK DOC\n\
            4    MILL 3 EDGES     +80.1    +10      +0.003  -0.02    L  7   3    0.1    0.05   +       %00000101 \
            R         +2.5      1      2      ROUGH\n\
            7    MILL 3 EDGES     +80.1    +10\n\
            [END]\n";
        let tool = parse(text).unwrap()[&4];
        assert_eq!(
            (tool.shape.oversize.length, tool.shape.oversize.radius),
            (0.003, -0.02)
        );
        assert_eq!(tool.shape.length, 80.1 + 0.003);
        let edges = Edges {
            count: 3,
            length_wear: 0.1,
            radius_wear: 0.05,
            length_offset: 2.5,
            radius_offset: 10.0,
            length_break: 1.0,
            radius_break: 2.0,
        };
        assert_eq!(
            (tool.edges, tool.plc, tool.left_hand, tool.locked),
            (edges, 5, true, true)
        );
        let own = parse("T;R;CUT;L-OFFS;PLC\n1;5;2;-1,5;7\n").unwrap()[&1];
        assert_eq!((own.edges.count, own.edges.length_offset, own.plc), (2, -1.5, 7));
        let faults = parse("T;R;CUT;PLC;LTOL\n1;5;21;;\n2;5;;%2;\n3;5;;;-1\n4;5;1.5;;\n").unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(2, 5), (3, 6), (4, 7), (5, 5)]);
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
