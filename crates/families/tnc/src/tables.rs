//! Tool and pocket table as modules 9092 to 9094 see them [000:15375-15545]: what the PLC writes there counts
//! at once and survives power-off.
//!
//! Decision: What module 9094 writes is kept beside the tool table; a tool table that was changed since counts

use std::collections::BTreeMap;

use bahn_kernel::Offsets;
use bahn_path::{Oversize, ToolShape};
use bahn_plc::{MemoryTable, TableFile, TableKind};

use crate::magazine::Magazine;
use crate::plc_link::{NcFiles, Pocket, WrittenElement, differences};
use crate::tool::{Edges, MeasuredTool, Tool, ToolCondition, ToolLife, in_table_steps};
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
const CUT: usize = 13;
const LTOL: usize = 14;
const RTOL: usize = 15;
const DIRECT: usize = 16;
const PLC: usize = 17;
const L_OFFS: usize = 18;
const R_OFFS: usize = 19;
const LBREAK: usize = 20;
const RBREAK: usize = 21;
/// Elements of the pocket table [000:15422-15429].
pub(crate) const T: usize = 0;
const ST: usize = 1;
const F: usize = 2;
const LOCKED: usize = 3;
const POCKET_PLC: usize = 4;
/// No tool in a pocket, no replacement tool.
const NO_TOOL: f64 = -1.0;

/// The tables as they were loaded: what differs from them was written.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadedTables(Vec<MemoryTable>);

impl LoadedTables {
    /// The tables of a tool table. The pocket table has a line for each pocket of the magazine (MP7261) and line 0
    /// [000:9057-9072]; without pockets there is none [000:9113].
    fn of<'t>(
        tools: impl Iterator<Item = (u32, &'t Tool)> + Clone,
        pockets: u32,
        lines: &BTreeMap<u16, Pocket>,
    ) -> LoadedTables {
        let line = |number: u32| i32::try_from(number).unwrap_or(i32::MAX);
        let mut table =
            MemoryTable::with_lines(TableKind::Tool, tools.clone().map(|(number, _)| line(number)));
        for (number, tool) in tools.clone() {
            for (element, value) in elements(tool) {
                table.set_value(line(number), element, value);
            }
        }
        let used = tools.clone().filter_map(|(_, tool)| tool.pocket);
        let last = used.chain(lines.keys().copied()).map(u32::from).max();
        let last = last.unwrap_or(0).max(pockets);
        if last == 0 {
            return LoadedTables(vec![table]);
        }
        let mut magazine = MemoryTable::with_lines(TableKind::Pocket, 0..=line(last));
        for (pocket, said) in lines {
            for (element, value) in [
                (F, u8::from(said.fixed)),
                (LOCKED, u8::from(said.locked)),
                (POCKET_PLC, said.plc),
            ] {
                magazine.set_value((*pocket).into(), element, value.into());
            }
        }
        for (number, tool) in tools {
            if let Some(pocket) = tool.pocket {
                magazine.set_value(pocket.into(), T, number.into());
                magazine.set_value(pocket.into(), ST, f64::from(u8::from(tool.special)));
            }
        }
        LoadedTables(vec![table, magazine])
    }
}

/// A line of the tool table.
fn elements(tool: &Tool) -> [(usize, f64); 20] {
    let ([length, radius, corner_radius], oversize) = (tool.nominal(), tool.shape.oversize);
    let (life, edges) = (tool.life, tool.edges);
    [
        (L, length),
        (R, radius),
        (R2, corner_radius),
        (DL, oversize.length),
        (DR, oversize.radius),
        (DR2, oversize.corner_radius),
        (RT, life.replacement.map_or(NO_TOOL, f64::from)),
        (TIME1, life.time1_min),
        (TIME2, life.time2_min),
        (CURRENT_TIME, life.current_min),
        (TL, f64::from(u8::from(tool.locked))),
        (CUT, edges.count.into()),
        (LTOL, edges.length_wear),
        (RTOL, edges.radius_wear),
        (DIRECT, f64::from(u8::from(tool.left_hand))),
        (PLC, tool.plc.into()),
        (L_OFFS, edges.length_offset),
        (R_OFFS, edges.radius_offset),
        (LBREAK, edges.length_break),
        (RBREAK, edges.radius_break),
    ]
}

/// A tool as its line says.
fn tool_of(value: impl Fn(usize) -> Option<f64>, loaded: Tool) -> Option<Tool> {
    let replacement = value(RT)?;
    let oversize = Oversize {
        length: value(DL)?,
        radius: value(DR)?,
        corner_radius: value(DR2)?,
    };
    Some(Tool {
        shape: ToolShape {
            length: value(L)? + oversize.length,
            radius: value(R)? + oversize.radius,
            corner_radius: value(R2)? + oversize.corner_radius,
            oversize,
            ..loaded.shape
        },
        locked: value(TL)? != 0.0,
        left_hand: value(DIRECT)? != 0.0,
        life: ToolLife {
            time1_min: value(TIME1)?,
            time2_min: value(TIME2)?,
            current_min: value(CURRENT_TIME)?,
            replacement: (replacement >= 0.0).then_some(replacement as u32),
        },
        edges: Edges {
            count: value(CUT)? as u8,
            length_wear: value(LTOL)?,
            radius_wear: value(RTOL)?,
            length_offset: value(L_OFFS)?,
            radius_offset: value(R_OFFS)?,
            length_break: value(LBREAK)?,
            radius_break: value(RBREAK)?,
        },
        plc: value(PLC)? as u8,
        ..loaded
    })
}

impl LoadedTables {
    /// The tables at power-on, with what was written before, for a magazine with so many pockets. Elements whose
    /// table has changed since are as it says.
    pub fn set_up(
        tools: &mut Magazine,
        files: &mut NcFiles,
        written: &[WrittenElement],
        pockets: u32,
    ) -> LoadedTables {
        let Some(all) = tools.all() else {
            return LoadedTables::default();
        };
        let loaded = LoadedTables::of(all, pockets, &files.pockets);
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

    /// The file of a table says something else from now on.
    pub fn take(&mut self, kind: TableKind, line: i32, element: usize, value: f64) {
        let table = self.0.iter_mut().find(|table| table.kind() == kind);
        if let Some(table) = table {
            table.set_value(line, element, value);
        }
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

/// The tool probe has measured a tool: its data, or with a check its oversize and whether it is locked. A broken tool
/// keeps its data (inferred).
pub(crate) fn take_measured(measured: &MeasuredTool, magazine: &mut Magazine, files: &mut NcFiles) {
    let Ok(line) = i32::try_from(measured.number) else {
        return;
    };
    let Some(table) = files.tables.get_mut(&TableKind::Tool) else {
        return;
    };
    let (data, oversize) = if measured.radius { (R, DR) } else { (L, DL) };
    let value = |table: &MemoryTable, element| table.value(line, element).unwrap_or_default();
    if measured.state != ToolCondition::Good {
        table.set_value(line, TL, 1.0);
    }
    if measured.check {
        if measured.state != ToolCondition::Broken {
            let sum = value(table, oversize) + measured.difference;
            table.set_value(line, oversize, in_table_steps(sum));
        }
    } else {
        let sum = value(table, data) + value(table, oversize) + measured.difference;
        table.set_value(line, data, in_table_steps(sum));
        table.set_value(line, oversize, 0.0);
    }
    take_tables(magazine, files);
}

/// The tools as the tables say.
fn take_tables(tools: &mut Magazine, files: &NcFiles) {
    let Some(table) = files.tables.get(&TableKind::Tool) else {
        return;
    };
    tools.take(|number, loaded| {
        let line = i32::try_from(number).ok()?;
        tool_of(|element| table.value(line, element), loaded)
    });
    let Some(magazine) = files.tables.get(&TableKind::Pocket) else {
        return;
    };
    tools.empty_magazine();
    let mut line = magazine.next_line(0);
    while let Some(pocket) = line {
        let value = |element| magazine.value(pocket, element).unwrap_or_default();
        if value(T) >= 0.0 {
            tools.put(value(T) as u32, pocket, value(ST) != 0.0, value(F) != 0.0);
        }
        line = magazine.next_line(pocket.saturating_add(1));
    }
}
