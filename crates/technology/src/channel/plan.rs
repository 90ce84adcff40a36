//! What decoding has made of the blocks so far: the path, and what is done where on it.

use bahn_path::Position;

use super::decoding::Decoding;
use super::in_force::InForce;
use super::leads::Leads;
use super::order::Orders;
use super::ranges::Ranges;
use super::track::Track;
use super::window::Window;
use crate::plc::Script;
use crate::report::{Fault, Warning};
use crate::settings::ChannelSettings;

/// The path as it is known, with its functions.
pub(super) struct Plan<'a> {
    pub(super) settings: &'a ChannelSettings,
    /// Settings as the program has left them.
    pub(super) in_force: InForce,
    pub(super) decoding: Decoding,
    pub(super) window: Window,
    pub(super) leads: Leads,
    pub(super) track: Track,
    pub(super) orders: Orders,
    pub(super) ranges: Ranges,
}

/// What decoding needs beside the blocks.
pub(super) struct Around<'a> {
    /// Contour cycle, s.
    pub(super) cycle_s: f64,
    pub(super) script: Option<&'a Script>,
    pub(super) warnings: &'a mut Vec<Warning>,
}

impl<'a> Plan<'a> {
    /// Nothing is decoded: the path begins somewhere.
    pub(super) fn new(settings: &'a ChannelSettings, start: Position) -> Plan<'a> {
        let mut window = Window::default();
        window.begin(0.0);
        Plan {
            settings,
            in_force: InForce::new(settings),
            decoding: Decoding::default(),
            window,
            leads: Leads::default(),
            track: Track::new(start, 1, 0.0),
            orders: Orders::default(),
            ranges: Ranges::default(),
        }
    }

    /// The path begins anew, somewhere, at a distance along it, mm. Returns its first place.
    pub(super) fn begin_path(&mut self, start: Position, distance: f64) -> u64 {
        let first = self.track.last() + 1;
        self.track = Track::new(start, first, distance);
        self.window.begin(distance);
        self.leads.begin(distance);
        first
    }

    /// The fault of a block with the code that a variable has given it.
    pub(super) fn coded(&mut self, fault: Fault) -> Fault {
        match self.in_force.code.take() {
            Some(code) => Fault { code, ..fault },
            None => fault,
        }
    }

    /// What lies before a place of the path is forgotten.
    pub(super) fn forget_before(&mut self, reached: u64) {
        let first = self.track.forget_before(reached);
        let ahead = self.leads.forget_before(self.track.distance(self.track.first()));
        let next = self.orders.next();
        let oldest = first.into_iter().chain(ahead).min().unwrap_or(next);
        self.orders.forget_before(oldest);
    }
}
