//! What the operator has of a channel: operating mode, panel, overrides, the axes by hand, the reference run.
//!
//! Decision: Axis keys of the keyboard highlight their axis for M2096 to M2099 and M2148 in the modes by hand, as
//! direction keys do; as key codes X, Y and Z alone, since those of IV and V are in the manual's lost table. With
//! MP7640 = 2 highlight and handwheel go together (also `tnc/src/handwheel.rs`)
//!
//! Decision: MP66 = 2 of a TNC 151/155: the external potentiometer acts by hand, that of the control in the other
//! modes; its wiper is the first analogue input of the plant, 0 to 10 V for 0 to 150 %
//!
//! Decision: M, S and TOUCH PROBE that the PLC presses are on the screen in MANUAL OPERATION and ELECTRONIC
//! HANDWHEEL; codes of the soft-key row, whose table is lost, are M2187

use bahn_exchange::{Bit, Exchange, Image, signal};
use bahn_kernel::reference::{Cams, DirectionKeys, ReferenceRun, is_asked};
use bahn_kernel::{Chain, Leaning, Mover, Now, OwnAxes, Progress, RunState};
use bahn_parameters::code_numbers::{ERASE_MEMORY, OFFSET_ADJUSTMENT};
use bahn_parameters::machining::MeasuringProbe;
use bahn_parameters::operation::OperationParameters;
use bahn_parameters::{ControlModel, ParameterList, PerPlcAxis};
use bahn_path::{Axis, BlockRef, Position};
use bahn_servo::{HandwheelInputs, Measured};

use crate::command::{Command, Mode};
use crate::datums::{Datums, NewDatum};
use crate::key_code::KeyCode;
use crate::machine::Facts;
use crate::manual::Manual;
use crate::marker_codes;
use crate::markers::{REFERENCE_CAM, REFERENCE_INHIBIT};
use crate::message::Messages;
use crate::overrides::Override;
use crate::panel::{Panel, PlcFaultCode};
use crate::plane_command::PlaneCommand;
use crate::probing::{Guarded, Probe, Stylus};
use crate::reach::Reach;
use crate::status::{self, ByHand};

const CODE_84159: u32 = 84_159;

/// The operator's side of a channel.
#[derive(Clone)]
pub(crate) struct Desk {
    rules: OperationParameters,
    mode: Mode,
    /// NC start was pressed and not yet used.
    start_pressed: bool,
    panel: Panel,
    feed_override: Override,
    spindle_override: Override,
    pub manual: Manual,
    /// 3D ROT by hand.
    pub leaning: Leaning,
    reference: ReferenceRun,
    stylus: Stylus,
    /// The key that was pressed or simulated last, for whoever has the keyboard.
    key: Option<KeyCode>,
}

impl Desk {
    pub fn new(rules: OperationParameters) -> Desk {
        Desk {
            mode: Mode::Manual,
            start_pressed: false,
            panel: Panel::default(),
            feed_override: Override::feed(rules.overrides.feed_steps),
            spindle_override: Override::spindle(rules.overrides.spindle_steps),
            manual: Manual::default(),
            leaning: Leaning::default(),
            reference: ReferenceRun::new(match rules.marks_by_code {
                true => DirectionKeys::Dead,
                false => DirectionKeys::ChooseAxis,
            }),
            stylus: Stylus::default(),
            key: None,
            rules,
        }
    }

    /// Goes over to changed machine parameters.
    pub fn set_rules(&mut self, rules: OperationParameters) {
        let before = self.rules.overrides;
        if rules.overrides.feed_steps != before.feed_steps {
            self.feed_override = Override::feed(rules.overrides.feed_steps);
        }
        if rules.overrides.spindle_steps != before.spindle_steps {
            self.spindle_override = Override::spindle(rules.overrides.spindle_steps);
        }
        self.rules = rules;
        // It is of the parameters that were.
        self.manual.lead_by(None);
    }

    pub fn rules(&self) -> &OperationParameters {
        &self.rules
    }

    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// PNT on or off: with a measuring probe, in POSITIONING WITH MDI.
    pub fn switch_pnt(&mut self, on: bool, probe: Option<MeasuringProbe>) -> bool {
        let probe = probe.filter(|_| on && self.mode == Mode::Mdi);
        let possible = probe.is_some() || !on && self.manual.follows_stylus();
        if possible {
            self.manual.lead_by(probe);
        }
        possible
    }

    /// Axes are moved by hand: Manual and Handwheel.
    pub fn is_by_hand(&self) -> bool {
        matches!(self.mode, Mode::Manual | Mode::Handwheel)
    }

    pub fn panel(&self) -> &Panel {
        &self.panel
    }

    /// Feed override in force, %.
    pub fn feed_percent(&self) -> f64 {
        self.feed_override.percent()
    }

    /// Spindle override in force, %.
    pub fn spindle_percent(&self) -> f64 {
        self.spindle_override.percent()
    }

    /// A reference run is on its way.
    pub fn runs_reference(&self) -> bool {
        self.reference.is_running()
    }

    /// What holds now; with the rapid traverse of the probe, mm/min, which is asked for only where it counts.
    pub fn now(&self, nc: &Image, probe_mm_min: impl FnOnce() -> f64, facts: Facts) -> Now {
        let feed_percent = self.feed_override.percent();
        // MP7620 bit 0 = 0 takes the feed override away while the rapid traverse key is pressed [000:10512]
        // [001:3262] [003:7434-7443].
        let rapid = self.panel.rapid && !self.rules.overrides.on_rapid_key;
        // D596: rapid traverse as the PLC limits it [000:4812-4814]. With a probe in the spindle MP6150 limits
        // it, too [000:7654].
        let by_plc = f64::from(nc.number(signal::RAPID_TRAVERSE_LIMIT).max(0));
        let rapid_limit_mm_min = if nc.bit(signal::NC_STOP_ON_STYLUS_DEFLECTION) {
            by_plc.min(probe_mm_min())
        } else {
            by_plc
        };
        let stop = self.panel.stop
            || self.stylus.stops
            || nc.bit(signal::NC_STOP_AND_OPEN_LOOPS)
            || !facts.ready
            || facts.fault;
        Now {
            time_s: facts.time_s,
            us: facts.us,
            start: self.start_pressed,
            stop,
            fault: facts.fault,
            stop_pressed: self.panel.stop,
            ready: facts.ready,
            loops_closed: facts.loops_closed,
            feed_percent,
            program_percent: if rapid { 100.0 } else { feed_percent },
            program_rapid: self.panel.rapid && self.rules.overrides.rapid_key_in_programs,
            axis_keys: self.panel.axis_keys,
            wheel_mm: self.manual.handwheel.travels(),
            rapid_limit_mm_min,
        }
    }

    /// NC stop, or anything that stops like it.
    pub fn stop(&mut self) {
        self.manual.stop();
        if self.reference.is_running() && self.mode != Mode::Reference {
            self.reference.abort();
        }
    }

    /// The loops are opened: nothing moves on.
    pub fn let_go(&mut self) {
        self.manual.stop();
        self.reference.abort();
    }

    /// NC start was used, or came to nothing.
    pub fn forget_start(&mut self) {
        self.start_pressed = false;
    }

    /// The loops are open: what is done meanwhile moves nothing when they close.
    pub fn forget_input(&mut self, inputs: &HandwheelInputs) {
        self.forget_start();
        self.manual.handwheel.forget_turns(inputs);
    }

    /// Chooses an operating mode, as far as the progress of the run allows it.
    pub fn choose_mode(&mut self, mode: Mode, progress: &Progress, axes: &mut OwnAxes) -> bool {
        let possible = match progress.state() {
            _ if mode == self.mode => true,
            _ if !progress.is_active() => true,
            RunState::Idle => false,
            // Single block ends a full sequence at the end of its block, and back.
            _ => self.mode != Mode::Mdi && matches!(mode, Mode::SingleBlock | Mode::FullSequence),
        };
        let missing = axes.iter().any(is_asked);
        if !possible || mode == Mode::Reference && !missing {
            return false;
        }
        self.set_mode(mode, axes);
        true
    }

    /// Changes the operating mode, and with it the kind of positioning.
    fn set_mode(&mut self, mode: Mode, axes: &mut OwnAxes) {
        if mode == self.mode {
            return;
        }
        if self.mode == Mode::Reference {
            self.reference.abort();
        }
        // What the old mode moved comes to a standstill on its ramp.
        axes.release(|mover| matches!(mover, Mover::Reference | Mover::Manual));
        self.mode = mode;
        self.manual.stop();
        if !self.is_by_hand() {
            self.manual.leave();
        }
    }

    /// The control voltage has come: with the first time the control asks for the reference run.
    pub fn ask_for_reference(&mut self, axes: &mut OwnAxes) {
        if self.reference.is_asked_for(axes) {
            self.set_mode(Mode::Reference, axes);
        }
    }

    /// A code number was entered: after 84 159 direction buttons lead the axes over their marks, where they do not without
    /// it, until power-off (inferred) [001:955].
    pub fn take_code(&mut self, code: u32) {
        if code == CODE_84159 && self.rules.marks_by_code {
            self.reference.set_keys(DirectionKeys::Lead);
        }
    }

    /// What is entered for moving by hand: M and S in Manual and Handwheel, jog increment, handwheel. `false` for what cannot
    /// be entered.
    pub fn enter(&mut self, command: &Command, model: ControlModel, axes: &OwnAxes) -> bool {
        let by_hand = self.is_by_hand();
        match command {
            command if !command.can_be_entered(model) => return false,
            Command::MFunction(m) if by_hand => self.manual.enter(Some(*m), None),
            Command::Speed(rpm) if by_hand => self.manual.enter(None, Some(*rpm)),
            Command::JogIncrement(mm) => self.manual.increment = *mm,
            Command::Handwheel(axis, factor) => return self.choose_handwheel(*axis, *factor, axes),
            Command::AxisKey(axis) if by_hand => return self.highlight(*axis, axes),
            _ => return false,
        }
        true
    }

    /// Operating mode and overrides before a PLC scan.
    pub fn publish(&mut self, measured: &Measured, exchange: &mut Exchange) {
        let operator = &measured.operator;
        let external = self.rules.overrides.external[usize::from(!self.mode.is_automatic())];
        let feed_percent = match external {
            true => external_percent(measured),
            false => operator.feed_override_percent,
        };
        self.feed_override.publish(exchange, feed_percent);
        self.spindle_override
            .publish(exchange, operator.spindle_override_percent);
        status::mode(self.mode, self.manual.last_key(), exchange);
    }

    /// Panel and overrides after a PLC scan.
    ///
    /// # Errors
    /// The code of the first command whose marker and complement are equal.
    pub fn take_panel(&mut self, exchange: &Exchange) -> Result<(), PlcFaultCode> {
        self.feed_override.take(exchange);
        self.spindle_override.take(exchange);
        let panel = self.panel.read(exchange.nc())?;
        self.start_pressed |= panel.started;
        self.panel = panel;
        Ok(())
    }

    /// Looks at the stylus, once in each servo step.
    pub fn watch_stylus(
        &mut self,
        measured: &Measured,
        guards: bool,
        probe: &Probe,
        stand: impl FnOnce() -> bool,
    ) {
        let (keys, automatic) = (&self.panel.axis_keys, self.mode.is_automatic());
        let may_touch = probe.touches() || self.manual.is_led();
        self.stylus.watch(measured, guards, may_touch, || Guarded {
            rest: keys.iter().all(Option::is_none) && stand(),
            automatic,
        });
    }

    /// What modules of the PLC read of moving by hand.
    pub fn by_hand(&self) -> ByHand {
        ByHand {
            leans: self.leaning.is_on(),
            deflection_mm: self.stylus.touch.deflection_mm,
        }
    }

    /// Follows NC stop, once in each contour cycle; in the TOUCH PROBE menu it is one of the probing alone.
    pub fn follow_stop(&mut self, now: &Now, probes: bool) {
        let ends = self.rules.stop_ends_m && self.is_by_hand() && !probes;
        self.manual.follow_stop(now.stop, ends);
    }

    /// The handwheel moves an axis, with an interpolation factor.
    pub fn choose_handwheel(&mut self, axis: Axis, factor: u8, axes: &OwnAxes) -> bool {
        let (handwheel, rules) = (&mut self.manual.handwheel, &self.rules.handwheel);
        axes.at(axis)
            .is_some_and(|unit| handwheel.choose(unit.index, factor, rules))
    }

    /// An axis key of the keyboard highlights its axis.
    fn highlight(&mut self, axis: Axis, axes: &OwnAxes) -> bool {
        let index = axes.at(axis).map(|unit| unit.index);
        index.is_some_and(|index| {
            self.manual.highlight(index, &self.rules.handwheel);
            true
        })
    }

    /// Switches 3D ROT on or off for manual operation.
    pub fn switch_plane(
        &mut self,
        command: &PlaneCommand,
        list: &ParameterList,
        axes: &OwnAxes,
        chain: &mut Chain,
    ) -> bool {
        let swivels = list.swivels().filter(|_| self.rules.tilting && self.is_by_hand());
        let Some(swivels) = swivels.filter(|_| axes.stand()) else {
            return false;
        };
        let Some(angles) = command.positions(&swivels, axes) else {
            return false;
        };
        let was = self.leaning.is_on();
        self.leaning.switch(angles, swivels, chain.offsets);
        if was && angles.is_none() {
            Leaning::leave(chain);
        }
        true
    }

    /// DATUM SET: the actual position becomes a value, in the plane of 3D ROT along it. `false` where that is inhibited.
    pub fn set_datum(&self, axis: Axis, value: f64, datums: &mut Datums, axes: &OwnAxes) -> bool {
        let mut actual = Position::UNKNOWN;
        for unit in axes.iter() {
            actual[unit.axis] = unit.servo.actual_mm();
        }
        let way = datums.chain.tip(&actual)[axis] - value;
        match self.leaning.datum_shift(axis, way) {
            Some(ways) => datums.shift(ways, axes),
            None => datums.set(axis, value, axes),
        }
    }

    /// What was probed becomes a value, in the plane of 3D ROT along it. `false` where that is inhibited.
    pub fn set_probed(&self, datum: NewDatum, datums: &mut Datums, axes: &OwnAxes) -> bool {
        let way = datum.at - datums.chain.offsets.datum[datum.axis] - datum.value;
        match self.leaning.datum_shift(datum.axis, way) {
            Some(ways) => datums.shift(ways, axes),
            None => datums.set_at(datum, axes),
        }
    }

    /// A key of the keyboard: inhibited ones only tell the PLC, with M2182 and W274 [000:7319], whose code is also in
    /// M2832 to M2839; any other is left for whoever has the keyboard. `false` for codes that are none and soft keys that
    /// are not on the screen.
    pub fn press_key(&mut self, code: u16, exchange: &mut Exchange) -> bool {
        let Some(key) = KeyCode::of(code) else {
            return false;
        };
        if matches!(key, KeyCode::SoftKey(_)) && !matches!(self.mode, Mode::Manual | Mode::Handwheel) {
            return false;
        }
        if key.inhibit().is_some_and(|marker| exchange.nc().bit(marker)) {
            exchange.nc_put_number(signal::INHIBITED_KEY_CODE, code.into());
            marker_codes::INHIBITED_KEY.put(code.into(), exchange);
            exchange.nc_set(signal::INHIBITED_KEY_PRESSED, true);
        } else {
            if let Some(index) = key.axis().filter(|_| self.is_by_hand()) {
                self.manual.highlight(index, &self.rules.handwheel);
            }
            self.key = Some(key);
        }
        true
    }

    /// Takes the key that is left.
    pub fn take_key(&mut self) -> Option<KeyCode> {
        self.key.take()
    }

    /// What is turned at the handwheel in another mode moves nothing later, but what M118 superimposes on a path. Its key
    /// for actual position capture is one of the keyboard.
    pub fn count_handwheel(
        &mut self,
        superimposes: bool,
        inputs: &HandwheelInputs,
        axes: &OwnAxes,
        exchange: &mut Exchange,
    ) {
        if self.manual.handwheel.take_capture() {
            // A code of the keyboard is always taken.
            let _ = self.press_key(KeyCode::CAPTURE, exchange);
        }
        let handwheel = &mut self.manual.handwheel;
        if superimposes && self.mode.is_automatic() {
            handwheel.superimpose(inputs, &self.rules.handwheel, axes, exchange.nc());
        } else if self.mode != Mode::Handwheel {
            handwheel.forget_turns(inputs);
        }
    }

    /// Moves the axes by hand for a cycle.
    pub fn move_by_hand(
        &mut self,
        handwheel: &HandwheelInputs,
        axes: &mut OwnAxes,
        nc: &Image,
        messages: &mut Messages,
        block: Option<BlockRef>,
        now: &Now,
    ) {
        let mut reach = Reach {
            axes,
            mode: self.mode,
            panel: &mut self.panel,
            rules: &self.rules,
            nc,
            messages,
            block,
        };
        match self.manual.is_led() {
            true => self.manual.follow_stylus(&self.stylus.touch, &mut reach, now),
            false => self.manual.moves(handwheel, &mut reach, now, &mut self.leaning),
        }
    }

    /// Moves the axes over their reference marks for a cycle; at the end the mode is Manual.
    pub fn move_reference(&mut self, axes: &mut OwnAxes, nc: &Image, now: &Now) {
        if self.reference.moves(axes, &reference_cams(nc), now) {
            self.set_mode(Mode::Manual, axes);
        }
    }
}

/// The external feed potentiometer of a TNC 151/155, whose wiper is the first analogue input: 0 to 10 V for 0 to 150 %
/// (inferred) [001:1014-1016].
fn external_percent(measured: &Measured) -> f64 {
    let [wiper_volts, ..] = measured.volts;
    wiper_volts.max(0.0) * 15.0
}

/// The cams of the axes: the PLC copies them from its inputs.
pub(crate) fn reference_cams(nc: &Image) -> Cams {
    let closed = |markers: &[Bit]| {
        let of = |axis: u8| {
            markers
                .get(usize::from(axis))
                .is_some_and(|marker| nc.bit(*marker))
        };
        PerPlcAxis::from_fn(of)
    };
    Cams {
        end: closed(&REFERENCE_CAM),
        inhibit: closed(&REFERENCE_INHIBIT),
    }
}

/// A code number; the last one stands in D276 for the PLC [000:6928-6947]. Whether it shows the offsets of the
/// drives.
pub(crate) fn enter_code(code: u32, exchange: &mut Exchange) -> bool {
    let number = i32::try_from(code).unwrap_or(i32::MAX);
    exchange.nc_put_number(signal::CODE_NUMBER, number);
    match code {
        ERASE_MEMORY => exchange.erase_retained(),
        CODE_84159 => exchange.nc_put(signal::CODE_84159_ENTERED, true),
        _ => {}
    }
    code == OFFSET_ADJUSTMENT
}
