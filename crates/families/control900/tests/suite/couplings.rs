//! Couplings: slave = P11491 + (master - P11490) * P11492 / P11493 [002:6520-6573].

use bahn_path::Axis;

use crate::support::Rig;
use crate::support::list::Line;

/// X of channel 2, physical axis 3, follows X of channel 1 in the ratio 20 : 10.
const COUPLED: &str = "q1480: 1\nq1481: 3\nq1492: 20\nq1493: 10\n";

fn to(x: f64) -> [Line; 1] {
    [Line::to(&[(Axis::X, x)], 1500.0)]
}

/// With 1 the slave goes by differences from where both stand.
#[test]
fn a_slave_follows_by_differences() {
    let mut rig = Rig::on(COUPLED);
    rig.start(1, &to(10.0));
    rig.until_end(1);
    rig.plc("P11495", "1");
    rig.seconds(0.5);
    assert_eq!(rig.read("P11496"), 1.0);
    rig.start(1, &to(40.0));
    rig.until_end(1);
    rig.seconds(0.5);
    // Twice 30 mm.
    assert!(
        (rig.read("2:P12151") - 60.0).abs() < 0.05,
        "{}",
        rig.read("2:P12151")
    );
    assert!((rig.read("2:P12150") - 60.0).abs() < 0.1);
    rig.plc("P11495", "0");
    rig.seconds(0.1);
    rig.start(1, &to(0.0));
    rig.until_end(1);
    assert!((rig.read("2:P12151") - 60.0).abs() < 0.05, "it stays");
    assert_eq!(rig.control.messages(), []);
}

/// With 2 the slave is at 5 when the master is at 0, wherever both stood.
#[test]
fn a_slave_comes_to_its_synchronous_place() {
    let mut rig = Rig::on(&format!("{COUPLED}q1490: 0\nq1491: 5\n"));
    rig.start(1, &to(10.0));
    rig.until_end(1);
    rig.plc("P11495", "2");
    rig.until(|rig| rig.read("P11496") == 2.0);
    rig.seconds(0.5);
    assert!((rig.read("2:P12151") - 25.0).abs() < 0.001, "5 + 2 * 10");
    rig.start(1, &to(-10.0));
    rig.until_end(1);
    rig.seconds(0.5);
    assert!((rig.read("2:P12151") + 15.0).abs() < 0.001, "5 - 2 * 10");
}

/// A slave takes no commands of its own: a block that moves it is refused.
#[test]
fn a_slave_takes_no_commands() {
    let mut rig = Rig::on(COUPLED);
    rig.plc("P11495", "1");
    rig.seconds(0.1);
    rig.start(2, &to(10.0));
    rig.until(|rig| !rig.control.messages().is_empty());
    let message = &rig.control.messages()[0];
    assert_eq!((message.channel, &*message.text), (2, "there is no axis X"));
}

/// A slave whose drive is dead comes apart: 1 mm for 100 ms are allowed, then both stop.
#[test]
fn a_coupling_that_comes_apart_stops_both() {
    let mut rig = Rig::on(&format!("{COUPLED}q1484: 1\nq1485: 100\nq2425: -1\n"));
    rig.plc("P11495", "1");
    rig.seconds(0.1);
    rig.start(1, &to(100.0));
    rig.until(|rig| rig.read("P12151") > 20.0);
    rig.plant.ideal.drives[2].as_mut().unwrap().is_dead = true;
    rig.until(|rig| !rig.control.messages().is_empty());
    assert_eq!(&*rig.control.messages()[0].text, "coupling error");
    rig.seconds(1.0);
    assert_eq!((rig.read("P8685"), rig.read("P12167")), (0.0, 0.0));
}
