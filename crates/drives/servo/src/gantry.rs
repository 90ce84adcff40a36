//! Synchronized axes: a slave that follows its master [000:4451-4539].

use crate::axis::Axis;
use crate::fault::{Fault, GrossFault};
use crate::settings::CouplingSettings;
use crate::timing::Timing;

/// The coupling of a slave axis to its master.
///
/// In each contour cycle [`Gantry::command`] hands the master's nominal position on and watches the
/// difference of the two.
#[derive(Clone, Debug)]
pub struct Gantry {
    /// The slave goes so much farther than its master.
    ratio: f64,
    /// Position of the slave less that of the master, in its ratio, when they are synchronous, mm.
    offset_mm: f64,
    /// Where the offset is driven to, mm.
    goal_mm: f64,
    /// Distance in a contour cycle in which it is driven, mm.
    part_mm: f64,
    limit_mm: Option<f64>,
    from_marks: bool,
    referenced: bool,
    synchronized: bool,
    difference_mm: f64,
}

impl Gantry {
    /// A coupling of which an offset is driven out at a speed in mm/min, that of the master's reference run
    /// [000:4498-4502].
    pub fn new(settings: CouplingSettings, speed_mm_min: f64, timing: Timing) -> Gantry {
        Gantry {
            ratio: 1.0,
            offset_mm: 0.0,
            goal_mm: 0.0,
            part_mm: speed_mm_min * timing.contour_min(),
            limit_mm: settings.difference_mm,
            from_marks: settings.from_reference_marks,
            referenced: false,
            synchronized: false,
            difference_mm: 0.0,
        }
    }

    /// The same with a ratio of the ways: the slave goes so much farther than its master.
    pub fn with_ratio(mut self, ratio: f64) -> Gantry {
        self.ratio = ratio;
        self
    }

    /// The two are in their relation where they are, mm, and stay in it.
    pub fn relate(&mut self, master_mm: f64, slave_mm: f64) {
        self.offset_mm = slave_mm - self.ratio * master_mm;
        self.goal_mm = self.offset_mm;
        self.synchronized = true;
    }

    /// The slave is to come to a place, mm, when its master is at another, and is synchronous from there on.
    pub fn synchronise(&mut self, master_mm: f64, slave_mm: f64) {
        self.goal_mm = slave_mm - self.ratio * master_mm;
        (self.synchronized, self.referenced) = (false, true);
    }

    /// Where the slave is to be at a nominal position of its master, mm.
    pub fn wanted(&self, nominal_mm: f64) -> f64 {
        self.ratio * nominal_mm + self.offset_mm
    }

    /// Takes the present relation of the two as it is, at switch-on. With MP860 = 0 they are synchronous from
    /// here on [000:4492-4496].
    pub fn switch_on(&mut self, master: &Axis, slave: &Axis) {
        self.offset_mm = slave.actual_mm() - self.ratio * master.actual_mm();
        self.goal_mm = self.offset_mm;
        self.synchronized = !self.from_marks;
    }

    /// Both have their datum, and nominal positions shifted by these ways (see [`Axis::set_datum`]), mm. With
    /// MP860 = 1 the slave drives out what offset remains; with 0 the relation stays.
    pub fn referenced(&mut self, master_shift_mm: f64, slave_shift_mm: f64) {
        self.shift(master_shift_mm, slave_shift_mm);
        if self.from_marks {
            self.goal_mm = 0.0;
            self.referenced = true;
        }
    }

    /// The positions of the two were shifted by these ways, mm; their relation is what it was.
    pub fn shift(&mut self, master_mm: f64, slave_mm: f64) {
        self.offset_mm += slave_mm - self.ratio * master_mm;
        self.goal_mm += slave_mm - self.ratio * master_mm;
    }

    /// Commands the slave to the master's nominal position, mm, and compares the two. A difference above
    /// MP855 is GROSS POSITIONING ERROR A of the slave [000:4490].
    pub fn command(&mut self, nominal_mm: f64, master: &Axis, slave: &mut Axis) {
        let way = self.goal_mm - self.offset_mm;
        self.offset_mm += way.clamp(-self.part_mm, self.part_mm);
        slave.command(self.wanted(nominal_mm));
        self.difference_mm = self.wanted(master.actual_mm()) - slave.actual_mm();
        // Monitoring begins when the slave, with its lag, has come to the side of its master.
        let beside = self
            .limit_mm
            .is_none_or(|limit| self.difference_mm.abs() <= limit);
        if self.referenced && self.offset_mm == self.goal_mm && beside {
            self.synchronized = true;
        }
        let monitored = self.synchronized && slave.closed();
        if monitored
            && self
                .limit_mm
                .is_some_and(|limit| self.difference_mm.abs() > limit)
        {
            slave.raise(Fault::Gross(GrossFault::Deviation));
        }
    }

    /// Position of the master less that of the slave, mm: what the slave shows as its lag [000:4490].
    pub fn difference_mm(&self) -> f64 {
        self.difference_mm
    }

    /// Whether the slave keeps its place beside the master and is monitored.
    pub fn synchronized(&self) -> bool {
        self.synchronized
    }
}
