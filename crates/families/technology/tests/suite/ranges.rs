//! Targets, values, spindles and lists of active functions: rows T7, T17 to T26 and T35 to T37 of the acceptance.

use crate::common::{Asked, Bench, RAPID, T, at, ramp_s, when, x};
use bahn_path::Axis;
use bahn_technology::{EventKind, Report, Value};

/// Outputs as `target:function=value`.
fn delivered(report: &Report) -> Vec<String> {
    assert!(report.completed, "{:?}", report.error);
    let text = |event: &&bahn_technology::Event| {
        let value = match &event.value {
            Value::None => String::new(),
            Value::Integer(value) => format!("={value}"),
            Value::Number(value) => format!("={value}"),
            Value::Numbers(_) => unreachable!("only lists"),
        };
        format!(
            "{}:{}{value}",
            event.target.as_deref().unwrap(),
            event.function.as_deref().unwrap()
        )
    };
    report.of(EventKind::Output).iter().map(text).collect()
}

#[test]
fn t07_mne_sns_after_the_measuring_event() {
    let program = "%T7\nN05 X0 Y0\nN10 G108\nN15 V.G.RW = 5\nN20 G01 X90 Y90 F2000\nN30 G01 X150 Y150 M33 F800\nN40 G107\n\
                   N50 G00 X200 Y200\nM30\n";
    let report = Bench::new(program, "m_synch[33] 0x20")
        .script("probe X120\nM33 ack 0.7")
        .run();
    assert!(report.completed, "{:?}", report.error);
    let place = 120.0 + 5.0 / 2.0f64.sqrt();
    let output = report.output("M33");
    at(x(output), place);
    at(output.position.0[Axis::Y], place);
    assert_eq!(output.block.as_deref(), Some("N30"));
    let (from, to, stands) = report.wait("M33");
    at(stands, place);
    when(from, output.t);
    when(to, output.t + 0.7);
    // The rest of the block is travelled.
    let stops = report.of(EventKind::Stop);
    assert_eq!(stops.len(), 1);
    at(report.path_end.0[Axis::X], 200.0);
    // Without an event it is an error after the block.
    let missing = Bench::new(program, "m_synch[33] 0x20").script("probe X190").run();
    let error = missing.error.unwrap();
    assert_eq!(
        (error.code.as_str(), error.block.as_str()),
        ("probe-missing", "N30")
    );
    at(missing.path_end.0[Axis::X], 150.0);
}

#[test]
fn t17_an_unknown_function_is_an_error() {
    let program = "%T17\nN10 G01 X10 F1000\nN20 X20 M99\nM30\n";
    let report = Bench::new(program, "").run();
    let error = report.error.clone().unwrap();
    assert!(!report.completed);
    assert_eq!(
        (error.code.as_str(), error.program.as_str(), error.block.as_str()),
        ("P-ERR-20157", "p1.nc", "N20")
    );
    // The blocks before it were executed.
    at(report.path_end.0[Axis::X], 10.0);
    let in_subroutine = Bench::new("%T\nN10 L sub.nc\nM30\n", "")
        .subroutine("sub.nc", "N07 G01 X1 F1000\nN08 M99\nM29\n")
        .run();
    let error = in_subroutine.error.unwrap();
    assert_eq!((error.program.as_str(), error.block.as_str()), ("sub.nc", "N8"));
}

#[test]
fn t18_one_number_to_several_targets() {
    let program = "%T18\nN10 M83 X[M83]\nN20 M83\nN30 X[M83]\nM30\n";
    let report = Bench::new(program, "m_synch[83] 0x1").run();
    assert_eq!(
        delivered(&report),
        ["channel:M83", "X:M83", "channel:M83", "X:M83"]
    );
    let blocks: Vec<_> = report.of(EventKind::Output);
    let blocks: Vec<_> = blocks.iter().map(|event| event.block.clone().unwrap()).collect();
    assert_eq!(blocks, ["N10", "N10", "N20", "N30"]);
}

const VALUES: &str = "m_synch[12] MOS\nm_default_outp_ax_name[12] Z\nm_synch[10] MOS\nm_default_outp_ax_name[10] S\n\
    m_synch[52] MOS\nm_synch[54] MOS\nm_synch[63] MOS\nm_synch[30] MOS\n\
    h_synch[3] MOS\nh_synch[4] MOS\nh_synch[5] MOS\nh_synch[7] MOS\nh_synch[8] MOS\nm_synch[151] MOS\nh_synch[181] MOS\n\
    h_synch[6] MOS\nh_default_outp_ax_name[6] Z\nh_synch[9] MOS\nh_default_outp_ax_name[9] S\n\
    spindel[0].bezeichnung S1\nspindel[0].m3_synch PLC_INFO | MOS\nspindel[0].m4_synch PLC_INFO | MOS\n\
    spindel[0].m5_synch PLC_INFO | MOS\n";

#[test]
fn t19_additive_values() {
    let program = "%T19\nN10 M52=-345\nN20 M12=123\nN30 M10=321\nN35 P1=567 P2=345\nN40 X[M54=P1]\n\
        N50 S[REV 1000 M03 M63=-789]\nN60 M12=123 M10=321 M52=-345 X[M54=567] S[REV 1000 M03 M63=-789]\n\
        N70 M63=-789 M52=-P2 M54=567\nN80 X[M52=-345 M54=567] Y[M63=-789] S[M05 M63=789 M54=-567] M54 M63\n\
        N110 H5=-345\nN120 H6=123\nN130 H9=321\nN135 P3=567 P4=-345\nN140 X[H7=P3]\nN150 S[REV 1500 M04 H8=-789]\n\
        N170 H8=-789 H5=P4 H7=567\nN180 X[H8=-789 H4 H5=-345] Y[H7=567] S[M05 H5=345 H7=567] H3 H8\n\
        N200 X[M52=-345 H4 H8=-789 M54=567 H5=345] H3=333 M54=444 H7=567 M63\n\
        N205 X[INDP G90 G01 FEED=2000 POS=55 M54=151 H8=-181]\nN210 M52='16#1F'\nN999 M30=111\n";
    let report = Bench::new(program, VALUES).run();
    let expected = "channel:M52=-345 Z:M12=123 S1:M10=321 X:M54=567 S1:M3 S1:M63=-789 \
        Z:M12=123 S1:M10=321 channel:M52=-345 X:M54=567 S1:M3 S1:M63=-789 \
        channel:M63=-789 channel:M52=-345 channel:M54=567 \
        X:M52=-345 X:M54=567 Y:M63=-789 S1:M5 S1:M63=789 S1:M54=-567 channel:M54 channel:M63 \
        channel:H5=-345 Z:H6=123 S1:H9=321 X:H7=567 S1:M4 S1:H8=-789 \
        channel:H8=-789 channel:H5=-345 channel:H7=567 \
        X:H8=-789 X:H4 X:H5=-345 Y:H7=567 S1:M5 S1:H5=345 S1:H7=567 channel:H3 channel:H8 \
        X:M52=-345 X:H4 X:H8=-789 X:M54=567 X:H5=345 channel:H3=333 channel:M54=444 channel:H7=567 channel:M63 \
        X:M54=151 X:H8=-181 channel:M52=31 channel:M30=111";
    let expected: Vec<_> = expected.split_whitespace().collect();
    assert_eq!(delivered(&report), expected);
    at(report.path_end.0[Axis::X], 55.0);
    let wrong = Bench::new("%T\nN10 M3=5\nM30\n", VALUES).run().error.unwrap();
    assert_eq!(wrong.code, "additive-value");
}

/// An axis that moves on its own does so at its feed; the path goes on from there.
#[test]
fn an_axis_on_its_own() {
    let program =
        "%T\nN10 G01 X10 F6000\nN20 X[INDP G90 G01 FEED=3000 POS=60 M54=1]\nN30 M54\nN40 X70\nM30\n";
    let report = Bench::new(program, "m_synch[54] MOS\n").run();
    assert_eq!(delivered(&report), ["X:M54=1", "channel:M54"]);
    let places: Vec<_> = report.outputs("M54").iter().map(|event| x(event)).collect();
    at(places[0], 10.0);
    at(places[1], 60.0);
    at(report.path_end.0[Axis::X], 70.0);
    let time = 2.0 * ramp_s(10.0, 100.0) + ramp_s(50.0, 50.0);
    assert!(
        (report.time_s - time).abs() <= 4.0 * T,
        "{} {time}",
        report.time_s
    );
}

#[test]
fn t20_the_range_by_default() {
    let list = "m_synch[25] MVS_SVS\nm_default_outp_ax_name[25] X\n";
    let report = Bench::new("%T\nN10 M25 G01 F1000 X100\nM30\n", list)
        .script("X[M25] ack 0.3")
        .run();
    assert_eq!(delivered(&report), ["X:M25"]);
    when(report.wait("M25").1, 0.3);
    when(report.of(EventKind::Go)[0].t, 0.3);
}

#[test]
fn t21_h3_of_the_spindle_takes_its_process_time() {
    let list =
        "spindel[0].bezeichnung S\nh_synch[3] 0x2\nh_default_outp_ax_name[3] S\nh_prozess_zeit[3] 1000000\n";
    let report = Bench::new("%T\nN10 G00 X10 H3\nM30\n", list).virtual_plc().run();
    assert_eq!(delivered(&report), ["S:H3"]);
    when(report.wait("H3").1, 1.0);
    when(report.time_s, 1.0 + ramp_s(10.0, RAPID));
}

#[test]
fn t22_m1_takes_its_process_time() {
    let list = "m_synch[1] 0x2\nm_prozess_zeit[1] 800000\n";
    let report = Bench::new("%T\nN10 M1 G00 X100\nM30\n", list).virtual_plc().run();
    assert_eq!(delivered(&report), ["channel:M1"]);
    when(report.time_s, 0.8 + ramp_s(100.0, RAPID));
    // A time that is shorter than the motion costs nothing.
    let hidden = Bench::new(
        "%T\nN10 M1 G00 X100\nN20 X200\nM30\n",
        "m_synch[1] MVS_SNS\nm_prozess_zeit[1] 100000\n",
    );
    when(hidden.virtual_plc().run().time_s, ramp_s(200.0, RAPID));
}

const SPINDLE: &str = "%T\nN10 M3 S1000 G01 F1000 X100\nM30\n";

#[test]
fn t23_a_spindle_of_the_nc_confirms_by_itself() {
    let list = "spindel[0].bezeichnung S1\nspindel[0].m3_synch 0x2\nspindel[0].m4_synch 0x4\n";
    let report = Bench::new(SPINDLE, list).script("spindle S1 ready 0.8").run();
    assert!(delivered(&report).is_empty());
    let (from, to, place) = report.wait("M3");
    assert_eq!((from, place), (0.0, 0.0));
    when(to, 0.8);
    when(report.of(EventKind::Go)[0].t, 0.8);
    // M4 is waited for after its block, the main spindle is called S as well, another one by its name.
    let m4 = SPINDLE.replace("M3", "M4").replace("M30", "N20 X110\nM30");
    let m4 = m4.replace("M40", "M30");
    let report = Bench::new(&m4, list).script("spindle S ready 9").run();
    at(report.wait("M4").2, 100.0);
    when(report.wait("M4").1, 9.0);
    let second = format!("{list}spindel[1].bezeichnung S2\nspindel[1].m3_synch 0x2\n");
    let program = "%T\nN10 S2[M3 REV1000] G01 F1000 X100\nM30\n";
    let report = Bench::new(program, &second).script("spindle S2 ready 0.4").run();
    when(report.wait("M3").1, 0.4);
}

/// The spindle executes M19 at once; after the motion the path stands in any case, however early it has confirmed [004:66].
#[test]
fn m19_mns_sns_stands_without_plc_info() {
    let program = "%T\nN10 G01 F1000 X10 M19\nN20 X20\nM30\n";
    let list = "spindel[0].bezeichnung S1\nspindel[0].m19_synch MNS_SNS\n";
    let v = 1000.0 / 60.0;
    for (ready, stands) in [(0.0, T), (5.0, 5.0 - ramp_s(10.0, v))] {
        let script = format!("spindle S1 ready {ready}");
        let report = Bench::new(program, list).script(&script).run();
        assert!(delivered(&report).is_empty());
        let stops = report.of(EventKind::Stop);
        assert_eq!(stops.len(), 1, "ready {ready}: {stops:?}");
        at(x(stops[0]), 10.0);
        when(stops[0].t, ramp_s(10.0, v));
        let go = report.of(EventKind::Go)[1].t;
        assert!((go - stops[0].t - stands).abs() <= 2.0 * T, "ready {ready}: {go}");
    }
    // Without a motion it is MVS_SVS, and waits only for the spindle.
    let alone = program.replace("X10 M19", "X10\nN15 M19");
    let report = Bench::new(&alone, list).script("spindle S1 ready 0.5").run();
    when(report.wait("M19").1, report.wait("M19").0 + 0.5);
}

/// On machines without spindles M3, M4, M5 and M19 are free with `spindle_m_fct_free 1` [004:159], and then need a type as any
/// other function [004:42].
#[test]
fn free_spindle_functions_need_a_type() {
    for number in [3, 4, 5, 19] {
        let program = format!("%T\nN10 G01 F1000 X10 M{number}\nM30\n");
        let free = "spindle_m_fct_free 1\n";
        let error = Bench::new(&program, free).run().error.unwrap();
        assert_eq!((&*error.code, &*error.block), ("P-ERR-20157", "N10"), "M{number}");
        let typed = Bench::new(&program, &format!("{free}m_synch[{number}] MOS\n")).run();
        assert_eq!(delivered(&typed), [format!("channel:M{number}")]);
        let said = Bench::new(&program, &format!("{free}m_synch[{number}] NO_SYNCH\n")).run();
        assert!(delivered(&said).is_empty());
        // Switched on by the program it is the same.
        let switched = program.replace("%T\n", "%T\nN5 V.SPDL.M_FCT_FREE = 1\n");
        let error = Bench::new(&switched, "").run().error.unwrap();
        assert_eq!(error.code, "P-ERR-20157", "M{number}");
    }
}

#[test]
fn t24_spindle_and_plc_both() {
    let list = "spindel[0].bezeichnung S1\nspindel[0].m3_synch 0x00020002\n";
    for (ready, ack) in [(0.8, 0.5), (0.3, 0.6)] {
        let script = format!("spindle S1 ready {ready}\nS[M3] ack {ack}\n");
        let report = Bench::new(SPINDLE, list).script(&script).run();
        assert_eq!(delivered(&report), ["S1:M3"]);
        when(report.wait("M3").1, f64::max(ready, ack));
        when(report.of(EventKind::Go)[0].t, f64::max(ready, ack));
    }
}

/// A spindle that the PLC drives, in its own range.
#[test]
fn a_plc_spindle_is_always_output() {
    let list = "spindel[0].bezeichnung S1\nspindel[0].achs_mode 0x00040000\nspindel[0].m3_synch 0x2\nspindel[0].s_synch MOS\n";
    let report = Bench::new(SPINDLE, list)
        .script("M3 ack 0.4\nspindle S1 ready never\n")
        .run();
    assert_eq!(delivered(&report), ["S1:M3", "S1:S=1000"]);
    when(report.wait("M3").1, 0.4);
}

#[test]
fn t25_a_plc_spindle_in_the_range_of_the_channel() {
    let list = "spindel[0].plc_control 1\nspindel[0].m4_synch 0x4\n";
    let report = Bench::new(SPINDLE, list).script("").run();
    assert_eq!(delivered(&report), ["channel:M3"]);
    assert!(report.waits.is_empty());
    let waits = format!("{list}spindel[0].m3_synch MVS_SVS\n");
    let report = Bench::new(SPINDLE, &waits).script("M3 ack 0.2").run();
    when(report.wait("M3").1, 0.2);
    let wrong = Bench::new("%T\nN10 S[M7]\nM30\n", &format!("{list}m_synch[7] MOS\n")).run();
    assert_eq!(wrong.error.unwrap().code, "P-ERR-21202");
}

#[test]
fn t26_gear_stages() {
    let list = "main_spindle_gear_change 1\nm_synch[40] MVS_SVS\nspindel[0].bezeichnung S1\n";
    let report = Bench::new("%T\nN10 M40 S1000\nN20 X[M40]\nM30\n", list)
        .script("M40 ack 0.2")
        .run();
    assert_eq!(delivered(&report), ["S1:M40", "X:M40"]);
    when(report.time_s, 0.4);
    let free = Bench::new("%T\nN10 M40\nM30\n", "m_synch[40] MOS\n").run();
    assert_eq!(delivered(&free), ["channel:M40"]);
    let none = Bench::new("%T\nN10 M3\nM30\n", "").run().error.unwrap();
    assert_eq!(none.code, "P-ERR-21548");
    let freed = "%T\nN05 V.SPDL.M_FCT_FREE = 1\nN10 M3 X10\nM30\n";
    assert_eq!(
        delivered(&Bench::new(freed, "m_synch[3] MVS_SVS\n").run()),
        ["channel:M3"]
    );
}

fn active(report: &Report, target: &str, letter: &str) -> Vec<Vec<u16>> {
    let events = report.of(EventKind::Active);
    let of = events
        .iter()
        .filter(|event| event.target.as_deref() == Some(target) && event.function.as_deref() == Some(letter));
    of.map(|event| match &event.value {
        Value::Numbers(numbers) => numbers.clone(),
        other => panic!("{other:?}"),
    })
    .collect()
}

#[test]
fn t35_active_functions_of_the_channel() {
    let list = "h_synch[41] MVS_SVS\nh_synch[42] MVS_SVS\nh_synch[51] MVS_SVS\n";
    let report = Bench::new("%T\nH41 H42 H51\nM30\n", list)
        .script("H41 ack 0.5\nH42 ack 0.2\nH51 ack 0.9\n")
        .run();
    let expected: [&[u16]; 4] = [&[41, 42, 51], &[41, 51], &[51], &[]];
    assert_eq!(active(&report, "channel", "H"), expected);
    when(report.time_s, 0.9);
}

#[test]
fn t36_active_functions_of_an_axis() {
    let report = Bench::new("%T\nX[H50]\nM30\n", "h_synch[50] MVS_SVS\n")
        .script("H50 ack 0.1")
        .run();
    let expected: [&[u16]; 2] = [&[50], &[]];
    assert_eq!(active(&report, "X", "H"), expected);
    assert!(active(&report, "channel", "H").is_empty());
}

#[test]
fn t37_what_is_not_fetched_blocks_the_next_output() {
    let program = "%T\nN10 G01 X10 F2000\nN20 X20 M7\nN30 X30\nN40 X40 M8\nN50 X50\nM30\n";
    let report = Bench::new(program, "m_synch[7] MOS\nm_synch[8] MOS\n")
        .script("M7 nofetch")
        .run();
    assert!(!report.completed && report.error.is_none());
    assert_eq!(report.order(), ["channel:M7"]);
    let (from, to, place) = report.wait("M7");
    at(place, 30.0);
    assert!(to.is_infinite() && from > 0.0);
    assert_eq!(report.waits[0].to_s, None);
    at(report.path_end.0[Axis::X], 30.0);
    // Another range is not blocked.
    let other = Bench::new(
        &program.replace("M8", "X[M8]"),
        "m_synch[7] MOS\nm_synch[8] MOS\n",
    );
    assert!(other.script("M7 nofetch").run().completed);
}

/// However near: what cannot be stopped any more is still not output.
#[test]
fn nothing_is_output_beside_what_is_not_fetched() {
    let program = "%T\nN10 G01 X10 F9000\nN20 X10.5 M7\nN30 X11 M8\nN40 X50\nM30\n";
    let report = Bench::new(program, "m_synch[7] MOS\nm_synch[8] MOS\n")
        .script("M7 nofetch")
        .run();
    assert!(!report.completed && report.error.is_none());
    assert_eq!(report.order(), ["channel:M7"]);
    assert!(T > 0.0 && report.waits.len() == 1);
}

#[test]
fn more_late_functions_than_a_range_takes() {
    let functions: String = (50..63).map(|m| format!("N{m} M{m}\n")).collect();
    let list: String = (50..63).map(|m| format!("m_synch[{m}] MVS_SLP\n")).collect();
    let report = Bench::new(&format!("%T\n{functions}M30\n"), &list)
        .script("default ack never")
        .run();
    assert_eq!(report.error.unwrap().code, "P-ERR-60146");
    let at_once: String = (50..63).map(|m| format!("M{m} ")).collect();
    let report = Bench::new(&format!("%T\nN10 {at_once}\nM30\n"), &list).run();
    assert_eq!(report.error.unwrap().code, "P-ERR-50388");
}

#[test]
fn twice_in_a_block() {
    let code = |block: &str| {
        let list = "m_synch[7] MOS\nh_synch[7] MOS\nspindel[0].m3_synch 2\n";
        let report = Bench::new(&format!("%T\n{block}\nM30\n"), list).run();
        report.error.map(|error| error.code)
    };
    assert_eq!(code("N10 M7 M7").as_deref(), Some("P-ERR-20765"));
    assert_eq!(code("N10 X[H7 H7]").as_deref(), Some("P-ERR-20766"));
    assert_eq!(code("N10 S[M3 M4]").as_deref(), Some("P-ERR-20155"));
    assert_eq!(code("N10 M1000").as_deref(), Some("P-ERR-20160"));
    assert_eq!(code("N10 M7 X[M7] H7"), None);
}
