//! A tool of the tool table with its lives [000:9160-9192].
//!
//! Decision: What is measured of a tool is kept in 1/10 000 mm, the unit of module 9093

use bahn_interpreter::ToolState;
use bahn_path::ToolShape;

/// A tool of the tool table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tool {
    /// Length, radius, corner radius, mm, with the oversizes.
    pub shape: ToolShape,
    /// Its pocket in the magazine.
    pub pocket: Option<u16>,
    /// A special tool, which takes more than one pocket.
    pub special: bool,
    /// F: its pocket is fixed, it returns there whatever the pocket coding [000:9153-9155].
    pub fixed: bool,
    /// It cuts when the spindle turns counter-clockwise (M4): DIRECT [000:9028].
    pub left_hand: bool,
    /// TL: it is locked and must not be called.
    pub locked: bool,
    /// How long it may work.
    pub life: ToolLife,
    /// What its edges are, and when they are worn or broken.
    pub edges: Edges,
    /// PLC: eight bits for the PLC [000:9029].
    pub plc: u8,
}

/// The edges of a tool and their tolerances, as measuring it wants them [000:9025-9033]. Tolerances of 0 are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edges {
    /// CUT: how many there are.
    pub count: u8,
    /// LTOL: wear of the length, mm.
    pub length_wear: f64,
    /// RTOL: wear of the radius, mm.
    pub radius_wear: f64,
    /// TT:L-OFFS: how much deeper the radius is measured, mm.
    pub length_offset: f64,
    /// TT:R-OFFS: how far from its axis the length is measured, mm.
    pub radius_offset: f64,
    /// LBREAK: deviation of the length by which it is broken, mm.
    pub length_break: f64,
    /// RBREAK: deviation of the radius by which it is broken, mm.
    pub radius_break: f64,
}

impl Tool {
    /// Whether it may be called.
    pub fn state(&self) -> ToolState {
        match self.locked {
            true => ToolState::Locked,
            false => self.life.state(),
        }
    }

    /// L, R and R2 of the tool table, without the oversizes, mm. A table has no finer step than a nanometre.
    pub(crate) fn nominal(&self) -> [f64; 3] {
        let parts = [
            (self.shape.length, self.shape.oversize.length),
            (self.shape.radius, self.shape.oversize.radius),
            (self.shape.corner_radius, self.shape.oversize.corner_radius),
        ];
        parts.map(|(whole, oversize)| match oversize {
            0.0 => whole,
            oversize => ((whole - oversize) * 1e6).round() / 1e6,
        })
    }
}

/// A length as the tool table keeps it, in 1/10 000 mm, the unit of module 9093 (inferred for what is measured).
pub(crate) fn in_table_steps(mm: f64) -> f64 {
    const STEPS_IN_MM: f64 = 10_000.0;
    (mm * STEPS_IN_MM).round() / STEPS_IN_MM
}

/// What was found of a tool, for the tool table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeasuredTool {
    /// Number of the tool.
    pub number: u32,
    /// Of the radius, not of the length.
    pub radius: bool,
    /// The difference becomes its oversize; else it becomes its data.
    pub check: bool,
    /// How much more it is than the table says, mm.
    pub difference: f64,
    /// What a check found.
    pub state: ToolCondition,
}

/// What a check found [000:8025].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ToolCondition {
    /// Within LTOL and RTOL.
    Good,
    /// Beyond LTOL or RTOL.
    Worn,
    /// Beyond LBREAK or RBREAK.
    Broken,
}

/// A tool that is not in the pocket of the tool table any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovedTool {
    /// Number of the tool.
    pub tool: u32,
    /// The pocket in which it is now; `None` when it is in none.
    pub pocket: Option<u16>,
    /// Its pocket in the tool table. Where the table says another one, the magazine was loaded anew.
    pub table: Option<u16>,
}

/// The lives of a tool in the tool table, minutes; 0 is no limit (inferred).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolLife {
    /// TIME1: after it the PLC is told (M2094).
    pub time1_min: f64,
    /// TIME2: after it TOOL CALL calls the replacement tool.
    pub time2_min: f64,
    /// CUR.TIME: how long it has worked.
    pub current_min: f64,
    /// RT: its replacement tool.
    pub replacement: Option<u32>,
}

impl ToolLife {
    /// Whether it may be called.
    pub fn state(&self) -> ToolState {
        match (self.is_beyond(self.time2_min), self.replacement) {
            (false, _) => ToolState::Usable,
            (true, None) => ToolState::Expired,
            (true, Some(replacement)) => ToolState::Replaced(replacement),
        }
    }

    /// It has worked for longer than TIME1.
    pub(crate) fn time1_elapsed(&self) -> bool {
        self.is_beyond(self.time1_min)
    }

    /// M101 replaces it: the first of the two lives is over (inferred: the manual names both).
    pub(crate) fn is_worn(&self) -> bool {
        self.time1_elapsed() || self.is_beyond(self.time2_min)
    }

    fn is_beyond(&self, life_min: f64) -> bool {
        life_min > 0.0 && self.current_min > life_min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_life_of_zero_never_ends() {
        let life = |time1_min, time2_min, current_min| ToolLife {
            time1_min,
            time2_min,
            current_min,
            replacement: None,
        };
        assert_eq!(life(0.0, 0.0, 1e6).state(), ToolState::Usable);
        assert!(!life(0.0, 0.0, 1e6).is_worn());
        // Greater than, not equal [000:9168-9173].
        assert_eq!(life(10.0, 20.0, 20.0).state(), ToolState::Usable);
        assert_eq!(life(10.0, 20.0, 20.1).state(), ToolState::Expired);
        assert!(!life(10.0, 20.0, 10.0).time1_elapsed() && life(10.0, 20.0, 10.1).time1_elapsed());
        assert!(life(0.0, 20.0, 20.1).is_worn() && life(10.0, 0.0, 10.1).is_worn());
    }
}
