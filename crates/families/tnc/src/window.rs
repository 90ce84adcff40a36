//! The window of a channel into the memory of the PLC.
//!
//! The manuals' PLC knows one channel; its fixed markers and words are those of the first one. Every other channel
//! has a memory of its own with the same markers and words, and a table that says where each of them stands in the
//! memory of the PLC *(inferred)*: `M2448` of the second channel may be `M100` for the PLC program. A marker
//! or word whose place is its own number is shared with the first channel. What the table does not name
//! the PLC can neither see nor set: commands of the panel rest, and NC stop (M2488 = 0) is given.
//!
//! Decision: The PLC of the manuals knows one channel: every other one has a window, a memory with the same markers
//! and words, and a table of where they stand in the PLC's memory; its panel is among them. Modules see the first
//! channel

use bahn_exchange::{Bit, BitArea, Exchange, Number, signal};

use crate::panel;

/// Where the fixed markers and words of a channel stand in the memory of the PLC.
///
/// ```
/// use bahn_tnc::Window;
/// let window = Window::default()
///     .markers("M2448".parse()?, "M100".parse()?, 8)
///     .number("W260".parse()?, "W128".parse()?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Window {
    bits: Vec<(Bit, Bit)>,
    numbers: Vec<(Number, Number)>,
}

impl Window {
    /// The channel's marker stands at a marker of the PLC, and those after it after that.
    pub fn markers(mut self, own: Bit, at: Bit, count: u16) -> Window {
        self.bits.extend((0..count).filter_map(|offset| {
            let marker = |first: Bit| Bit::new(BitArea::M, first.number().checked_add(offset)?);
            Some((marker(own)?, marker(at)?))
        }));
        self
    }

    /// The channel's byte, word or doubleword stands at one of the PLC.
    pub fn number(mut self, own: Number, at: Number) -> Window {
        self.numbers.push((own, at));
        self
    }

    /// The memory of the channel at power-on: no command of the panel is given.
    pub(crate) fn memory(&self) -> Exchange {
        let mut exchange = Exchange::default();
        exchange.nc_set(signal::WORD_PROCESSING, true);
        for complement in panel::complements() {
            exchange.nc_set(complement, true);
        }
        exchange.begin_scan();
        exchange.end_scan();
        exchange
    }

    /// Before a PLC scan: what the channel has changed goes to the memory of the PLC.
    pub(crate) fn publish(&self, own: &mut Exchange, plc: &mut Exchange) {
        own.begin_scan();
        for (bit, at) in &self.bits {
            plc.nc_put(*at, own.plc().bit(*bit));
        }
        for (number, at) in &self.numbers {
            plc.nc_put_number(*at, own.plc().number(*number));
        }
    }

    /// After a PLC scan: what the PLC has changed comes to the channel.
    pub(crate) fn take(&self, own: &mut Exchange, plc: &Exchange) {
        for (bit, at) in &self.bits {
            own.plc_mut().set_bit(*bit, plc.nc().bit(*at));
        }
        for (number, at) in &self.numbers {
            own.plc_mut().set_number(*number, plc.nc().number(*at));
        }
        own.end_scan();
    }
}
