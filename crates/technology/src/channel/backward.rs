//! The way back along what was executed, and forward again over it.
//!
//! On the way back functions are output as MOS, those with BWD_SYNCH as MVS_SVS; forward again they have their own types
//! [004:54] (public: backward motion). What is output ahead is not repeated (inferred).

use std::collections::{BTreeMap, VecDeque};

use bahn_motion::Drive;
use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, Step};

use super::Channel;
use super::order::{OrderId, State};
use super::record::Moment;
use super::track::{Deed, Track};
use crate::synch::{Synch, SynchType};

#[derive(Debug, Default)]
pub(super) struct Backward {
    back: Option<Back>,
}

/// The path goes back.
#[derive(Debug)]
struct Back {
    /// The element on which it turned, and how much of that was executed, mm.
    from: u64,
    along: f64,
    /// Number of the way back that the interpolator is given next: the first is 1.
    fed: u64,
    /// The place to which the path has come back, and the one whose functions were looked at last.
    reached: u64,
    seen: u64,
    /// Functions that are to be output at that place, and those that are waited for.
    queue: VecDeque<OrderId>,
    gate: Vec<OrderId>,
}

impl Backward {
    pub(super) fn is_on(&self) -> bool {
        self.back.is_some()
    }
}

/// Gives the interpolator the elements of the track from one on back.
struct FeedBack<'a> {
    track: &'a Track,
    back: &'a mut Back,
}

impl ElementSource for FeedBack<'_> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        let number = self.back.element(self.back.fed);
        let leg = number.and_then(|number| self.track.leg(number));
        let Some(leg) = leg else {
            return Step::Barrier(Barrier::Acknowledge {
                block: BlockRef::default(),
            });
        };
        let along = if self.back.fed == 1 {
            self.back.along
        } else {
            leg.length
        };
        let element = leg.rest(along, true).element(self.back.fed);
        self.back.fed += 1;
        Step::Element(element)
    }

    fn resume(&mut self, _: LiveData) {}
}

impl Back {
    /// The element that is so many on the way back.
    fn element(&self, back: u64) -> Option<u64> {
        (self.from + 1).checked_sub(back)
    }
}

impl Channel<'_> {
    /// Spends a cycle on the path. Whether it moved.
    pub(super) fn spend(&mut self, mut drive: Drive) -> bool {
        drive.hold |= self.resets();
        let t = self.t() + 0.5 * self.cycle_s;
        let script = self.plc.script();
        let wanted = script.is_some_and(|script| script.backward.iter().any(|range| range.contains(&t)));
        if wanted == self.backward.is_on() {
            return self.spend_on(drive);
        }
        // The path turns where it stands.
        if !self.still {
            drive.hold = true;
            return self.spend_on(drive);
        }
        if !self.stands {
            let at = self.now();
            self.stop(at);
        }
        if wanted {
            self.turn_back();
        } else {
            self.turn_forward();
        }
        self.spend_on(drive);
        true
    }

    fn spend_on(&mut self, drive: Drive) -> bool {
        if self.backward.is_on() {
            self.cycle_back(drive)
        } else {
            self.cycle_path(drive)
        }
    }

    /// The element on which the path is, and how much of it is executed, mm.
    fn whereabouts(&self) -> (u64, f64) {
        let number = self.reached;
        let leg = self.track.leg(number);
        let along = leg.map_or(0.0, |leg| self.way() - leg.from);
        match number.checked_sub(1).and_then(|before| self.track.leg(before)) {
            Some(before) if along <= 0.0 => (number - 1, before.length),
            _ => (number, along),
        }
    }

    fn turn_back(&mut self) {
        let (from, along) = self.whereabouts();
        let position = self.path.position();
        self.path.clear();
        self.path.set_position(position);
        self.backward.back = Some(Back {
            from,
            along,
            fed: 1,
            reached: from + 1,
            seen: from + 1,
            queue: VecDeque::new(),
            gate: Vec::new(),
        });
    }

    /// The way along the path, mm, while it is run back.
    pub(super) fn way_back(&self) -> Option<f64> {
        let back = self.backward.back.as_ref()?;
        let number = self
            .path
            .element()
            .and_then(|element| back.element(element.sequence));
        let leg = number.and_then(|number| self.track.leg(number));
        Some(match leg {
            Some(leg) => leg.from + self.path.rest_mm(),
            None => self
                .track
                .leg(back.from)
                .map_or_else(|| self.track.way(self.track.first()), |leg| leg.from + back.along),
        })
    }

    fn cycle_back(&mut self, mut drive: Drive) -> bool {
        let Some(back) = self.backward.back.as_mut() else {
            return false;
        };
        let mut feed = FeedBack {
            track: &self.track,
            back,
        };
        self.path.prepare(&mut feed, usize::MAX);
        let (from, seen, reached) = (back.from, back.seen, back.reached);
        let waits = !back.queue.is_empty() || !back.gate.is_empty();
        // The next place with a function that is waited for on the way back.
        let first = self.track.first();
        let known = (from + 2).saturating_sub(back.fed).max(first);
        let stop = (known..seen).rev().find(|place| self.waits_backward(*place));
        drive.stop_before = stop.map(|place| from + 2 - place);
        drive.hold |= waits;
        if stop != Some(reached) && !waits {
            self.path.go_on();
        }
        let number = if reached > from {
            from
        } else {
            reached.saturating_sub(1)
        };
        let block = self.track.leg(number).map(|leg| leg.block.clone());
        self.drive_once(&drive, block)
    }

    /// Whether a function at a place is waited for on the way back.
    fn waits_backward(&self, place: u64) -> bool {
        self.track.deeds(place).iter().any(|deed| match deed {
            Deed::Output(id) => self.orders.get(*id).is_some_and(|order| order.synch.backward),
            _ => false,
        })
    }

    /// The path has come to the end of an element.
    pub(super) fn pass(&mut self, sequence: u64) {
        match self.backward.back.as_mut() {
            Some(back) => {
                if let Some(place) = back.element(sequence) {
                    back.reached = place;
                }
            }
            None => self.reached = self.reached.max(sequence + 1),
        }
    }

    /// Outputs functions on the way back. Whether anything was done.
    pub(super) fn act_backward(&mut self) -> bool {
        let Some(mut back) = self.backward.back.take() else {
            return false;
        };
        let mut any = false;
        loop {
            while let Some(id) = back.queue.front().copied() {
                if self.range_of(id).and_then(|range| self.blocker(range)).is_some() {
                    break;
                }
                back.queue.pop_front();
                any = true;
                let at = Moment {
                    position: self.track.position(back.seen),
                    ..self.now()
                };
                self.output(id, at, None);
                back.gate.push(id);
            }
            back.gate.retain(|id| !self.orders.is_done(*id));
            if !back.queue.is_empty() || !back.gate.is_empty() || back.seen <= back.reached {
                break;
            }
            back.seen -= 1;
            any = true;
            back.queue = self.repeated(back.seen);
        }
        self.backward.back = Some(back);
        any
    }

    /// The functions of a place as they are output on the way back, the last one first.
    fn repeated(&mut self, place: u64) -> VecDeque<OrderId> {
        let deeds = self.track.deeds(place).iter().rev();
        let ids: Vec<_> = deeds
            .filter_map(|deed| match deed {
                Deed::Output(id) => Some(*id),
                _ => None,
            })
            .collect();
        let mut queue = VecDeque::new();
        for id in ids {
            let Some(mut order) = self.orders.get(id).cloned() else {
                continue;
            };
            order.waits = order.synch.backward;
            let kind = if order.waits {
                SynchType::MvsSvs
            } else {
                SynchType::Mos
            };
            // On the way back a simulated one is waited for all the same (public).
            order.synch = Synch {
                kind,
                forward: order.waits,
                ..order.synch
            };
            (order.spindle, order.state) = (None, State::default());
            queue.push_back(self.orders.push(order));
        }
        queue
    }

    /// The functions for which the path cannot go on back.
    pub(super) fn missing_backward(&self) -> Vec<OrderId> {
        let Some(back) = &self.backward.back else {
            return Vec::new();
        };
        let front = back.queue.front();
        let blocked = front.and_then(|id| self.range_of(*id).and_then(|range| self.blocker(range)));
        back.gate.iter().copied().chain(blocked).collect()
    }

    /// Goes forward again from where the path stands: what it comes over is output anew.
    fn turn_forward(&mut self) {
        let way = self.way();
        let Some(back) = self.backward.back.take() else {
            return;
        };
        let number = back.reached.saturating_sub(1).max(self.track.first());
        let (mut number, mut along) = match self.track.leg(number) {
            Some(leg) => (number, (way - leg.from).max(0.0)),
            // There is no way to go back: it is still at the place where it turned.
            None => (number, 0.0),
        };
        if self.track.leg(number).is_some_and(|leg| along >= leg.length) {
            (number, along) = (number + 1, 0.0);
        }
        let position = self.path.position();
        self.path.clear();
        self.path.set_position(position);
        let first = if along > 0.0 { number + 1 } else { number };
        self.renew(first, self.cursor.0);
        let done = if along > 0.0 {
            self.track.deeds(number).len()
        } else {
            0
        };
        (self.fed, self.reached, self.cursor) = (number, number, (number, done));
        (self.open_to, self.dwell) = (number, None);
        self.part = (along > 0.0).then_some(along);
    }

    /// The functions of these places are new ones.
    fn renew(&mut self, first: u64, last: u64) {
        let mut renewed: BTreeMap<OrderId, OrderId> = BTreeMap::new();
        for place in first..=last {
            for deed in self.track.deeds(place) {
                let (Deed::Output(id) | Deed::Command(id)) = deed else {
                    continue;
                };
                if let Some(mut order) = self.orders.get(*id).cloned()
                    && !renewed.contains_key(id)
                {
                    order.state = State::default();
                    renewed.insert(*id, self.orders.push(order));
                }
            }
        }
        let new = |id: &mut OrderId| *id = renewed.get(id).copied().unwrap_or(*id);
        for place in first..=self.track.last() {
            for deed in self.track.deeds_mut(place) {
                match deed {
                    Deed::Output(id) | Deed::Command(id) => new(id),
                    Deed::Gate(ids) => ids.iter_mut().for_each(new),
                    _ => {}
                }
            }
        }
        self.decoding.late.iter_mut().flatten().for_each(new);
    }
}
