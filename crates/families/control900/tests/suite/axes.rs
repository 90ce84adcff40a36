//! Axes and what they say of themselves [002:8321-8547].

use bahn_path::{At, Axis, Function, Synchronisation};

use crate::support::Rig;
use crate::support::list::Line;

/// P12154 = P12151 - P12157, and P7032 and P7128 are the same by logical axes.
#[test]
fn the_display_is_the_nominal_position_less_the_shift() {
    let mut rig = Rig::on("");
    // What an earlier program has left is forgotten.
    rig.operator("P12157", "3");
    let shift = Function::Shift { logical: 1, by: 15.0 };
    let line = Line::to(&[(Axis::X, 40.0)], 3000.0);
    rig.start(1, &[line.says(shift, At::Start, Synchronisation::Mos)]);
    rig.until(|rig| rig.exact("P12151") > 10.0);
    // Where the block leads, as it is displayed, and what is left.
    assert_eq!(rig.read("P12155"), 25.0);
    assert!((rig.read("P12156") - (25.0 - rig.read("P12154"))).abs() < 0.0011);
    rig.until_end(1);
    let shown = ["P12151", "P12157", "P12154", "P7032", "P7128"].map(|name| rig.read(name));
    assert_eq!(shown, [40.0, 15.0, 25.0, 25.0, 15.0]);
}

/// Positions have the decimals of q159, three without it.
#[test]
fn positions_have_their_decimals() {
    for (more, written) in [("", "10.000"), ("q159: 5\n", "10.00000")] {
        let mut rig = Rig::on(more);
        rig.start(1, &[Line::to(&[(Axis::X, 10.0)], 3000.0)]);
        rig.until_end(1);
        let cell = rig.control.memory().cell("P12151".parse().unwrap()).unwrap();
        assert_eq!(cell.written(), written);
    }
}

/// P12187 says plus, and that the axis drives, until it is within the exact stop of sqrt(1/1000) mm.
#[test]
fn the_driving_instruction_ends_within_the_exact_stop() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 40.0)], 3000.0)]);
    rig.until(|rig| rig.exact("P12151") > 10.0);
    assert_eq!(rig.read("P12187"), f64::from(0x1_0001));
    rig.until(|rig| rig.read("P12187") == 0.0);
    assert!((rig.exact("P12150") - 40.0).abs() < (1.0f64 / 1000.0).sqrt());
    assert_eq!(rig.read("P12151"), 40.0);
}

/// The interpolation cycle is P11301, at most 4 ms.
#[test]
fn the_cycle_is_that_of_the_parameters() {
    for (more, us) in [("", 4000), ("P11301: 2\n", 2000), ("P11301: 8\n", 4000)] {
        assert_eq!(Rig::on(more).control.cycle_us(), us, "{more}");
    }
}
