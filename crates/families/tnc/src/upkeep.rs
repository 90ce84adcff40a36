//! What the control looks after beside the movements: lubrication, limits that axes have left, the buffer battery, the
//! memory test.
//!
//! Decision: EXCHANGE BUFFER BATTERY comes as soon as the battery is low, once since power-on; nothing stops, and the
//! memory is kept
//!
//! Decision: A memory that fails its test at switch-on flashes MEMORY TEST with what is defective; no manual prints a text

use bahn_exchange::Exchange;
use bahn_kernel::{Axes, AxisUnit, OwnAxes};
use bahn_parameters::operation::OperationParameters;
use bahn_parameters::{MessageId, PerPlcAxis};
use bahn_path::Direction;

use crate::markers::LUBRICATION_PULSE;
use crate::message::{Message, Messages};

/// The buffer battery of the memory. A low one is said once since power-on, so that CE clears the message until the
/// control is switched on again; when it is looked at, and that it is at all while the control is on, no manual says
/// (inferred) [000:1385-1400].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BufferBattery {
    said: bool,
}

impl BufferBattery {
    /// Once in each contour cycle. One that was exchanged may be low again.
    pub fn watch(&mut self, low: bool, messages: &mut Messages) {
        if low && !self.said {
            let message = Message::Plain(MessageId::ExchangeBufferBattery);
            messages.of_machine().show(message, None);
        }
        self.said = low;
    }
}

/// The memory test at switch-on, as the machine parameters have it: RAM; EPROMs and checksum. What fails it stops the
/// control for good [001:906-908] [001:2369-2371] [000:6976-6986].
#[derive(Clone, Copy, Debug)]
pub(crate) struct MemoryTest {
    /// What is still to be tested.
    due: [bool; 2],
}

impl MemoryTest {
    pub fn new(rules: &OperationParameters) -> MemoryTest {
        MemoryTest {
            due: [rules.ram_test, rules.eprom_test],
        }
    }

    /// Once in each contour cycle; the first one tests.
    pub fn follow(&mut self, defective: [bool; 2], messages: &mut Messages) {
        let texts = [MessageId::MemoryDefective, MessageId::MemoryChecksum];
        let tested = std::mem::take(&mut self.due).into_iter().zip(defective);
        for ((due, defective), text) in tested.zip(texts) {
            if due && defective {
                messages.of_machine().show(Message::Plain(text), None);
            }
        }
    }
}

/// Something of each axis, by an axis index.
pub(crate) fn by_index<'a, T: Copy + Default>(
    axes: impl Iterator<Item = &'a AxisUnit>,
    index: impl Fn(&AxisUnit) -> usize,
    of: impl Fn(&AxisUnit) -> T,
) -> PerPlcAxis<T> {
    let mut values = PerPlcAxis::splat(T::default());
    for unit in axes {
        if let Some(slot) = values.get_mut(index(unit)) {
            *slot = of(unit);
        }
    }
    values
}

/// The distance of each axis beyond MP4060: it asks for lubrication [000:3575-3577].
pub(crate) fn lubricate(axes: &OwnAxes, exchange: &mut Exchange) {
    for unit in axes.iter() {
        let Some(limit) = unit.parameters.travel.lubrication_mm else {
            continue;
        };
        if unit.travelled > limit
            && let Some(pulse) = LUBRICATION_PULSE.get(unit.index)
        {
            exchange.nc_put(*pulse, true);
        }
    }
}

/// M2624 ff. of a block that was refused goes with its message, unless the axis stands at the limit.
pub(crate) fn leave_limits(axes: &mut Axes, messages: &Messages) {
    for unit in axes.iter_mut() {
        let Some(direction) = unit.at_limit else { continue };
        let limit = unit
            .limits
            .get(usize::from(direction == Direction::Plus))
            .copied();
        let message = Message::limit(unit.id, direction);
        if limit != Some(unit.nominal) && !messages.contains(&message) {
            unit.at_limit = None;
        }
    }
}
