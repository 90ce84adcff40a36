//! Synchronized axes [000:4451-4539].

use crate::common::Bench;
use bahn_parameters::{ControlModel::Tnc415b, ParameterList};
use bahn_servo::{Fault, Gantry, GrossFault};

/// X and its slave IV: MP850 = 0, 0, 0, 1, 0 [000:4457-4463].
struct Pair {
    master: Bench,
    slave: Bench,
    gantry: Gantry,
}

impl Pair {
    fn new(assignments: &[&str]) -> Pair {
        let mut list = ParameterList::reference(Tnc415b);
        for assignment in ["850.3=1", "410.3=3", "1330.0=600"].iter().chain(assignments) {
            list.assign(assignment).unwrap();
        }
        let master = Bench::new(Tnc415b, &[]);
        let mut slave = Bench::new(Tnc415b, &[]);
        slave.table_mm = 0.0;
        let slaved = list.axis_parameters(3).synchronization;
        assert_eq!(slaved.master, Some(0));
        let speed_mm_min = list.axis_parameters(0).reference.feed_mm_min;
        let gantry = Gantry::new(slaved.coupling, speed_mm_min, master.timing);
        Pair {
            master,
            slave,
            gantry,
        }
    }

    fn run(&mut self, feed_mm_min: f64, cycles: u32) {
        let start = self.master.axis.target_mm();
        for cycle in 1..=cycles {
            let nominal = start + feed_mm_min * 0.003 / 60.0 * f64::from(cycle);
            self.gantry
                .command(nominal, &self.master.axis, &mut self.slave.axis);
            let slave = self.slave.axis.target_mm();
            self.master.cycle(nominal);
            self.slave.cycle(slave);
        }
    }
}

#[test]
fn the_slave_goes_with_its_master() {
    let mut pair = Pair::new(&["855.3=0.5", "860.3=0"]);
    pair.gantry.switch_on(&pair.master.axis, &pair.slave.axis);
    assert!(pair.gantry.synchronized());
    pair.run(3000.0, 200);
    assert!((pair.slave.table_mm - pair.master.table_mm).abs() < 1e-4);
    assert!(pair.gantry.difference_mm().abs() < 1e-4);
    assert_eq!(pair.slave.axis.fault(), None);
}

#[test]
fn too_large_a_difference_is_a_fault_of_the_slave() {
    let fault = Some(Fault::Gross(GrossFault::Deviation));
    for (limit, found) in [("855.3=0.5", fault), ("855.3=2", None), ("855.3=0", None)] {
        let mut pair = Pair::new(&[limit, "860.3=0"]);
        pair.gantry.switch_on(&pair.master.axis, &pair.slave.axis);
        pair.slave.blocked = true;
        pair.run(600.0, 40);
        assert_eq!(pair.slave.axis.fault(), found, "{limit}");
        assert!(pair.gantry.difference_mm() > 0.3);
        assert_eq!(pair.master.axis.fault(), None);
    }
}

#[test]
fn the_relation_at_switch_on_stays_with_mp860_0() {
    let mut pair = Pair::new(&["860.3=0"]);
    pair.slave.axis.set_datum(0, 7.0);
    pair.gantry.switch_on(&pair.master.axis, &pair.slave.axis);
    pair.run(600.0, 20);
    assert!((pair.slave.axis.target_mm() - pair.master.axis.target_mm() - 7.0).abs() < 1e-9);
    // Only the master needs its mark; the slave does not move.
    let before = pair.slave.axis.target_mm();
    let shift = pair.master.axis.set_datum(0, 100.0);
    pair.gantry.referenced(shift, 0.0);
    pair.run(0.0, 3);
    assert!((pair.slave.axis.target_mm() - before).abs() < 1e-9);
}

#[test]
fn the_slave_drives_the_offset_of_the_marks_out() {
    let mut pair = Pair::new(&["860.3=1", "855.3=0.5"]);
    pair.gantry.switch_on(&pair.master.axis, &pair.slave.axis);
    assert!(!pair.gantry.synchronized());
    // The slave's mark shows that it stands 0.3 mm ahead.
    let slave = pair.slave.axis.set_datum(0, 0.3);
    pair.gantry.referenced(0.0, slave);
    // MP1330 600 mm/min: 0.03 mm in each cycle, so ten cycles.
    pair.run(0.0, 9);
    assert!(!pair.gantry.synchronized());
    pair.run(0.0, 2);
    assert!(pair.gantry.synchronized());
    pair.run(0.0, 1000);
    assert!(
        (pair.slave.table_mm + 0.3).abs() < 1e-3,
        "{}",
        pair.slave.table_mm
    );
    assert_eq!(pair.slave.axis.fault(), None);
}
