//! Settings of the tool probe TT 110 [000:7960-8058].

use bahn_path::Direction;

use crate::ParameterList;

/// How the TT 110 is approached, and what it measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolProbeParameters {
    /// The cycles for measuring tools are permitted: MP6500 = 1.
    pub enabled: bool,
    /// Radii are probed in the 90° axis, not in the angle reference axis: MP6505 = 1 or 3.
    pub across: bool,
    /// Where radii are probed: MP6505, minus with 2 or 3.
    pub direction: Direction,
    /// How the probing feed follows from the radius: MP6507.
    pub tolerance: ToolProbeTolerance,
    /// Greatest measuring error with a rotating tool, mm: MP6510.
    pub error_mm: f64,
    /// Probing feed with a standing tool, mm/min: MP6520.
    pub standing_mm_min: f64,
    /// How the spindle is oriented for standing tools: MP6560.
    pub orientation: ProbeOrientation,
    /// How far below the top of the contact radii are measured, mm: MP6530.
    pub depth_mm: f64,
    /// Diameter or edge length of the contact, mm: MP6531.
    pub width_mm: f64,
    /// Safety zone around the contact, mm: MP6540.
    pub safety_mm: f64,
    /// Rapid traverse in the cycle, mm/min: MP6550.
    pub rapid_mm_min: f64,
    /// Greatest surface speed of the edge, m/min: MP6570.
    pub surface_m_min: f64,
    /// Centre of the contact from the machine datum, X, Y, Z, mm: MP6580.
    pub centre_mm: [f64; 3],
}

/// Who orients the spindle when a standing tool is measured: MP6560 [000:7978-7982].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeOrientation {
    /// 0: not at all; standing tools are not measured.
    None,
    /// -1: by the NC itself.
    Nc,
    /// 1 to 88: by the PLC with this M function, to the angle of cycle 13.
    Plc(u8),
}

/// How the permissible error of MP6510 follows the radius of a turning tool: MP6507 [000:8007-8021].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolProbeTolerance {
    /// 0: MP6510 whatever the radius.
    Constant,
    /// 1: once more MP6510 for every 30 mm of the radius.
    Stepped,
    /// 2: in proportion to the radius, so that the feed stays the same.
    ConstantFeed,
}

impl ParameterList {
    /// The tool probe; where there is none, nothing is permitted.
    pub fn tool_probe(&self) -> ToolProbeParameters {
        let value = |number: u16, index: u8| self.get_new(number, index).unwrap_or_default();
        let direction = value(6505, 0) as u8;
        ToolProbeParameters {
            enabled: value(6500, 0) == 1.0,
            across: direction & 1 == 1,
            direction: Direction::minus_if(direction >= 2),
            tolerance: match value(6507, 0) as u8 {
                0 => ToolProbeTolerance::Constant,
                1 => ToolProbeTolerance::Stepped,
                _ => ToolProbeTolerance::ConstantFeed,
            },
            error_mm: value(6510, 0),
            standing_mm_min: value(6520, 0),
            orientation: match value(6560, 0) {
                0.0 => ProbeOrientation::None,
                code if code < 0.0 => ProbeOrientation::Nc,
                code => ProbeOrientation::Plc(code as u8),
            },
            depth_mm: value(6530, 0),
            width_mm: value(6531, 0),
            safety_mm: value(6540, 0),
            rapid_mm_min: value(6550, 0),
            surface_m_min: value(6570, 0),
            centre_mm: [0, 1, 2].map(|index| value(6580, index)),
        }
    }
}
