//! What the NC tells the PLC of itself: markers and words of state, before every scan.

use bahn_exchange::signal;
use bahn_plc::StatusItem;

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;
use crate::markers::{
    ANALOGUE, ENABLED, IN_MOTION, IN_POSITION, LIMIT, NEGATIVE_TRAVERSE, REFERENCE_MISSING,
};
use crate::panel::Direction;
use crate::run::RunState;

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

impl Control {
    /// Brings markers and words up to date.
    pub(crate) fn publish(&mut self) {
        self.publish_mode();
        self.publish_axes();
        self.publish_run();
        for (marker, value) in self.messages.markers() {
            self.put(marker, value);
        }
        self.spindle.publish(&mut self.exchange);
        self.publish_coordinates();
        self.publish_status();
    }

    /// Analogue inputs of the extensions that MP4410 names: voltages in 0.1 V, temperatures in 0.5 degrees
    /// [000:8449-8484].
    pub(crate) fn publish_analogue(&mut self) {
        let extensions = self.plc_parameters.analogue_inputs;
        let mut values = self.measured.volts.into_iter().zip(self.measured.temperatures);
        for ([voltages, temperatures], there) in ANALOGUE.iter().zip(extensions) {
            for ((voltage, temperature), (volts, celsius)) in
                voltages.iter().zip(temperatures).zip(&mut values)
            {
                if there {
                    let volts = (volts * 10.0).round();
                    self.put_number(*voltage, volts.clamp(-100.0, 100.0) as i32);
                    let celsius = (celsius * 2.0).round();
                    self.put_number(*temperature, celsius.clamp(0.0, 200.0) as i32);
                }
            }
        }
    }

    fn publish_mode(&mut self) {
        let mode = self.mode;
        self.put_number(signal::OPERATING_MODE, mode.code());
        for (marker, of) in MODES {
            self.put(marker, of == mode);
        }
        for (place, marker) in MODE_BITS.into_iter().enumerate() {
            self.put(marker, mode.code() >> place & 1 != 0);
        }
        let last = self.manual.last_key;
        for (index, marker) in LAST_KEYS.into_iter().enumerate() {
            self.put(marker, index == last);
        }
    }

    /// The markers of each axis [000:5341-5401] [000:3278-3286] [000:4669-4674] [000:3522-3534].
    fn publish_axes(&mut self) {
        for place in 0..self.axes.len() {
            let Some(unit) = self.axes.get_mut(place) else {
                continue;
            };
            let index = unit.index;
            let slave = unit.parameters.synchronization.master.is_some();
            let moving = !unit.stands();
            if moving || unit.mover == Mover::Reference {
                unit.in_position = false;
            } else if unit.servo.closed() && unit.servo.in_position() {
                unit.in_position = true;
            }
            // In Handwheel no axis is in position [000:5371-5384].
            let in_position = unit.in_position && self.mode != Mode::Handwheel;
            let in_motion = moving && self.mode.is_automatic() && !slave;
            let negative = unit.direction == Direction::Minus && !slave;
            let missing = !unit.referenced && !unit.is_plc_axis();
            let closed = unit.servo.closed();
            let at_limit = unit.at_limit;
            let values = [
                (&ENABLED, closed),
                (&IN_POSITION, in_position),
                (&IN_MOTION, in_motion),
                (&NEGATIVE_TRAVERSE, negative),
                (&REFERENCE_MISSING, missing),
            ];
            for (markers, value) in values {
                if let Some(marker) = markers.get(index) {
                    self.put(*marker, value);
                }
            }
            if let Some([plus, minus]) = LIMIT.get(index) {
                self.put(*plus, at_limit == Some(Direction::Plus));
                self.put(*minus, at_limit == Some(Direction::Minus));
            }
        }
    }

    /// `*`: on while something is executed, flashing after an external stop [000:6581-6587]; feeds
    /// [000:6521-6536].
    fn publish_run(&mut self) {
        let state = self.run.state;
        let waiting = !self.handshakes.is_idle();
        self.put(
            signal::CONTROL_IN_OPERATION,
            matches!(state, RunState::Running | RunState::Interrupted) || waiting,
        );
        self.put(signal::PROGRAM_INTERRUPTED, state == RunState::Interrupted);
        let programmed = self.programmed_feed();
        self.put(
            signal::RAPID_TRAVERSE_PROGRAMMED,
            programmed.is_none() && self.run.is_active(),
        );
        self.put_number(signal::PROGRAMMED_FEED, programmed.unwrap_or(0.0).round() as i32);
        self.put_number(signal::CURRENT_FEED, (self.run.speed * 60.0).round() as i32);
    }

    /// Programmed feed of the element that is executed, mm/min; `None` for rapid traverse.
    pub(crate) fn programmed_feed(&self) -> Option<f64> {
        match self.path.element()?.feed {
            bahn_path::FeedRate::Programmed(feed) => Some(feed),
            bahn_path::FeedRate::Rapid => None,
        }
    }

    /// What module 9035 reads.
    fn publish_status(&mut self) {
        let handwheel = i32::try_from(self.manual.handwheel_axis).unwrap_or(-1);
        let last_key = i32::try_from(self.manual.last_key).unwrap_or(0);
        let items = [
            (StatusItem::MachineMode, self.mode.code()),
            (StatusItem::MachineAxis, last_key),
            (StatusItem::HandwheelAxis, handwheel),
            (
                StatusItem::HandwheelAxes,
                1i32.checked_shl(handwheel.max(0) as u32).unwrap_or(0),
            ),
            (
                StatusItem::ExecutedFile,
                kind_of_file(self.run.selected.as_deref()),
            ),
            (StatusItem::EditedFile, kind_of_file(self.tested_program())),
        ];
        for (item, value) in items {
            self.link.set_status(item, value);
        }
        let subdivisions = [
            StatusItem::SubdivisionX,
            StatusItem::SubdivisionY,
            StatusItem::SubdivisionZ,
            StatusItem::Subdivision4,
            StatusItem::Subdivision5,
        ];
        for (item, factor) in subdivisions.into_iter().zip(self.manual.factors) {
            self.link.set_status(item, factor.into());
        }
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
