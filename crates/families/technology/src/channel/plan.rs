//! What decoding has made of the blocks so far: the path, and what is done where on it.

use bahn_kernel::gates::Gates;

use super::decoding::Decoding;
use super::in_force::InForce;
use super::order::{OrderId, Orders};
use super::own::Own;
use super::ranges::Ranges;
use crate::plc::Script;
use crate::report::{Fault, Warning};
use crate::settings::ChannelSettings;

/// What blocks before have left.
pub(super) struct Plan<'a> {
    pub(super) settings: &'a ChannelSettings,
    /// Settings as the program has left them.
    pub(super) in_force: InForce,
    pub(super) decoding: Decoding,
}

/// Takes blocks into the path.
pub(super) struct Taking<'t> {
    pub(super) in_force: &'t InForce,
    pub(super) decoding: &'t mut Decoding,
    pub(super) gates: &'t mut Gates<OrderId, Own>,
    pub(super) orders: &'t mut Orders,
    pub(super) ranges: &'t mut Ranges,
    /// MVS_SLM and MVS_SLP functions that wait for their place.
    pub(super) late: &'t mut [Vec<OrderId>; 2],
    pub(super) cycle_s: f64,
    pub(super) script: Option<&'t Script>,
    pub(super) warnings: &'t mut Vec<Warning>,
}

impl<'a> Plan<'a> {
    /// A plan with nothing decoded yet.
    pub(super) fn new(settings: &'a ChannelSettings) -> Plan<'a> {
        Plan {
            settings,
            in_force: InForce::new(settings),
            decoding: Decoding::default(),
        }
    }

    /// The fault of a block with the code that a variable has given it.
    pub(super) fn coded(&mut self, fault: Fault) -> Fault {
        match self.in_force.code.take() {
            Some(code) => Fault { code, ..fault },
            None => fault,
        }
    }
}
