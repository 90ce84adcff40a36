//! Tool and pocket table as modules 9092 to 9094 see them [000:15375-15545]: what the PLC writes there counts
//! at once and survives power-off.

use bahn_path::ToolShape;
use bahn_plc::{MemoryTable, TableFile, TableKind};

use crate::kinematics::Offsets;
use crate::magazine::Magazine;
use crate::plc_link::{NcFiles, WrittenElement, differences};
use crate::tool::{Tool, ToolLife};
use crate::tools::Tools;

/// Elements of the tool table [000:15431-15454].
const L: usize = 0;
const R: usize = 1;
const RT: usize = 3;
const TIME1: usize = 5;
const TIME2: usize = 6;
pub(crate) const CURRENT_TIME: usize = 7;
const R2: usize = 8;
const DL: usize = 9;
const DR: usize = 10;
const DR2: usize = 11;
const TL: usize = 12;
/// Elements of the pocket table [000:15422-15429].
const T: usize = 0;
const ST: usize = 1;
/// No tool in a pocket, no replacement tool.
const NO_TOOL: f64 = -1.0;

/// The tables as they were loaded: what differs from them was written.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadedTables(Vec<MemoryTable>);

impl LoadedTables {
    /// The tables of a tool table.
    fn of<'t>(tools: impl Iterator<Item = (u32, &'t Tool)> + Clone) -> LoadedTables {
        let line = |number: u32| i32::try_from(number).unwrap_or(i32::MAX);
        let pockets = tools.clone().filter_map(|(_, tool)| tool.pocket);
        let last = pockets.max().unwrap_or(0);
        let mut table =
            MemoryTable::with_lines(TableKind::Tool, tools.clone().map(|(number, _)| line(number)));
        let mut magazine = MemoryTable::with_lines(TableKind::Pocket, (0..=last).map(i32::from));
        for (number, tool) in tools {
            let (shape, life) = (tool.shape, tool.life);
            for (element, value) in [
                (L, shape.length),
                (R, shape.radius),
                (R2, shape.corner_radius),
                (RT, life.replacement.map_or(NO_TOOL, f64::from)),
                (TIME1, life.time1_min),
                (TIME2, life.time2_min),
                (CURRENT_TIME, life.current_min),
                (TL, f64::from(u8::from(tool.locked))),
            ] {
                table.set_value(line(number), element, value);
            }
            if let Some(pocket) = tool.pocket {
                magazine.set_value(pocket.into(), T, number.into());
                magazine.set_value(pocket.into(), ST, f64::from(u8::from(tool.special)));
            }
        }
        LoadedTables(vec![table, magazine])
    }
}

impl LoadedTables {
    /// The tables at power-on, with what was written before. Elements whose table has changed since are as it
    /// says.
    pub fn set_up(tools: &mut Magazine, files: &mut NcFiles, written: &[WrittenElement]) -> LoadedTables {
        let Some(all) = tools.all() else {
            return LoadedTables::default();
        };
        let loaded = LoadedTables::of(all);
        for table in &loaded.0 {
            files.tables.insert(table.kind(), table.clone());
        }
        mirror_pockets(tools, files);
        for element in written {
            let table = loaded.0.iter().find(|table| table.kind() == element.table);
            let as_before =
                table.and_then(|table| table.value(element.line, element.element)) == Some(element.file);
            if let Some(table) = files.tables.get_mut(&element.table)
                && as_before
            {
                table.set_value(element.line, element.element, element.value);
            }
        }
        take_tables(tools, files);
        loaded
    }

    /// What module 9094 wrote and no tool change can say.
    pub fn written(&self, files: &NcFiles) -> Vec<WrittenElement> {
        let mut written = Vec::new();
        for loaded in &self.0 {
            let Some(table) = files.tables.get(&loaded.kind()) else {
                continue;
            };
            written.extend(differences(loaded, table).filter(|row| {
                // The tools say those.
                row.table != TableKind::Pocket || !matches!(row.element, T | ST)
            }));
        }
        written
    }
}

/// The tools have changed their pockets: the pocket table says so.
pub(crate) fn mirror_pockets(tools: &Magazine, files: &mut NcFiles) {
    let (Some(tools), Some(magazine)) = (tools.all(), files.tables.get_mut(&TableKind::Pocket)) else {
        return;
    };
    let mut line = magazine.next_line(0);
    while let Some(pocket) = line {
        magazine.set_value(pocket, T, NO_TOOL);
        magazine.set_value(pocket, ST, 0.0);
        line = magazine.next_line(pocket.saturating_add(1));
    }
    for (number, tool) in tools {
        if let Some(pocket) = tool.pocket {
            magazine.set_value(pocket.into(), T, number.into());
            magazine.set_value(pocket.into(), ST, f64::from(u8::from(tool.special)));
        }
    }
}

/// Module 9094 wrote: the tools are as the tables say, the tool in the spindle too.
pub(crate) fn initialise_geometry(
    tools: &mut Tools,
    magazine: &mut Magazine,
    files: &NcFiles,
    offsets: &mut Offsets,
) {
    let before = magazine.length(tools.number);
    take_tables(magazine, files);
    let longer = magazine.length(tools.number) - before;
    // A tool whose data are cancelled counts without length until it is called.
    let cancelled = offsets.tool_length == 0.0 && before != 0.0;
    if !tools.lengthen_held(longer) && !cancelled {
        offsets.tool_length += longer;
    }
}

/// The tools as the tables say.
fn take_tables(tools: &mut Magazine, files: &NcFiles) {
    let (Some(table), Some(magazine)) = (
        files.tables.get(&TableKind::Tool),
        files.tables.get(&TableKind::Pocket),
    ) else {
        return;
    };
    tools.take(|number, loaded| {
        let line = i32::try_from(number).ok()?;
        let value = |element| table.value(line, element);
        let replacement = value(RT)?;
        // Those of the file are in its radii.
        let [loaded_dr, loaded_dr2] = loaded.shape.oversize;
        Some(Tool {
            shape: ToolShape {
                length: value(L)? + value(DL)?,
                radius: value(R)? + value(DR)?,
                corner_radius: value(R2)? + value(DR2)?,
                oversize: [loaded_dr + value(DR)?, loaded_dr2 + value(DR2)?],
                ..loaded.shape
            },
            locked: value(TL)? != 0.0,
            life: ToolLife {
                time1_min: value(TIME1)?,
                time2_min: value(TIME2)?,
                current_min: value(CURRENT_TIME)?,
                replacement: (replacement >= 0.0).then_some(replacement as u32),
            },
            ..loaded
        })
    });
    tools.empty_magazine();
    let mut line = magazine.next_line(0);
    while let Some(pocket) = line {
        let value = |element| magazine.value(pocket, element).unwrap_or_default();
        if value(T) >= 0.0 {
            tools.put(value(T) as u32, pocket, value(ST) != 0.0);
        }
        line = magazine.next_line(pocket.saturating_add(1));
    }
}
