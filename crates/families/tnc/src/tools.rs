//! Tools: what TOOL CALL and TOOL DEF hand to the PLC (MP7480).
//!
//! Decision: The control takes the acknowledgement of a tool change after the scan that gives it, whenever the supply
//! goes or an EMERGENCY STOP comes then: the PLC program may rely on that. M2093 falls with a change that is broken
//! off between its codes (also `tnc/src/handshake.rs`)
//!
//! Decision: TCH PROBE 30 probes the face and four sides, each at 0° and 180°; what it finds is remembered and counts
//! until MP6580 or MP6531 are changed

use bahn_exchange::{Exchange, signal};
use bahn_kernel::Offsets;
use bahn_parameters::machining::ToolProbeParameters;
use bahn_parameters::operation::{ToolOutput, ToolOutputKind, ToolParameters};
use bahn_path::{Axis, ToolCall};
use bahn_plc::ToolCallBlock;

use crate::handshake::{Handshakes, Transfer};
use crate::magazine::{Kind, Magazine, NO_POCKET};
use crate::setup::{Remembered, ToolProbeCalibration};
use crate::tool::MeasuredTool;

/// The tool in the spindle of a channel, and the one that is called.
#[derive(Clone, Debug)]
pub(crate) struct Tools {
    parameters: ToolParameters,
    /// Tool in the spindle.
    pub number: u32,
    /// Tool of the last TOOL CALL.
    called: u32,
    /// Length and axis of the tool in the spindle while another one is called.
    held: Option<(f64, Axis)>,
    /// Tool or pockets have changed: to be stored.
    pub changed: bool,
    /// A tool was called since the program began: its life counts.
    pub counts: bool,
    /// M101: a tool whose life is over while it works is replaced.
    pub replaces_worn: bool,
    /// M107: also by one that is larger.
    pub takes_larger: bool,
    /// The PLC waits at M2717 for the geometry that it activated.
    geometry_taken: bool,
    /// Tool of the last TOOL DEF.
    defined: Option<u32>,
    /// What the tool probe found, until the tables have taken it.
    pub measured: Option<MeasuredTool>,
    /// Where the contact of the tool probe was found.
    pub calibration: Option<ToolProbeCalibration>,
    /// A TOOL CALL that module 9150 inserted.
    pub inserted_call: Option<ToolCallBlock>,
}

impl Tools {
    pub fn new(parameters: ToolParameters, remembered: &Remembered) -> Tools {
        Tools {
            parameters,
            number: remembered.tool,
            called: remembered.tool,
            held: None,
            changed: false,
            counts: false,
            replaces_worn: false,
            takes_larger: false,
            geometry_taken: false,
            defined: None,
            measured: None,
            calibration: remembered.tool_probe,
            inserted_call: None,
        }
    }

    /// The tool probe of the machine; its contact is where it was found, unless the list was changed since.
    pub fn probe(&self) -> ToolProbeParameters {
        let mut probe = self.parameters.probe;
        let list = place_of(&probe);
        if let Some(calibration) = self.calibration.filter(|known| known.list == list) {
            let [x, y, z, width] = calibration.found;
            (probe.centre_mm, probe.width_mm) = ([x, y, z], width);
        }
        probe
    }

    /// The contact of the tool probe was found: its middle (X, Y, Z) and its width, mm.
    pub fn calibrate(&mut self, [x, y, z]: [f64; 3], width: f64) {
        self.calibration = Some(ToolProbeCalibration {
            found: [x, y, z, width],
            list: place_of(&self.parameters.probe),
        });
        self.changed = true;
    }

    /// The tool in the spindle is longer while another one is called; `false` when none is.
    pub fn lengthen_held(&mut self, longer: f64) -> bool {
        match &mut self.held {
            Some((length, _)) => *length += longer,
            None => return false,
        }
        true
    }

    /// W262 and W264 of a tool [000:9221-9263].
    fn code(output: ToolOutput, number: u32, magazine: &Magazine) -> (i16, i16) {
        let tool = i16::try_from(number).unwrap_or(i16::MAX);
        match output.what {
            ToolOutputKind::None | ToolOutputKind::Tool => (tool, 0),
            ToolOutputKind::Pocket | ToolOutputKind::FixedPocket => (magazine.pocket(number), tool),
        }
    }

    /// TOOL DEF for the next tool. A tool without pocket means nothing to the PLC [000:9285].
    pub fn define(&mut self, number: u32, magazine: &Magazine) -> Option<Transfer> {
        let output = self.parameters.definition;
        let changed = self.defined != Some(number);
        let by_pocket = matches!(output.what, ToolOutputKind::Pocket | ToolOutputKind::FixedPocket);
        self.defined = Some(number);
        if output.what == ToolOutputKind::None
            || !(changed || output.always)
            || by_pocket && magazine.pocket(number) == NO_POCKET
        {
            return None;
        }
        let (w262, w264) = Tools::code(output, number, magazine);
        Some(Transfer::ToolDef { w262, w264 })
    }

    /// TOOL CALL: one or two codes, by the kinds of the old and the new tool [000:9287-9410].
    pub fn call(
        &mut self,
        call: &ToolCall,
        magazine: &Magazine,
        exchange: &mut Exchange,
        handshakes: &mut Handshakes,
    ) {
        let number = call.tool;
        let output = self.parameters.call;
        let (old, changed) = (self.called, self.called != number);
        self.called = number;
        self.counts = true;
        self.mark(call, magazine, exchange);
        if output.what == ToolOutputKind::None || !(changed || output.always) {
            self.number = number;
            return;
        }
        let own_pocket = exchange.nc().bit(signal::SPECIAL_TOOL_TO_OWN_POCKET)
            || output.what == ToolOutputKind::FixedPocket;
        let two =
            output.what != ToolOutputKind::Tool && changed && magazine.needs_two(old, number, own_pocket);
        let (w262, w264) = if number == 0 && output.what != ToolOutputKind::Tool {
            // The old tool goes to its pocket, or the operator takes it out.
            (magazine.pocket(old), 0)
        } else {
            Tools::code(output, number, magazine)
        };
        if !two {
            handshakes.push(Transfer::ToolCall {
                w262,
                w264,
                more: false,
            });
            return;
        }
        let by_hand = magazine.kind(old) == Kind::Manual || magazine.kind(number) == Kind::Manual;
        let new_first = exchange.nc().bit(signal::TOOL_NUMBER_ORDER) && !by_hand;
        let mut codes = [(magazine.pocket(old), 0), (w262, w264)];
        if new_first {
            codes.reverse();
        }
        for ((w262, w264), more) in codes.into_iter().zip([true, false]) {
            handshakes.push(Transfer::ToolCall { w262, w264, more });
        }
    }

    /// The TOOL CALL of module 9150; `None` when it is none that can be executed. What is not given stays: tool, and
    /// axis and speed in rpm as they are [000:16098-16106].
    pub fn tool_call(
        &self,
        block: &ToolCallBlock,
        (axis, speed_rpm): (Axis, f64),
        magazine: &Magazine,
    ) -> Option<ToolCall> {
        let tool = block
            .tool
            .map_or(Some(self.called), |tool| u32::try_from(tool).ok())?;
        let axis = match block.axis {
            None => axis,
            Some(number) => inserted_axis(number)?,
        };
        let mut shape = magazine.tool(tool).shape;
        shape.length += block.length_oversize;
        Some(ToolCall {
            tool,
            axis,
            speed_rpm: block.speed.unwrap_or(speed_rpm),
            shape,
            at_end_of_life: false,
        })
    }

    /// M2400 to M2404 [000:9229] [000:9294-9297].
    fn mark(&self, call: &ToolCall, magazine: &Magazine, exchange: &mut Exchange) {
        let number = call.tool;
        let by_pocket = self.parameters.call.what == ToolOutputKind::Pocket && number != 0;
        let has_pocket = magazine.tool(number).pocket.is_some();
        for (marker, value) in [
            (signal::TOOL_0_PROGRAMMED, number == 0),
            (signal::ACTIVE_TOOL_HAS_POCKET, by_pocket && has_pocket),
            (signal::ACTIVE_TOOL_HAS_NO_POCKET, by_pocket && !has_pocket),
            (signal::ACTIVE_TOOL_IS_SPECIAL, magazine.tool(number).special),
            (signal::TOOL_CALL_ORIGIN, call.at_end_of_life),
        ] {
            if exchange.nc().bit(marker) != value {
                exchange.nc_set(marker, value);
            }
        }
    }

    /// A tool is called that is not yet in the spindle.
    pub fn is_changing(&self) -> bool {
        self.number != self.called
    }

    /// Length and axis before a call: those of the tool in the spindle until it is changed.
    pub fn hold_geometry(&mut self, length: f64, axis: Axis) {
        if self.is_changing() {
            self.held.get_or_insert((length, axis));
        } else {
            // It counts with another length from here on.
            self.changed = true;
        }
    }

    /// Length and axis of the tool in the spindle; while another one is called not those in force.
    pub fn remembered_geometry(&self, in_force: &Offsets) -> (f64, Axis) {
        self.held.unwrap_or((in_force.tool_length, in_force.tool_axis))
    }

    /// The data of the tool are cancelled: it counts without length.
    pub fn forget_length(&mut self, offsets: &mut Offsets) {
        self.changed |= offsets.tool_length != 0.0;
        offsets.tool_length = 0.0;
    }

    /// A change was broken off: the old tool is still in the spindle, and the next call is one again.
    pub fn take_back(&mut self, offsets: &mut Offsets) {
        self.called = self.number;
        if let Some((length, axis)) = self.held.take() {
            (offsets.tool_length, offsets.tool_axis) = (length, axis);
        }
    }

    /// After a scan: what the PLC has acknowledged in it has happened, whenever the supply goes or an EMERGENCY STOP takes
    /// the strobe away *(inferred)*. Its program may rely on that.
    pub fn take_end(&mut self, magazine: &mut Magazine, handshakes: &Handshakes, exchange: &Exchange) {
        let acknowledged = handshakes.acknowledged(exchange.nc());
        if matches!(acknowledged, Some(Transfer::ToolCall { more: false, .. })) && self.is_changing() {
            self.inserted(magazine, exchange);
        }
    }

    /// The last code of a TOOL CALL was acknowledged: the tool is in the spindle. With variable pocket
    /// coding the old tool has taken the pocket of the new one, unless it went to its own (inferred), and
    /// M2612 = 0 [000:9281].
    pub fn inserted(&mut self, magazine: &mut Magazine, exchange: &Exchange) {
        let (old, new) = (self.number, self.called);
        self.number = new;
        self.held = None;
        self.changed = true;
        let nc = exchange.nc();
        let own_pocket = nc.bit(signal::SPECIAL_TOOL_TO_OWN_POCKET);
        if self.parameters.call.what != ToolOutputKind::Pocket
            || nc.bit(signal::KEEP_POCKET_NUMBERS)
            || [old, new].contains(&0)
            || magazine.needs_two(old, new, own_pocket)
        {
            return;
        }
        magazine.swap(old, new);
    }

    /// M2717: the geometry of the tool in W264 is active [000:9217-9219]. The marker falls when that is stored.
    pub fn take_geometry_strobe(
        &mut self,
        magazine: &Magazine,
        exchange: &mut Exchange,
        offsets: &mut Offsets,
    ) {
        if !exchange.nc().bit(signal::ACTIVATE_TOOL_GEOMETRY) || self.geometry_taken {
            return;
        }
        let number = exchange.nc().number(signal::TOOL_NUMBER);
        if let Ok(number) = u32::try_from(number) {
            self.number = number;
            self.called = number;
            self.held = None;
            offsets.tool_length = magazine.tool(number).shape.length;
        }
        self.changed = true;
        self.geometry_taken = true;
    }

    /// What changed is stored: M2717 falls.
    pub fn end_geometry_strobe(&mut self, exchange: &mut Exchange) {
        if std::mem::take(&mut self.geometry_taken) {
            exchange.nc_set(signal::ACTIVATE_TOOL_GEOMETRY, false);
        }
    }
}

/// Tool axis by its number in module 9150: 0 to 2 are X, Y, Z [000:16100-16113].
pub(crate) fn inserted_axis(number: i32) -> Option<Axis> {
    match number {
        0 => Some(Axis::X),
        1 => Some(Axis::Y),
        2 => Some(Axis::Z),
        _ => None,
    }
}

/// Centre (MP6580) and width (MP6531) of the tool probe, mm.
fn place_of(probe: &ToolProbeParameters) -> [f64; 4] {
    let [x, y, z] = probe.centre_mm;
    [x, y, z, probe.width_mm]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::Tool;

    /// The tool in the spindle with its magazine.
    struct Changer {
        tools: Tools,
        magazine: Magazine,
    }

    impl Changer {
        fn call(&mut self, call: &ToolCall, exchange: &mut Exchange, handshakes: &mut Handshakes) {
            self.tools.call(call, &self.magazine, exchange, handshakes);
        }

        fn inserted(&mut self, exchange: &Exchange) {
            self.tools.inserted(&mut self.magazine, exchange);
        }

        fn define(&mut self, number: u32) -> Option<Transfer> {
            self.tools.define(number, &self.magazine)
        }

        /// A tool is in the spindle.
        fn holds(&mut self, number: u32) {
            (self.tools.number, self.tools.called) = (number, number);
        }
    }

    fn tools(what: ToolOutputKind) -> Changer {
        let tool = |pocket, special| Tool {
            pocket,
            special,
            ..Tool::default()
        };
        let table = [
            (1, tool(Some(11), false)),
            (2, tool(Some(12), false)),
            (3, tool(None, false)),
            (4, tool(Some(14), true)),
            (5, tool(None, false)),
            (6, tool(Some(16), true)),
        ];
        let output = ToolOutput { what, always: false };
        let parameters = ToolParameters {
            table_size: 10,
            pockets: 20,
            reserved_pockets: 0,
            probe: bahn_parameters::ParameterList::reference(bahn_parameters::ControlModel::Tnc415b)
                .tool_probe(),
            call: output,
            definition: output,
        };
        Changer {
            tools: Tools::new(parameters, &Remembered::default()),
            magazine: Magazine::new(Some(table.into_iter().collect()), &[]),
        }
    }

    /// What calibrating found counts until the list says something else than it did then.
    #[test]
    fn a_changed_list_counts() {
        let mut tools = tools(ToolOutputKind::Tool).tools;
        let list = tools.probe();
        tools.calibrate([1.0, 2.0, 3.0], 4.0);
        let found = tools.probe();
        assert_eq!((found.centre_mm, found.width_mm), ([1.0, 2.0, 3.0], 4.0));
        tools.parameters.probe.width_mm += 1.0;
        let changed = tools.probe();
        assert_eq!(
            (changed.centre_mm, changed.width_mm),
            (list.centre_mm, list.width_mm + 1.0)
        );
    }

    fn tool_call(tool: u32) -> ToolCall {
        ToolCall {
            tool,
            axis: Axis::Z,
            speed_rpm: 0.0,
            shape: bahn_path::ToolShape::default(),
            at_end_of_life: false,
        }
    }

    /// The codes (W262, W264, M2093) of a row of calls; what the PLC has set, it has set before.
    fn codes_with(tools: &mut Changer, exchange: &mut Exchange, calls: &[u32]) -> Vec<(i16, i16, bool)> {
        let mut codes = Vec::new();
        for call in calls {
            let mut handshakes = Handshakes::default();
            tools.call(&tool_call(*call), exchange, &mut handshakes);
            while !handshakes.is_idle() {
                handshakes.cycle(exchange, true);
                let nc = exchange.nc();
                let code = |number| i16::try_from(nc.number(number)).unwrap_or_default();
                codes.push((
                    code(signal::T_CODE),
                    code(signal::TOOL_NUMBER),
                    nc.bit(signal::TOOL_CALL_ANOTHER_T_FOLLOWS),
                ));
                exchange.begin_scan();
                exchange.plc_mut().set_bit(signal::TOOL_CALL_ACK, true);
                exchange.end_scan();
                handshakes.cycle(exchange, true);
                exchange.begin_scan();
                exchange.plc_mut().set_bit(signal::TOOL_CALL_ACK, false);
                exchange.end_scan();
            }
            tools.inserted(exchange);
        }
        codes
    }

    fn codes(tools: &mut Changer, calls: &[u32]) -> Vec<(i16, i16, bool)> {
        codes_with(tools, &mut Exchange::default(), calls)
    }

    fn plc_sets(marker: bahn_exchange::Bit) -> Exchange {
        let mut exchange = Exchange::default();
        exchange.begin_scan();
        exchange.plc_mut().set_bit(marker, true);
        exchange.end_scan();
        exchange
    }

    /// F of the pocket table: a normal tool returns to its own pocket despite variable coding, with two codes; the
    /// pocket table stays as it is. Tools without F change their pockets [000:9153-9155].
    #[test]
    fn fixed_pocket_under_variable_coding() {
        let mut changer = tools(ToolOutputKind::Pocket);
        changer.holds(1);
        assert_eq!(codes(&mut changer, &[2]), [(12, 2, false)]);
        assert_eq!((changer.magazine.pocket(1), changer.magazine.pocket(2)), (12, 11));
        changer.magazine.put(1, 12, false, true);
        for (call, expected) in [
            // To the fixed pocket of tool 1, and from there back: tool 2 keeps pocket 11.
            (1, [(11, 0, true), (12, 1, false)]),
            (2, [(12, 0, true), (11, 2, false)]),
        ] {
            assert_eq!(codes(&mut changer, &[call]), expected);
            assert_eq!((changer.magazine.pocket(1), changer.magazine.pocket(2)), (12, 11));
        }
        let mut double_arm = plc_sets(signal::TOOL_NUMBER_ORDER);
        let codes = codes_with(&mut changer, &mut double_arm, &[1]);
        assert_eq!(codes, [(12, 1, true), (11, 0, false)]);
    }

    /// MP7480.0 = 1: the tool number in W262, on change only [000:9221-9263].
    #[test]
    fn tool_numbers() {
        let mut tools = tools(ToolOutputKind::Tool);
        assert_eq!(codes(&mut tools, &[1, 1, 2]), [(1, 0, false), (2, 0, false)]);
    }

    /// MP7480.0 = 5: pocket and tool; N to N one code, N to M (P_old, 0) and (255, T), M to N (255, 0) and
    /// (P_new, T), M to M one [000:9287-9410].
    #[test]
    fn fixed_pockets() {
        let mut tools = tools(ToolOutputKind::FixedPocket);
        assert_eq!(codes(&mut tools, &[1, 2]), [(11, 1, false), (12, 2, false)]);
        assert_eq!(codes(&mut tools, &[3]), [(12, 0, true), (255, 3, false)]);
        assert_eq!(codes(&mut tools, &[5]), [(255, 5, false)]);
        assert_eq!(codes(&mut tools, &[1]), [(255, 0, true), (11, 1, false)]);
        assert_eq!(codes(&mut tools, &[4]), [(11, 0, true), (14, 4, false)]);
    }

    /// The nine transitions of variable pocket coding, MP7480.0 = 3: N are tools 1 and 2 (pockets 11, 12), M
    /// 3 and 5, S 4 and 6 (pockets 14, 16). Single arm (M2600 = 0): the old tool first; double arm: the new
    /// one first, unless one of them is changed by hand [000:9287-9410].
    #[test]
    fn nine_transitions() {
        type Codes<'a> = &'a [(i16, i16, bool)];
        let both: [(u32, u32, Codes); 9] = [
            (1, 2, &[(12, 2, false)]),
            (3, 5, &[(255, 5, false)]),
            (4, 6, &[(16, 6, false)]),
            (4, 1, &[(14, 0, true), (11, 1, false)]),
            (1, 4, &[(11, 0, true), (14, 4, false)]),
            (3, 1, &[(255, 0, true), (11, 1, false)]),
            (3, 4, &[(255, 0, true), (14, 4, false)]),
            (1, 3, &[(11, 0, true), (255, 3, false)]),
            (4, 3, &[(14, 0, true), (255, 3, false)]),
        ];
        for (old, new, expected) in both {
            let mut tools = tools(ToolOutputKind::Pocket);
            tools.holds(old);
            assert_eq!(codes(&mut tools, &[new]), expected, "{old} -> {new}, single arm");
            let mut tools = super::tests::tools(ToolOutputKind::Pocket);
            tools.holds(old);
            let swapped: Vec<_> = match (old, new, expected) {
                (1 | 4, 1 | 4, [(p, t, _), (q, u, _)]) => vec![(*q, *u, true), (*p, *t, false)],
                _ => expected.to_vec(),
            };
            let mut double_arm = plc_sets(signal::TOOL_NUMBER_ORDER);
            let codes = codes_with(&mut tools, &mut double_arm, &[new]);
            assert_eq!(codes, swapped, "{old} -> {new}, double arm");
        }
        // M2601: a special tool goes back to its own pocket.
        let mut tools = tools(ToolOutputKind::Pocket);
        tools.holds(4);
        let mut own = plc_sets(signal::SPECIAL_TOOL_TO_OWN_POCKET);
        assert_eq!(
            codes_with(&mut tools, &mut own, &[6]),
            [(14, 0, true), (16, 6, false)]
        );
    }

    /// Variable coding: tool 1 takes pocket 12, from which tool 2 came; tool 2 would go to 11, which is free.
    /// M2612 keeps the table; T0 empties the spindle.
    #[test]
    fn pockets_change_with_the_tools() {
        let mut tools = tools(ToolOutputKind::Pocket);
        assert_eq!(
            codes(&mut tools, &[1, 2, 1, 0]),
            [(11, 1, false), (12, 2, false), (12, 1, false), (11, 0, false)]
        );
        let mut tools = super::tests::tools(ToolOutputKind::Pocket);
        let mut keep = plc_sets(signal::KEEP_POCKET_NUMBERS);
        assert_eq!(
            codes_with(&mut tools, &mut keep, &[1, 2, 1]),
            [(11, 1, false), (12, 2, false), (11, 1, false)]
        );
    }

    /// M2400 stays until another tool is called; M2401 and M2402 with MP7480 = 3 or 4 only; M2403 for a
    /// special tool [000:9229] [000:9294-9296].
    #[test]
    fn markers_of_the_called_tool() {
        let marks = |what, call| {
            let mut exchange = Exchange::default();
            tools(what).call(&tool_call(call), &mut exchange, &mut Handshakes::default());
            [
                signal::TOOL_0_PROGRAMMED,
                signal::ACTIVE_TOOL_HAS_POCKET,
                signal::ACTIVE_TOOL_HAS_NO_POCKET,
                signal::ACTIVE_TOOL_IS_SPECIAL,
            ]
            .map(|marker| exchange.nc().bit(marker))
        };
        assert_eq!(marks(ToolOutputKind::Pocket, 0), [true, false, false, false]);
        assert_eq!(marks(ToolOutputKind::Pocket, 1), [false, true, false, false]);
        assert_eq!(marks(ToolOutputKind::Pocket, 3), [false, false, true, false]);
        assert_eq!(marks(ToolOutputKind::Pocket, 4), [false, true, false, true]);
        assert_eq!(marks(ToolOutputKind::Tool, 4), [false, false, false, true]);
    }

    /// TOOL DEF of a tool without pocket means nothing to the PLC [000:9285].
    #[test]
    fn definitions() {
        let mut tools = tools(ToolOutputKind::FixedPocket);
        let transfer = Transfer::ToolDef { w262: 12, w264: 2 };
        assert_eq!(tools.define(2), Some(transfer));
        assert_eq!(tools.define(2), None, "on change only");
        assert_eq!(tools.define(3), None, "no pocket");
    }
}
