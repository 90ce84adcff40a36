//! What the control looks after beside the movements: offsets of the drives, lubrication, limits that axes
//! have left, the buffer battery.
//!
//! Decision: EXCHANGE BUFFER BATTERY comes as soon as the battery is low, once since power-on; nothing stops, and the
//! memory is kept
//!
//! Decision: A memory that fails its test at switch-on flashes MEMORY TEST with what is defective; no manual prints a text

use bahn_exchange::Exchange;
use bahn_kernel::{Axes, AxisUnit, Direction, OwnAxes};
use bahn_parameters::operation::OperationParameters;
use bahn_parameters::{MessageId, PerPlcAxis};
use bahn_servo::OffsetInterval;

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

/// The offsets of the drives.
#[derive(Clone, Debug)]
pub(crate) struct DriveOffsets {
    /// When they are adjusted next (MP1220).
    interval: OffsetInterval,
    /// All axes have passed their marks.
    referenced: bool,
    /// Code number 75 368 shows them.
    pub shown: bool,
}

impl DriveOffsets {
    pub fn new(interval_s: f64) -> DriveOffsets {
        DriveOffsets {
            interval: OffsetInterval::new(interval_s),
            referenced: false,
            shown: false,
        }
    }

    /// The interval has changed.
    pub fn set_interval(&mut self, interval_s: f64) {
        self.interval = OffsetInterval::new(interval_s);
    }

    /// The cyclic offset adjustment: all axes stand in their loops, the spindle is off. An axis with
    /// integral factor does without [000:5012] [000:5022-5037]. Controls with patience adjust outside the window, too,
    /// and once the axes have passed their marks [001:2600-2606].
    pub fn adjust_cyclically(&mut self, cycle_us: u32, spindle_off: bool, axes: &mut Axes) {
        let settled = |unit: &AxisUnit| {
            let stood_s = f64::from(unit.stood_cycles) * f64::from(cycle_us) * 1e-6;
            let patience = unit.parameters.offset_patience_s;
            unit.servo.in_position() || patience.is_some_and(|patience_s| stood_s > patience_s)
        };
        let controlled = || axes.iter().filter(|unit| unit.parameters.controlled);
        let permitted =
            spindle_off && controlled().all(|unit| unit.servo.closed() && unit.stands() && settled(unit));
        let referenced = controlled().all(|unit| unit.referenced);
        let passed = referenced && !std::mem::replace(&mut self.referenced, referenced);
        if passed && controlled().all(|unit| unit.parameters.offset_patience_s.is_some()) {
            self.interval.come();
        }
        if !self.interval.pass(cycle_us, permitted) {
            return;
        }
        for unit in axes.iter_mut() {
            if unit.parameters.controlled && unit.parameters.output.integral_factor == 0.0 {
                unit.servo.adjust_offset();
            }
        }
    }

    /// Answers to code number 75 368: compensates the offsets of the axes, or switches the automatic
    /// adjustment off [000:5014-5020]. `false` when they are not shown.
    pub fn answer(&mut self, adjust: bool, axes: &mut Axes) -> bool {
        if !std::mem::take(&mut self.shown) {
            return false;
        }
        for unit in axes.iter_mut() {
            if adjust {
                unit.servo.compensate_offset();
            } else {
                unit.servo.set_offset_compensation(0.0);
            }
        }
        if !adjust {
            self.interval = OffsetInterval::new(0.0);
        }
        true
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
