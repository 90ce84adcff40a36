//! Commands of modules to PLC axes and spindle.

/// A command to a PLC axis. Feed rates are in mm/min or degrees/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlcAxisCommand {
    /// Module 9120: positioning.
    Start {
        /// Target or distance in mm or degrees.
        target: f64,
        /// The target is a distance.
        incremental: bool,
        /// Feed rate; it is not checked and may be negative.
        feed: f64,
    },
    /// Module 9121: the axis stops.
    Stop,
    /// Until the reference mark is found; no limit switches, no override. Clears a positioning error (9123).
    TraverseReferenceMarks {
        /// Feed rate; it is not checked and may be negative.
        feed: f64,
        /// The marks are looked for in negative direction.
        negative: bool,
    },
}

/// What a PLC axis does [000:15951-15958].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlcAxisStatus {
    /// It is over its reference point; cleared at power-on.
    pub referenced: bool,
    /// A positioning of it is on its way.
    pub positioning: bool,
    /// It moves in negative direction.
    pub negative: bool,
    /// A positioning error occurred.
    pub error: bool,
}

/// A TOOL CALL that the PLC inserts [000:16100-16113].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolCallBlock {
    /// Tool number, not checked; `None` keeps the active one.
    pub tool: Option<i32>,
    /// Tool axis, 0 to 4 meant but not checked; `None` keeps the active one.
    pub axis: Option<i32>,
    /// Spindle speed in rpm, not checked; `None` keeps the active one.
    pub speed: Option<f64>,
    /// Oversize in length DL, mm.
    pub length_oversize: f64,
    /// Oversize in radius DR, mm.
    pub radius_oversize: f64,
}

/// An orientation of the spindle [000:16139-16152].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleOrientation {
    /// Angle of the oriented stop, degrees.
    pub angle: f64,
    /// The angle is added to that of CYCL DEF 13.
    pub added_to_cycle: bool,
    /// Speed in rpm, not negative.
    pub speed: f64,
    /// Direction when the spindle stands.
    pub direction: OrientationDirection,
}

/// In which direction a standing spindle is oriented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrientationDirection {
    /// In the direction of M04.
    Negative,
    /// In the direction in which the angle is nearer.
    Shortest,
    /// In the direction of M03.
    Positive,
}
