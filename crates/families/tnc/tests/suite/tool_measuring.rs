//! Tools are measured with the tool probe of the mill: TCH PROBE 31 and 32 [000:7960-8058].

use crate::support::*;
use bahn_path::ToolShape;
use bahn_plc::TableKind;
use bahn_tnc::{Edges, Tool};

/// Tool 2 is 95 mm long with a radius of 10 mm in the table; the one in the spindle is 94.96 and 9.985 mm.
const DIFFERENCES: [f64; 2] = [-0.04, -0.015];
/// What encoder steps and the probing feed leave: 6.4 mm/min in a contour cycle of 3 ms and a servo step are less than 1 µm.
const NEAR: f64 = 0.002;

fn mill(edges: Edges, blocks: &str) -> Rig {
    mill_with(edges, &[], blocks)
}

fn mill_with(edges: Edges, parameters: &[&str], blocks: &str) -> Rig {
    mill_of([95.0, 10.0], edges, parameters, |build| build, blocks)
}

fn mill_of(
    [length, radius]: [f64; 2],
    edges: Edges,
    parameters: &[&str],
    plant: impl Fn(Build) -> Build,
    blocks: &str,
) -> Rig {
    let tool = Tool {
        shape: ToolShape {
            length,
            radius,
            ..ToolShape::default()
        },
        pocket: Some(2),
        edges,
        ..Tool::default()
    };
    let called = if blocks.starts_with("TOOL CALL") {
        ""
    } else {
        "TOOL CALL 2 Z S800\n"
    };
    let mut build = plant(Build::mill())
        .mp("7261=12")
        .mp("7480.0=3")
        .mp("4310.0=3")
        .mp("7300=4")
        .program("1.H", &format!("{called}{blocks}"));
    for parameter in parameters {
        build = build.mp(parameter);
    }
    build.tools = Some([(2, tool)].into());
    let mut rig = build.rig();
    rig.machine.load_magazine([(2, 2)].into_iter(), 0);
    rig.power_on();
    rig
}

fn cycle(number: u8, check: &str) -> String {
    format!(
        "TCH PROBE {number}.0 MEASURE\nTCH PROBE {number}.1 CHECK: {check}\nTCH PROBE {number}.2 HEIGHT: +100\n\
         TCH PROBE {number}.3 PROBING THE TEETH: 0\n"
    )
}

fn close_to(value: f64, expected: f64) {
    assert!((value - expected).abs() < NEAR, "{value} instead of {expected}");
}

/// What was written into the tool table, by the number of the element.
fn written(rig: &Rig, element: usize) -> Option<f64> {
    let written = rig.control.remember().written;
    let found = written
        .iter()
        .find(|row| row.table == TableKind::Tool && row.element == element);
    found.map(|row| row.value)
}

/// Element numbers of the tool table [000:15431-15454].
const L: usize = 0;
const R: usize = 1;
const DR: usize = 10;
const TL: usize = 12;

/// Length and radius become the data of the tool; Q115 and Q116 are the differences. The tool turns backwards at
/// 40 / (2 π 0.01) = 636.6 rpm while it is probed, and the spindle stands and has its speed again after.
#[test]
fn length_and_radius_are_measured() {
    let blocks = cycle(31, "0") + "Q10 = Q115\n" + &cycle(32, "0") + "Q11 = Q116";
    let mut rig = mill(Edges::default(), &blocks);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(60.0, "it measures", |rig| rig.bit("M2390"));
    assert!(!rig.bit("M2391"));
    rig.until(60.0, "the contact is deflected", |rig| rig.bit("M2025"));
    let spindle = rig.control.snapshot().spindle;
    assert!((spindle.actual_rpm.abs() - 636.6).abs() < 5.0, "{spindle:?}");
    assert!(rig.bit("M2486"), "M4");
    rig.until(200.0, "the program ends", |rig| rig.control.snapshot().ended);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2390") && !rig.bit("M2486") && rig.bit("M2487"));
    assert_eq!(rig.control.snapshot().spindle.programmed_rpm, 800.0);
    close_to(written(&rig, L).unwrap(), 95.0 + DIFFERENCES[0]);
    close_to(written(&rig, R).unwrap(), 10.0 + DIFFERENCES[1]);
    close_to(q(&rig, 10), DIFFERENCES[0]);
    close_to(q(&rig, 11), DIFFERENCES[1]);
    // The length counts at once.
    close_to(rig.control.remember().tool_length, 95.0 + DIFFERENCES[0]);
}

/// What was measured acts at once, length and radius, without another TOOL CALL: Q108 is the radius, Q114 the length; a path
/// with radius compensation runs with the new radius, a position in machine coordinates (M91) with the new length. A
/// check, whose difference becomes DL and DR, too.
#[test]
fn what_was_measured_acts_at_once() {
    for check in ["0", "1"] {
        let blocks = cycle(31, check)
            + &cycle(32, check)
            + "Q10 = Q108\nQ11 = Q114\nL Z+100 R0 FMAX M91\nQ12 = 1\nL X+100 Y+60 R0 FMAX\nL X+100 Y+100 RR F2000\n\
               L X+100 Y+130 F2000\nSTOP";
        let mut rig = mill(Edges::default(), &blocks);
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(200.0, "it has measured", |rig| q(rig, 12) == 1.0);
        rig.until(60.0, "it stops", |rig| {
            rig.control.snapshot().run == bahn_tnc::RunState::Stopped
        });
        assert_eq!(rig.messages(), [""; 0]);
        let [length, radius] = [95.0 + DIFFERENCES[0], 10.0 + DIFFERENCES[1]];
        close_to(q(&rig, 10), radius);
        close_to(q(&rig, 11), length);
        // Right of a contour in the direction of Y+ is X+.
        let shown = |letter: char| {
            rig.control
                .observe(&format!("{letter}.displayed").parse().unwrap())
        };
        assert!((shown('X') - 100.0 - radius).abs() < 0.002, "{}", shown('X'));
        assert!(
            (rig.machine_position('Z') - 100.0).abs() < 0.002,
            "{}",
            rig.machine_position('Z')
        );
    }
}

/// A check: the difference becomes DR; beyond RTOL the tool is worn and locked, M2392; Q5 is 1.
#[test]
fn a_worn_tool_is_locked() {
    let edges = Edges {
        radius_wear: 0.01,
        radius_break: 0.1,
        ..Edges::default()
    };
    let mut rig = mill(edges, &(cycle(32, "1 Q5") + "TOOL CALL 0 Z S0\nTOOL CALL 2 Z S0"));
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(60.0, "it checks", |rig| rig.bit("M2390") && rig.bit("M2391"));
    rig.until(200.0, "the tool is refused", |rig| !rig.messages().is_empty());
    assert!(rig.bit("M2392") && !rig.bit("M2393"));
    assert!(rig.messages()[0].contains("LOCKED"), "{:?}", rig.messages());
    close_to(written(&rig, DR).unwrap(), DIFFERENCES[1]);
    assert_eq!((written(&rig, TL), written(&rig, R)), (Some(1.0), None));
    assert_eq!(q(&rig, 5), 1.0);
}

/// Beyond RBREAK it is broken: M2393, Q5 is 2, its data stay.
#[test]
fn a_broken_tool_is_locked() {
    let edges = Edges {
        radius_wear: 0.005,
        radius_break: 0.01,
        ..Edges::default()
    };
    let mut rig = mill(edges, &cycle(32, "1 Q5"));
    rig.run("1.H", 200.0);
    rig.seconds(0.1);
    assert!(rig.bit("M2393") && !rig.bit("M2392"));
    assert_eq!((written(&rig, TL), written(&rig, DR)), (Some(1.0), None));
    assert_eq!(q(&rig, 5), 2.0);
}

/// Where the tool goes by MP6505, MP6530, MP6531, MP6540 and L-OFFS: for the radius in negative Y (MP6505 = 3) from
/// 40 + 40/2 + 10 + 2 mm, its tip 5 + 1 mm below the upper face at 60 mm, at MP6550 = 3000 mm/min.
#[test]
fn the_contact_is_where_the_list_says() {
    let edges = Edges {
        length_offset: 1.0,
        ..Edges::default()
    };
    let mut rig = mill_with(edges, &["6505=3", "6530=5", "6531=40", "6540=2"], &cycle(32, "0"));
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(60.0, "it measures", |rig| rig.bit("M2390"));
    let mut fastest: f64 = 0.0;
    let here = |rig: &Rig| ['X', 'Y'].map(|letter| rig.axis(letter).nominal);
    let (mut before, mut time) = (here(&rig), rig.control.time_us());
    while !rig.bit("M2486") {
        rig.cycle();
        let (now, passed) = (here(&rig), rig.control.time_us() - time);
        let way = (now[0] - before[0]).hypot(now[1] - before[1]);
        fastest = fastest.max(way / (passed as f64 / 6e7));
        (before, time) = (now, rig.control.time_us());
    }
    assert!((fastest - 3000.0).abs() < 1.0, "{fastest}");
    close_to(rig.axis('X').nominal, 560.0);
    close_to(rig.axis('Y').nominal, 40.0 + 40.0 / 2.0 + 10.0 + 2.0);
    close_to(rig.axis('Z').nominal, 60.0 - 5.0 - 1.0);
    rig.until(200.0, "the program ends", |rig| rig.control.snapshot().ended);
    close_to(written(&rig, R).unwrap(), 10.0 + DIFFERENCES[1]);
}

/// Without MP6500 nothing is measured; a contact that is not where MP6580 says is not found, and the axes stand.
#[test]
fn nothing_to_measure_with() {
    for (parameter, said) in [
        ("6500=0", "PROBE SYSTEM NOT READY"),
        ("6580.2=80", "TOUCH POINT INACCESSIBLE"),
    ] {
        let mut build = Build::mill()
            .mp("7261=12")
            .mp("7480.0=3")
            .mp("4310.0=3")
            .mp(parameter);
        build = build.program("1.H", &format!("TOOL CALL 2 Z S800\n{}", cycle(31, "0")));
        let mut rig = build.rig();
        rig.power_on();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(200.0, "it is refused", |rig| {
            rig.messages().iter().any(|text| text.contains(said))
        });
        rig.seconds(0.5);
        assert!(!rig.bit("M2390") && !rig.control.snapshot().ended, "{parameter}");
    }
}

/// A Q parameter as the control remembers it.
fn q(rig: &Rig, number: u16) -> f64 {
    let all = rig.control.remember().q;
    all.iter()
        .find(|(own, _)| *own == number)
        .map_or(0.0, |(_, value)| *value)
}

/// Tool 2 with three teeth: radii 9.985, 9.9 and 9.95 mm, lengths 94.96, 94.96 and 94.9 mm.
fn three_teeth(build: Build) -> Build {
    let tooth = "\n[[tool_probe.tool.tooth]]\n";
    let teeth = format!("radius = 9.985\n{tooth}{tooth}radius = 9.9\n{tooth}radius = 9.95\nlength = 94.9\n");
    build.plant("radius = 9.985\n", &teeth)
}

fn teeth(number: u8, check: &str) -> String {
    cycle(number, check).replace("TEETH: 0", "TEETH: 1")
}

/// MP6520 so slow that a contour cycle is a way of 1 µm.
const SLOWLY: &str = "6520=20";

/// The spindle angles at which the contact was deflected, whole degrees, until the program ends.
fn angles_of_touches(rig: &mut Rig) -> Vec<i64> {
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let angle: bahn_tnc::Signal = "S.angle".parse().unwrap();
    let (mut angles, mut moved, mut touched) = (Vec::new(), false, false);
    rig.until(60.0, "it measures", |rig| rig.bit("M2390"));
    let end = rig.control.time_us() + 400_000_000;
    while rig.bit("M2390") {
        assert!(rig.control.time_us() < end, "{:?}", rig.messages());
        assert!(!rig.bit("M2486"), "it does not turn");
        moved |= rig.bit("M2127");
        rig.cycle();
        let touches = rig.machine.tool_probe().deflected;
        if touches && !touched {
            angles.push((rig.control.observe(&angle).round() as i64).rem_euclid(360));
        }
        touched = touches;
    }
    assert!(moved, "M2127");
    rig.until(60.0, "the program ends", |rig| rig.control.snapshot().ended);
    rig.seconds(0.2);
    angles
}

/// Each tooth is turned to the contact and probed with MP6520; the longest one is the radius, the farthest off counts
/// for the tolerances: 0.1 mm are beyond RTOL 0.06, not beyond RBREAK 0.2. Seen from the spindle M3 turns against the
/// plane: to look in +X, the probing direction of MP6505 = 0, teeth at 0, 120 and 240° need as much.
#[test]
fn single_teeth_have_a_radius_each() {
    let edges = Edges {
        count: 3,
        radius_wear: 0.06,
        radius_break: 0.2,
        ..Edges::default()
    };
    let blocks = teeth(32, "1 Q5");
    let mut rig = mill_of([95.0, 10.0], edges, &["6560=-1", SLOWLY], three_teeth, &blocks);
    assert_eq!(angles_of_touches(&mut rig), [0, 120, 240]);
    assert!(rig.bit("M2392") && !rig.bit("M2393"));
    assert_eq!(q(&rig, 5), 1.0);
    close_to(q(&rig, 116), 9.985 - 10.0);
    close_to(written(&rig, DR).unwrap(), 9.985 - 10.0);
}

/// The length of teeth is measured R-OFFS = 25 mm beside the middle, where only the tooth that looks back to it (-X, 180°)
/// is over the contact: 94.9 mm are 0.1 less than the table says, broken beyond LBREAK 0.08.
#[test]
fn single_teeth_have_a_length_each() {
    let edges = Edges {
        count: 3,
        length_break: 0.08,
        radius_offset: 25.0,
        ..Edges::default()
    };
    let blocks = teeth(31, "1 Q5");
    let mut rig = mill_of([95.0, 10.0], edges, &["6560=-1", SLOWLY], three_teeth, &blocks);
    assert_eq!(angles_of_touches(&mut rig), [180, 300, 60]);
    assert_eq!(q(&rig, 5), 2.0);
    assert!(rig.bit("M2393"));
    close_to(q(&rig, 115), 94.96 - 95.0);
}

/// MP6560 = 19: M19 orients to the angle of cycle 13, which is that of the program again after it.
#[test]
fn the_plc_orients_for_teeth() {
    let edges = Edges {
        count: 3,
        ..Edges::default()
    };
    let mut rig = mill_of(
        [95.0, 10.0],
        edges,
        &["6560=19", SLOWLY],
        three_teeth,
        &teeth(32, "0"),
    );
    assert_eq!(angles_of_touches(&mut rig), [0, 120, 240]);
    close_to(written(&rig, R).unwrap(), 9.985);
}

/// Nobody orients the spindle (MP6560 = 0), or the tool has no teeth (CUT).
#[test]
fn teeth_that_cannot_be_measured() {
    for (count, parameter) in [(3, "6560=0"), (0, "6560=-1")] {
        let edges = Edges {
            count,
            ..Edges::default()
        };
        let mut rig = mill_of([95.0, 10.0], edges, &[parameter], three_teeth, &teeth(31, "0"));
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(60.0, "it is refused", |rig| !rig.messages().is_empty());
        assert!(
            rig.messages()[0].contains("PROBE SYSTEM NOT READY"),
            "{:?}",
            rig.messages()
        );
    }
}

/// With a tool whose data are exact (94.96 and 9.985 mm) TCH PROBE 30 finds the contact at 560, 40, 60 with 40 mm, where
/// the list says 560.3, 39.8, 60.1 and 40.2: its face, then four sides at 0° and 180°. The tool is then right as it is.
#[test]
fn the_contact_is_calibrated() {
    let blocks = "TCH PROBE 30.0 TT CALIBRATION\nTCH PROBE 30.1 HEIGHT: +100\n";
    let list = [
        "6580.0=560.3",
        "6580.1=39.8",
        "6580.2=60.1",
        "6531=40.2",
        "6560=-1",
        SLOWLY,
    ];
    let mut rig = mill_of([94.96, 9.985], Edges::default(), &list, |build| build, blocks);
    assert_eq!(angles_of_touches(&mut rig), [0, 0, 180, 0, 180, 0, 180, 0, 180]);
    assert_eq!(rig.messages(), [""; 0]);
    let calibration = rig.control.remember().tool_probe.unwrap();
    assert_eq!(calibration.list, [560.3, 39.8, 60.1, 40.2]);
    // A disc that is probed d mm beside its middle is met d² / (2 (20 + 9.985)) later; on two sides of two axes.
    let later = (0.3f64.powi(2) + 0.2f64.powi(2)) / (2.0 * (20.0 + 9.985));
    for (found, true_place) in calibration
        .found
        .into_iter()
        .zip([560.0, 40.0, 60.0, 40.0 - later])
    {
        close_to(found, true_place);
    }
    assert_eq!(written(&rig, L), None);
}

/// A tool that is refused while it turns backwards, and one that INTERNAL STOP leaves, come to a stop with the speed of
/// the program.
#[test]
fn a_measuring_that_is_broken_off_stops_the_spindle() {
    for (parameter, stops) in [("6580.2=80", false), ("6580.2=60", true)] {
        let mut rig = mill_with(Edges::default(), &[parameter], &cycle(31, "0"));
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(60.0, "it turns backwards", |rig| {
            rig.bit("M2486") && rig.control.snapshot().spindle.actual_rpm.abs() > 600.0
        });
        if stops {
            rig.event("key NC_STOP tap");
            rig.seconds(1.0);
            assert!(rig.bit("M2486"), "NC stop alone interrupts nothing");
            rig.command("stop");
        } else {
            rig.until(200.0, "it is refused", |rig| !rig.messages().is_empty());
        }
        rig.seconds(5.0);
        let spindle = rig.control.snapshot().spindle;
        assert!(spindle.actual_rpm.abs() < 1.0, "{parameter}: {spindle:?}");
        assert_eq!(spindle.programmed_rpm, 800.0);
        assert!(!rig.bit("M2486") && rig.bit("M2487") && !rig.bit("M2390"));
    }
}

/// Tool axis Y: the length in -Y, the radius in the angle reference axis of its plane, Z.
#[test]
fn a_tool_in_y() {
    let blocks = format!("TOOL CALL 2 Y S800\n{}{}", cycle(31, "0"), cycle(32, "0")).replace("+100", "+250");
    let plant = |build: Build| build.plant("centre = [560, 40, 60]", "centre = [560, 40, 60]\naxis = \"Y\"");
    let mut rig = mill_of([95.0, 10.0], Edges::default(), &[], plant, &blocks);
    rig.run("1.H", 300.0);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), [""; 0]);
    close_to(written(&rig, L).unwrap(), 95.0 + DIFFERENCES[0]);
    close_to(written(&rig, R).unwrap(), 10.0 + DIFFERENCES[1]);
}

/// Without a magazine the tool probe knows the tool that was put into the spindle by hand.
#[test]
fn a_tool_that_was_changed_by_hand() {
    let tool = Tool {
        shape: ToolShape {
            length: 95.0,
            radius: 10.0,
            ..ToolShape::default()
        },
        ..Tool::default()
    };
    let blocks = format!("TOOL CALL 2 Z S800\n{}", cycle(31, "0"));
    let build = Build::mill().mp("4310.0=1").mp("7300=4");
    let mut build = build.program("1.H", &blocks);
    build.tools = Some([(2, tool)].into());
    let mut rig = build.rig();
    rig.power_on();
    rig.machine.tool_is_called(2);
    rig.run("1.H", 200.0);
    close_to(q(&rig, 115), DIFFERENCES[0]);
}
