//! Between NC and PLC: read-in inhibit, queues, the free analogue output, modules of status and spindle, tool
//! changes that are broken off.

use crate::stand::*;
use crate::support::*;
use bahn_tnc::Signal;

/// M2614 = I20: after the block whose strobe is acknowledged nothing is executed until it falls, whether the
/// function comes at the begin or at the end of its block [000:10835].
#[test]
fn read_in_inhibit() {
    let plc = format!("{ACKNOWLEDGE}       L     I20\n       = M2614\n");
    for (program, stands_at) in [
        ("M8\nL X+60 R0 F6000\nL X+70", 50.0),
        ("L X+60 R0 F6000 M9\nL X+70", 60.0),
        ("L X+60 R0 F6000 M3\nL X+70", 60.0),
        ("L X+60 R0 F6000\nTOOL CALL 1 Z S500\nL X+70", 60.0),
    ] {
        let mut rig = bench_with(&plc, program);
        rig.event("key A press");
        rig.start();
        rig.seconds(3.0);
        near(display(&rig, 'X'), stands_at);
        assert!(!rig.control.snapshot().ended, "{program}");
        assert_eq!(rig.control.snapshot().run, bahn_tnc::RunState::Running);
        rig.event("key A release");
        rig.until(3.0, "it goes on", |rig| rig.control.snapshot().ended);
        near(display(&rig, 'X'), 70.0);
    }
    // Without a strobe M2614 holds nothing.
    let mut rig = bench_with(&plc, "L X+60 R0 F6000\nL X+70");
    rig.event("key A press");
    rig.start();
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
}

/// M functions at which the axes do not stop (MP7440 bit 2) come faster than the PLC takes them, which waits
/// 200 ms each: the path is held, and every one of them arrives, in its order.
#[test]
fn a_slow_plc_holds_the_path() {
    // T0 runs 10 cycles of 20 ms.
    let plc = "
       L     M2045
       AN    M2482
       = T0
       L     M2045
       A     T48
       O     M2482
       A     M2045
       = M2482
";
    let count: i32 = 60;
    let blocks: String = (0..count)
        .map(|number| format!("L IX+0.5 R0 F6000 M{}\n", 40 + number % 40))
        .collect();
    let mut rig = ready(
        bench(plc)
            .mp("7440=%00111")
            .mp("4110.0=10")
            .program("1.H", &format!("{blocks}L X+100")),
    );
    rig.start();
    let mut seen = Vec::new();
    let mut strobe = false;
    let mut farthest = 0;
    let end = rig.control.time_us() + 60_000_000;
    while rig.control.time_us() < end && !rig.control.snapshot().ended {
        rig.cycle();
        if rig.bit("M2045") && !strobe {
            seen.push(rig.number("W260"));
        }
        strobe = rig.bit("M2045");
        let block = rig.control.snapshot().block.map_or(0, |block| block.block) as i32;
        farthest = farthest.max(block - seen.len() as i32);
    }
    let expected: Vec<i32> = (0..count).map(|number| 40 + number % 40).collect();
    assert_eq!(seen, expected);
    // 16 may wait; braking from 100 mm/s at 1 m/s² takes 5 mm, 10 blocks; one is on its way.
    assert!((10..=16 + 10 + 2).contains(&farthest), "{farthest} ahead");
    assert!(rig.control.snapshot().ended);
}

/// Voltage of output S.
fn volts(rig: &Rig) -> f64 {
    rig.machine.spindle().unwrap().volts
}

/// MP3011 = 1: output S gives a voltage in proportion to the contour feed, 10 V at MP3012 [000:9835-9839].
#[test]
fn analogue_output_by_feed() {
    let mut rig = ready(
        bench(ACKNOWLEDGE)
            .mp("3010=0")
            .mp("3011=1")
            .mp("3012=8000")
            .program("1.H", "L X+150 R0 F6000"),
    );
    assert_eq!(volts(&rig), 0.0);
    rig.start();
    rig.until(2.0, "the feed", |rig| {
        (rig.control.snapshot().feed_mm_min - 6000.0).abs() < 1e-6
    });
    rig.cycle();
    assert!((volts(&rig) - 7.5).abs() < 1e-9, "{}", volts(&rig));
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    rig.cycle();
    assert_eq!(volts(&rig), 0.0);
}

/// Module 9130: the PLC gives output S a voltage in mV, limited to 10 V; the machine gets it, and it can be recorded. There is no
/// other output that it may set [000:16037-16061].
#[test]
fn a_voltage_of_the_plc_at_output_s() {
    let plc = format!(
        "{ACKNOWLEDGE}\n       PS    W902\n       PS    W900\n       CM    9130\n       L     M3171\n       = M950\n"
    );
    let mut rig = ready(bench(&plc).mp("3010=2").mp("3011=2"));
    let output: Signal = "output.S".parse().unwrap();
    for (millivolts, wanted) in [(-2500, -2.5), (12_000, 10.0), (-12_000, -10.0), (0, 0.0)] {
        rig.command(&format!("W900={millivolts}"));
        rig.seconds(0.1);
        assert!((volts(&rig) - wanted).abs() < 1e-9, "{wanted}: {}", volts(&rig));
        assert!((rig.control.observe(&output) - wanted).abs() < 1e-9);
        assert!(!rig.bit("M950"));
    }
    rig.command("W902=1");
    rig.command("W900=5000");
    rig.seconds(0.1);
    assert!(rig.bit("M950") && volts(&rig) == 0.0, "output 1 is not the PLC's");
}

/// Several changes of one item by module 9036 in one scan: the last one holds. All factors, then X, then X
/// again; handwheel axis Y, then Z.
#[test]
fn the_last_change_of_status_holds() {
    let change = |item: u8, value: u8| {
        format!("       PS    K+{item}\n       PS    K+{value}\n       CM    9036\n       PL    B200\n")
    };
    let changes = [(5, 4), (0, 2), (0, 7), (6, 1), (6, 2)].map(|(item, value)| change(item, value));
    let plc = format!(
        "       L     I20\n       AN    M0\n       CMT   CHANGE\n       L     I20\n       = M0\n       EM\nLBL CHANGE\n{}",
        changes.concat()
    );
    let read = |item: u8, to: u16| format!("       PS    K+{item}\n       CM    9035\n       PL    W{to}\n");
    let reads = [(9, 100), (11, 102), (12, 104)]
        .map(|(item, to)| read(item, to))
        .concat();
    let plc = format!("{reads}{plc}");
    let mut rig = ready(
        bench(&plc)
            .mp("7641=1")
            .mp("7640=2")
            .program("1.H", "L X+60 R0 F6000"),
    );
    rig.event("key A press");
    rig.seconds(0.3);
    assert_eq!(rig.number("B200"), 0);
    assert_eq!(["W100", "W102", "W104"].map(|word| rig.number(word)), [2, 7, 4]);
}

/// Module 9035 on the running control: operating mode, program of the run and of TEST RUN, axis and subdivision of the
/// handwheel [000:14899-14933].
#[test]
fn the_plc_reads_the_status() {
    // Nothing lies over a mode, $MDI is a .H, the display is in mm, no plane is tilted: 0.
    let items = [1, 5, 6, 9, 10, 11, 13, 2, 3, 16, 17, 18];
    let read = |(place, item): (usize, u8)| {
        let to = 100 + 2 * place;
        format!("       PS    K+{item}\n       CM    9035\n       PL    W{to}\n")
    };
    let reads: String = (0..).zip(items).map(read).collect();
    let build = bench(&format!("{ACKNOWLEDGE}{reads}")).mp("7640=2");
    let build = build.program("1.H", "L X+60 R0 F6000").program("2.I", "");
    let mut rig = ready(build);
    let status = |rig: &mut Rig| {
        rig.seconds(0.1);
        (0..items.len())
            .map(|place| rig.number(&format!("W{}", 100 + 2 * place)))
            .collect::<Vec<i32>>()
    };
    rig.command("handwheel Z 7");
    rig.command("handwheel X 3");
    // Full sequence is 5; a .H is selected, none is tested; the handwheel moves X.
    assert_eq!(status(&mut rig), [5, 0, 1, 0, 1, 3, 7, 0, 0, 0, 0, 0]);
    rig.command("mode handwheel");
    rig.command("handwheel Z 6");
    assert_eq!(status(&mut rig), [2, 0, 1, 2, 4, 3, 6, 0, 0, 0, 0, 0]);
    rig.command("mode single");
    rig.command("test 1.H");
    rig.command("select 2.I");
    assert_eq!(status(&mut rig), [4, 1, 2, 2, 4, 3, 6, 0, 0, 0, 0, 0]);
    // A screen says what it shows: the machine parameters over the editing screen, a directory over the machine screen, a tool
    // table that is edited, inches.
    rig.command("screen 3 2 257 3 1");
    assert_eq!(status(&mut rig), [4, 3, 2, 2, 4, 3, 6, 3, 2, 0, 1, 0]);
}

/// A tool change that is broken off before the PLC has acknowledged it: the old tool is in the spindle, with
/// its length, and the same call is a change again.
#[test]
fn a_change_that_is_broken_off_did_not_happen() {
    let plc = "       L     M2046\n       A     I20\n       = M2483\n       L     M2043\n       = M2480\n";
    let mut rig = ready(
        bench(plc)
            .mp("7480.0=1")
            .program("1.H", "TOOL CALL 1 Z S0\nTOOL CALL 2 Z S0\nL X+60 R0 F6000"),
    );
    rig.event("key A press");
    rig.start();
    rig.until(2.0, "tool 1", |rig| rig.control.snapshot().tool == 1);
    rig.event("key A release");
    rig.until(2.0, "the call of tool 2", |rig| {
        rig.bit("M2046") && rig.number("W262") == 2
    });
    let kept = rig.control.remember();
    assert_eq!((kept.tool, kept.tool_length), (1, 70.0), "if power fails now");
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    rig.command("stop");
    rig.seconds(0.2);
    let kept = rig.control.remember();
    assert_eq!((kept.tool, kept.tool_length), (1, 70.0));
    assert!(!rig.bit("M2046"));
    rig.event("key A press");
    rig.start();
    rig.until(2.0, "the strobe again", |rig| {
        rig.bit("M2046") && rig.number("W262") == 2
    });
    rig.until(2.0, "tool 2", |rig| rig.control.snapshot().tool == 2);
    let kept = rig.control.remember();
    assert_eq!((kept.tool, kept.tool_length), (2, 95.0));
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 60.0);
}

/// The wire of the acknowledgement I3 breaks: the NC sees it as the PLC does, and stops.
#[test]
fn a_broken_wire_of_the_acknowledgement_stops_the_axes() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+150 R0 F1000");
    rig.start();
    rig.until(2.0, "it moves", |rig| rig.control.snapshot().feed_mm_min > 500.0);
    assert!(rig.machine.control_ready());
    rig.event("fault input I3 0");
    assert!(!rig.machine.control_ready());
    rig.seconds(0.5);
    assert!(!rig.bit("I3"));
    let messages = rig.messages();
    assert!(
        messages
            .iter()
            .any(|text| text.contains("EMERGENCY STOP") || text.contains("EXT")),
        "{messages:?}"
    );
    assert_eq!(rig.control.snapshot().feed_mm_min, 0.0);
    assert!(display(&rig, 'X') < 100.0);
}

/// What the submit job of [`tables_of_the_control`] asks and writes.
fn job_on_tables() -> String {
    // Pocket table: the line with tool 2; tool table: its length, then written 90 mm and the tool life 30 min.
    [
        call(&["K+2", "K+2", "K+0", "K+0"], 9092, &["W100", "W102"]),
        call(&["K+0", "K+2", "K+0"], 9093, &["D104", "W108"]),
        call(&["K+0", "K+2", "K+0", "K+900000"], 9094, &["W110"]),
        call(&["K+0", "K+2", "K+7", "K+30"], 9094, &["W112"]),
        call(&["K+1", "K+0", "K+0"], 9093, &["D116", "W114"]),
        // DL 0.5 mm, CUT 4, LTOL 0.1 mm, PLC; then the pocket: F, PLC of pocket 12; pocket 30 of MP7261 = 30.
        call(&["K+0", "K+2", "K+9"], 9093, &["D120", "W124"]),
        call(&["K+0", "K+2", "K+13"], 9093, &["D128", "W126"]),
        call(&["K+0", "K+2", "K+14"], 9093, &["D132", "W136"]),
        call(&["K+0", "K+2", "K+17"], 9093, &["D140", "W138"]),
        call(&["K+2", "K+12", "K+2"], 9093, &["D144", "W148"]),
        call(&["K+2", "K+12", "K+4"], 9093, &["D152", "W150"]),
        call(&["K+2", "K+31", "K+0"], 9093, &["D156", "W160"]),
    ]
    .concat()
}

/// Modules 9092 to 9094 on the running control: tool 2 lies in pocket 12 and is 94.5 + 0.5 mm long; written to 90 it
/// counts at once, is stored, and is there after power-off. A tool table that says something else since counts.
#[test]
fn tables_of_the_control() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       AN    M0\n       CMT   ASK\n       L     I20\n       = M0\n       EM\nLBL ASK\n       SUBM  JOB\n       = B90\n       EM\nLBL JOB\n{}",
        job_on_tables()
    );
    let with_pocket = |length: f64| {
        let mut tool = bahn_tnc::Tool::default();
        tool.shape.length = length;
        tool.shape.oversize.length = 0.5;
        tool.edges.count = 4;
        tool.edges.length_wear = 0.1;
        tool.plc = 0b1010_0001;
        (tool.pocket, tool.fixed) = (Some(12), true);
        tool
    };
    let build = |length, remembered| {
        let mut build = bench(&plc)
            .mp("7480.0=3")
            .mp("7261=30")
            // The data of the tool stay in force.
            .mp("7300=4")
            .program("1.H", "TOOL CALL 2 Z S0\nL X+60 R0 F6000");
        build.tools = Some([(2, with_pocket(length))].into());
        let pocket = bahn_tnc::Pocket {
            fixed: true,
            plc: 7,
            ..bahn_tnc::Pocket::default()
        };
        build.files.pockets.insert(12, pocket);
        build.remembered = remembered;
        build
    };
    let mut rig = ready(build(95.0, bahn_tnc::Remembered::default()));
    rig.control.keep_state(true);
    rig.start();
    while !rig.control.snapshot().ended {
        assert!(rig.control.time_us() < 30_000_000, "the tool is in");
        rig.control.stored();
        rig.seconds(0.1);
    }
    let z = display(&rig, 'Z');
    rig.event("key A press");
    rig.until(1.0, "what was written is to be stored", |rig| {
        rig.control.unsaved().is_some()
    });
    rig.seconds(0.2);
    assert_eq!(
        (rig.number("W100"), rig.number("W102")),
        (12, 0),
        "pocket of tool 2"
    );
    assert_eq!((rig.number("D104"), rig.number("W108")), (945_000, 0));
    assert_eq!((rig.number("W110"), rig.number("W112")), (0, 0));
    assert_eq!(rig.number("W114"), 3, "there is no datum table");
    for (word, value) in [
        ("D120", 5000),
        ("D128", 4),
        ("D132", 1000),
        ("D140", 0b1010_0001),
        ("D144", 1),
        ("D152", 7),
        ("W160", 4),
    ] {
        assert_eq!(rig.number(word), value, "{word}");
    }
    near(display(&rig, 'Z'), z + 4.5);
    let remembered = rig.control.remember();
    assert_eq!(remembered.tool_length, 90.5);
    // After power-off the PLC finds what it wrote, and the tool in the spindle is as long as it was.
    for (length, expected) in [(95.0, 900_000), (97.0, 965_000)] {
        let mut rig = ready(build(length, remembered.clone()));
        assert_eq!(rig.control.remember().tool_length, 90.5);
        rig.event("key A press");
        rig.seconds(0.2);
        assert_eq!(rig.number("D104"), expected);
    }
}

/// Module 9033 selects another list: the control is reset, whatever the axes do, and begins with that list; the job that
/// called goes on no more [000:14886-14893]. The same list once more is no reset.
#[test]
fn a_selected_list_resets_the_control() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       AN    M20\n       CMT   ASK\n       L     I20\n       = M20\n       EM\n\
         LBL ASK\n       SUBM  JOB\n       = B80\n       EM\n\
         LBL JOB\n       L     S\"OTHER.MP\"\n       = S1\n{}       L     B84\n       +     K+1\n       = B84\n",
        call(&["K+1"], 9033, &["B82"])
    );
    let mut other = bench("").setup().0.parameters;
    other.assign("4210.0=12.5").unwrap();
    let mut build = bench(&plc).program("1.H", "L X+400 R0 F1000");
    build.files.parameter_lists = [("OTHER.MP".to_owned(), Some(other))].into();
    let mut rig = ready(build);
    rig.start();
    rig.seconds(0.5);
    assert!(rig.control.snapshot().axes.iter().all(|axis| axis.closed));
    rig.control.stored();
    // In a program it works during a strobe only; so it is stopped first [000:14897].
    rig.event("key NC_STOP press");
    rig.seconds(0.5);
    rig.command("stop");
    rig.event("key A press");
    rig.until(0.5, "the reset", |rig| rig.control.starts() == 2);
    assert!(!rig.control.snapshot().axes.iter().any(|axis| axis.closed));
    assert_eq!(rig.control.take_restart().as_deref(), Some("OTHER.MP"));
    assert_eq!(rig.control.take_restart(), None);
    // It is kept at once; D768 shows MP4210.0 in 1/10000 mm.
    let kept = rig.control.unsaved().unwrap();
    assert_eq!(kept.parameter_list.as_deref(), Some("OTHER.MP"));
    assert_eq!(rig.number("B84"), 0, "no job goes on");
    rig.event("key NC_STOP release");
    rig.event("key A release");
    rig.seconds(0.2);
    assert_eq!(rig.number("D768"), 125_000);
    rig.event("key A press");
    rig.seconds(0.2);
    assert_eq!(
        (rig.control.starts(), rig.number("B82"), rig.number("B84")),
        (2, 0, 1)
    );
}

/// Module 9041 reads actual values from the datum that was set (0) and from the one that cycle 7 has shifted it to (6)
/// [000:14998-15006]: X+50 after a shift of 20 stands at 70.
#[test]
fn the_plc_reads_positions_in_the_shifted_datum() {
    let read = "
       PS    K+100
       PS    K+0
       CM    9041
       PS    K+200
       PS    K+6
       CM    9041
";
    let program = "L X+50 R0 F6000\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+20\nCYCL DEF 7.2 Y-5\nL X+40\nL X+50 M0\nL X+60";
    let mut rig = bench_with(&format!("{ACKNOWLEDGE}{read}"), program);
    let read = |rig: &Rig| {
        ["D100", "D104", "D200", "D204"].map(|word| (f64::from(rig.number(word)) / 10_000.0).round())
    };
    rig.seconds(0.1);
    let [x, y, ..] = read(&rig);
    assert_eq!(read(&rig), [x, y, x, y], "nothing is shifted");
    rig.start();
    rig.until(4.0, "M0", |rig| display(rig, 'X') > 69.99);
    rig.seconds(0.2);
    assert_eq!(read(&rig), [70.0, y, 50.0, y + 5.0]);
}

/// Until a help file is selected W270 is -1, from power-on on [000:7048].
#[test]
fn without_a_help_file_its_line_is_minus_1() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+60");
    rig.seconds(0.1);
    assert_eq!(rig.number("W270"), -1);
}
