//! Module 9171 orients the spindle: its directions, and what it refuses [000:16120-16160].

use crate::stand::*;
use crate::support::Rig;

/// Module 9171 with the directions of its table: key B is M04, key C M03, none the shortest path; the angle goes to and
/// fro between 90 degrees and the one of key A's last press.
fn module_by_key() -> String {
    format!(
        "{}
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
       L     K+0
       = W210
       L     I21
       IFT
         L     K-1
         = W210
       ENDI
       L     I22
       IFT
         L     K+1
         = W210
       ENDI
       L     M1
       CMT   TO_AND_FRO
       EM
LBL TO_AND_FRO
       L     K+900000
       -     D204
       = D204
       PS    D204
       PS    K+0
       PS    W210
       CM    9171
       L     M3171
       = M10
",
        with_gear()
    )
}

/// A spindle that stands in position turns to the next one in the direction that is asked for: 0 to 90 degrees and back by
/// the shortest path, with M03 and with M04 [000:16130-16152]. Whatever holds it there, a load in its loop
/// of either sense: the voltage of the loop is no turning. Also when M05 comes in the scan of the call.
#[test]
fn from_one_position_the_spindle_turns_as_the_module_says() {
    for m05 in [false, true] {
        let plc = match m05 {
            false => module_by_key(),
            true => module_by_key().replace(
                "LBL TO_AND_FRO\n",
                "LBL TO_AND_FRO\n       L     M2719\n       S     M2487\n       R     M2485\n       R     M2486\n",
            ),
        };
        let build = diagram(&plc).mps("3440.0=5 3520.1=60 3410.1=0.05");
        let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S100\nM3\nM5"));
        run(&mut rig, 5.0);
        let angle = |rig: &Rig| rig.machine.spindle().unwrap().angle_deg;
        let orient = |rig: &mut Rig| {
            let before = angle(rig);
            rig.event("key A press");
            rig.until(1.0, "the orientation", |rig| rig.bit("M2712"));
            rig.until(10.0, "its end", |rig| !rig.bit("M2712") && rig.bit("M2007"));
            rig.event("key A release");
            // As soon as it is in its window the next one may come.
            rig.seconds(0.04);
            angle(rig) - before
        };
        // To 90 degrees, in whatever way, and to 0.
        orient(&mut rig);
        orient(&mut rig);
        for (key, ways) in [("", [90.0, -90.0]), ("C", [90.0, 270.0]), ("B", [-270.0, -90.0])] {
            for event in ["press", "release"] {
                if !key.is_empty() {
                    rig.event(&format!("key {key} {event}"));
                }
                if event == "release" {
                    continue;
                }
                rig.seconds(0.05);
                for expected in ways.into_iter().chain(ways) {
                    let way = orient(&mut rig);
                    assert!(
                        (way - expected).abs() < 2.0,
                        "key {key}, M05 {m05}: {way}, not {expected}"
                    );
                }
            }
        }
    }
}

/// A spindle that is not controlled, MP3010 = 3 to 5, is not oriented: module 9171 says so, and M2712 does not stay
/// [000:5444-5472].
#[test]
fn a_spindle_without_position_control_is_not_oriented() {
    for (mp3010, refused) in [("3010=3", true), ("3010=5", true), ("3010=6", false)] {
        let mut rig = ready(diagram(&module_by_key()).mp(mp3010).mp("3440.0=5"));
        rig.event("key A press");
        rig.seconds(0.1);
        assert_eq!(
            (rig.bit("M10"), rig.bit("M2712")),
            (refused, !refused),
            "{mp3010}"
        );
    }
}
