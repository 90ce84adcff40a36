//! The markers and words that exist once for each axis, by axis index: X, Y, Z, 4, 5.

use bahn_exchange::signal::*;
use bahn_exchange::{Bit, Number};
use bahn_parameters::PLC_AXES;

/// Axes that have markers.
pub(crate) const AXES: usize = PLC_AXES;

/// M2000 ff.: the axis is held in its position loop.
pub(crate) const ENABLED: [Bit; AXES] = [
    AXIS_X_ENABLED,
    AXIS_Y_ENABLED,
    AXIS_Z_ENABLED,
    AXIS_4_ENABLED,
    AXIS_5_ENABLED,
];
/// M2008 ff.: the axis is in its positioning window.
pub(crate) const IN_POSITION: [Bit; AXES] = [
    AXIS_X_IN_POSITION,
    AXIS_Y_IN_POSITION,
    AXIS_Z_IN_POSITION,
    AXIS_4_IN_POSITION,
    AXIS_5_IN_POSITION,
];
/// M2012 ff.: the axis asks for lubrication.
pub(crate) const LUBRICATION_PULSE: [Bit; AXES] = [
    LUBRICATION_PULSE_AXIS_X,
    LUBRICATION_PULSE_AXIS_Y,
    LUBRICATION_PULSE_AXIS_Z,
    LUBRICATION_PULSE_AXIS_4,
    LUBRICATION_PULSE_AXIS_5,
];
/// M2548 ff.: the PLC lubricated the axis.
pub(crate) const LUBRICATED: [Bit; AXES] = [
    RESET_LUBRICATION_PATH_AXIS_X,
    RESET_LUBRICATION_PATH_AXIS_Y,
    RESET_LUBRICATION_PATH_AXIS_Z,
    RESET_LUBRICATION_PATH_AXIS_4,
    RESET_LUBRICATION_PATH_AXIS_5,
];
/// M2128 ff.: the axis moves.
pub(crate) const IN_MOTION: [Bit; AXES] = [
    AXIS_X_IN_MOTION,
    AXIS_Y_IN_MOTION,
    AXIS_Z_IN_MOTION,
    AXIS_4_IN_MOTION,
    AXIS_5_IN_MOTION,
];
/// M2136 ff.: the reference mark of the axis is not passed yet.
pub(crate) const REFERENCE_MISSING: [Bit; AXES] = [
    REFERENCE_MISSING_AXIS_X,
    REFERENCE_MISSING_AXIS_Y,
    REFERENCE_MISSING_AXIS_Z,
    REFERENCE_MISSING_AXIS_4,
    REFERENCE_MISSING_AXIS_5,
];
/// M2160 ff.: direction of traverse, 1 = negative.
pub(crate) const NEGATIVE_TRAVERSE: [Bit; AXES] = [
    TRAVERSE_DIRECTION_AXIS_X,
    TRAVERSE_DIRECTION_AXIS_Y,
    TRAVERSE_DIRECTION_AXIS_Z,
    TRAVERSE_DIRECTION_AXIS_4,
    TRAVERSE_DIRECTION_AXIS_5,
];
/// M2492 ff.: wait for the loop to be opened after the axis was positioned.
pub(crate) const WAIT_OPEN_LOOP: [Bit; AXES] = [
    WAIT_OPEN_LOOP_AXIS_X,
    WAIT_OPEN_LOOP_AXIS_Y,
    WAIT_OPEN_LOOP_AXIS_Z,
    WAIT_OPEN_LOOP_AXIS_4,
    WAIT_OPEN_LOOP_AXIS_5,
];
/// M2544 ff.: open the position loop.
pub(crate) const OPEN_LOOP: [Bit; AXES] = [
    OPEN_CONTROL_LOOP_AXIS_X,
    OPEN_CONTROL_LOOP_AXIS_Y,
    OPEN_CONTROL_LOOP_AXIS_Z,
    OPEN_CONTROL_LOOP_AXIS_4,
    OPEN_CONTROL_LOOP_AXIS_5,
];
/// M2552 ff.: the actual value becomes the nominal value.
pub(crate) const ACTUAL_TO_NOMINAL: [Bit; AXES] = [
    ACTUAL_TO_NOMINAL_AXIS_X,
    ACTUAL_TO_NOMINAL_AXIS_Y,
    ACTUAL_TO_NOMINAL_AXIS_Z,
    ACTUAL_TO_NOMINAL_AXIS_4,
    ACTUAL_TO_NOMINAL_AXIS_5,
];
/// M2556 ff.: the cam of the reference end position is closed.
pub(crate) const REFERENCE_CAM: [Bit; AXES] = [
    REFERENCE_END_POSITION_AXIS_X,
    REFERENCE_END_POSITION_AXIS_Y,
    REFERENCE_END_POSITION_AXIS_Z,
    REFERENCE_END_POSITION_AXIS_4,
    REFERENCE_END_POSITION_AXIS_5,
];
/// M2616 ff.: the pulse of the reference mark does not count; four axes [001:946-949].
pub(crate) const REFERENCE_INHIBIT: [Bit; 4] = [
    REFERENCE_PULSE_INHIBIT_AXIS_X,
    REFERENCE_PULSE_INHIBIT_AXIS_Y,
    REFERENCE_PULSE_INHIBIT_AXIS_Z,
    REFERENCE_PULSE_INHIBIT_AXIS_4,
];
/// M2624 ff.: software limit switch, plus and minus.
pub(crate) const LIMIT: [[Bit; 2]; AXES] = [
    [LIMIT_REACHED_X_PLUS, LIMIT_REACHED_X_MINUS],
    [LIMIT_REACHED_Y_PLUS, LIMIT_REACHED_Y_MINUS],
    [LIMIT_REACHED_Z_PLUS, LIMIT_REACHED_Z_MINUS],
    [LIMIT_REACHED_4_PLUS, LIMIT_REACHED_4_MINUS],
    [LIMIT_REACHED_5_PLUS, LIMIT_REACHED_5_MINUS],
];
/// M2688 ff.: position, standstill, movement and voltage are not monitored.
pub(crate) const MONITORING_OFF: [Bit; AXES] = [
    MONITORING_OFF_AXIS_X,
    MONITORING_OFF_AXIS_Y,
    MONITORING_OFF_AXIS_Z,
    MONITORING_OFF_AXIS_4,
    MONITORING_OFF_AXIS_5,
];
/// M2704 ff.: PLC positioning.
pub(crate) const PLC_POSITIONING: [Bit; AXES] = [
    POSITION_AXIS_X,
    POSITION_AXIS_Y,
    POSITION_AXIS_Z,
    POSITION_AXIS_4,
    POSITION_AXIS_5,
];
/// D528 ff.: target of PLC positioning, or datum correction, 1/10 000 mm.
pub(crate) const TRANSFER: [Number; AXES] = [
    TRANSFER_VALUE,
    TRANSFER_VALUE_Y,
    TRANSFER_VALUE_Z,
    TRANSFER_VALUE_AXIS_4,
    TRANSFER_VALUE_AXIS_5,
];
/// W560 ff.: feed of PLC positioning, mm/min.
pub(crate) const POSITIONING_FEED: [Number; AXES] = [
    POSITIONING_FEED_AXIS_X,
    POSITIONING_FEED_AXIS_Y,
    POSITIONING_FEED_AXIS_Z,
    POSITIONING_FEED_AXIS_4,
    POSITIONING_FEED_AXIS_5,
];
/// Voltages and temperatures of the two PLC extensions [000:8449-8484].
pub(crate) const ANALOGUE: [[[Number; 4]; 2]; 2] = [
    [
        [
            ANALOGUE_0_EXTENSION_1,
            ANALOGUE_1_EXTENSION_1,
            ANALOGUE_2_EXTENSION_1,
            ANALOGUE_3_EXTENSION_1,
        ],
        [
            THERMISTOR_0_EXTENSION_1,
            THERMISTOR_1_EXTENSION_1,
            THERMISTOR_2_EXTENSION_1,
            THERMISTOR_3_EXTENSION_1,
        ],
    ],
    [
        [
            ANALOGUE_0_EXTENSION_2,
            ANALOGUE_1_EXTENSION_2,
            ANALOGUE_2_EXTENSION_2,
            ANALOGUE_3_EXTENSION_2,
        ],
        [
            THERMISTOR_0_EXTENSION_2,
            THERMISTOR_1_EXTENSION_2,
            THERMISTOR_2_EXTENSION_2,
            THERMISTOR_3_EXTENSION_2,
        ],
    ],
];
/// W576 ff.: lag tracking, 1/10 µm.
pub(crate) const LAG_TRACKING: [Number; AXES] = [
    LAG_COMPENSATION_AXIS_X,
    LAG_COMPENSATION_AXIS_Y,
    LAG_COMPENSATION_AXIS_Z,
    LAG_COMPENSATION_AXIS_4,
    LAG_COMPENSATION_AXIS_5,
];
/// M2100 ff.: the tool axis; the 5th axis cannot be it [000:3410-3416].
pub(crate) const TOOL_AXIS: [Bit; 4] = [
    AXIS_X_TOOL_AXIS,
    AXIS_Y_TOOL_AXIS,
    AXIS_Z_TOOL_AXIS,
    AXIS_4_TOOL_AXIS,
];
