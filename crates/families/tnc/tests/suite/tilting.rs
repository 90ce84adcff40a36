//! Swivel axes on a machine: cycle 19 and M114 with a head that swivels about B.

use crate::support::*;
use bahn_tnc::RunState;

#[track_caller]
fn assert_near(a: [f64; 3], b: [f64; 3]) {
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 0.01), "{a:?} is not {b:?}");
}

const START: &str = "L X+300 Y+200 Z+300 B+0 R0 FMAX\n";
const TILT: &str = "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30\n";

/// X of the plane is cos 30° of the machine's X and -sin 30° of its Z, Z of the plane sin 30° and cos 30°. The display shows
/// the coordinates of the plane; by hand and after the program nothing is tilted.
#[test]
fn a_tilted_plane_moves_all_axes() {
    let blocks = format!(
        "{START}L B+30 FMAX\n{TILT}L IX+50 F5000\nL IZ+40 IY+10\nM0\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\nL IX+0 FMAX"
    );
    let mut rig = Build::swivelling_mill().program("TILT.H", &blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select TILT.H");
    rig.start();
    rig.until(60.0, "M0", |rig| {
        rig.control.snapshot().run == bahn_tnc::RunState::Stopped
    });
    rig.seconds(1.0);
    assert_eq!(rig.messages(), [""; 0]);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let there = [
        300.0 + 50.0 * cos + 40.0 * sin,
        210.0,
        300.0 - 50.0 * sin + 40.0 * cos,
    ];
    assert_near(machine(&rig), there);
    // The plane is tilted about the datum (0,0,0); the head's centre 150 mm above the tool datum stays where it is, so the
    // tool datum has gone by (-150 sin, 150 (1 - cos)) in X and Z, and the axes count back.
    let swung = [-150.0 * sin, 150.0 * (1.0 - cos)];
    let upright = [there[0] + swung[0], there[2] + swung[1]];
    let shown = [
        cos * upright[0] - sin * upright[1],
        sin * upright[0] + cos * upright[1],
    ];
    let axes = rig.control.snapshot().axes;
    let display = ['X', 'Z'].map(|letter| {
        axes.iter()
            .find(|axis| axis.letter == letter)
            .expect("an axis")
            .nominal
    });
    assert!(
        (display[0] - shown[0]).abs() < 1e-6 && (display[1] - shown[1]).abs() < 1e-6,
        "{display:?} {shown:?}"
    );
    rig.start();
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_near(machine(&rig), there);
    let axes = rig.control.snapshot().axes;
    assert!((axes[0].nominal - there[0]).abs() < 0.01, "{}", axes[0].nominal);
}

/// What would leave the traverse range behind the plane is refused where it stands: Z+460 of the machine.
#[test]
fn limits_are_those_of_the_axes_through_the_plane() {
    let run = |way: &str| {
        let blocks = format!("{START}L B+30 FMAX\n{TILT}L IX-{way} F5000");
        let mut rig = Build::swivelling_mill().program("LIMIT.H", &blocks).rig();
        rig.power_on();
        rig.command("mode full");
        rig.command("select LIMIT.H");
        rig.start();
        rig.until(60.0, "the end or a message", |rig| {
            rig.control.snapshot().ended || !rig.messages().is_empty()
        });
        (rig.messages(), machine(&rig))
    };
    // X-300 of the plane raises Z by 150.
    let (messages, at) = run("300");
    assert_eq!(messages, [""; 0]);
    assert_near(at, [300.0 - 300.0 * 30f64.to_radians().cos(), 200.0, 450.0]);
    let (messages, at) = run("330");
    assert!(messages[0].contains("LIMIT SWITCH Z"), "{messages:?}");
    assert_near(at, [300.0, 200.0, 300.0]);
}

/// The mill with a table B whose centre is at X 300, Z 150 of the machine: cycle 27 turns it under the tool, which stays
/// over it. On a radius of 50 mm a quarter takes 78.5 mm at 1000 mm/min; the axes are shown, not the surface.
#[test]
fn a_cylinder_surface() {
    let table = [
        "410.3=1",
        "7500=1",
        "7510=%000001",
        "7511=%11",
        "7512=300",
        "7520=%000100",
        "7521=%11",
        "7522=150",
        "7530=%010000",
        "7531=%01",
    ];
    let mill = Build::mill()
        .plant("[axis.C]", "[axis.B]")
        .plant("[axis.C.encoder]", "[axis.B.encoder]")
        .plant("clamps = \"C\"", "clamps = \"B\"");
    let blocks = "L X+250 Y+200 Z+300 B+0 R0 FMAX\nCYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1\n\
                  CYCL DEF 27.0 CYLINDER SURFACE Q1=-5 Q3=+0 Q6=+2 Q10=+5 Q11=500 Q12=1000 Q16=50 Q17=0\nCYCL CALL\n\
                  L Z+300 FMAX M2\nLBL 1\nL B+10 Y+200 R0\nL B+100\nL Y+230\nLBL 0";
    let mut rig = table
        .into_iter()
        .fold(mill, Build::mp)
        .program("ROLL.H", blocks)
        .rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select ROLL.H");
    rig.start();
    let (mut seconds, mut last) = (0.0, None);
    for _ in 0..40_000 {
        let before = rig.control.time_us();
        rig.cycle();
        let axes = rig.control.snapshot().axes;
        let of = |letter: char| axes.iter().find(|axis| axis.letter == letter).expect("an axis");
        // At its depth the tool is 5 mm below the surface, and over the centre.
        if (of('Z').machine - 195.0).abs() < 0.01 && of('B').machine < 99.99 {
            assert!((of('X').machine - 300.0).abs() < 0.01, "{}", of('X').machine);
            assert!((of('X').nominal - 300.0).abs() < 1e-6, "{}", of('X').nominal);
            // Behind it by the servo lag.
            assert!((of('B').nominal - of('B').machine).abs() < 2.0);
            seconds += (rig.control.time_us() - before) as f64 * 1e-6;
            last = Some(of('B').machine);
        }
        if rig.control.snapshot().ended {
            break;
        }
    }
    assert_eq!(rig.messages(), [""; 0]);
    assert!(last.is_some_and(|b| b > 99.0), "{last:?}");
    let expected = 0.5 * std::f64::consts::PI * 50.0 / 1000.0 * 60.0;
    assert!((seconds - expected).abs() < 0.15, "{seconds} s, not {expected}");
    assert_near(machine(&rig), [300.0, 230.0, 300.0]);
}

/// M114: the head swivels by 90 degrees and the axes carry its centre around the tip, which is the tool datum here.
#[test]
fn m114_keeps_the_tip_where_it_is() {
    let blocks = format!("{START}L B+90 F3000 M114\nL IX+10 FMAX");
    let mut rig = Build::swivelling_mill().program("TIP.H", &blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select TIP.H");
    rig.start();
    let (mut farthest, mut least) = (0.0f64, f64::INFINITY);
    for _ in 0..20_000 {
        rig.cycle();
        let axes = rig.control.snapshot().axes;
        let nominal = |letter: char| {
            axes.iter()
                .find(|axis| axis.letter == letter)
                .expect("an axis")
                .machine
        };
        let b = nominal('B');
        let block = rig.control.snapshot().block.map(|block| block.block);
        if block == Some(2) {
            // The centre is at (X, Z + 150); the tool datum hangs below it, swung by B.
            let (sin, cos) = b.to_radians().sin_cos();
            let tip = [nominal('X') - 150.0 * sin, nominal('Z') + 150.0 * (1.0 - cos)];
            least = least.min(b);
            farthest = farthest.max((tip[0] - 300.0).hypot(tip[1] - 300.0));
        }
        if rig.control.snapshot().ended {
            break;
        }
    }
    assert_eq!(rig.messages(), [""; 0]);
    assert_near(machine(&rig), [300.0 + 150.0 + 10.0, 200.0, 300.0 - 150.0]);
    // The axes follow the nominal path with their lags: the tip strays by hundredths.
    assert!(
        farthest > 0.0 && farthest < 0.05 && least < 1.0,
        "{farthest} {least}"
    );
}

/// NC stop, internal stop and a new start in the plane: the block is run again from where the axes stand.
#[test]
fn a_stop_in_the_plane() {
    let blocks = format!("{START}L B+30 FMAX\n{TILT}L IX+50 F1000\nL IX+0 FMAX");
    let mut rig = Build::swivelling_mill().program("STOP.H", &blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select STOP.H");
    rig.start();
    rig.until(60.0, "it is on its way in the plane", |rig| {
        machine(rig)[2] < 290.0
    });
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    let stopped = machine(&rig);
    rig.command("stop");
    rig.seconds(0.5);
    assert_near(machine(&rig), stopped);
    rig.start();
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    assert_near(machine(&rig), [300.0 + 50.0 * cos, 200.0, 300.0 - 50.0 * sin]);
}

/// Module 9035, item 18: bit 0 the plane is tilted, bit 2 by the program [000:14899-14933].
#[test]
fn the_plc_reads_that_the_plane_is_tilted() {
    let blocks = format!(
        "{START}L B+30 FMAX\n{TILT}L IX+50 F5000\nM0\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\nL IX+1 FMAX"
    );
    let mut build = Build::swivelling_mill().program("READ.H", &blocks);
    build.plc = build.plc.replacen(
        "       EM\n",
        "       PS    K+18\n       CM    9035\n       PL    W900\n       EM\n",
        1,
    );
    let mut rig = build.rig();
    rig.power_on();
    assert_eq!(rig.number("W900"), 0);
    rig.command("mode full");
    rig.command("select READ.H");
    rig.start();
    rig.until(60.0, "M0", |rig| {
        rig.control.snapshot().run == bahn_tnc::RunState::Stopped
    });
    rig.seconds(0.1);
    assert_eq!(rig.number("W900"), 0b101);
    rig.start();
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    rig.seconds(0.1);
    assert_eq!(rig.number("W900"), 0);
}

/// Neither a tilted plane nor M114 allocates in a cycle, nor do their beginning and end.
#[test]
fn leaning_cycles_allocate_nothing() {
    let blocks = format!(
        "{START}L B+30 FMAX\n{TILT}L IX+50 F5000\nCC IX+0 IY+10\nC IX+0 IY+0 DR+\nCYCL DEF 19.0 WORKING PLANE\n\
         CYCL DEF 19.1\nL IX+1 FMAX\nL B+0 F3000 M114\nL IX+5 B+10\nL IX+1 M115\nL IX+1 FMAX"
    );
    let mut rig = Build::swivelling_mill().program("QUIET.H", &blocks).rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select QUIET.H");
    rig.start();
    for cycle in 0..100_000 {
        rig.control.prepare();
        let allocated = allocation_counter::measure(|| rig.control.cycle(&mut rig.machine));
        assert_eq!(
            (allocated.count_total, allocated.count_current),
            (0, 0),
            "cycle {cycle}: {:?}",
            rig.control.snapshot()
        );
        if rig.control.snapshot().ended {
            assert_eq!(rig.messages(), [""; 0]);
            return;
        }
    }
    panic!("{:?}", rig.control.snapshot());
}

/// B stops where X goes straight on: the path stops there as MP7460 has it, and in no contour cycle B changes its
/// velocity by more than MP1060 allows: 1 m/s² of a rotary axis are 1000 degrees/s², 0.009 degrees in (3 ms)².
#[test]
fn a_rotary_axis_makes_no_step_at_a_straight_joint() {
    let blocks = "L X+300 Y+200 Z+300 B+0 R0 FMAX\nL IX+5 B+10 F3000\nL IX+5";
    let mut rig = Build::swivelling_mill()
        .mp("7460=10")
        .mp("1060.3=1")
        .program("JOINT.H", blocks)
        .rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("select JOINT.H");
    rig.start();
    let nominal = |rig: &Rig| {
        let axes = rig.control.snapshot().axes;
        axes.iter()
            .find(|axis| axis.letter == 'B')
            .expect("an axis")
            .nominal
    };
    let (mut before, mut step, mut greatest, mut fastest) = (nominal(&rig), 0.0, 0.0f64, 0.0f64);
    for _ in 0..20_000 {
        rig.cycle();
        let way = nominal(&rig) - before;
        greatest = greatest.max((way - step).abs());
        fastest = fastest.max(way);
        (before, step) = (before + way, way);
        if rig.control.snapshot().ended {
            break;
        }
    }
    assert!(rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(fastest > 0.1, "B moved: {fastest}");
    assert!(greatest <= 1000.0 * 0.003 * 0.003 * 1.001, "{greatest}");
}

/// Keys of jog increments with two contacts, in the mode Handwheel.
const JOG: &str = "
       L M2052
       = M2498
       R M2512
       R M2517
       S M2528
       S M2533
       L I133
       S M2512
       R M2528
       L I130
       S M2517
       R M2533
       EM
";

/// 3D ROT: a jog increment leads along the axis of the plane, once for each press, at manual feed; one that would lead beyond
/// a software limit ends there with its message [000:8494-8556].
#[test]
fn jog_increments_lead_along_the_plane() {
    let mut build = Build::swivelling_mill().mp("920.2=295");
    build.plc = build.plc.replacen("       EM\n", JOG, 1);
    let mut rig = by_hand(build);
    rig.command("mode handwheel");
    rig.command("jog 8");
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let start = machine(&rig);
    let before = shown(&rig);
    rig.event("key X+ press");
    rig.seconds(0.08);
    // Manual feed is 50 mm/s, at which the way takes twice this time.
    let way = (machine(&rig)[0] - start[0]) / cos;
    assert!(way > 0.5 && way < 50.0 * 0.08, "{way}");
    rig.seconds(1.0);
    let after = shown(&rig);
    assert!((after[0] - before[0] - 8.0).abs() < 1e-6, "{before:?} {after:?}");
    assert_near(
        machine(&rig),
        [start[0] + 8.0 * cos, start[1], start[2] - 8.0 * sin],
    );
    rig.event("key X+ release");
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    // Z of the machine stands at 296 and may go down to 295: 1 mm / cos 30 degrees along -Z of the plane.
    rig.event("key Z- press");
    rig.seconds(1.0);
    rig.event("key Z- release");
    rig.seconds(0.2);
    assert_near(machine(&rig), [start[0] + 8.0 * cos - sin / cos, start[1], 295.0]);
    assert_eq!(rig.messages(), ["LIMIT SWITCH Z-"]);
}

/// By hand in the plane of B+30, switched on there.
fn by_hand(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.command("mode mdi");
    rig.command("mdi L X+300 Y+200 Z+300 B+30 R0 FMAX");
    rig.start();
    rig.until(60.0, "B+30", |rig| rig.control.snapshot().ended);
    rig.command("mode manual");
    rig.seconds(0.5);
    assert_near(machine(&rig), [300.0, 200.0, 300.0]);
    rig.command("3d-rot on");
    rig.seconds(0.1);
    rig
}

/// Positions of X, Y and Z in the display.
fn shown(rig: &Rig) -> [f64; 3] {
    let axes = rig.control.snapshot().axes;
    ['X', 'Y', 'Z'].map(|letter| {
        let axis = axes.iter().find(|axis| axis.letter == letter).expect("an axis");
        axis.nominal
    })
}

/// 3D ROT: X+ and Z- lead along the axes of the plane, as fast as manual feed has it; a datum set there makes the display
/// what it says and leaves the others. Off again, X is that of the machine.
#[test]
fn by_hand_in_the_plane() {
    let mut build = Build::swivelling_mill();
    build.plc = build.plc.replacen(
        "       EM\n",
        "       PS    K+18\n       CM    9035\n       PL    W900\n       EM\n",
        1,
    );
    let mut rig = by_hand(build);
    assert_eq!(rig.number("W900"), 0b011);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let mut at = machine(&rig);
    for (key, [x, z]) in [("X+", [cos, -sin]), ("Z-", [-sin, -cos])] {
        let before = shown(&rig);
        rig.event(&format!("key {key} press"));
        rig.seconds(1.0);
        rig.event(&format!("key {key} release"));
        rig.seconds(0.5);
        let after = shown(&rig);
        let way = (after[0] - before[0]).abs() + (after[2] - before[2]).abs();
        assert!(way > 5.0, "{key}: {way}");
        let axis = usize::from(key == "Z-");
        assert!(
            (after[1] - before[1]).abs() < 1e-9 && (after[2 - 2 * axis] - before[2 - 2 * axis]).abs() < 1e-6,
            "{before:?} {after:?}"
        );
        at = [at[0] + way * x, at[1], at[2] + way * z];
        assert_near(machine(&rig), at);
    }
    let before = shown(&rig);
    rig.command("datum Z 10");
    rig.seconds(0.1);
    let after = shown(&rig);
    assert!(
        (after[0] - before[0]).abs() < 0.01 && (after[2] - 10.0).abs() < 0.01,
        "{before:?} {after:?}"
    );
    rig.event("key X+ press");
    rig.seconds(0.5);
    rig.event("key X+ release");
    rig.seconds(0.5);
    assert!((shown(&rig)[2] - 10.0).abs() < 0.01);
    rig.command("3d-rot off");
    rig.seconds(0.1);
    assert_eq!(rig.number("W900"), 0);
    let before = machine(&rig);
    rig.event("key X- press");
    rig.seconds(0.5);
    rig.event("key X- release");
    rig.seconds(0.5);
    let after = machine(&rig);
    assert!(after[0] < before[0] - 1.0 && (after[2] - before[2]).abs() < 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The software limits are those of the machine: X- of the plane raises Z, which stops at its limit, and X with it. The
/// way back is free, and the message goes.
#[test]
fn by_hand_in_the_plane_up_to_the_limit() {
    let mut rig = by_hand(Build::swivelling_mill());
    rig.event("key X- press");
    rig.event("key RAPID press");
    rig.seconds(20.0);
    let at = machine(&rig);
    let messages = rig.messages();
    assert!(
        messages.len() == 1 && messages[0].contains("LIMIT SWITCH"),
        "{messages:?} {at:?}"
    );
    rig.seconds(1.0);
    assert_near(machine(&rig), at);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    // Both axes came along the plane.
    assert!(
        ((300.0 - at[0]) * sin - (at[2] - 300.0) * cos).abs() < 0.01,
        "{at:?}"
    );
    rig.event("key X- release");
    rig.event("key RAPID release");
    rig.seconds(0.1);
    rig.event("key X+ press");
    rig.seconds(0.5);
    rig.event("key X+ release");
    rig.seconds(0.5);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(machine(&rig)[0] > at[0] + 1.0);
}

/// The wheel leads along the plane, too; a program that starts then is upright, and by hand the plane is there again.
#[test]
fn the_wheel_in_the_plane() {
    let build = ["7640=2", "7650=1", "7660=0"]
        .into_iter()
        .fold(Build::swivelling_mill(), Build::mp);
    let mut rig = by_hand(build.program("UP.H", "L IX+10 R0 F5000\nL IX+0"));
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let way = |turns: f64, rig: &mut Rig| {
        let before = shown(rig);
        rig.event(&format!("handwheel {}", turns * bahn_tnc::HANDWHEEL_STEPS));
        rig.seconds(2.0);
        let after = shown(rig);
        assert!((after[0] - before[0]).abs() < 1e-6, "{before:?} {after:?}");
        after[2] - before[2]
    };
    rig.command("mode handwheel");
    rig.command("handwheel Z 4");
    rig.seconds(0.1);
    let before = machine(&rig);
    let z = way(2.0, &mut rig);
    assert!((z - 2.5).abs() < 0.01, "{z}");
    assert_near(
        machine(&rig),
        [before[0] + z * sin, before[1], before[2] + z * cos],
    );
    let before = machine(&rig);
    rig.command("mode full");
    rig.command("select UP.H");
    rig.start();
    rig.seconds(0.5);
    rig.until(20.0, "the run ends", |rig| rig.control.snapshot().ended);
    assert_near(machine(&rig), [before[0] + 10.0, before[1], before[2]]);
    rig.command("mode handwheel");
    rig.seconds(0.1);
    let z = way(-1.0, &mut rig);
    assert!((z + 1.25).abs() < 0.01, "{z}");
    assert_eq!(rig.messages(), [""; 0]);
}

/// A block in MDI; then by hand again.
fn go(rig: &mut Rig, block: &str) {
    rig.command("mode mdi");
    rig.command(&format!("mdi {block} R0 FMAX"));
    rig.start();
    let runs = |rig: &Rig| rig.control.snapshot().run == RunState::Running;
    rig.until(1.0, "the block begins", runs);
    rig.until(60.0, block, |rig| !runs(rig));
    rig.command("mode manual");
    rig.seconds(0.5);
}

/// Probing in the plane of 3D ROT: Z- from 40 mm above the contact leads 40 mm / cos 30° along the plane. What was touched
/// becomes Z+7 of the plane, X and Y of the display stay. A basic rotation is measured with the swivel axes at 0 only
/// [000:4269], the probe is calibrated upright.
#[test]
fn the_datum_is_probed_in_the_plane() {
    let mut rig = by_hand(Build::swivelling_mill());
    go(&mut rig, "L X+300 Y+150 Z+200");
    rig.event("probe insert");
    // The face of the block is at Z 40, the tip 120 mm below the axis.
    let way = (200.0 - 40.0 - 120.0) / 30f64.to_radians().cos();
    let before = shown(&rig);
    rig.command("probe surface");
    rig.command("probe direction Z-");
    rig.start();
    let probed = |rig: &Rig| {
        let signal = "probe.touches".parse().expect("a signal");
        rig.control.first().observe(&signal) == 1.0 && rig.bit("M2026")
    };
    rig.until(30.0, "the touch", probed);
    rig.seconds(0.5);
    assert_near(shown(&rig), before);
    rig.command("probe datum Z 7");
    rig.seconds(0.1);
    assert_near(shown(&rig), [before[0], before[1], 7.0 + way]);
    assert_eq!(rig.messages(), [""; 0]);
    for (plane, function, barred) in [
        ("3d-rot on", "probe rotation", true),
        ("3d-rot on", "probe length 40", true),
        ("3d-rot on", "probe corner", false),
        ("3d-rot off", "probe rotation", true),
        ("3d-rot off", "probe length 40", false),
    ] {
        rig.command("mode manual");
        rig.command(plane);
        rig.command(function);
        let messages = rig.messages();
        let expected = if barred {
            vec!["PLANE WRONGLY DEFINED"]
        } else {
            vec![]
        };
        assert_eq!(messages, expected, "{plane} {function}");
        if barred {
            rig.command("ce");
        }
    }
    go(&mut rig, "L B+0");
    rig.command("probe rotation");
    assert_eq!(rig.messages(), [""; 0]);
}

/// 3D ROT for program run, apart from manual operation [000:4256]: a program without cycle 19 runs in the plane of the swivel
/// axes, along which X leads by cos 30° in X and by -sin 30° in Z of the machine; off again, it is upright. Module 9035 tells
/// which is selected [000:14933].
#[test]
fn program_run_in_the_plane_of_the_menu() {
    let mut build = Build::swivelling_mill().program("1.H", "L IX+10 R0 F6000");
    build.plc = build.plc.replacen(
        "       EM\n",
        "       PS    K+18\n       CM    9035\n       PL    W900\n       EM\n",
        1,
    );
    let mut rig = by_hand(build);
    let selected = |rig: &mut Rig| {
        rig.seconds(0.1);
        rig.number("W900")
    };
    assert_eq!(selected(&mut rig), 0b011);
    rig.command("3d-rot off");
    assert_eq!(selected(&mut rig), 0b000);
    rig.command("3d-rot run on");
    assert_eq!(selected(&mut rig), 0b100);
    let start = machine(&rig);
    rig.run("1.H", 10.0);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let tilted = [start[0] + 10.0 * cos, start[1], start[2] - 10.0 * sin];
    rig.seconds(0.2);
    assert_near(machine(&rig), tilted);
    assert_eq!(selected(&mut rig), 0b100, "after the program, too");
    rig.command("3d-rot run off");
    assert_eq!(selected(&mut rig), 0b000);
    rig.run("1.H", 10.0);
    rig.seconds(0.2);
    assert_near(machine(&rig), [tilted[0] + 10.0, tilted[1], tilted[2]]);
}

/// The position of the swivel axis is edited [000:4256]: B stands at 30 degrees, X+ leads along the plane of 45.
#[test]
fn by_hand_in_a_plane_that_was_entered() {
    let mut rig = by_hand(Build::swivelling_mill());
    rig.command("3d-rot on B+45");
    rig.seconds(0.1);
    let start = machine(&rig);
    rig.event("key X+ press");
    rig.seconds(1.0);
    rig.event("key X+ release");
    rig.seconds(0.5);
    let way = (machine(&rig)[0] - start[0]) / 45f64.to_radians().cos();
    assert!(way > 5.0, "{way}");
    assert_near(
        machine(&rig),
        [
            start[0] + way * 0.5f64.sqrt(),
            start[1],
            start[2] - way * 0.5f64.sqrt(),
        ],
    );
    // The machine has no axis A that swivels.
    assert!(!rig.control.command("3d-rot on A+45".parse().unwrap()));
}
