//! Output A6 of the standard PLC program of a TNC 151/155, the lock for "spindle on".

use crate::terminals::*;

/// A6 opens with a programmed spindle stop and a programmed stop (M2189) together, is closed in Manual [001:1046-1053], in each mode in
/// which programs run: NC start leads to the stop, in single block once for each block before it.
#[test]
fn lock_for_spindle_on() {
    // The blocks, how many starts lead to the last of them, whether A6 is open there, and whether another start goes on.
    let cases = [
        ("L M0", 1, true, true),
        ("L M3\nL M6", 2, true, true),
        ("L M5\nSTOP", 2, true, true),
        ("STOP M5", 1, true, true),
        ("L IX+1 R0 F1000 M5\nSTOP M8", 2, true, true),
        ("L M3\nSTOP", 2, false, true),
        ("L M3\nL M30", 2, true, false),
        ("L M5\nL IX+1 R0 F1000", 2, false, false),
    ];
    for mode in ["full", "single", "mdi"] {
        for (blocks, starts, open, starts_again) in cases {
            let mut rig = terminals().mp("214=0").program("1.H", blocks).rig();
            rig.power_on();
            rig.command(&format!("mode {mode}"));
            let mut starts = if mode == "single" { starts } else { 1 };
            match mode {
                "mdi" => rig.command(&format!("mdi {}", blocks.replace('\n', "\\n"))),
                _ => rig.command("select 1.H"),
            }
            while starts > 0 {
                starts -= 1;
                rig.start();
                rig.until(0.5, "it runs", |rig| rig.bit("A4"));
                assert!(rig.bit("A6"), "{mode} {blocks}");
                rig.until(5.0, "it stands", |rig| !rig.bit("A4"));
                rig.seconds(0.5);
            }
            assert_eq!(!rig.bit("A6"), open, "{mode} {blocks}");
            // A program that has stopped goes on to its end; one that has ended stays so.
            if starts_again {
                rig.start();
                rig.seconds(1.0);
                assert!(rig.bit("A6"), "{mode} {blocks}: it has gone on");
            }
            // What is interrupted is broken off first.
            let _ = rig.control.command("stop".parse().unwrap());
            rig.command("mode manual");
            rig.seconds(0.1);
            assert!(rig.bit("A6"), "{mode} {blocks}: closed in Manual");
        }
    }
}
