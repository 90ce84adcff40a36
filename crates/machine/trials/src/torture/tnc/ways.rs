//! The way that is left to an axis after every reaction of the table that bounds it: ramp, 0 V, open loop. What is left
//! after "control is ready" off is in [`super::axes`].

use bahn_machine::{AxisState, Machine};
use bahn_parameters::fault::Travel;
use bahn_path::OverrideLaw;
use bahn_tnc::{AxisWatch, ChannelView, RunState, Signal};

use super::axes::{Braking, Moment};
use crate::torture::rule::{Rule, Violation};

/// Contour cycles at full speed that are left to a ramp beside its own way: the one in which it is wanted, the one that is
/// interpolated already, and that of the table.
const RAMP_CYCLES: f64 = 3.0;
/// What rounding adds to a ramp, mm or degrees.
const ROUNDING: f64 = 1e-3;

/// The path of a channel on its ramp.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    way: f64,
    bound: f64,
}

/// Why an axis is left to its machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// Its loop was opened: [`Travel::Brake`].
    Open,
    /// The feed enable was withdrawn, the drive has power: [`Travel::Drive`].
    Halted,
    /// The drive has no power.
    Dead,
}

/// An axis after a reaction.
#[derive(Clone, Copy, Debug)]
struct Left {
    output: usize,
    cause: Cause,
    braking: Option<Braking>,
}

/// Follows the ways of a machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Ways {
    /// Of each channel: its run went on, and the ramp after that.
    ramps: Vec<(bool, Option<Ramp>)>,
    /// Channels that a message stops.
    stopped: Vec<usize>,
    left: Vec<Left>,
}

impl Ways {
    /// A message with a ramp is shown: in one channel, or in all of them.
    pub fn stops(&mut self, channel: Option<usize>, channels: usize) {
        match channel {
            Some(channel) => self.stopped.push(channel),
            None => self.stopped.extend(0..channels),
        }
    }

    /// Begins anew, as after power-on.
    pub fn restart(&mut self) {
        *self = Ways::default();
    }

    /// A cycle of a channel.
    pub fn channel(&mut self, view: ChannelView, plant: &Machine, moment: &Moment) -> Result<(), Violation> {
        self.path(&view, moment)?;
        for watch in view.watch() {
            // An axis that follows its loop is left to nobody: what the machine knows of it need not be asked.
            if watch.closed && !watch.halted || moment.fatal || moment.unbraked {
                self.left.retain(|left| left.output != watch.output);
            } else if let Some(axis) = plant.axes().find(|axis| axis.output == watch.output) {
                self.axis(&watch, &axis, moment)?;
            }
        }
        Ok(())
    }

    /// The path comes to a standstill on the ramp of MP1060, however its run was stopped: NC stop or a message.
    fn path(&mut self, view: &ChannelView, moment: &Moment) -> Result<(), Violation> {
        let number = view.number();
        if self.ramps.len() <= number {
            self.ramps.resize(number + 1, (false, None));
        }
        let speed = view.observe(&Signal::PathSpeed).abs() / 60.0;
        let runs = view.run_state() == RunState::Running;
        let stopped = self.stopped.contains(&number);
        self.stopped.retain(|stopped| *stopped != number);
        // In a thread the spindle leads the path, and both run down together; where a head is swivelled the ramp of the path
        // is that of the axis that has most to do for it.
        let otherwise = view.element().is_some_and(|element| {
            !matches!(element.override_law, OverrideLaw::Free) || element.placement.is_some()
        });
        let Some((ran, ramp)) = self.ramps.get_mut(number) else {
            return Ok(());
        };
        let ended = std::mem::replace(ran, runs) && !runs;
        if speed == 0.0 || otherwise || runs && !stopped && ended {
            *ramp = None;
            return Ok(());
        }
        match ramp {
            Some(_) if runs && !stopped => *ramp = None,
            Some(ramp) => {
                ramp.way += speed * moment.cycle_s;
                if ramp.way > ramp.bound {
                    let values = format!(
                        "the path travels {:.4} after the stop of channel {}, {:.4} are left to it",
                        ramp.way,
                        number + 1,
                        ramp.bound
                    );
                    return Err(Violation::new(Rule::Distance, moment.time_us, values));
                }
            }
            None if ended || stopped => {
                let axes = view.watch().filter(|watch| watch.on_path && !watch.slave);
                let least = axes
                    .map(|watch| watch.acceleration_mm_s2)
                    .fold(f64::INFINITY, f64::min);
                let bound = speed * speed / (2.0 * least) + RAMP_CYCLES * speed * moment.cycle_s + ROUNDING;
                *ramp = Some(Ramp { way: 0.0, bound });
            }
            None => {}
        }
        Ok(())
    }

    /// An axis whose loop is open, or whose feed is not enabled.
    fn axis(&mut self, watch: &AxisWatch, axis: &AxisState, moment: &Moment) -> Result<(), Violation> {
        let place = self.left.iter().position(|left| left.output == watch.output);
        let cause = match watch.closed {
            false => Cause::Open,
            true if axis.powered => Cause::Halted,
            true => Cause::Dead,
        };
        match place.and_then(|place| self.left.get_mut(place)) {
            Some(left) if left.cause == cause => {
                if let Some(braking) = &left.braking {
                    braking.check(axis, travel(cause).word(), moment)?;
                }
            }
            other => {
                let braking = match travel(cause) {
                    // A digital drive is held on the ramp of MP1060.
                    Travel::Drive => {
                        Braking::by_drive(axis, watch.torque_s.map(|_| watch.acceleration_mm_s2))
                    }
                    _ => Braking::of(axis),
                };
                let new = Left {
                    output: watch.output,
                    cause,
                    braking,
                };
                match other {
                    Some(left) => *left = new,
                    None => self.left.push(new),
                }
            }
        }
        Ok(())
    }
}

/// The row of the table that bounds the way.
fn travel(cause: Cause) -> Travel {
    use bahn_parameters::fault::FaultId;
    match cause {
        Cause::Open => FaultId::OpenLoop.row().travel,
        Cause::Halted => FaultId::FeedEnable.row().travel,
        Cause::Dead => Travel::Brake,
    }
}
