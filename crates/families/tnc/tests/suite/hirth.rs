//! A rotary axis with Hirth coupling: the whole PLC program of it on the running control [000:8560-8906].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::RunState;

/// The coupling: O3 releases it, I10 says that it is released, I11 that it is locked.
const COUPLING: &str = r#"
[device.coupling]
states = ["released", "locked"]
output = "not O3"
start = "locked"
forth_ms = 250
back_ms = 300
input_first = "I10"
input_second = "I11"
clamps = "C"
"#;

/// Main program. M300: the coupling is at work; M301: MP420.3; M302: C was in position once; M304, M305: parameters are read;
/// M5: a controlled mode; M2: on the grid; M4: the target is off the grid.
const MAIN: &str = "
       LN    M1
       S     M1
       L     M2180
       O     M2185
       CMT   290
       L     M301
       A     M304
       AN    M305
       CMT   292
       L     M2011
       A     M305
       S     M302
       L     M2053
       O     M2054
       O     M2055
       = M5
       LN    M2011       ; is the target of the block on the grid?
       AN    M300
       A     M305
       A     M5
       CMT   370
       L     M4
       A     M5
       AN    M2011
       S     M3018
       LN    M2011
       A     M301
       A     M302
       A     M305
       S     M300
       L     M300
       AN    M3018
       CMT   300
";

/// Reads MP420.3 and the grid MP430.3 into D28; the loop of C is open from the start on.
const PARAMETERS: &str = "
LBL 290
       RPLY  B128
       <>    K+0
       EMT
       SUBM  291
       = B128
       EM
LBL 291
       PS    K+420
       PS    K+3
       CM    9032
       PLW
       <>    K+0
       = M301
       L     M1
       S     M304
       S     M2495
       S     M2547
       EM
LBL 292
       RPLY  B129
       <>    K+0
       EMT
       SUBM  293
       = B129
       EM
LBL 293
       PS    K+430
       PS    K+3
       CM    9032
       PL    D28
       L     M1
       R     M302
       S     M305
       EM
";

/// Unlock, close the loop; on the grid lock, open the loop; by hand go to the grid first.
const COUPLE: &str = "
LBL 300
       L     M2011
       AN    M2707
       CMT   330
       CM    360
       LN    M2011
       S     O3
       L     M2
       A     M2011
       R     O3
       LN    M2011
       A     I10
       AN    I11
       R     M2547
       L     M2
       A     M2011
       A     I11
       AN    I10
       S     M2547
       R     M300
       LN    I10         ; neither released nor locked: no loop
       AN    I11
       AN    M2011
       AN    M2547
       S     M2547
       L     M2051
       O     M2052
       AN    M2
       A     M2011
       AN    M2707
       CMT   340
       EM
";

/// D36 and D40: the points of the grid beside D44, where C is to be. M3: it went in negative direction.
const GRID: &str = "
LBL 330
       PS    K+8
       PS    K+3
       CM    9041
       PS    K+0
       PS    K+2
       CM    9041
       L     D12
       +     D20
       = D44
       = D48
       L     D48
       <     K+0
       CMT   331
       L     D48
       /     D28
       x     D28
       = D36
       L     D36
       +     D28
       = D40
       L     M2163
       = M3
       EM
LBL 331
       L     D48
       -     D28
       = D48
       EM
LBL 360
       PS    K+0
       PS    K+2
       CM    9041
       L     D12
       -     D36
       = D60
       L     D60
       <     K+0
       CMT   361
       L     D40
       -     D12
       = D64
       L     D64
       <     K+0
       CMT   362
       L     D60
       <     D776
       O[
       L     D64
       <     D776
       ]
       = M2
       EM
LBL 361
       L     K+0
       -     D60
       = D60
       EM
LBL 362
       L     K+0
       -     D64
       = D64
       EM
";

/// To the nearest point of the grid; with MP4310.1 bit 0 reset to the one that lies ahead, with bit 1 to the one behind.
const GO: &str = "
LBL 340
       L     D44
       -     D36
       = D60
       L     D40
       -     D44
       = D64
       L     D36
       = D540
       L     D64
       <     D60
       CMT   341
       LN    M2208
       CMT   342
       L     W966
       = W566
       L     M1
       S     M2707
       EM
LBL 341
       L     D40
       = D540
       EM
LBL 342
       L     D40
       = D540
       L     M3
       XO    M2209
       CMT   343
       EM
LBL 343
       L     D36
       = D540
       EM
";

/// M4: actual position, distance to go and lag do not come to a point of the grid within MP4210.3.
const CHECK: &str = "
LBL 370
       PS    K+0
       PS    K+4
       CM    9041
       L     D12
       = D48
       PS    K+8
       PS    K+3
       CM    9041
       PS    K+0
       PS    K+2
       CM    9041
       L     D48
       +     D12
       +     D20
       MOD   D28
       = D52
       L     D52
       <     K+0
       CMT   371
       L     D28
       -     D52
       = D56
       L     D52
       >     D56
       CMT   372
       L     D52
       >     D780
       = M4
       EM
LBL 371
       L     D52
       +     D28
       = D52
       EM
LBL 372
       L     D56
       = D52
       EM
";

/// C with a grid of 5 degrees; window on the grid 0.02 degrees, tolerance of targets 0.01 degrees, 1200 degrees/min.
fn table(direction: &str) -> Build {
    let modules = [PARAMETERS, COUPLE, GRID, GO, CHECK].concat();
    bench(&format!("{MAIN}{modules}"))
        .with(TABLE)
        .with(COUPLING)
        .mps("10=15 50=15 960.3=-90 1010.3=3600 1020.3=1200 1330.3=1800 1340.0=1 1340.1=2 1340.2=3 1340.3=4")
        .mps("910.3=500 920.3=-500 810.3=0 1030.3=0.01 1510.3=2 420.3=1 430.3=5")
        .mps("4210.2=0.02 4210.3=0.01 4220.3=1200")
        .mps(direction)
}

const NEAREST: &str = "4310.1=%1";

/// C is locked, its loop open, and nothing is at work.
#[track_caller]
fn rests(rig: &Rig) {
    let locked = rig.bit("I11") && !rig.bit("I10") && !rig.bit("O3");
    assert!(
        locked && rig.bit("M2547") && !rig.bit("M300") && rig.bit("M2011"),
        "{:?}",
        rig.control.snapshot()
    );
}

/// Holds a direction key until C has gone so far, and waits until it is locked again.
fn jog(rig: &mut Rig, key: &str, to: f64) {
    let from = rig.machine_position('C');
    rig.event(&format!("key {key} press"));
    rig.until(20.0, "the way by hand", |rig| {
        (rig.machine_position('C') - from).abs() >= (to - from).abs()
    });
    rig.event(&format!("key {key} release"));
    rig.until(20.0, "the grid", |rig| !rig.bit("M300") && rig.bit("M2547"));
    rig.seconds(0.3);
    rests(rig);
}

/// After the reference run C goes to the grid and is locked.
fn ready(direction: &str, program: &str) -> Rig {
    let mut rig = table(direction).program("1.H", program).ready();
    rig.command("mode manual");
    let from = rig.machine_position('C');
    jog(&mut rig, "IV+", from + 1.0);
    rig
}

#[track_caller]
fn on_grid(degrees: f64) {
    let beside = degrees - (degrees / 5.0).round() * 5.0;
    close(beside, 0.0, 0.02);
}

/// The direction key unlocks, the loop closes, C goes; where it stops off the grid the PLC leads it to the nearest point by
/// the shortest way, locks, and opens the loop [000:8568].
#[test]
fn by_hand_the_axis_comes_to_rest_on_the_grid() {
    let mut rig = ready(NEAREST, "L C+0 R0 F1000");
    let from = (rig.machine_position('C') / 5.0).round() * 5.0;
    on_grid(rig.machine_position('C'));
    // At 1200 degrees/min, 20 a second, it stops some tenths of a degree behind where the key was released.
    jog(&mut rig, "IV+", from + 11.0);
    close(rig.machine_position('C'), from + 10.0, 0.02);
    jog(&mut rig, "IV-", from + 6.5);
    close(rig.machine_position('C'), from + 5.0, 0.02);
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP4310.1 bit 0 reset: it goes on in the direction in which it went; with bit 1 back [000:8584].
#[test]
fn the_direction_of_repositioning_is_preset() {
    for (direction, to) in [("4310.1=%0", 15.0), ("4310.1=%10", 10.0)] {
        let mut rig = ready(direction, "L C+0 R0 F1000");
        let from = (rig.machine_position('C') / 5.0).round() * 5.0;
        jog(&mut rig, "IV+", from + 11.0);
        close(rig.machine_position('C'), from + to, 0.02);
    }
}

/// In a program the target must lie on the grid: 25 degrees are reached and locked; 27 brings the PLC's message, and the
/// coupling is not released [000:8572].
#[test]
fn a_target_off_the_grid_is_refused_in_a_program() {
    let mut rig = ready(NEAREST, "L C+25 R0 F1000\nL C+27");
    // The datum is that of the machine: rounded to the grid it stays there.
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(20.0, "the message", |rig| !rig.messages().is_empty());
    // M3018 is line 94 of the messages.
    assert_eq!(rig.messages(), ["PLC: ERROR 94"]);
    close(rig.axis('C').actual, 25.0, 0.02);
    let at = rig.table('C');
    rig.seconds(3.0);
    close(rig.table('C'), at, 0.001);
    assert!(rig.bit("I11") && !rig.bit("O3") && rig.bit("M2547"));
    assert_ne!(rig.control.snapshot().run, RunState::Idle);
}

/// A datum that is set is rounded to the grid [000:8564]: 1.2 at a point of the grid is 0.
#[test]
fn a_datum_is_rounded_to_the_grid() {
    let mut rig = ready(NEAREST, "L C+0 R0 F1000");
    rig.command("datum C 1.2");
    close(rig.axis('C').actual, 0.0, 0.02);
    rig.command("datum C 3.9");
    close(rig.axis('C').actual, 5.0, 0.02);
}
