//! What is said of a program that was executed while it was transferred.

use std::collections::BTreeMap;

use serde::Serialize;

/// What is told of a program that was executed from a line.
#[derive(Debug, Serialize)]
pub(super) struct DncReport {
    pub program: String,
    pub completed: bool,
    /// Blocks that were acknowledged.
    pub blocks: u64,
    /// Blocks that were executed.
    pub executed: u64,
    /// Of the workpiece, by axis letter, mm and degrees.
    pub position: BTreeMap<char, f64>,
    pub message: Option<String>,
    pub machining_time_s: f64,
}

impl DncReport {
    /// The report as lines for people.
    pub fn text(&self) -> String {
        let position: Vec<String> = self
            .position
            .iter()
            .map(|(letter, at)| format!("{letter}{at:+.3}"))
            .collect();
        let end = match (&self.message, self.completed) {
            (Some(message), _) => message.as_str(),
            (None, true) => "completed",
            (None, false) => "interrupted",
        };
        format!(
            "{}: {end}\n  blocks    {} transferred, {} executed\n  position  {}\n  time      {}\n",
            self.program,
            self.blocks,
            self.executed,
            position.join(" "),
            bahn_report::text::clock(self.machining_time_s)
        )
    }
}
