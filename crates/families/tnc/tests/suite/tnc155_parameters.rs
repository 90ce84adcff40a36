//! Machine parameters of a TNC 151/155 that act on motion and display.

use crate::support::bench::close;
use crate::support::knee::*;
use crate::support::*;

/// Speed that a direction button gives to X and Y, mm/min.
fn jog(rig: &mut Rig) -> [f64; 2] {
    ['X', 'Y'].map(|axis| {
        rig.event(&format!("key {axis}- press"));
        rig.seconds(0.5);
        let speed = rig.speed(axis).abs();
        rig.event(&format!("key {axis}- release"));
        rig.settle();
        speed
    })
}

fn referenced(build: Build) -> Rig {
    let mut rig = asked(build);
    reference(&mut rig);
    rig
}

/// MP4 to MP7 by themselves with MP167 = 0; with MP167 = 1 all axes use the smallest of them, here MP7 = 300 [001:1020-1024].
#[test]
fn mp167_lets_all_axes_jog_with_the_smallest_feed() {
    for (mp167, expected) in [(0, [1200.0, 900.0]), (1, [300.0, 300.0])] {
        let mut rig = referenced(knee("").mps(&format!("167={mp167} 4=1200 5=900 6=600 7=300")));
        let speeds = jog(&mut rig);
        for (speed, expected) in speeds.into_iter().zip(expected) {
            close(speed, expected, expected * 0.01);
        }
    }
}

/// MP66: the potentiometer of the control at 100 %, the external one at 3.333 V = 50 % [001:1403]. 0: that of the control; 1:
/// the external one everywhere; 2: the external one by hand, that of the control in program run.
#[test]
fn mp66_chooses_the_feed_potentiometer() {
    for (mp66, by_hand, automatic) in [(0, 100.0, 100.0), (1, 50.0, 50.0), (2, 50.0, 100.0)] {
        let build = knee("").mps(&format!("66={mp66}")).program("1", "L X+0 R0 F1000");
        let mut rig = asked(build);
        rig.event("analogue 0 6.6667");
        reference(&mut rig);
        rig.event("analogue 0 3.3333");
        rig.seconds(0.1);
        assert_eq!(rig.control.feed_override_percent(), by_hand, "MP66 = {mp66}");
        close(jog(&mut rig)[0], 12.0 * by_hand, 12.0);
        rig.command("mode full");
        rig.seconds(0.1);
        assert_eq!(rig.control.feed_override_percent(), automatic, "MP66 = {mp66}");
    }
}

/// MP158, MP249 and MP250 set M2192 to M2207, M2208 to M2223 and M2224 to M2239 [001:1835] [001:1839-1840].
#[test]
fn mp158_mp249_and_mp250_set_markers() {
    let rig = referenced(knee("").mps("158=16385 249=2 250=32768"));
    let set: Vec<u16> = (2192..2240)
        .filter(|marker| rig.bit(&format!("M{marker}")))
        .collect();
    assert_eq!(set, [2192, 2206, 2209, 2239], "bits 0, 14; 1; 15");
}
