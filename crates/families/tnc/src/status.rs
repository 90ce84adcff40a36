//! What the NC tells the PLC of itself: markers and words of state, before every scan.
//!
//! Decision: Type 6 of modules 9040 and 9041 is the actual value less the datum shift of the program alone, whatever
//! is turned or mirrored around it

use bahn_exchange::{Exchange, signal};
use bahn_kernel::{AxisUnit, Chain, OwnAxes, RunState, path_positions};
use bahn_parameters::PerPlcAxis;
use bahn_parameters::machining::MeasuringProbe;
use bahn_path::{Direction, Position, deflection_along_axes};
use bahn_plc::{CoordinateKind, StatusItem};
use bahn_servo::Measured;

use crate::command::Mode;
use crate::manual::Manual;
use crate::markers::{
    ANALOGUE, ENABLED, IN_MOTION, IN_POSITION, LIMIT, NEGATIVE_TRAVERSE, REFERENCE_MISSING,
};
use crate::plc_link::PlcLink;
use crate::run::ProgramRun;
use crate::screen_command::ScreenCommand;
use crate::strobe_form;

/// Mode markers of the TNC 355 kind that the later controls keep.
const MODES: [(bahn_exchange::Bit, Mode); 6] = [
    (signal::MODE_MANUAL, Mode::Manual),
    (signal::MODE_ELECTRONIC_HANDWHEEL, Mode::Handwheel),
    (signal::MODE_POSITIONING_MDI, Mode::Mdi),
    (signal::MODE_PROGRAM_RUN_SINGLE_BLOCK, Mode::SingleBlock),
    (signal::MODE_PROGRAM_RUN_FULL_SEQUENCE, Mode::FullSequence),
    (signal::MODE_TRAVERSING_REFERENCE_MARKS, Mode::Reference),
];
const MODE_BITS: [bahn_exchange::Bit; 4] = [
    signal::MODE_CODE_BIT_1,
    signal::MODE_CODE_BIT_2,
    signal::MODE_CODE_BIT_3,
    signal::MODE_CODE_BIT_4,
];
const LAST_KEYS: [bahn_exchange::Bit; 5] = [
    signal::AXIS_KEY_X_PRESSED_LAST,
    signal::AXIS_KEY_Y_PRESSED_LAST,
    signal::AXIS_KEY_Z_PRESSED_LAST,
    signal::AXIS_KEY_IV_PRESSED_LAST,
    signal::AXIS_KEY_V_PRESSED_LAST,
];

/// Analogue inputs of the extensions that MP4410 names: voltages in 0.1 V, temperatures in 0.5 degrees
/// [000:8449-8484].
pub(crate) fn analogue(extensions: [bool; 2], measured: &Measured, exchange: &mut Exchange) {
    let mut values = measured.volts.into_iter().zip(measured.temperatures);
    for ([voltages, temperatures], there) in ANALOGUE.iter().zip(extensions) {
        for ((voltage, temperature), (volts, celsius)) in voltages.iter().zip(temperatures).zip(&mut values) {
            if there {
                let volts = (volts * 10.0).round();
                exchange.nc_put_number(*voltage, volts.clamp(-100.0, 100.0) as i32);
                let celsius = (celsius * 2.0).round();
                exchange.nc_put_number(*temperature, celsius.clamp(0.0, 200.0) as i32);
            }
        }
    }
}

/// Markers and words with a value at power-on.
pub(crate) fn preset<'a>(axes: impl Iterator<Item = &'a AxisUnit>, english: bool, exchange: &mut Exchange) {
    // They lie among the markers that power-off keeps, but belong to the NC.
    let of_the_nc = [
        &signal::RISING_EDGES,
        &signal::FALLING_EDGES,
        &signal::DECODED_M_FUNCTIONS,
    ];
    for marker in of_the_nc.into_iter().flat_map(|range| range.iter()) {
        exchange.nc_put(marker, false);
    }
    for unit in axes {
        if let Some(marker) = REFERENCE_MISSING.get(unit.index) {
            exchange.nc_set(*marker, unit.parameters.controlled);
        }
    }
    strobe_form::preset(exchange);
    exchange.nc_set_number(signal::RAPID_TRAVERSE_LIMIT, 300_000);
    // No help file is selected [000:7048].
    exchange.nc_set_number(signal::HELP_LINE, -1);
    exchange.nc_set(signal::ENGLISH_SELECTED, english);
}

/// The operating mode, and the axis key that was pressed last.
pub(crate) fn mode(mode: Mode, last_key: usize, exchange: &mut Exchange) {
    exchange.nc_put_number(signal::OPERATING_MODE, mode.code());
    for (marker, of) in MODES {
        exchange.nc_put(marker, of == mode);
    }
    for (place, marker) in MODE_BITS.into_iter().enumerate() {
        exchange.nc_put(marker, mode.code() >> place & 1 != 0);
    }
    for (index, marker) in LAST_KEYS.into_iter().enumerate() {
        exchange.nc_put(marker, index == last_key);
    }
}

/// M2050 of the TNC 151/155: PROGRAMMING AND EDITING is on the screen, and not beside a program that runs [001:1039-1042].
/// M2189: a programmed stop is in force [001:1049-1053]. M2024: the touch probe is not ready, which no plant tells from a transmission
/// that is not, M2022 [001:2262-2263].
pub(crate) fn of_old_interface(screen: Option<ScreenCommand>, run: &ProgramRun, exchange: &mut Exchange) {
    /// Bit of the windows of the editing screen.
    const EDITING: u16 = 1;
    let shown = screen.is_some_and(|screen| screen.windows & EDITING != 0);
    let edits = shown && !run.is_active();
    exchange.nc_put(signal::MODE_PROGRAMMING_EDITING_TNC355, edits);
    let stopped = run.progress().state() == RunState::Stopped;
    exchange.nc_put(signal::PROGRAMMED_STOP, stopped);
    let not_ready = exchange.nc().bit(signal::PROBE_NOT_READY);
    exchange.nc_put(signal::TOUCH_PROBE_READY_TNC355, not_ready);
}

/// The markers of each axis [000:5341-5401] [000:3278-3286] [000:4669-4674] [000:3522-3534]. `by_wheel`: none is in position,
/// as in Handwheel [000:5371-5384]; on the TNC 151/155 these say there, too, which axis moves *(inferred)*.
pub(crate) fn axes(mode: Mode, by_wheel: bool, axes: &mut OwnAxes, exchange: &mut Exchange) {
    for unit in axes.iter_mut() {
        let index = unit.index;
        let slave = unit.parameters.synchronization.master.is_some();
        let moving = !unit.stands();
        let in_position = unit.show_in_position() && !by_wheel;
        let values = [
            (&ENABLED, unit.servo.closed()),
            (&IN_POSITION, in_position),
            (&IN_MOTION, moving && mode.is_automatic() && !slave),
            (&NEGATIVE_TRAVERSE, unit.direction == Direction::Minus && !slave),
            (&REFERENCE_MISSING, !unit.referenced && !unit.is_plc_axis()),
        ];
        for (markers, value) in values {
            if let Some(marker) = markers.get(index) {
                exchange.nc_put(*marker, value);
            }
        }
        if let Some([plus, minus]) = LIMIT.get(index) {
            exchange.nc_put(*plus, unit.at_limit == Some(Direction::Plus));
            exchange.nc_put(*minus, unit.at_limit == Some(Direction::Minus));
        }
    }
}

/// An axis has left the channel: its markers rest.
pub(crate) fn leave(index: usize, exchange: &mut Exchange) {
    for markers in [
        &ENABLED,
        &IN_POSITION,
        &IN_MOTION,
        &NEGATIVE_TRAVERSE,
        &REFERENCE_MISSING,
    ] {
        if let Some(marker) = markers.get(index) {
            exchange.nc_put(*marker, false);
        }
    }
    for marker in LIMIT.get(index).into_iter().flatten() {
        exchange.nc_put(*marker, false);
    }
}

/// `*`: on while something is executed or a transfer `waits`, flashing after an external stop [000:6581-6587];
/// feeds [000:6521-6536].
pub(crate) fn run(run: &ProgramRun, waits: bool, exchange: &mut Exchange) {
    let state = run.progress().state();
    exchange.nc_put(
        signal::CONTROL_IN_OPERATION,
        matches!(state, RunState::Running | RunState::Interrupted) || waits,
    );
    exchange.nc_put(signal::PROGRAM_INTERRUPTED, state == RunState::Interrupted);
    let programmed = run.core.track.programmed_feed();
    exchange.nc_put(
        signal::RAPID_TRAVERSE_PROGRAMMED,
        programmed.is_none() && run.is_active(),
    );
    exchange.nc_put_number(signal::PROGRAMMED_FEED, programmed.unwrap_or(0.0).round() as i32);
    let feed = (run.core.track.speed_mm_s() * 60.0).round();
    exchange.nc_put_number(signal::CURRENT_FEED, feed as i32);
}

/// What the operator moves by hand with, whatever the mode.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByHand {
    /// 3D ROT is on.
    pub leans: bool,
    /// How far a measuring probe is deflected along its own axes, mm.
    pub deflection_mm: [f64; 3],
}

/// The coordinates that modules 9040 and 9041 read in the next scan.
pub(crate) fn coordinates<'a>(
    axes: impl Iterator<Item = &'a AxisUnit> + Clone,
    chain: &Chain,
    run: &ProgramRun,
    by_hand: ByHand,
    link: &mut PlcLink,
) {
    /// Kinds of coordinates that each axis has, in the order of [`CoordinateKind`]: actual and nominal from the datum,
    /// actual from the machine datum, lag, distance to go.
    const SERVED: usize = 5;
    let [actual, nominal] = path_positions(axes.clone(), chain);
    // Of the datum shift alone, not of what is turned or mirrored around it (inferred).
    let frame = run.frame();
    let shift = frame.map_or(Position::ZERO, |frame| frame.shift);
    let mut rows = [PerPlcAxis::splat(0.0); SERVED];
    let mut shifted = PerPlcAxis::splat(0.0);
    for unit in axes {
        if let Some(cell) = shifted.get_mut(unit.index) {
            *cell = actual[unit.axis] - shift[unit.axis];
        }
        let values: [f64; SERVED] = [
            actual[unit.axis],
            nominal[unit.axis],
            unit.servo.actual_mm(),
            unit.servo.lag_mm(),
            run.distance_to_go(unit, chain),
        ];
        for (row, value) in rows.iter_mut().zip(values) {
            if let Some(cell) = row.get_mut(unit.index) {
                *cell = value;
            }
        }
    }
    for (kind, row) in CoordinateKind::ALL.iter().zip(rows) {
        link.set_coordinates(*kind, row);
    }
    let along =
        |probe: MeasuringProbe| deflection_along_axes(&by_hand.deflection_mm, probe.axes, probe.reversed);
    let deflection = link.list().measuring_probe().map_or([0.0; 3], along);
    let deflection =
        PerPlcAxis::from_fn(|axis| deflection.get(usize::from(axis)).copied().unwrap_or_default());
    link.set_coordinates(CoordinateKind::Deflection, deflection);
    // While the program is read on another thread the last ones stay.
    if frame.is_some() {
        link.set_coordinates(CoordinateKind::ShiftedDatum, shifted);
    }
}

/// What module 9035 reads of the working plane; `leans`: 3D ROT is on.
pub(crate) fn working_plane(chain: &Chain, run: &ProgramRun, leans: bool, link: &mut PlcLink) {
    // Bit 0: tilted; bit 1: selected for manual operation; bit 2: for program run, by the menu or by the program.
    let tilted = chain.placement().is_some_and(|placement| placement.is_tilted());
    let by_program = match run.progress().is_on_its_way() {
        true => tilted,
        false => run.source.plane().is_some(),
    };
    link.set_status(
        StatusItem::WorkingPlane,
        i32::from(tilted) | i32::from(leans) << 1 | i32::from(by_program) << 2,
    );
}

/// What module 9035 reads.
pub(crate) fn items(
    mode: Mode,
    manual: &Manual,
    executed: Option<&str>,
    tested: Option<&str>,
    link: &mut PlcLink,
) {
    let handwheel = i32::try_from(manual.handwheel.axis()).unwrap_or(-1);
    let last_key = i32::try_from(manual.last_key()).unwrap_or(0);
    let items = [
        (StatusItem::MachineMode, mode.code()),
        (StatusItem::MachineAxis, last_key),
        (StatusItem::HandwheelAxis, handwheel),
        (
            StatusItem::HandwheelAxes,
            1i32.checked_shl(handwheel.max(0) as u32).unwrap_or(0),
        ),
        (StatusItem::ExecutedFile, kind_of_file(executed)),
    ];
    for (item, value) in items {
        link.set_status(item, value);
    }
    if link.screen().is_none() {
        link.set_status(StatusItem::EditedFile, kind_of_file(tested));
    }
    let subdivisions = [
        StatusItem::SubdivisionX,
        StatusItem::SubdivisionY,
        StatusItem::SubdivisionZ,
        StatusItem::Subdivision4,
        StatusItem::Subdivision5,
    ];
    for (item, factor) in subdivisions.into_iter().zip(manual.handwheel.factors()) {
        link.set_status(item, factor.into());
    }
}

/// Kind of a program by its extension, as module 9035 codes it: 1 .H, 2 .I; a name without one is a .H
/// [000:14921-14926].
fn kind_of_file(name: Option<&str>) -> i32 {
    match name {
        None => 0,
        Some(name) if name.ends_with(".I") || name.ends_with(".i") => 2,
        Some(_) => 1,
    }
}
