//! A tool probe on the table: its contact is deflected by the tool in the spindle.

use crate::reader::Section;

/// A tool as it really is, whatever the tables say.
#[derive(Clone, Copy, Debug)]
struct TrueTool {
    number: u32,
    length: f64,
    radius: f64,
}

/// See the module. The contact is a disc, in positions of the axes X, Y, Z.
#[derive(Clone, Debug)]
pub(crate) struct ToolProbe {
    /// Middle of its upper face.
    centre: [f64; 3],
    diameter: f64,
    tools: Vec<TrueTool>,
    pub ready: bool,
}

impl ToolProbe {
    /// Reads `[tool_probe]`.
    pub fn read(section: Section) -> ToolProbe {
        let tools = section.list("tool").into_iter().map(|section| {
            let tool = TrueTool {
                number: section.needed_number("number", 1.0..=32_767.0) as u32,
                length: section.needed_number("length", 0.0..=10_000.0),
                radius: section.needed_number("radius", 0.0..=1000.0),
            };
            section.finish();
            tool
        });
        if !section.has("centre") {
            section.fault("[tool_probe] needs centre".to_owned());
        }
        let probe = ToolProbe {
            tools: tools.collect(),
            centre: section.numbers::<3>("centre").unwrap_or_default(),
            diameter: section.needed_number("diameter", 0.001..=1000.0),
            ready: true,
        };
        section.finish();
        probe
    }

    /// Whether a tool in the spindle touches the contact, with the axes X, Y, Z at a position.
    pub fn deflected(&self, tool: u32, position: [f64; 3]) -> bool {
        let Some(tool) = self.tools.iter().find(|own| own.number == tool) else {
            return false;
        };
        let [x, y, z] = [0, 1, 2].map(|place: usize| position[place] - self.centre[place]);
        z - tool.length < 0.0 && x.hypot(y) < tool.radius + self.diameter / 2.0
    }
}
