//! Tools: what T and the tool change do to the blocks of tool data [002:1695-2047].

use bahn_system900::PathParameter;

use crate::block::Work;
use crate::refusal::Refusal;

impl Work<'_> {
    /// T of a block, with M6 or M16 beside it: the tool goes to the block of the PLC, and with them to the one by which the path
    /// behind it is computed. T 0 is no tool.
    pub fn tool(&mut self, programmed: Option<i64>, change: Option<u16>) -> Result<(), Refusal> {
        let channel = self.channel;
        let set = |memory: &mut bahn_system900::Memory, parameter, number| {
            memory.set_path(channel, parameter, Some(number));
        };
        if programmed.is_some() || change.is_some() {
            set(self.memory, PathParameter::ToolChange, change.unwrap_or(0).into());
        }
        let Some(group) = programmed else {
            return Ok(());
        };
        set(self.memory, PathParameter::ToolGroup, group);
        let spindle = self.memory.path(channel, PathParameter::SpindleTool).whole();
        let from = match spindle == Some(group) {
            true => PathParameter::SpindleTool.number(),
            false => match self.memory.tool_record(channel, group) {
                Some(record) => record,
                None => return Err(Refusal::of(format!("T{group} is no tool of the channel"))),
            },
        };
        self.memory.copy_tool(channel, from, PathParameter::PlcTool);
        if change.is_some() {
            self.memory.copy_tool(channel, from, PathParameter::ActiveTool);
        }
        if change != Some(16) {
            self.memory.copy_tool(channel, from, PathParameter::RealTimeTool);
        }
        Ok(())
    }
}
