//! What the functions of the channel are to the gates of its path.

use bahn_kernel::gates::{Functions, Moment, Short, Way, Why};
use bahn_motion::Limits;
use bahn_path::{Position, Synchronisation};

use super::beside::Beside;
use super::order::{Order, OrderId, Orders, RangeId, State};
use super::own::Own;
use super::ranges::Ranges;
use super::record::Record;
use crate::plc::{Output, Plc};
use crate::report::{EventKind, Fault, ToGo, Warning};
use crate::settings::ChannelSettings;
use crate::synch::Synch;

/// 0.1 µm and µs are these parts of a mm and a second.
const PER_MM: f64 = 1e4;
const PER_S: f64 = 1e6;
/// ms in a second, µm in a mm.
const THOUSAND: f64 = 1e3;

/// The functions that were programmed, with PLC and spindles.
pub(super) struct Side<'a> {
    settings: &'a ChannelSettings,
    pub(super) cycle_s: f64,
    /// Cycles of the run that are over.
    pub(super) cycle: u64,
    pub(super) orders: Orders,
    pub(super) ranges: Ranges,
    /// MVS_SLM and MVS_SLP functions that wait for their place, over all programs.
    pub(super) late: [Vec<OrderId>; 2],
    pub(super) plc: Plc<'a>,
    pub(super) record: Record,
    pub(super) beside: Beside<'a>,
    /// Simulated forward motion: functions are output as MOS.
    pub(super) simulated: bool,
    /// Why the run cannot go on.
    pub(super) fault: Option<Fault>,
    /// The program has ended.
    pub(super) ended: bool,
}

impl<'a> Side<'a> {
    /// Nothing was programmed; cycles take so long, s.
    pub(super) fn new(
        settings: &'a ChannelSettings,
        limits: &'a Limits,
        plc: Plc<'a>,
        cycle_s: f64,
    ) -> Side<'a> {
        Side {
            settings,
            cycle_s,
            cycle: 0,
            orders: Orders::default(),
            ranges: Ranges::default(),
            late: Default::default(),
            plc,
            record: Record::default(),
            beside: Beside::new(limits),
            simulated: false,
            fault: None,
            ended: false,
        }
    }

    /// Time of the run, s.
    pub(super) fn t(&self) -> f64 {
        self.cycle as f64 * self.cycle_s
    }

    /// A function is fetched or acknowledged.
    pub(super) fn answered(&mut self, kind: EventKind, id: OrderId, at: Moment) {
        match kind {
            EventKind::Fetch => self.ranges.fetch(id, &mut self.orders),
            _ => self.ranges.acknowledge(id, &mut self.orders),
        }
        self.note(kind, id, at);
    }

    fn note(&mut self, kind: EventKind, id: OrderId, at: Moment) {
        if let Some(order) = self.orders.get(id) {
            let target = order.range.map_or("", |range| self.ranges.name(range));
            self.record.function(kind, (id, order), target, at);
        }
    }

    /// Says which lists of active functions have changed.
    pub(super) fn lists(&mut self, at: Moment) {
        let record = &mut self.record;
        self.ranges
            .changed(|target, letter, numbers| record.active(target, letter, numbers, at));
    }

    /// Drops all functions that are open.
    pub(super) fn reset(&mut self) {
        self.plc.reset();
        self.ranges.reset();
        self.late.iter_mut().for_each(Vec::clear);
    }

    /// The type of a function counts in motion as it is: not in simulated motion, unless the type says so.
    fn counts(&self, order: &Order) -> bool {
        !self.simulated || order.synch.forward
    }

    fn put(&mut self, id: OrderId, at: Moment, offset_us: Option<f64>) {
        let simulated = self.simulated;
        if let Some(order) = self.orders.get_mut(id)
            && simulated
            && !order.synch.forward
        {
            order.waits = false;
        }
        let has_room = self.ranges.output(id, &mut self.orders, self.cycle);
        let Some(order) = self.orders.get(id) else {
            return;
        };
        let Some(range) = order.range else { return };
        let label = order.label();
        let names = self.ranges.names(range);
        let output = Output {
            id,
            names,
            label: &label,
            range: range.in_window(),
            letter: order.letter.byte(),
            number: order.number,
            value: order.value.in_window(),
            process_s: order.process_s,
            offset_us,
            waits: order.waits,
        };
        self.plc.order(&output, self.cycle);
        if !has_room {
            let message = format!("{label} is one late function too many that is not acknowledged");
            self.fault = Some(super::fault::numbered(&order.place, 60146, message));
        }
        self.note(EventKind::Output, id, at);
    }

    /// Whether the PLC gets the time since the path was at the place of a function.
    fn is_stamped(&self, id: OrderId) -> bool {
        self.orders.get(id).is_some_and(|order| {
            order.synch.kind == Synchronisation::MosTs && order.range == Some(RangeId::Channel)
        })
    }

    fn why(&self, why: Why) -> String {
        match why {
            Why::NoStop => {
                "it is planned with an end velocity of 0 there, and the path has not stopped".to_owned()
            }
            Why::Sooner => "the path has come there sooner than it was planned".to_owned(),
            Why::Another => "another function came first, or was not fetched".to_owned(),
            Why::Barrier => "the path begins there, or comes to rest there for a flush".to_owned(),
            Why::LookAhead => {
                let blocks = self.settings.pre_output.blocks;
                format!("the look-ahead of {blocks} blocks begins there (P-CHAN-00274)")
            }
        }
    }
}

impl Functions for Side<'_> {
    type Ticket = OrderId;
    type Own = Own;

    fn cycle(&self) -> u64 {
        self.cycle
    }

    fn is_done(&self, id: OrderId) -> bool {
        self.orders.is_done(id)
    }

    fn is_open(&self, id: OrderId) -> bool {
        let is_open = |order: &Order| order.is_done() || !self.counts(order) && !order.state.output;
        self.orders.get(id).is_none_or(is_open)
    }

    fn stands_for(&self, id: OrderId) -> bool {
        !self.simulated || self.orders.get(id).is_some_and(|order| order.synch.forward)
    }

    fn is_waited_for(&self, id: OrderId) -> bool {
        self.orders.get(id).is_some_and(|order| order.waits)
    }

    fn waits_backward(&self, id: OrderId) -> bool {
        self.orders.get(id).is_some_and(|order| order.synch.backward)
    }

    fn blocker(&self, id: OrderId) -> Option<OrderId> {
        let range = self.orders.get(id)?.range?;
        self.ranges.blocked(range, self.plc.fetched_before(self.cycle))
    }

    fn any_blocked(&self) -> bool {
        self.ranges.any_blocked(self.plc.fetched_before(self.cycle))
    }

    /// A spindle of the NC executes a function.
    fn command(&mut self, id: OrderId) {
        let Some(order) = self.orders.get_mut(id) else {
            return;
        };
        order.state.commanded = true;
        if let Some(index) = order.spindle {
            let names = super::resolve::names(RangeId::Spindle(index), self.settings);
            self.plc.command(id, &names, order.process_s, self.cycle);
        }
    }

    fn output(&mut self, id: OrderId, at: Moment, way: Way) {
        let offset_us = match way {
            // Below the cycle, however it is rounded.
            Way::Place(left_s) if self.is_stamped(id) => Some((left_s * 1e9).floor() / 1e3),
            _ => None,
        };
        self.put(id, at, offset_us);
        let to_go = match way {
            Way::Ahead(to_go) => to_go.map(|(distance_mm, time_s)| ToGo {
                path: (distance_mm * PER_MM).round() as i64,
                time: (time_s * PER_S).round() as i64,
            }),
            Way::Place(_) | Way::Back => None,
        };
        self.record.output_beside(offset_us, to_go);
    }

    fn again(&mut self, id: OrderId, backward: bool) -> Option<OrderId> {
        let mut order = self.orders.get(id)?.clone();
        order.state = State::default();
        if backward {
            order.waits = order.synch.backward;
            let kind = if order.waits {
                Synchronisation::MvsSvs
            } else {
                Synchronisation::Mos
            };
            // In backward motion a simulated one is waited for all the same (public).
            order.synch = Synch {
                kind,
                forward: order.waits,
                ..order.synch
            };
            order.spindle = None;
        }
        Some(self.orders.push(order))
    }

    fn renamed(&mut self, new: &dyn Fn(&mut OrderId)) {
        self.late.iter_mut().flatten().for_each(new);
    }

    fn act(&mut self, own: &Own, path: Position, all_out: bool) -> bool {
        match own {
            Own::Independent(independent) => {
                self.beside
                    .begin(independent.as_ref().clone(), path[independent.axis]);
                true
            }
            Own::AllEnded => self.beside.all_ended(),
            Own::Fault(fault) => {
                self.fault = Some(fault.as_ref().clone());
                true
            }
            Own::End => {
                self.ended = all_out;
                all_out
            }
        }
    }

    fn stops_for(&self, own: &Own) -> bool {
        !matches!(own, Own::Independent(_))
    }

    fn waits_for(&self, own: &Own) -> bool {
        !matches!(own, Own::End | Own::AllEnded)
    }

    fn goes_on(&self) -> bool {
        self.fault.is_none() && !self.ended
    }

    fn beside(&self, path: Position) -> Position {
        self.beside.with_path(path)
    }

    fn move_beside(&mut self) -> bool {
        self.beside.cycle(self.cycle_s)
    }

    fn tell(&mut self, moves: bool, block: &str, at: Moment) {
        self.record.path(moves, block, at);
    }

    fn went(&mut self, distance_mm: f64, speed_mm_s: f64) {
        self.record
            .sample(self.t() + self.cycle_s, distance_mm, speed_mm_s);
    }

    fn tell_short_lead(&mut self, id: OrderId, short: Short) {
        let Some(order) = self.orders.get(id) else {
            return;
        };
        let (label, place) = (order.label(), order.place.clone());
        let first = self
            .record
            .is_first(label.clone(), place.program.clone(), place.line);
        if !first {
            return;
        }
        let why = self.why(short.why);
        let (is, asked, unit) = if short.is_time {
            (
                (short.is * THOUSAND).round(),
                (short.asked * THOUSAND).round(),
                "ms",
            )
        } else {
            let of_mm = |mm: f64| (mm * THOUSAND).round() / THOUSAND;
            (of_mm(short.is), of_mm(short.asked), "mm")
        };
        let (is, side) = (is.abs(), if is < 0.0 { "after" } else { "before" });
        self.record.warnings.push(Warning {
            message: format!("{label} is output {is} {unit} {side} its place, not {asked} {unit}: {why}"),
            program: place.program.to_string(),
            block: place.block.to_string(),
        });
    }
}
