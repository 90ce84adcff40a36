//! What the interpolator may do in a cycle of a program run.

use bahn_exchange::{Image, signal};
use bahn_kernel::{Direction, OwnAxes, Progress, Tapping, Track};
use bahn_motion::Drive;
use bahn_path::{AxisSet, PathElement};

use crate::command::Mode;
use crate::markers::WAIT_OPEN_LOOP;
use crate::site::Site;

/// What it depends on beside the site.
pub(crate) struct Driving<'a> {
    pub track: &'a Track,
    pub progress: &'a Progress,
    pub tapping: &'a Tapping,
    /// The element that is executed.
    pub element: Option<&'a PathElement>,
    /// The operator moves axes while the run is interrupted.
    pub by_hand: bool,
    /// The block before which the path stops for another tool.
    pub stop_before: Option<u64>,
    /// The axes are in position.
    pub settled: bool,
    /// The tool is worn.
    pub worn: bool,
}

impl Driving<'_> {
    /// What the interpolator may do in this cycle.
    pub fn drive(&self, site: &Site) -> Drive {
        let now = site.now;
        let coupled = self.track.path.is_coupled();
        let [back, on] = if self.by_hand {
            way_out(self.track, site)
        } else {
            [false; 2]
        };
        let runs_out = self
            .tapping
            .runs_out(self.element, &site.axes, drives_stopped(site));
        let stopped = !self.progress.goes_on() && !on && !runs_out;
        let single = site.mode == Mode::SingleBlock || on || self.worn;
        Drive {
            feed_override_percent: now.program_percent,
            rapid_override_percent: now.program_percent,
            spindle_override_percent: site.spindle.drive.effective_percent(),
            master: self.tapping.master(self.track, &site.standing()),
            back,
            rapid_limit_mm_min: now.rapid_limit_mm_min,
            // Without spindle enable nothing is led. Functions at which the axes do not stop (MP7440 bit 2) may
            // come faster than the PLC takes them.
            hold: stopped || site.handshakes.is_crowded() || coupled && !site.spindle.drive.is_enabled(),
            single_block: single || site.handshakes.inhibit_read_in(),
            stop_before: self.stop_before,
            acknowledged: self.track.has_output_all() && site.handshakes.is_idle(),
            in_position: self.settled,
            clamped: site.axes.clamped(),
            clamping: clamping_axes(&site.axes, site.exchange.nc()),
        }
    }
}

/// Axes that the PLC wants to clamp after their block (M2492 ff.), and whose loop is still closed.
fn clamping_axes(axes: &OwnAxes, nc: &Image) -> AxisSet {
    let wanted = axes.iter().filter(|unit| {
        let marker = WAIT_OPEN_LOOP.get(unit.index);
        unit.servo.closed() && marker.is_some_and(|marker| nc.bit(*marker))
    });
    wanted.fold(AxisSet::EMPTY, |axes, unit| axes.with(unit.axis))
}

/// The path is led back, or on, out of the thread by the axis key plus of the tool axis.
fn way_out(track: &Track, site: &Site) -> [bool; 2] {
    let axis = site.chain.offsets.tool_axis;
    let unit = site.axes.at(axis);
    let key = unit.and_then(|unit| site.now.axis_keys.get(unit.index).copied().flatten());
    let ascends = track
        .path
        .element()
        .is_some_and(|element| element.end[axis] > element.start[axis]);
    let wanted = key == Some(Direction::Plus) && !site.now.stop;
    [wanted && !ascends, wanted && ascends]
}

/// Something stops the drives, not the path alone.
fn drives_stopped(site: &Site) -> bool {
    let open = site.exchange.nc().bit(signal::NC_STOP_AND_OPEN_LOOPS);
    !site.now.ready || open || site.messages.is_fatal()
}
