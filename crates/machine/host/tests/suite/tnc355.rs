//! The mill with its PLC program in the form of the TNC 355, machines/mill/plc355: T, S and M functions, gears, PLC
//! positioning, orientation, datum shift and Q parameters of a part program, all in markers.

use crate::support::*;
use bahn_host::{Host, PowerOn};

const PROGRAM: &str = "TOOL CALL 1 Z S1000
L Z+100 R0 FMAX M3
L X+10 Y+10 F2000
M70
M71
M73
L M8
L IY+Q101 F2000
M19
CYCL DEF 9.0 DWELL TIME
CYCL DEF 9.1 DWELL 2
TOOL CALL 2 Z S4000
L Z+100 R0 FMAX M13
M72
L X+0 Y+0 F2000
M30";

/// Strobes, and the axis whose place is of interest when they fall.
const STROBES: [(&str, char); 6] = [
    ("M2046", 'Z'),
    ("M2454", 'Z'),
    ("M2452", 'X'),
    ("M2453", 'Y'),
    ("M2527", 'Y'),
    ("M2819", 'Y'),
];

fn bit(host: &Host, name: &str) -> bool {
    host.control().exchange().plc().bit(name.parse().unwrap())
}

/// Position of an axis from the machine datum.
fn machine_position(host: &Host, letter: char) -> f64 {
    let axes = host.control().snapshot().axes;
    axes.iter().find(|axis| axis.letter == letter).unwrap().machine
}

/// Steps until something is so, and notes each strobe that falls meanwhile with where its axis is, in mm.
fn falling(host: &mut Host, seconds: f64, so: impl Fn(&Host) -> bool) -> Vec<String> {
    let end_us = host.control().time_us() + (seconds * 1e6) as u64;
    let mut before = STROBES.map(|(name, _)| bit(host, name));
    let mut seen = Vec::new();
    while !so(host) {
        assert!(
            host.control().time_us() < end_us,
            "{seen:?} {:?}",
            host.control().snapshot()
        );
        host.step().unwrap();
        for ((name, letter), before) in STROBES.iter().zip(&mut before) {
            let now = bit(host, name);
            if *before && !now {
                seen.push(format!(
                    "{name} {letter}{}",
                    machine_position(host, *letter).round()
                ));
            }
            *before = now;
        }
    }
    seen
}

/// The strobes fall in the order of the program, each where the axes are to be: the tool changes at Z 440, M70 at Z 300,
/// M71 at X 100 and Y 200, from where the 7 of M73 counts with the strobe of M8. The datum of the mill is X 200, Y 120;
/// M72 shifts X by 5: X+0 is then at 195.
#[test]
fn a_part_program_on_the_old_plc_program() {
    let (_copy, machine) = old_mill();
    let mut host = host(&machine, PowerOn::fresh(&machine), PROGRAM);
    let mut seen = falling(&mut host, 300.0, |host| bit(host, "M2045") && bit(host, "M47"));
    // M19: the spindle turned with 1000 rpm in the first gear until now.
    assert_eq!(host.control().snapshot().spindle.gear, 1);
    assert!(bit(&host, "O13"), "coolant");
    seen.extend(falling(&mut host, 30.0, |host| bit(host, "M2482")));
    // It swings into the position of MP4210.31 while the program dwells.
    seconds(&mut host, 1.5);
    let angle = host.plant().spindle().unwrap().angle_deg.rem_euclid(360.0);
    assert!((angle - 90.0).abs() < 1.0, "{angle}");
    seen.extend(falling(&mut host, 30.0, |host| bit(host, "M2046")));
    // The second tool, in decades in both places.
    for (first, what) in [(2032, "T code"), (2112, "T number")] {
        let digits: Vec<bool> = (first..first + 8)
            .map(|number| bit(&host, &format!("M{number}")))
            .collect();
        assert_eq!(
            digits,
            [false, true, false, false, false, false, false, false],
            "{what}"
        );
    }
    seen.extend(falling(&mut host, 60.0, |host| bit(host, "M2819")));
    let spindle = host.control().snapshot().spindle;
    assert_eq!(spindle.gear, 2);
    assert!((spindle.actual_rpm - 4000.0).abs() < 100.0, "{spindle:?}");
    seen.extend(falling(&mut host, 60.0, |host| host.control().snapshot().ended));
    assert_eq!(
        seen,
        [
            "M2454 Z440", // the first tool
            "M2046 Z440",
            "M2454 Z300", // M70
            "M2453 Y200", // M71
            "M2452 X100",
            "M2527 Y207", // M19 after IY+Q101
            "M2454 Z440", // the second tool
            "M2046 Z440",
            "M2819 Y207", // M72
        ]
    );
    let at = ['X', 'Y'].map(|letter| machine_position(&host, letter));
    assert!(
        (at[0] - 195.0).abs() < 0.02 && (at[1] - 120.0).abs() < 0.02,
        "{at:?}"
    );
    let shown = host.control().shown();
    assert!(shown.is_empty(), "{shown:?}");
}
