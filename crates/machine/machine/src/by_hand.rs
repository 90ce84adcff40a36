//! The tool that somebody has put into the spindle by hand.
//!
//! Decision: Who changes a tool by hand puts in the one that is called, unless the arm of the magazine has moved one
//! since power-on

/// See the module. 0 is no tool.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ByHand {
    tool: u32,
    called: u32,
}

impl ByHand {
    /// Somebody puts a tool into the spindle, whichever is called.
    pub fn insert(&mut self, tool: u32) {
        self.tool = tool;
    }

    /// The tool that is called goes into the spindle, once for each call; whether this is a call.
    pub fn called(&mut self, tool: u32) -> bool {
        let is_call = self.called != tool;
        if is_call {
            (self.called, self.tool) = (tool, tool);
        }
        is_call
    }

    /// The tool, and the one that was called.
    pub fn place(self) -> [u32; 2] {
        [self.tool, self.called]
    }

    /// Puts the tools back as they were at power-off.
    pub fn stand_at(&mut self, [tool, called]: [u32; 2]) {
        (self.tool, self.called) = (tool, called);
    }

    pub fn tool(self) -> u32 {
        self.tool
    }
}
