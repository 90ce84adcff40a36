//! A tool probe on the table: its contact is deflected by the tool in the spindle.

use crate::reader::Section;
use crate::spindle::SpindleState;

/// Slower than this the teeth of a tool are felt one by one, rpm.
const STANDS_RPM: f64 = 1.0;

/// A tooth of a tool that is not round.
#[derive(Clone, Copy, Debug)]
struct Tooth {
    length: f64,
    radius: f64,
}

/// A tool as it really is, whatever the tables say.
#[derive(Clone, Debug)]
struct TrueTool {
    number: u32,
    /// Of its longest teeth.
    length: f64,
    radius: f64,
    /// In equal steps; the first looks in the first axis of the contact's plane when the spindle is at 0°.
    teeth: Vec<Tooth>,
}

impl TrueTool {
    fn read(section: Section) -> TrueTool {
        let length = section.needed_number("length", 0.0..=10_000.0);
        let radius = section.needed_number("radius", 0.0..=1000.0);
        let tooth = |section: Section| {
            let tooth = Tooth {
                length: section.number("length", 0.0..=length).unwrap_or(length),
                radius: section.number("radius", 0.0..=radius).unwrap_or(radius),
            };
            section.finish();
            tooth
        };
        let tool = TrueTool {
            number: section.needed_number("number", 1.0..=32_767.0) as u32,
            length,
            radius,
            teeth: section.list("tooth").into_iter().map(tooth).collect(),
        };
        section.finish();
        tool
    }
}

/// See the module. The contact is a disc, in positions of the axes X, Y, Z.
#[derive(Clone, Debug)]
pub(crate) struct ToolProbe {
    /// Middle of its upper face.
    centre: [f64; 3],
    diameter: f64,
    /// The axis in which its upper face looks, and those of the face: places of X, Y, Z.
    axes: [usize; 3],
    tools: Vec<TrueTool>,
    pub ready: bool,
}

impl ToolProbe {
    /// The tool probe as the section `[tool_probe]` of the machine file describes it.
    pub fn read(section: Section) -> ToolProbe {
        let mut tools: Vec<TrueTool> = Vec::new();
        for own in section.list("tool") {
            let number = own.number("number", 1.0..=32_767.0);
            if let Some(number) =
                number.filter(|number| tools.iter().any(|tool| f64::from(tool.number) == *number))
            {
                own.fault_at("number", format!("tool {number} stands here already"));
            }
            tools.push(TrueTool::read(own));
        }
        if !section.has("centre") {
            section.fault("[tool_probe] needs centre".to_owned());
        }
        let axes = match section.text("axis") {
            None | Some("Z") => [2, 0, 1],
            Some("Y") => [1, 2, 0],
            Some("X") => [0, 1, 2],
            Some(_) => {
                section.fault_at("axis", "axis is \"X\", \"Y\" or \"Z\"".to_owned());
                [2, 0, 1]
            }
        };
        let probe = ToolProbe {
            tools,
            centre: section.numbers::<3>("centre").unwrap_or_default(),
            diameter: section.needed_number("diameter", 0.001..=1000.0),
            axes,
            ready: true,
        };
        section.finish();
        probe
    }

    /// Whether a tool in the spindle touches the contact, with the axes X, Y, Z at a position. A tool that turns is
    /// as long and as thick as its longest teeth.
    pub fn deflected(
        &self,
        tool: u32,
        position: [f64; 3],
        spindle: impl Fn() -> Option<SpindleState>,
    ) -> bool {
        let Some(tool) = self.tools.iter().find(|own| own.number == tool) else {
            return false;
        };
        let off = |axis: usize| {
            let at = position.get(axis).zip(self.centre.get(axis));
            at.map_or(f64::NAN, |(position, centre)| position - centre)
        };
        let [height, first, second] = self.axes.map(off);
        let contact = self.diameter / 2.0;
        let reach = tool.radius + contact;
        // No distance is shorter than its components: most of the time the tool is far off.
        let may = height < tool.length && first.abs() < reach && second.abs() < reach;
        let near = may && first.hypot(second) < reach;
        if !near || tool.teeth.is_empty() {
            return near;
        }
        let Some(spindle) = spindle().filter(|spindle| spindle.rpm.abs() < STANDS_RPM) else {
            return near;
        };
        let pitch = 360.0 / tool.teeth.len() as f64;
        let touches = |(place, tooth): (usize, &Tooth)| {
            let (sin, cos) = (place as f64 * pitch - spindle.angle_deg).to_radians().sin_cos();
            let tip = (first + tooth.radius * cos).hypot(second + tooth.radius * sin);
            height < tooth.length && tip < contact
        };
        tool.teeth.iter().enumerate().any(touches)
    }
}
