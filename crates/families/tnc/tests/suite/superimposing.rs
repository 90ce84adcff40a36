//! M118: the handwheel leads axes beside the path of a program [000:742].

use crate::support::bench::*;
use crate::support::*;
use bahn_path::Axis;
use bahn_tnc::{AxisWatch, HANDWHEEL_STEPS, RunState};

/// Acceleration of Z, m/s²: MP1060.2; and the contour cycle, s.
const ACCELERATION: f64 = 0.5;
const CYCLE_S: f64 = 0.003;

/// The bench with a handwheel on Z, a turn 10 mm; the program is selected.
fn wheel(blocks: &str) -> Rig {
    wheel_with("", "1710.0=8 1720.0=10 1060.2=0.5", blocks)
}

fn wheel_with(plc: &str, parameters: &str, blocks: &str) -> Rig {
    let mut rig = bench(plc)
        .plant("speed = 6000", "speed = 12000")
        .mps("7640=2 7650=1 7660=0 7670.0=0 7460=10")
        .mps(parameters)
        .mps("1010.0=12000 1010.1=12000 1010.2=12000")
        .program("1.H", blocks)
        .ready();
    rig.command("handwheel Z 1");
    rig.command("mode full");
    rig.command("select 1.H");
    rig
}

/// Z as the kernel moves it.
fn z_of(rig: &Rig) -> AxisWatch {
    let mut watch = rig.control.first().watch();
    watch.find(|watch| watch.axis == Axis::Z).unwrap()
}

/// Turns the wheel by so many mm of Z; what Z and X do meanwhile, and the greatest change of Z's way in a cycle.
fn turn(rig: &mut Rig, mm: f64, seconds: f64) -> f64 {
    rig.event(&format!("handwheel {}", mm / 10.0 * HANDWHEEL_STEPS));
    let mut greatest = 0.0f64;
    let at = z_of(rig);
    let mut before = [at.commanded, at.commanded - at.speed_mm_s * CYCLE_S];
    for _ in 0..(seconds / CYCLE_S) as usize {
        rig.cycle();
        let z = rig.axis('Z').nominal;
        greatest = greatest.max((z - 2.0 * before[0] + before[1]).abs());
        before = [z, before[0]];
    }
    greatest
}

/// No change of velocity beyond MP1060, but for the resolution of the display.
#[track_caller]
fn assert_ramp(greatest: f64) {
    let most = 1000.0 * ACCELERATION * CYCLE_S * CYCLE_S;
    assert!(greatest <= most * 1.001 + 1e-9, "{greatest} beyond {most}");
    assert!(greatest > 0.0);
}

/// Z goes as far as the wheel leads it, 2 mm at most, on its ramp, while X keeps to its path.
#[test]
fn the_handwheel_leads_beside_the_path() {
    let mut rig = wheel("L IX+40 R0 F600 M118 Z2\nL IX+10");
    let [x, z] = ['X', 'Z'].map(|axis| rig.axis(axis).nominal);
    rig.start();
    rig.seconds(0.3);
    assert_ramp(turn(&mut rig, 1.0, 0.5));
    close(rig.axis('Z').nominal - z, 1.0, 1e-9);
    close(rig.table('Z') - z, 1.0, 0.005);
    close(rig.speed('X'), 600.0, 1.0);
    assert_ramp(turn(&mut rig, 5.0, 0.5));
    close(rig.axis('Z').nominal - z, 2.0, 1e-9);
    assert_ramp(turn(&mut rig, -9.0, 1.0));
    close(rig.axis('Z').nominal - z, -2.0, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('X').nominal - x, 50.0, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
    // After the end nothing moves; the next run begins where the axes stand.
    close(rig.axis('Z').nominal - z, -2.0, 1e-9);
    turn(&mut rig, 1.0, 0.3);
    close(rig.axis('Z').nominal - z, -2.0, 1e-9);
}

/// The wheel has a ramp of MP1060 of its own, whatever the path does: where both accelerate one way the axis has more than
/// MP1060, but never more than twice of it. The path is none the worse for it.
#[test]
fn path_and_wheel_together_have_twice_mp1060_at_most() {
    let mut rig =
        wheel("L IZ+1 R0 F600 M118 Z5\nLBL 1\nL IZ+6 F6000\nL IZ-6\nCALL LBL 1 REP 5/5\nL IX+20 F600 M118");
    let z = rig.axis('Z').nominal;
    rig.start();
    rig.seconds(0.4);
    let turns = [3.0, -6.0, 6.0, -5.0, 6.0, -6.0, 4.0];
    let greatest = turns
        .into_iter()
        .map(|mm| turn(&mut rig, mm, 0.29))
        .fold(0.0, f64::max);
    let most = 2.0 * 1000.0 * ACCELERATION * CYCLE_S * CYCLE_S;
    assert!(greatest > 0.75 * most, "{greatest} of {most}");
    assert!(greatest <= most * 1.001 + 1e-9, "{greatest} beyond {most}");
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    rig.seconds(1.0);
    close(rig.axis('Z').nominal - z, 1.0, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
}

/// M118 without words: Z goes back to the path on its ramp, and the wheel moves nothing any more. Without M118 it
/// never does.
#[test]
fn m118_ends_on_a_ramp() {
    let mut rig = wheel("L IX+5 R0 F600 M118 Z2\nL IX+10 M118\nL IX+5");
    let z = rig.axis('Z').nominal;
    rig.start();
    rig.seconds(0.2);
    turn(&mut rig, 1.5, 0.25);
    close(rig.axis('Z').nominal - z, 1.5, 1e-9);
    let greatest = turn(&mut rig, 0.0, 0.8);
    assert_ramp(greatest);
    close(rig.axis('Z').nominal, z, 1e-9);
    turn(&mut rig, 1.0, 0.4);
    close(rig.axis('Z').nominal, z, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}

/// At an NC stop the wheel still leads; INTERNAL STOP ends it where the axes stand. The block is then run to its end
/// as it is programmed.
#[test]
fn an_internal_stop_ends_it() {
    let mut rig = wheel("L X+100 Z+60 R0 FMAX M118 Z2\nL X+120 F600\nL Z+60");
    rig.start();
    rig.until(20.0, "the second block", |rig| rig.axis('X').nominal > 105.0);
    turn(&mut rig, 1.0, 0.3);
    rig.event("key NC_STOP tap");
    rig.seconds(0.3);
    turn(&mut rig, 0.5, 0.5);
    close(rig.axis('Z').nominal, 61.5, 1e-9);
    rig.command("stop");
    assert_eq!(rig.control.snapshot().run, RunState::Idle);
    rig.start();
    rig.seconds(0.3);
    turn(&mut rig, -1.0, 0.2);
    close(rig.axis('Z').nominal, 61.5, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('Z').nominal, 60.0, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The software limits hold: a block on whose way the handwheel could lead Z beyond 170 is refused.
#[test]
fn the_traverse_range_holds() {
    let run = |z: &str| {
        let mut rig = wheel(&format!("L IX+1 R0 F600 M118 Z2\nL Z{z} FMAX\nL IX+1 F600"));
        rig.start();
        rig.until(20.0, "the end or a message", |rig| {
            rig.control.snapshot().ended || !rig.messages().is_empty()
        });
        rig.messages()
    };
    assert_eq!(run("+168"), [""; 0]);
    assert_eq!(run("+168.1"), ["LIMIT SWITCH Z+"]);
}

/// Return to the contour: axes moved by hand go back to the path, and Z to beside it.
#[test]
fn the_return_to_the_contour_knows_it() {
    let mut rig = bench("")
        .plant("speed = 6000", "speed = 12000")
        .mps("1710.0=8 1720.0=10 7640=2 7650=1 7660=0 7670.0=0 7680=%0000010")
        .mps("1010.0=12000 1010.1=12000 1010.2=12000")
        .program("1.H", "L X+100 Z+60 R0 FMAX M118 Z2\nL X+120 F600\nL IY+1")
        .ready();
    rig.command("handwheel Z 1");
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(20.0, "the second block", |rig| rig.axis('X').nominal > 105.0);
    turn(&mut rig, 1.0, 0.3);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let x = rig.axis('X').nominal;
    rig.command("manual-operation");
    rig.event("key Z+ press");
    rig.seconds(0.5);
    rig.event("key Z+ release");
    rig.seconds(0.5);
    assert!(rig.axis('Z').nominal > 62.0);
    rig.command("restore-position");
    rig.start();
    rig.seconds(2.0);
    close(rig.axis('Z').nominal, 61.0, 1e-6);
    close(rig.axis('X').nominal, x, 1e-6);
    rig.start();
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('Z').nominal, 61.0, 1e-6);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Neither the wheel under M118 nor its end allocates in a cycle.
#[test]
fn cycles_allocate_nothing() {
    let mut rig = wheel("L IX+5 R0 F600 M118 Z2\nL IX+3 M118\nL IX+1");
    rig.start();
    for cycle in 0..10_000 {
        if cycle == 50 {
            rig.event("handwheel 150");
        }
        rig.control.prepare();
        let allocated = allocation_counter::measure(|| rig.control.cycle(&mut rig.machine));
        assert_eq!(
            (allocated.count_total, allocated.count_current),
            (0, 0),
            "{cycle}"
        );
        if rig.control.snapshot().ended {
            return;
        }
    }
    panic!("{:?}", rig.control.snapshot());
}

/// Beside the path nothing is measured: nobody would know where the touch lies.
#[test]
fn measuring_under_m118_is_refused() {
    let probe = "TCH PROBE 0.0 REF. PLANE Q5 X+\nTCH PROBE 0.1 X+80 Y+50 Z+50\nL IX+1 F600";
    let run = |m118: &str| {
        let mut rig = wheel(&format!("L IX+1 R0 F600 M118 Z2\nL IX+1 {m118}\n{probe}"));
        rig.start();
        rig.seconds(15.0);
        (rig.messages(), rig.control.snapshot().run)
    };
    assert_eq!(
        run("M9"),
        (vec!["PROBE SYSTEM NOT READY".to_owned()], RunState::Interrupted)
    );
    let (messages, state) = run("M118");
    assert_eq!(messages, [""; 0]);
    assert_eq!(state, RunState::Running);
}

/// EMERGENCY STOP while the wheel leads Z by 1 mm: what is turned while the loops are open, and until NC start has led the axes
/// back, adds nothing; then the wheel leads on from 1 mm, and the path ends where it is to.
#[test]
fn the_wheel_in_an_emergency_stop_moves_nothing_later() {
    let mut rig = wheel("L IX+20 R0 F600 M118 Z2\nL IX+20");
    let [x, z] = ['X', 'Z'].map(|axis| rig.axis(axis).nominal);
    rig.start();
    rig.seconds(0.3);
    turn(&mut rig, 1.0, 0.5);
    rig.event("emergency press");
    rig.seconds(0.5);
    turn(&mut rig, 0.5, 0.3);
    rig.event("emergency release");
    rig.seconds(0.3);
    rig.command("ce");
    rig.until(2.0, "the loops are closed", |rig| rig.bit("M2000"));
    rig.seconds(0.3);
    turn(&mut rig, -0.7, 0.5);
    close(rig.table('Z') - z, 1.0, 0.01);
    rig.start();
    rig.seconds(1.0);
    close(rig.axis('Z').nominal - z, 1.0, 1e-9);
    turn(&mut rig, 0.5, 0.5);
    close(rig.axis('Z').nominal - z, 1.5, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('X').nominal - x, 40.0, 1e-9);
    close(rig.axis('Z').nominal - z, 1.5, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Runs to the end, and turns the wheel by so many mm to and fro, each for so many cycles; now and then it rests, since a block
/// that ends in a stop waits until Z is in position. Z never is faster than MP1010; what the
/// wheel adds keeps to the ramp of MP1060 by itself, but where both together are at rapid traverse it gives way to the path, and
/// Z itself gains no more than path and ramp. How fast the path alone, the wheel alone and both were at most, mm/s.
fn together(rig: &mut Rig, mm: f64, cycles: usize) -> [f64; 3] {
    const RAPID: f64 = 12_000.0 / 60.0;
    let state = |rig: &Rig| {
        let z = z_of(rig);
        assert!(z.speed_mm_s.abs() <= RAPID * (1.0 + 1e-9), "{z:?}");
        let ramp = z.acceleration_mm_s2 * CYCLE_S * (1.0 + 1e-6) + 1e-9;
        (z.commanded, z.superimposed, ramp)
    };
    let mut fastest = [0.0f64; 3];
    let (mut before, mut was) = (state(rig), [0.0; 3]);
    rig.start();
    for cycle in 0.. {
        if cycle % cycles == 0 && cycle % 400 < 200 {
            let way = if (cycle / cycles).is_multiple_of(2) {
                mm
            } else {
                -mm
            };
            rig.event(&format!("handwheel {}", way / 10.0 * HANDWHEEL_STEPS));
        }
        rig.cycle();
        let now = state(rig);
        let [sum, wheel] = [now.0 - before.0, now.1 - before.1].map(|way| way / CYCLE_S);
        let speeds = [sum - wheel, wheel, sum];
        let [path_step, wheel_step, step] = std::array::from_fn(|index| (speeds[index] - was[index]).abs());
        let given = if sum.abs() >= RAPID * (1.0 - 1e-9) {
            path_step
        } else {
            0.0
        };
        assert!(
            wheel_step <= now.2 + given,
            "{wheel_step} mm/s of the wheel in cycle {cycle}: {was:?}, {speeds:?}"
        );
        assert!(
            step <= now.2 + path_step,
            "{step} mm/s of Z in cycle {cycle}: {was:?}, {speeds:?}"
        );
        fastest = std::array::from_fn(|index| fastest[index].max(speeds[index].abs()));
        (before, was) = (now, speeds);
        if rig.control.snapshot().ended {
            break;
        }
        assert!(
            cycle < 20_000,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
    }
    assert_eq!(rig.messages(), [""; 0]);
    fastest
}

/// A bench whose Z is as quick as that of a small machine: MP1060.2 = 5 m/s².
fn quick(parameters: &str, blocks: &str) -> Rig {
    wheel_with(
        "",
        &format!("1710.0=30 1710.2=30 1720.0=40 1720.2=40 1060.2=5 {parameters}"),
        blocks,
    )
}

/// In rapid traverse the path leaves the wheel nothing: what it was given while the path was slow it has given back when the path is
/// fast. MP1010 is the rapid traverse of the axis, whatever moves it.
#[test]
fn path_and_wheel_together_keep_the_rapid_traverse() {
    for cycles in [7, 11, 16, 23, 31] {
        let mut rig = quick(
            "",
            "L Z+140 R0 FMAX M118 Z8\nLBL 1\nL IZ-80 FMAX\nL IZ+80 FMAX\nCALL LBL 1 REP 9/9\nL IX+9 F600 M118",
        );
        let fastest = together(&mut rig, 16.0, cycles);
        close(fastest[0], 200.0, 1e-6);
        close(fastest[2], 200.0, 1e-6);
        assert!(fastest[1] > 20.0, "{fastest:?}");
        close(rig.axis('Z').nominal, 140.0, 1e-9);
    }
}

/// At a corner that is passed (M90, with servo lag: MP1390 = 1) the path takes its speed along Z at once, and the wheel gives way by as much.
#[test]
fn at_a_corner_the_wheel_gives_way_to_the_path() {
    for cycles in [40, 47, 55, 71] {
        let zigzag = "L IX+12 F12000 M90\nL IZ-12 M90\nL IX-12 M90\nL IZ+12 M90";
        let mut rig = quick(
            "1390=1",
            &format!(
                "L Z+90 X+40 R0 FMAX M118 Z60\nLBL 1\n{zigzag}\nCALL LBL 1 REP 20/20\nL IX+30 F600 M118"
            ),
        );
        let fastest = together(&mut rig, 120.0, cycles);
        assert!(fastest[0] > 60.0 && fastest[1] > 150.0, "{fastest:?}");
        close(fastest[2], 200.0, 1e-6);
        close(rig.axis('Z').nominal, 90.0, 1e-9);
    }
}

/// POSITIONING ERROR stops the machine [000:5198]: the wheel leads no axis on. At full speed Z lags 200 mm/s / (2 m/min/mm) = 6 mm
/// after, where MP1710 allows 4; it stands within its braking distance of 200² / (2 · 5000) = 4 mm and three cycles, and
/// what is turned meanwhile moves nothing later.
#[test]
fn a_positioning_error_stops_the_wheel() {
    let mut rig = quick(
        "1390=1 1710.2=4 1720.2=20",
        "L X+120 Z+90 R0 FMAX M118 Z60\nL X+160 F600",
    );
    rig.start();
    rig.until(20.0, "the second block", |rig| rig.axis('X').nominal > 121.0);
    rig.event(&format!("handwheel {}", 50.0 / 10.0 * HANDWHEEL_STEPS));
    rig.until(1.0, "a message", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["POSITIONING ERROR Z"]);
    let from = rig.axis('Z').nominal;
    let greatest = turn(&mut rig, 30.0, 0.5);
    close(greatest, 5000.0 * CYCLE_S * CYCLE_S, 1e-6);
    let stood = rig.axis('Z').nominal;
    let bound = 200.0 * 200.0 / (2.0 * 5000.0) + 3.0 * 200.0 * CYCLE_S;
    assert!((0.0..bound).contains(&(stood - from)), "{from} to {stood}");
    rig.command("ce");
    rig.start();
    rig.seconds(1.0);
    close(rig.axis('Z').nominal, stood, 1e-9);
    assert!(turn(&mut rig, -5.0, 0.5) > 0.0);
    close(rig.axis('Z').nominal, stood - 5.0, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('X').nominal, 160.0, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
}

/// An M function lets the PLC take Z from 90 to 110 mm (M2706, D536 from the machine datum, W564 [000:4005-4053]). What is turned
/// meanwhile moves nothing, neither then nor later: Z stands at 110 when it is there, and the wheel leads on from there.
#[test]
fn the_wheel_moves_nothing_that_the_plc_positions() {
    let plc = "
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     M1
       IFT
         L     K+1100000
         = D536
         L     K+3000
         = W564
       ENDI
       L     M1
       S     M2706
       L     M2045
       AN    M2706
       = M2482
";
    let blocks = "L X+120 Z+90 R0 FMAX M118 Z60\nL X+122 F3000 M70\nL X+160 F600";
    let mut rig = wheel_with(plc, "1710.2=30 1720.2=40 1060.2=5", blocks);
    rig.start();
    rig.until(20.0, "the PLC positions Z", |rig| {
        rig.bit("M2706") && rig.axis('Z').nominal > 91.0
    });
    let mut cycles = 0;
    while rig.axis('Z').nominal < 109.9 {
        rig.event(&format!("handwheel {}", 0.3 / 10.0 * HANDWHEEL_STEPS));
        rig.cycle();
        cycles += 1;
    }
    assert!(cycles > 100, "{cycles}");
    rig.until(1.0, "Z is there", |rig| !rig.bit("M2706"));
    close(rig.axis('Z').nominal, 110.0, 1e-9);
    let greatest = turn(&mut rig, 0.0, 0.5);
    assert_eq!(greatest, 0.0);
    close(rig.axis('Z').nominal, 110.0, 1e-9);
    assert!(turn(&mut rig, 5.0, 0.3) > 0.0);
    close(rig.axis('Z').nominal, 115.0, 1e-9);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    close(rig.axis('Z').nominal, 115.0, 1e-9);
    assert_eq!(rig.messages(), [""; 0]);
}
