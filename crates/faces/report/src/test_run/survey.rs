//! What the table of a shelf says of a run beyond its report: the use of every tool and the travel of every axis.

use bahn_motion::Planned;
use bahn_path::{Axis, Blank, Curve, FeedRate, Function, Position};

/// How long a tool is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolUse {
    /// `None` before the first TOOL CALL.
    pub tool: Option<u32>,
    pub radius_mm: f64,
    pub time_s: f64,
    pub feed_mm: f64,
    pub rapid_mm: f64,
}

/// Collects while the path runs. Its size is bounded by the tools of a control.
#[derive(Clone, Debug)]
pub struct Survey {
    uses: Vec<ToolUse>,
    /// The tool in the spindle as index into `uses`, its axis and its length.
    current: usize,
    tool_axis: Axis,
    length_mm: f64,
    /// Least and greatest position of the tip.
    tip: [Position; 2],
    /// The same of the spindle nose, which is higher by the length of the tool.
    nose: [Position; 2],
    pub blank: Option<Blank>,
}

impl Default for Survey {
    fn default() -> Survey {
        Survey {
            uses: vec![ToolUse::default()],
            current: 0,
            tool_axis: Axis::Z,
            length_mm: 0.0,
            tip: [Position::UNKNOWN; 2],
            nose: [Position::UNKNOWN; 2],
            blank: None,
        }
    }
}

impl Survey {
    /// Takes an element that was executed.
    #[inline]
    pub fn element(&mut self, planned: &Planned) {
        let element = &planned.element;
        for function in element.functions() {
            match &function.function {
                Function::Tool(call) => {
                    self.take_tool(call.tool, call.shape.radius);
                    (self.tool_axis, self.length_mm) = (call.axis, call.shape.length);
                }
                Function::Blank(blank) => {
                    self.blank.get_or_insert(*blank);
                }
                _ => {}
            }
        }
        let length = element.curve.linear_length(&element.start, &element.end);
        if let Some(tool) = self.uses.get_mut(self.current) {
            tool.time_s += planned.duration_s();
            match element.feed {
                FeedRate::Rapid => tool.rapid_mm += length,
                FeedRate::Programmed(_) => tool.feed_mm += length,
            }
        }
        if element.curve != Curve::Hold {
            let mut bounds = element.curve.bounds(&element.start, &element.end);
            widen(&mut self.tip, &bounds);
            for bound in &mut bounds {
                bound[self.tool_axis] += self.length_mm;
            }
            widen(&mut self.nose, &bounds);
        }
    }

    fn take_tool(&mut self, number: u32, radius_mm: f64) {
        let tool = Some(number);
        self.current = match self.uses.iter().position(|known| known.tool == tool) {
            Some(at) => at,
            None => {
                self.uses.push(ToolUse {
                    tool,
                    radius_mm,
                    ..ToolUse::default()
                });
                self.uses.len() - 1
            }
        };
    }

    /// The tools in the order of their first call; what runs without one only when it takes time.
    pub fn uses(&self) -> impl Iterator<Item = &ToolUse> {
        self.uses
            .iter()
            .filter(|tool| tool.tool.is_some() || tool.time_s > 0.0)
    }

    /// Least and greatest position of an axis in workpiece coordinates: of the tip, and of the spindle nose.
    pub fn travel(&self, axis: Axis) -> Option<([f64; 2], [f64; 2])> {
        let range = |[least, greatest]: &[Position; 2]| Some([least.get(axis)?, greatest.get(axis)?]);
        Some((range(&self.tip)?, range(&self.nose)?))
    }
}

fn widen(range: &mut [Position; 2], [least, greatest]: &[Position; 2]) {
    // `f64::min` and `max` pass over NaN.
    for axis in Axis::ALL {
        range[0][axis] = range[0][axis].min(least[axis]);
        range[1][axis] = range[1][axis].max(greatest[axis]);
    }
}
