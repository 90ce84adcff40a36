//! The magazine of the machine: the tool table with the pockets as they are now.
//!
//! Decision: A tool with F has two codes under variable coding whatever follows it, and so has the tool that follows;
//! the pocket table stays

use std::collections::BTreeMap;

use bahn_interpreter::ToolState;

use crate::tool::{MovedTool, Tool, ToolLife};

/// W262 for a tool without pocket [000:9273-9283].
pub(crate) const NO_POCKET: i16 = 255;

/// The tool table, which all channels share.
#[derive(Clone, Debug)]
pub(crate) struct Magazine {
    table: Option<BTreeMap<u32, Tool>>,
    /// The pockets as the tool table has them.
    pockets: BTreeMap<u32, Option<u16>>,
    /// Counts the changes of lives, locks and pockets: interpreters are to know which tools must not be called.
    version: u64,
}

/// The kinds of tools that decide how many codes go out [000:9287-9307].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// With a pocket.
    Normal,
    /// Without a pocket: changed by hand.
    Manual,
    /// ST of the pocket table: a special tool, with a pocket.
    Special,
}

impl Magazine {
    /// The tools of a table, in the pockets that are remembered.
    pub fn new(table: Option<BTreeMap<u32, Tool>>, remembered: &[MovedTool]) -> Magazine {
        let pockets = table.iter().flatten();
        let mut magazine = Magazine {
            pockets: pockets.map(|(number, tool)| (*number, tool.pocket)).collect(),
            table,
            version: 0,
        };
        for moved in remembered {
            if let Some(tool) = magazine
                .table
                .as_mut()
                .and_then(|table| table.get_mut(&moved.tool))
            {
                tool.pocket = moved.pocket;
            }
        }
        magazine
    }

    /// Counts the changes that interpreters are to know.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Interpreters are to look at the tools anew.
    pub fn touch(&mut self) {
        self.version += 1;
    }

    /// The file of the pocket table has the tools where they are now, but in one pocket.
    pub fn take_pocket(&mut self, pocket: i32, tool: f64) {
        let Ok(pocket) = u16::try_from(pocket) else {
            return;
        };
        let tools = self.table.iter().flatten();
        let now = tools.map(|(number, own)| (*number, own.pocket.filter(|own| *own != pocket)));
        self.pockets = now.collect();
        if tool >= 0.0
            && let Some(own) = self.pockets.get_mut(&(tool as u32))
        {
            *own = Some(pocket);
        }
    }

    /// The tools that are elsewhere than in the pocket of the tool table.
    pub fn moved(&self) -> Vec<MovedTool> {
        let moved = |(tool, table): (&u32, &Option<u16>)| {
            let pocket = self.tool(*tool).pocket;
            (pocket != *table).then_some(MovedTool {
                tool: *tool,
                pocket,
                table: *table,
            })
        };
        self.pockets.iter().filter_map(moved).collect()
    }

    /// The shapes for the interpreter; `None` when tools are defined in the programs.
    pub fn shapes(&self) -> Option<bahn_interpreter::ToolTable> {
        let table = self.table.as_ref()?;
        Some(table.iter().map(|(number, tool)| (*number, tool.shape)).collect())
    }

    /// The tools that must not be called, for the interpreter.
    pub fn barred(&self) -> BTreeMap<u32, ToolState> {
        let tools = self.table.iter().flatten();
        let states = tools.map(|(number, tool)| (*number, tool.state()));
        states.filter(|(_, state)| *state != ToolState::Usable).collect()
    }

    /// Whether the table has a tool and lets it be called; without a table the programs know.
    pub fn may_be_called(&self, number: u32) -> bool {
        let Some(table) = &self.table else { return true };
        table
            .get(&number)
            .is_some_and(|tool| tool.state() == ToolState::Usable)
    }

    /// All tools of the table.
    pub fn all(&self) -> Option<impl Iterator<Item = (u32, &Tool)> + Clone> {
        let table = self.table.as_ref()?;
        Some(table.iter().map(|(number, tool)| (*number, tool)))
    }

    /// Length of a tool in the table, mm.
    pub fn length(&self, number: u32) -> f64 {
        self.tool(number).shape.length
    }

    /// Radius of a tool in the table, mm.
    pub fn radius(&self, number: u32) -> f64 {
        self.tool(number).shape.radius
    }

    /// How many tools the table has.
    pub fn count(&self) -> usize {
        self.table.as_ref().map_or(0, BTreeMap::len)
    }

    /// The lives of a tool.
    pub fn life(&self, number: u32) -> ToolLife {
        self.tool(number).life
    }

    /// Sets the current life of a tool, minutes; `false` when the table does not have it.
    pub fn set_life(&mut self, number: u32, minutes: f64) -> bool {
        let tool = self.table.as_mut().and_then(|table| table.get_mut(&number));
        let Some(tool) = tool else { return false };
        let before = tool.state();
        tool.life.current_min = minutes;
        // Who reads programs has to know a tool whose life ends or begins anew, not each tenth of a minute.
        self.version += u64::from(tool.state() != before);
        true
    }

    /// Takes the tools as a table has them.
    pub fn take(&mut self, read: impl Fn(u32, Tool) -> Option<Tool>) {
        for (number, tool) in self.table.iter_mut().flatten() {
            *tool = read(*number, *tool).unwrap_or(*tool);
        }
        self.version += 1;
    }

    /// No tool has a pocket, until it is put into one.
    pub fn empty_magazine(&mut self) {
        for tool in self.table.iter_mut().flatten().map(|(_, tool)| tool) {
            tool.pocket = None;
        }
    }

    /// A tool is in a pocket.
    pub fn put(&mut self, number: u32, pocket: i32, special: bool, fixed: bool) {
        if let Some(tool) = self.table.as_mut().and_then(|table| table.get_mut(&number)) {
            tool.pocket = u16::try_from(pocket).ok();
            tool.special = special;
            tool.fixed = fixed;
        }
    }

    pub fn tool(&self, number: u32) -> Tool {
        self.table
            .as_ref()
            .and_then(|table| table.get(&number))
            .copied()
            .unwrap_or_default()
    }

    pub fn kind(&self, number: u32) -> Kind {
        let tool = self.tool(number);
        match (tool.pocket, tool.special) {
            (None, _) => Kind::Manual,
            (_, true) => Kind::Special,
            _ => Kind::Normal,
        }
    }

    /// W262 of a tool: its pocket.
    pub fn pocket(&self, number: u32) -> i16 {
        self.tool(number)
            .pocket
            .and_then(|pocket| i16::try_from(pocket).ok())
            .unwrap_or(NO_POCKET)
    }

    /// Whether the old tool has a code of its own: it does not go where the new one comes from. `own_pocket` is said
    /// of all special tools, F of the pocket table of single ones [000:9153-9155].
    pub fn needs_two(&self, old: u32, new: u32, own_pocket: bool) -> bool {
        if old == 0 || new == 0 {
            return false;
        }
        let fixed = [old, new].into_iter().any(|number| self.tool(number).fixed);
        match (self.kind(old), self.kind(new)) {
            (Kind::Manual, Kind::Manual) => false,
            (Kind::Normal, Kind::Normal) => fixed,
            (Kind::Special, Kind::Special) => own_pocket || fixed,
            _ => true,
        }
    }

    /// Two tools change their pockets, when both have one.
    pub fn swap(&mut self, old: u32, new: u32) {
        let Some(table) = &mut self.table else { return };
        let pocket = |tool| table.get(&tool).and_then(|tool: &Tool| tool.pocket);
        let pockets = [(old, pocket(new)), (new, pocket(old))];
        for (number, pocket) in pockets {
            if let Some(tool) = table.get_mut(&number)
                && tool.pocket.is_some()
                && pocket.is_some()
            {
                tool.pocket = pocket;
            }
        }
    }
}
