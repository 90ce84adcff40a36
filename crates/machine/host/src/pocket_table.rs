//! Pocket tables: which tool is in which pocket of the magazine [000:9055-9082].
//!
//! Written as tool tables are, with the columns P (number of the pocket), T, ST, F, L and PLC; columns of later
//! controls (TNAME, RSV, DOC) are passed over. Pocket 0 is the spindle there, and says nothing here.
//!
//! Decision: A pocket table is a file of its own; without pockets (MP7261 = 0) it is not read, with one the tool
//! table has no pockets. F and L belong to the pocket, ST to the tool; the magazine is a ring for MP7264

use std::collections::BTreeMap;

use bahn_parameters::operation::ToolParameters;
use bahn_text::Diagnostic;
use bahn_tnc::{Pocket, Tool};

use crate::columns::{self, Form, Row, RowFault};
use crate::tool_table::{self, POCKET_MAX};

/// A line of a pocket table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PocketLine {
    /// Number of the tool in the pocket; `None` for an empty one.
    pub tool: Option<u32>,
    /// ST: it is a special tool.
    pub special: bool,
    /// What the table says of the pocket beside the tool in it.
    pub pocket: Pocket,
}

const FORM: Form = Form {
    needed: &["P", "T"],
    known: None,
    example: "P T ST F L PLC",
};

/// Reads a pocket table. All faults are named, up to a limit.
///
/// # Errors
/// The faults with their lines.
pub fn parse(text: &str) -> Result<BTreeMap<u16, PocketLine>, Vec<Diagnostic>> {
    let mut lines = BTreeMap::new();
    let mut pockets = BTreeMap::new();
    columns::read(text, &FORM, |row| {
        let (number, line) = line(row)?;
        if lines.insert(number, line).is_some() {
            return Err(row.fault("P", &format!("pocket {number} is there twice")));
        }
        let Some(tool) = line.tool.filter(|_| number > 0) else {
            return Ok(());
        };
        match pockets.insert(tool, number) {
            Some(other) => Err(row.fault("T", &format!("tool {tool} is in pocket {other} already"))),
            None => Ok(()),
        }
    })?;
    Ok(lines)
}

fn line(row: &Row<'_>) -> Result<(u16, PocketLine), RowFault> {
    let text = row.text("P");
    // Later controls write the magazine, a point and the pocket.
    let number = text.rsplit_once('.').map_or(text, |(_, pocket)| pocket);
    let number = number.parse().ok().filter(|pocket| *pocket <= POCKET_MAX);
    let number =
        number.ok_or_else(|| row.fault("P", &format!("`{text}` is no pocket from 0 to {POCKET_MAX}")))?;
    let tool = match row.text("T") {
        "" | "-" | "-1" => None,
        text => Some(
            tool_table::key(text).ok_or_else(|| row.fault("T", &format!("`{text}` is no tool number")))?,
        ),
    };
    let pocket = Pocket {
        fixed: row.mark("F")?,
        locked: row.mark("L")?,
        plc: row.byte("PLC")?,
    };
    // Tool 0 is no tool.
    let tool = tool.filter(|tool| *tool != 0);
    if pocket.locked && tool.is_some() && number > 0 {
        return Err(row.fault("L", "a locked pocket holds no tool"));
    }
    let special = row.mark("ST")?;
    Ok((
        number,
        PocketLine {
            tool,
            special,
            pocket,
        },
    ))
}

/// Whether the tools of a pocket table fit the magazine: its size (MP7261), the pockets that are kept free beside a
/// special tool (MP7264), and the tools that there are.
///
/// # Errors
/// What does not fit, with its line.
pub fn fits(
    text: &str,
    lines: &BTreeMap<u16, PocketLine>,
    tools: &BTreeMap<u32, Tool>,
    sizes: &ToolParameters,
) -> Result<(), Vec<Diagnostic>> {
    columns::read(text, &FORM, |row| {
        let (number, line) = line(row)?;
        if u32::from(number) > sizes.pockets {
            return Err(match sizes.pockets {
                0 => row.fault("P", "the magazine has no pockets (MP7261 = 0)"),
                most => row.fault("P", &format!("the magazine has {most} pockets (MP7261)")),
            });
        }
        let Some(tool) = line.tool.filter(|_| number > 0) else {
            return Ok(());
        };
        if !tools.contains_key(&tool) {
            return Err(row.fault("T", &format!("there is no tool {tool} in the tool table")));
        }
        let taken = |pocket: &u16| lines.get(pocket).is_some_and(|line| line.tool.is_some());
        let mut beside = neighbours(number, sizes);
        match beside.find(taken).filter(|_| line.special) {
            Some(pocket) => {
                let free = sizes.reserved_pockets;
                let what = format!(
                    "{free} pockets on each side of a special tool are kept free (MP7264), but {pocket} holds one"
                );
                Err(row.fault("ST", &what))
            }
            None => Ok(()),
        }
    })
}

/// The pockets that are kept free beside one; the magazine is a ring (inferred).
fn neighbours(pocket: u16, sizes: &ToolParameters) -> impl Iterator<Item = u16> {
    let count = i32::try_from(sizes.pockets).unwrap_or_default().max(1);
    let reserved = i32::from(sizes.reserved_pockets);
    (-reserved..=reserved)
        .filter(|way| *way != 0)
        .map(move |way| (i32::from(pocket) - 1 + way).rem_euclid(count) + 1)
        .filter_map(|other| u16::try_from(other).ok())
        .filter(move |other| *other != pocket)
}

/// The tools as they lie in the pockets, and the pockets themselves.
pub(crate) fn put_away(
    lines: &BTreeMap<u16, PocketLine>,
    tools: &mut BTreeMap<u32, Tool>,
    pockets: &mut BTreeMap<u16, Pocket>,
) {
    for tool in tools.values_mut() {
        (tool.pocket, tool.special, tool.fixed) = (None, false, false);
    }
    for (number, line) in lines {
        pockets.insert(*number, line.pocket);
        let held = line.tool.filter(|_| *number > 0);
        if let Some(tool) = held.and_then(|tool| tools.get_mut(&tool)) {
            (tool.pocket, tool.special, tool.fixed) = (Some(*number), line.special, line.pocket.fixed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::{ControlModel, ParameterList};

    fn sizes(pockets: u32, reserved_pockets: u8) -> ToolParameters {
        let list = ParameterList::reference(ControlModel::Tnc415b);
        ToolParameters {
            pockets,
            reserved_pockets,
            ..list.operation_parameters().tools
        }
    }

    fn tools() -> BTreeMap<u32, Tool> {
        (1..=6).map(|number| (number, Tool::default())).collect()
    }

    /// The picture of the manual: `1 1 S F %10110111`, `2 L %10001100`, `3 3 F`, `5 5 S` [000:9057-9072].
    const MANUAL: &str = "BEGIN TOOL_P .TCH MM\n\
        P   T   ST F L PLC\n\
        0   0          %00000000\n\
        1   1   S  F   %10110111\n\
        2            L %10001100\n\
        3   3      F   %11100111\n\
        5   5   S      %11000000\n\
        [END]\n";

    #[test]
    fn pocket_tables_are_read() {
        let lines = parse(MANUAL).unwrap();
        let line = lines[&1];
        assert_eq!(
            (line.tool, line.special, line.pocket.fixed),
            (Some(1), true, true)
        );
        assert_eq!(line.pocket.plc, 0b1011_0111);
        assert_eq!((lines[&2].tool, lines[&2].pocket.locked), (None, true));
        assert_eq!((lines[&0].tool, lines[&0].pocket.plc), (None, 0));
        let (mut tools, mut pockets) = (tools(), BTreeMap::new());
        assert_eq!(fits(MANUAL, &lines, &tools, &sizes(6, 0)), Ok(()));
        put_away(&lines, &mut tools, &mut pockets);
        let kinds: Vec<_> = tools
            .values()
            .map(|tool| (tool.pocket, tool.special, tool.fixed))
            .collect();
        let no = (None, false, false);
        assert_eq!(
            kinds,
            [
                (Some(1), true, true),
                no,
                (Some(3), false, true),
                no,
                (Some(5), true, false),
                no
            ]
        );
        assert_eq!(pockets[&2].plc, 0b1000_1100);
        // A table of a later control.
        let later = parse("P\tT\tTNAME\tRSV\tST\n0.0\t3\tMILL\t\t\n1.7\t4\tDRILL\t\tS\n").unwrap();
        assert_eq!((later[&7].tool, later[&7].special), (Some(4), true));
    }

    #[test]
    fn faults_have_line_and_column() {
        let faults =
            parse("P;T;F;L;PLC\n1;2;;;\n1;3;;;\n2;2;;;\n255;1;;;\n3;4;;L;\n4;x;;;%3\n5;5;?;;\n").unwrap_err();
        let places: Vec<_> = faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(3, 1), (4, 3), (5, 1), (6, 6), (7, 3), (8, 5)]);
        assert_eq!(faults[1].message, "T: tool 2 is in pocket 1 already");
    }

    /// MP7264 = 1: pockets 12 and 2 beside the special tool in pocket 1 of twelve are free [000:9160-9165].
    #[test]
    fn pockets_beside_special_tools_are_free() {
        let fitting = |text: &str, sizes: &ToolParameters| fits(text, &parse(text).unwrap(), &tools(), sizes);
        for (pocket, free) in [(2, false), (3, true), (11, true), (12, false)] {
            let text = format!("P T ST\n1 1 S\n{pocket} 2 -\n");
            assert_eq!(fitting(&text, &sizes(12, 1)).is_ok(), free, "{pocket}");
            assert!(fitting(&text, &sizes(12, 0)).is_ok());
        }
        let faults = fitting("P T ST\n13 1 -\n2 9 -\n", &sizes(12, 0)).unwrap_err();
        let said: Vec<_> = faults.iter().map(|fault| fault.message.as_str()).collect();
        assert_eq!(
            said,
            [
                "P: the magazine has 12 pockets (MP7261)",
                "T: there is no tool 9 in the tool table"
            ]
        );
    }
}
