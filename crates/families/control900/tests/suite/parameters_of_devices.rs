//! Overrides, handwheels, couplings and spindles: all that there are of each do the same.

use bahn_path::Axis;

use crate::support::list::Line;
use crate::support::{Rig, axis};

/// The other overrides are as the first one: potentiometer, least, greatest, own table of three values [002:6375-6402].
#[test]
fn overrides_are_all_alike() {
    for first in [11_310, 11_315, 11_320, 11_325] {
        let mut rig = Rig::on("P11370: 3\nP11371: 0\nP11372: 50\nP11373: 80\n");
        let of = |offset: u32| format!("P{}", first + offset);
        rig.plc(&of(2), "20");
        rig.plc(&of(3), "75");
        let percent = |rig: &mut Rig, raw: &str| {
            rig.operator(&of(1), raw);
            rig.read(&of(0))
        };
        assert_eq!([percent(&mut rig, "0"), percent(&mut rig, "255")], [20.0, 75.0]);
        rig.plc(&of(4), "11370");
        // floor(127 * 3 / 256) = 1, floor(255 * 3 / 256) = 2 with 80 %, of which 75 are allowed.
        assert_eq!([percent(&mut rig, "127"), percent(&mut rig, "255")], [50.0, 75.0]);
    }
}

/// Handwheels 1 to 8 at encoders 9 to 16: 300 INC with 100 INC/mm to the other side move X by -3 mm, three times as much with
/// P11404 = 3 [002:6448-6473].
#[test]
fn handwheels_are_all_alike() {
    for wheel in 0..8 {
        let first = 1400 + 10 * wheel;
        let set = format!(
            "q{first}: {}\nq{}: 1\nq{}: 1\nq{}: -100\n",
            9 + wheel,
            first + 1,
            first + 2,
            first + 3
        );
        let mut rig = Rig::on(&set);
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(1.0);
        assert_eq!(rig.read("P12151"), -3.0, "{wheel}");
        rig.plc(&format!("q{}", first + 4), "3");
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(1.0);
        assert_eq!(rig.read("P12151"), -12.0, "{wheel}");
        rig.plc(&format!("q{}", first + 2), "0");
        rig.seconds(0.1);
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(0.5);
        assert_eq!(rig.read("P12151"), -12.0, "{wheel} is not active");
    }
}

/// Couplings 2 to 8: the slave, physical axis 3, comes to 5 + 20 / 10 * master, and both stop when it is 1 mm off for 100 ms
/// [002:6520-6573].
#[test]
fn couplings_are_all_alike() {
    for coupling in 0..8 {
        let of = |offset: u32| format!("q{}", 1480 + 20 * coupling + offset);
        let set = [
            (0, 1),
            (1, 3),
            (4, 1),
            (5, 100),
            (10, 1),
            (11, 7),
            (12, 20),
            (13, 10),
        ];
        let set: String = set
            .iter()
            .map(|(offset, value)| format!("{}: {value}\n", of(*offset)))
            .collect();
        let mut rig = Rig::on(&format!("{set}q2425: -1\n"));
        rig.plc(&of(15), "2");
        rig.until(|rig| rig.read(&of(16)) == 2.0);
        rig.start(1, &[Line::to(&[(Axis::X, 10.0)], 1500.0)]);
        rig.until_end(1);
        rig.seconds(0.5);
        // 7 + 2 * (10 - 1).
        assert!(
            (rig.read("2:P12151") - 25.0).abs() < 0.001,
            "{coupling}: {}",
            rig.read("2:P12151")
        );
        rig.start(1, &[Line::to(&[(Axis::X, 100.0)], 1500.0)]);
        rig.until(|rig| rig.read("P12151") > 20.0);
        rig.plant.ideal.drives[2].as_mut().unwrap().is_dead = true;
        rig.until(|rig| !rig.control.messages().is_empty());
        assert_eq!(&*rig.control.messages()[0].text, "coupling error", "{coupling}");
        rig.plc(&of(15), "0");
        rig.seconds(0.1);
        assert_eq!(rig.read(&of(16)), 0.0);
    }
}

/// Spindles 1 to 8 on physical axis 5: at most 400 rpm, reached within 50 % of it, that is before it is at 400; 2 goes to the
/// reset position of 90 degrees [002:6575-6627].
#[test]
fn spindles_are_all_alike() {
    for spindle in 0..8 {
        let of = |offset: u32| format!("q{}", 1640 + 20 * spindle + offset);
        let set = [(0, 5), (5, 400), (8, 500), (12, 90), (13, 50)];
        let set: String = set
            .iter()
            .map(|(offset, value)| format!("{}: {value}\n", of(*offset)))
            .collect();
        let mut rig = Rig::on(&(axis(5) + "q2801: 2\nq2804: 360000\n" + &set));
        rig.plc(&of(10), "1");
        rig.until(|rig| rig.read(&of(11)) == 1.0);
        let reached = rig.read(&of(9));
        assert!((200.0..300.0).contains(&reached), "{spindle}: {reached}");
        rig.seconds(1.0);
        assert!(
            (rig.read(&of(9)) - 400.0).abs() < 0.5,
            "{spindle}: {}",
            rig.read(&of(9))
        );
        rig.plc(&of(10), "2");
        rig.until(|rig| rig.read(&of(11)) == 2.0);
        assert!(
            (rig.read("q2950") - 90.0).abs() < 0.1,
            "{spindle}: {}",
            rig.read("q2950")
        );
        rig.plc(&of(10), "0");
        rig.seconds(0.1);
        assert_eq!(rig.read(&of(11)), 0.0);
    }
}

/// G96 with 100 m/min (P11643 = 1000) at a wheel of 200 mm: 100 000 / (200 pi) = 159.2 rpm; P11644 limits to 80 000 mm/min. About an
/// axis at X 50 the diameter is 100 mm. P11646 = 1 counts in degrees/min [002:6580-6595].
#[test]
fn cutting_speeds_turn_by_their_diameter() {
    let pi = std::f64::consts::PI;
    for spindle in 0..8 {
        let of = |offset: u32| format!("q{}", 1640 + 20 * spindle + offset);
        let set = [(0, 5), (2, 200), (3, 1000), (7, 96), (8, 100), (10, 1)];
        let set: String = set
            .iter()
            .map(|(offset, value)| format!("{}: {value}\n", of(*offset)))
            .collect();
        let mut rig = Rig::on(&(axis(5) + "q2801: 2\nq2804: 360000\n" + &set));
        let turns = |rig: &mut Rig| {
            rig.seconds(1.0);
            (rig.read("q2970") / 360.0, rig.read(&of(9)))
        };
        let near = |found: (f64, f64), wanted: (f64, f64)| {
            let is_near = |found: f64, wanted: f64| (found - wanted).abs() < wanted * 3e-3;
            assert!(
                is_near(found.0, wanted.0) && is_near(found.1, wanted.1),
                "{found:?} {wanted:?}"
            );
        };
        near(turns(&mut rig), (100_000.0 / (200.0 * pi), 100.0));
        rig.plc(&of(4), "80000");
        near(turns(&mut rig), (80_000.0 / (200.0 * pi), 80.0));
        // P11645 is of G97 alone.
        rig.plc(&of(5), "10");
        near(turns(&mut rig), (80_000.0 / (200.0 * pi), 80.0));
        rig.plc(&of(3), "0");
        rig.plc(&of(8), "30000");
        rig.plc(&of(1), "1");
        // In the middle as fast as the axis can: 1000 rpm.
        assert!((turns(&mut rig).0 - 1000.0).abs() < 1.0);
        rig.start(1, &[Line::to(&[(Axis::X, 50.0)], 3000.0)]);
        rig.until_end(1);
        near(turns(&mut rig), (30_000.0 / (100.0 * pi), 30_000.0));
        rig.plc(&of(7), "97");
        rig.plc(&of(5), "40");
        rig.plc(&of(6), "1");
        rig.plc(&of(8), "7200");
        near(turns(&mut rig), (20.0, 7200.0));
        rig.plc(&of(8), "36000");
        near(turns(&mut rig), (40.0, 14_400.0));
    }
}
