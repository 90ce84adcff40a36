//! Tools: what TOOL CALL and TOOL DEF hand to the PLC (MP7480).

use std::collections::BTreeMap;

use bahn_exchange::{Exchange, signal};
use bahn_parameters::{ToolOutput, ToolOutputKind, ToolParameters};
use bahn_plc::ToolCallBlock;

use crate::feeder::Offsets;
use crate::handshake::{Handshakes, Transfer};
use crate::setup::{Remembered, Tool};

/// W262 for a tool without pocket [000:9273-9283].
const NO_POCKET: i16 = 255;

/// The tool table and the tool in the spindle.
#[derive(Debug)]
pub(crate) struct Tools {
    table: Option<BTreeMap<u32, Tool>>,
    parameters: ToolParameters,
    /// Tool in the spindle.
    pub number: u32,
    /// Tool of the last TOOL CALL.
    called: u32,
    /// Tool of the last TOOL DEF.
    defined: Option<u32>,
    /// A TOOL CALL that module 9150 inserted.
    pub inserted_call: Option<ToolCallBlock>,
}

/// The kinds of tools that decide how many codes go out [000:9287-9307].
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// With a pocket.
    Normal,
    /// Without a pocket: changed by hand.
    Manual,
    /// A special tool.
    Special,
}

impl Tools {
    pub fn new(
        table: Option<BTreeMap<u32, Tool>>,
        parameters: ToolParameters,
        remembered: &Remembered,
    ) -> Tools {
        Tools {
            table,
            parameters,
            number: remembered.tool,
            called: remembered.tool,
            defined: None,
            inserted_call: None,
        }
    }

    /// The shapes for the interpreter; `None` when tools are defined in the programs.
    pub fn shapes(&self) -> Option<bahn_interpreter::ToolTable> {
        let table = self.table.as_ref()?;
        Some(table.iter().map(|(number, tool)| (*number, tool.shape)).collect())
    }

    fn tool(&self, number: u32) -> Tool {
        self.table
            .as_ref()
            .and_then(|table| table.get(&number))
            .copied()
            .unwrap_or_default()
    }

    fn kind(&self, number: u32) -> Kind {
        let tool = self.tool(number);
        match (tool.pocket, tool.special) {
            (None, _) => Kind::Manual,
            (_, true) => Kind::Special,
            _ => Kind::Normal,
        }
    }

    /// W262 and W264 of a tool [000:9221-9263].
    fn code(&self, output: ToolOutput, number: u32) -> (i16, i16) {
        let tool = i16::try_from(number).unwrap_or(i16::MAX);
        match output.what {
            ToolOutputKind::None | ToolOutputKind::Tool => (tool, 0),
            ToolOutputKind::Pocket | ToolOutputKind::FixedPocket => (self.pocket(number), tool),
        }
    }

    fn pocket(&self, number: u32) -> i16 {
        self.tool(number)
            .pocket
            .and_then(|pocket| i16::try_from(pocket).ok())
            .unwrap_or(NO_POCKET)
    }

    /// TOOL DEF for the next tool. A tool without pocket means nothing to the PLC [000:9285].
    pub fn define(&mut self, number: u32) -> Option<Transfer> {
        let output = self.parameters.definition;
        let changed = self.defined != Some(number);
        let by_pocket = matches!(output.what, ToolOutputKind::Pocket | ToolOutputKind::FixedPocket);
        self.defined = Some(number);
        if output.what == ToolOutputKind::None
            || !(changed || output.always)
            || by_pocket && self.pocket(number) == NO_POCKET
        {
            return None;
        }
        let (w262, w264) = self.code(output, number);
        Some(Transfer::ToolDef { w262, w264 })
    }

    /// TOOL CALL: one or two codes, by the kinds of the old and the new tool [000:9287-9410].
    pub fn call(&mut self, number: u32, handshakes: &mut Handshakes) {
        let output = self.parameters.call;
        let (old, changed) = (self.called, self.called != number);
        self.called = number;
        self.number = number;
        if output.what == ToolOutputKind::None || !(changed || output.always) {
            return;
        }
        let (w262, w264) = self.code(output, number);
        let returned = (self.pocket(old), 0);
        // With tool numbers, and with fixed pockets between tools of the magazine, one code does
        // (inferred for what the table of variable coding does not say).
        let two = output.what != ToolOutputKind::Tool
            && changed
            && old != 0
            && match (self.kind(old), self.kind(number)) {
                (Kind::Normal, Kind::Normal) | (Kind::Manual, Kind::Manual) => false,
                (Kind::Special, Kind::Special) => self.parameters.call.what == ToolOutputKind::FixedPocket,
                _ => true,
            };
        if two {
            let (pocket, tool) = returned;
            handshakes.push(Transfer::ToolCall {
                w262: pocket,
                w264: tool,
                more: true,
            });
        }
        handshakes.push(Transfer::ToolCall {
            w262,
            w264,
            more: false,
        });
    }

    /// The last code of a TOOL CALL was acknowledged.
    pub fn inserted(&mut self) {
        self.number = self.called;
    }

    /// M2717: the geometry of the tool in W264 is active [000:9217-9219].
    pub fn take_geometry_strobe(&mut self, exchange: &mut Exchange, offsets: &mut Offsets) {
        if !exchange.nc().bit(signal::ACTIVATE_TOOL_GEOMETRY) {
            return;
        }
        let number = exchange.nc().number(signal::TOOL_NUMBER);
        if let Ok(number) = u32::try_from(number) {
            self.number = number;
            self.called = number;
            offsets.tool_length = self.tool(number).shape.length;
        }
        exchange.nc_set(signal::ACTIVATE_TOOL_GEOMETRY, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tools(what: ToolOutputKind) -> Tools {
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
        ];
        let output = ToolOutput { what, always: false };
        let parameters = ToolParameters {
            table_size: 10,
            pockets: 20,
            reserved_pockets: 0,
            call: output,
            definition: output,
        };
        Tools::new(
            Some(table.into_iter().collect()),
            parameters,
            &Remembered::default(),
        )
    }

    /// The codes (W262, W264, M2093) of a row of calls.
    fn codes(tools: &mut Tools, calls: &[u32]) -> Vec<(i16, i16, bool)> {
        let mut handshakes = Handshakes::default();
        for call in calls {
            tools.call(*call, &mut handshakes);
        }
        let mut exchange = Exchange::default();
        let mut codes = Vec::new();
        while !handshakes.is_idle() {
            handshakes.cycle(&mut exchange, true);
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
            handshakes.cycle(&mut exchange, true);
            exchange.begin_scan();
            exchange.plc_mut().set_bit(signal::TOOL_CALL_ACK, false);
            exchange.end_scan();
        }
        codes
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
