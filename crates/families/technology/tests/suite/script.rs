//! What the script does beside acknowledging, several programs, and how runs end.

use crate::common::{A, Asked, Bench, RAPID, T, at, ramp_s, when, x};
use bahn_path::Axis;
use bahn_technology::{ChannelList, EventKind, Report, Script};

const LINE: &str = "%T\nN10 G01 X100 F6000\nN20 M7\nM30\n";
/// F6000, mm/s.
const V: f64 = 100.0;

#[test]
fn a_hold_brakes_and_lets_go() {
    let report = Bench::new(LINE, "m_synch[7] MOS").script("hold 0.5..0.9").run();
    let stops = report.of(EventKind::Stop);
    assert_eq!(stops.len(), 1);
    // 0.5 s at 100 mm/s less half the ramp, and the braking distance.
    at(x(stops[0]), V * 0.5 - V * V / (2.0 * A) + V * V / (2.0 * A));
    when(stops[0].t, 0.5 + V / A);
    when(report.of(EventKind::Go)[1].t, 0.9);
    // It stands at X50.
    when(report.time_s, 0.9 + ramp_s(50.0, V));
    assert!(report.waits.is_empty());
}

/// Acknowledgements during a hold are kept.
#[test]
fn a_hold_at_a_gate() {
    let program = "%T\nN10 G01 X50 F6000\nN20 X100 M7\nM30\n";
    let report = Bench::new(program, "m_synch[7] MVS_SVS")
        .script("M7 ack 0.2\nhold 0.5..2")
        .run();
    let output = report.output("M7").t;
    when(report.wait("M7").1, output + 0.2);
    when(report.of(EventKind::Go)[1].t, 2.0);
    assert_eq!(report.of(EventKind::Stop).len(), 1);
}

#[test]
fn an_override_slows_down() {
    let report = Bench::new(LINE, "m_synch[7] MOS")
        .script("override 50 at 0.5\noverride 100 at 0.9")
        .run();
    let lost = 0.4 * V * 0.5;
    when(report.time_s, ramp_s(100.0, V) + lost / V);
    let never = Bench::new(LINE, "m_synch[7] MOS")
        .script("override 0 at 0.5")
        .run();
    assert!(!never.completed && never.error.is_none() && never.waits.is_empty());
}

#[test]
fn a_reset_ends_a_program_and_the_next_one_runs() {
    let second = "%T2\nN10 G01 X100 F6000\nM30\n";
    let list = "m_synch[7] MVS_SLM\nm_synch[8] MOS";
    let first = "%T1\nN10 M7 G00 X10\nN20 G00 X500\nN30 M8\nM30\n";
    let report = Bench::new(first, list)
        .and(second)
        .script("M7 ack never\nreset 1.0\n")
        .run();
    assert!(!report.completed && report.error.is_none());
    assert_eq!(
        report
            .programs
            .iter()
            .map(|program| program.completed)
            .collect::<Vec<_>>(),
        [false, true]
    );
    when(report.programs[0].time_s, 1.0 + RAPID / A);
    // M7 is dropped: the feed of the second program does not wait for it.
    assert!(report.waits.is_empty());
    assert!(report.outputs("M8").is_empty());
    at(report.path_end.0[Axis::X], 100.0);
    let lists = report.of(EventKind::Active);
    assert_eq!(lists.len(), 2);
}

#[test]
fn the_next_program_begins_where_the_last_one_ended() {
    let first = "%T1\nV.G.M_FCT[7].SYNCH = 2\nN10 G91 G01 X10 F6000\nN20 M7\nM30\n";
    let second = "%T2\nN10 X5 M7\nM30\n";
    let report = Bench::new(first, "m_synch[7] MOS")
        .and(second)
        .script("M7 ack 0.1")
        .run();
    assert!(report.completed, "{:?}", report.error);
    // The type that the first one wrote is gone, and so is G91.
    assert_eq!(report.waits.len(), 1);
    at(report.path_end.0[Axis::X], 5.0);
    assert_eq!(report.programs[0].program, "p1.nc");
}

#[test]
fn after_an_error_the_following_programs_are_not_run() {
    let report = Bench::new("%T1\nN10 M99\nM30\n", "m_synch[7] MOS")
        .and("%T2\nN10 M7\nM30\n")
        .run();
    assert!(report.error.is_some());
    assert_eq!(report.programs.len(), 1);
    assert!(report.events.is_empty());
}

#[test]
fn a_run_from_a_block_outputs_nothing_before_it() {
    let program = "%T\nN10 G01 F6000 X10 M7\nN20 X20 M8\nN30 X30 M7\nM30\n";
    let report = Bench::new(program, "m_synch[7] MOS\nm_synch[8] MOS")
        .from("N30")
        .run();
    assert_eq!(report.order(), ["channel:M7"]);
    at(x(report.output("M7")), 20.0);
    when(report.time_s, ramp_s(10.0, V));
    let missing = Bench::new(program, "").from("N31").run();
    assert!(missing.error.is_some());
}

#[test]
fn what_never_comes_ends_the_run() {
    let program = "%T\nN10 G01 F6000 X10\nN20 X20 M8\nN30 X30\nM30\n";
    let report = Bench::new(program, "m_synch[8] MVS_SNS")
        .script("M8 ack never")
        .run();
    assert!(!report.completed && report.error.is_none());
    assert_eq!(report.waits.len(), 1);
    assert_eq!(
        (report.waits[0].function.as_str(), report.waits[0].to_s),
        ("M8", None)
    );
    at(report.waits[0].position.0[Axis::X], 20.0);
    assert_eq!(report.of(EventKind::Stop).len(), 1);
    when(report.time_s, ramp_s(20.0, V) + 2.0 * T);
}

/// FAW_SYNCH can be set in addition to a type [004:54], so it stands without one, too: output, and decoding holds.
#[test]
fn faw_synch_alone_is_output_and_holds_decoding() {
    let program = "%T\nN10 G01 X10 F2000\nN20 X20 M8\nN30 X30\nM30\n";
    let alone = Bench::new(program, "m_synch[8] FAW_SYNCH").run();
    let with_mos = Bench::new(program, "m_synch[8] MOS | FAW_SYNCH").run();
    assert_eq!(alone.of(EventKind::Output).len(), 1);
    assert_eq!(alone.events, with_mos.events);
    let stop = alone.of(EventKind::Stop);
    at(x(stop[0]), 20.0);
    let of_h = Bench::new(&program.replace("M8", "H8"), "h_synch[8] FAW_SYNCH").run();
    assert_eq!(of_h.of(EventKind::Stop).len(), 1);
    let speed = program.replace("M8", "S500");
    let list = "spindel[0].bezeichnung S1\nspindel[0].s_synch FAW_SYNCH\n";
    let report = Bench::new(&speed, list).run();
    assert_eq!(report.of(EventKind::Output).len(), 1);
    at(x(report.of(EventKind::Stop)[0]), 20.0);
}

/// BWD_SYNCH and FWD_SYNCH say when a type counts [004:54] [004:207]: without one they are refused where they stand.
#[test]
fn bits_of_backward_motion_need_a_type() {
    for bit in ["BWD_SYNCH", "FWD_SYNCH", "0x00400000", "BWD_SYNCH | FWD_SYNCH"] {
        let list = ChannelList::from_bytes(format!("m_synch[7] MOS\nm_synch[8] {bit}\n").as_bytes());
        let errors = list.errors();
        assert_eq!(errors.len(), 1, "{bit}: {errors:?}");
        assert_eq!((errors[0].span.line, errors[0].span.column), (2, 12));
        assert!(
            errors[0].message.contains("needs a type"),
            "{}",
            errors[0].message
        );
    }
    let program = "%T\nN10 V.G.M_FCT[8].SYNCH = 4194304\nN20 M8\nM30\n";
    let report = Bench::new(program, "m_synch[8] MOS").run();
    let error = report.error.unwrap();
    assert_eq!(error.block, "N10");
    assert!(error.message.contains("needs a type"), "{}", error.message);
}

/// Flush and wait: the block after is decoded when the path stands, so that there is no corner to pass.
#[test]
fn faw_synch_holds_decoding() {
    let program = "%T\nN10 G01 F6000 X10\nN20 X20 M8\nN30 X30\nM30\n";
    let plain = Bench::new(program, "m_synch[8] MOS").run();
    let flushed = Bench::new(program, "m_synch[8] MOS | FAW_SYNCH").run();
    when(plain.time_s, ramp_s(30.0, V));
    // Twice to a standstill, each to a cycle.
    when(flushed.time_s - T, ramp_s(20.0, V) + ramp_s(10.0, V));
    let stops =
        |report: &Report| -> Vec<f64> { report.of(EventKind::Stop).iter().map(|event| x(event)).collect() };
    assert_eq!((stops(&plain), stops(&flushed)), (vec![], vec![20.0]));
    let compensated = program.replace("N10 G01", "N10 G41 G01");
    let refused = Bench::new(&compensated, "m_synch[8] MOS | FAW_SYNCH").run();
    assert!(refused.error.is_some());
}

/// In simulated motion only what has FWD_SYNCH is waited for.
#[test]
fn simulated_motion() {
    let program = "%T\nN10 G01 F6000 X10\nN20 X20 M8\nN30 X30 M9\nN40 X40\nM30\n";
    let list = "m_synch[8] MVS_SVS\nm_synch[9] MVS_SVS | FWD_SYNCH\n";
    let report = Bench::new(program, list)
        .script("default ack 0.5\nsimulated 0..9")
        .run();
    assert_eq!(report.order(), ["channel:M8", "channel:M9"]);
    assert_eq!(report.waits.len(), 1);
    at(report.wait("M9").2, 20.0);
    assert_eq!(report.of(EventKind::Acknowledge).len(), 1);
    when(report.wait("M9").1, report.output("M9").t + 0.5);
    when(report.time_s, report.wait("M9").1 + ramp_s(20.0, V));
}

/// Back along what was executed, and forward again: functions are output as MOS in backward motion, with BWD_SYNCH they are
/// waited for; forward they have their own types again.
#[test]
fn backward_motion() {
    let program = "%T\nN10 G01 F6000 X20\nN20 X40 M8\nN30 X60 M9\nN40 X80\nM30\n";
    let list = "m_synch[8] MVS_SVS\nm_synch[9] MOS | BWD_SYNCH\n";
    // Forward to X70 or so, back to X0, forward again.
    let script = "default ack 0.1\nbackward 0.9..3.0\n";
    let report = Bench::new(program, list).script(script).run();
    assert!(report.completed, "{:?}", report.error);
    assert_eq!(
        report.order(),
        ["M8", "M9", "M9", "M8", "M8", "M9"].map(|function| format!("channel:{function}"))
    );
    let places: Vec<_> = report
        .of(EventKind::Output)
        .iter()
        .map(|event| x(event))
        .collect();
    for (place, expected) in places.iter().zip([20.0, 40.0, 40.0, 20.0, 20.0, 40.0]) {
        at(*place, expected);
    }
    // M8 forward twice, M9 backward once.
    let mut waits: Vec<_> = report.waits.iter().map(|wait| wait.function.as_str()).collect();
    waits.sort_unstable();
    assert_eq!(waits, ["M8", "M8", "M9"]);
    at(report.path_end.0[Axis::X], 80.0);
    // It stands where it turns back: at 0.9 s it begins to brake from X70 or so.
    let turn = report
        .of(EventKind::Stop)
        .into_iter()
        .find(|event| event.t >= 0.9);
    assert!(
        turn.is_some_and(|event| event.t < 0.9 + V / A + 2.0 * T && x(event) > 40.0),
        "{turn:?}"
    );
    // At the start the path stands until it goes forward again.
    let goes = report.of(EventKind::Go);
    at(x(goes[goes.len() - 2]), 0.0);
}

/// Without a motion there is nothing to go back: the function is waited for as if nothing had been.
#[test]
fn there_is_no_way_back_before_the_first_motion() {
    let report = Bench::new("%T\nN10 M7\nN20 G01 X10 F6000\nM30\n", "m_synch[7] MVS_SVS")
        .script("M7 ack 0.5\nbackward 0..0.2\n")
        .run();
    assert!(report.completed, "{:?}", report.waits);
    at(report.path_end.0[Axis::X], 10.0);
}

/// What a script of a machine says at a time a script of a channel says with the same words: each pair of texts is one run.
#[test]
fn what_happens_at_a_time_has_the_words_of_every_script() {
    let program = "%T\nN10 G01 X50 F6000\nN20 X100 M7\nN30 X150\nM30\n";
    let run = |script: &str| Bench::new(program, "m_synch[7] MVS_SVS").script(script).run();
    for (own, of_all) in [
        // The potentiometer.
        (
            "override 50 at 0.5\noverride 100 at 0.9",
            "0.5: override feed 50\n+0.4: override feed 100",
        ),
        // NC stop and NC start.
        (
            "hold 0.5..0.9",
            "0.5: key NC_STOP tap     ; stands from here\n0.9: key NC_START press\n+0.2: key NC_START release",
        ),
        // The words of the channel take times in front, too.
        ("hold 0.5..0.9", "start+0.5..+0.4: hold"),
        ("backward 0.6..0.8", "0.6..0.8: backward"),
        ("simulated 0.1..9", "0.1..9: simulated"),
        // A cycle takes 3 ms: cycle 101 begins after 100 of them.
        ("hold 0.3..0.6", "cycle 101..200 cycles: hold"),
        // Operating modes, and the starts in single block.
        (
            "single 0..3\nstart 1\nstart 2",
            "0: mode single\n1: key NC_START tap\n2: key NC_START tap\n3: mode full",
        ),
        ("reset 0.4", "0.4: reset"),
        // An internal stop ends the run that was interrupted.
        ("hold 0.3..0.7\nreset 0.7", "0.3: key NC_STOP tap\n0.7: stop"),
        // Replies are ruled; times in cycles are times of all scripts.
        (
            "M7 ack 0.06\nhold 0.3..0.6",
            "0.3..0.6: hold\nM7 ack 20 cycles # 60 ms",
        ),
    ] {
        let (own, of_all) = (run(own), run(of_all));
        let text = |report: &Report| serde_json::to_string(report).unwrap();
        assert_eq!(text(&own), text(&of_all));
    }
    // The run ends, whatever is still to come: incomplete, and no error.
    let ended = run("0.3: end\n");
    assert!(!ended.completed && ended.error.is_none());
    when(ended.time_s, 0.3);
    let all = run("");
    assert!(all.completed && all.time_s > 1.0);
}

/// What a channel alone does not have is refused at its place, with what is meant.
#[test]
fn what_a_channel_does_not_have_is_refused() {
    for (text, line, column, said) in [
        ("1: key DOOR tap", 1, 8, "`NC_STOP` or `NC_START`"),
        ("1: override spindle 50", 1, 13, "`feed`"),
        ("1: override feed 151", 1, 18, "150"),
        ("1: mode manual", 1, 9, "`single` or `full`"),
        ("1: expect tool=3", 1, 4, "machine"),
        ("when run ended: end", 1, 6, "times only"),
        ("after message A: end", 1, 1, "times only"),
        ("\n1: M25 ack 1", 2, 4, "without a time"),
        ("1..2: reset", 1, 7, "no span of time"),
        ("2..1: hold", 1, 1, "before it begins"),
        ("1: stop", 1, 0, "interrupted"),
        ("x: hold", 1, 1, "no time"),
        ("1: hodl", 1, 4, "no verb"),
    ] {
        let (_, errors) = Script::from_text(text);
        let [error] = errors.as_slice() else {
            panic!("{text}: {errors:?}");
        };
        let place = (error.span.line, error.span.column);
        assert_eq!(place, (line, column), "{text}: {error}");
        assert!(error.message.contains(said), "{text}: {error}");
    }
    let (_, errors) = Script::from_text("1: hodl");
    assert_eq!(errors[0].help.as_deref(), Some("did you mean `hold`?"));
}

#[test]
fn scripts_say_what_is_wrong() {
    let (_, errors) = Script::from_text("M25 akc 1\nM26 ack 1\nhold 1\novreride 50 at 1\n");
    let reported = errors
        .iter()
        .map(|error| (error.span.line, error.span.column, error.span.length));
    assert_eq!(reported.collect::<Vec<_>>(), [(1, 5, 3), (3, 6, 1), (4, 1, 8)]);
    let help: Vec<_> = errors.iter().filter_map(|error| error.help.as_deref()).collect();
    assert_eq!(help, ["did you mean `ack`?", "did you mean `override`?"]);
    for (text, line, column) in [
        ("M25 ack -1", 1, 9),
        ("\nM25 what", 2, 5),
        ("hold 2..1", 1, 6),
        ("T5 ack 0", 1, 1),
        ("probe 45", 1, 7),
        ("override 50 1.0", 1, 13),
        ("spindle S1 ready", 1, 17),
        ("reset 1 2", 1, 9),
        ("X[M7 ack 0", 1, 1),
    ] {
        let error = text.parse::<Script>().unwrap_err();
        assert_eq!(
            (error.span.line, error.span.column),
            (line, column),
            "{text}: {error}"
        );
    }
    assert!(
        "# nothing\n\nX[M7] ack 1 # said\nM26 at 3.0\ndefault ack never\n"
            .parse::<Script>()
            .is_ok()
    );
}

/// What the channel does not have is not answered either: a script that names it is mistaken.
#[test]
fn functions_and_spindles_of_a_script_are_those_of_the_channel() {
    let list = "m_synch[25] MOS\nm_synch[26] MVS_SVS\nh_synch[5] MOS\nspindel[0].bezeichnung S1\n";
    let settings = crate::common::settings(list);
    let unknown = |text: &str| -> Vec<(u32, u32, String, Option<String>)> {
        let (script, errors) = Script::from_text(text);
        assert_eq!(errors, []);
        let unknown = script
            .unknown(&settings, |function| function == "M77")
            .into_iter();
        unknown
            .map(|error| (error.span.line, error.span.column, error.message, error.help))
            .collect()
    };
    let fine = "M25 ack 1\nX[M26] ack 1\nH5 ack never\nM3 ack 1\nS[M3] ack 1\nS1[M5] ack 0\nM30 ack 1\nS ack 1\n\
                channel[M25] ack 1\nM77 ack 1\nspindle S1 ready 1\nspindle S ready 1\n";
    assert_eq!(unknown(fine), []);
    let found = unknown("M25 ack 1\n  M52 ack 1\nS2[M3] ack 1\nspindle S3 ready 1\nH9 ack 0\nQ[M25] ack 0\n");
    let places: Vec<_> = found.iter().map(|(line, column, ..)| (*line, *column)).collect();
    assert_eq!(places, [(2, 3), (3, 1), (4, 9), (5, 1), (6, 1)]);
    assert!(
        found[0].2.contains("M52 has no synchronisation type"),
        "{found:?}"
    );
    assert_eq!(found[0].3.as_deref(), Some("did you mean `M25`?"));
    assert_eq!(found[2].3.as_deref(), Some("did you mean `S1`?"));
}

/// What takes longer than it may ends at the block where it is.
#[test]
fn a_run_has_its_bounds() {
    let program = "%T\nN10 G01 X1 F1\nN20 X100\nM30\n";
    let mut bench = Bench::new(program, "");
    bench.bounds.time_s = 120.0;
    let report = bench.run();
    let error = report.error.unwrap();
    assert_eq!(
        (&*error.code, &*error.block, &*error.program),
        ("endless", "N20", "p1.nc")
    );
    assert!(error.message.contains("120 s"), "{}", error.message);
    assert!((report.time_s - 120.0).abs() <= 2.0 * T, "{}", report.time_s);
    let mut bench = Bench::new(program, "");
    bench.bounds.blocks = 2;
    assert_eq!(bench.run().error.unwrap().code, "endless");
    bench.bounds.blocks = 3;
    assert!(bench.run().completed);
}
