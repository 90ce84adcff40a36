//! Micro Joints: rows T27 to T34 and T38 of the acceptance.

use crate::common::{A, Asked, Bench, at, x, y};
use bahn_technology::{Event, EventKind, Report};

/// The first two lines of every list here.
const ENABLED: &str = "configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n";

fn list(more: &str) -> String {
    format!("{ENABLED}{more}")
}

/// Functions with their places.
fn places(report: &Report) -> Vec<(String, f64, f64)> {
    let place = |event: &&Event| (event.function.clone().unwrap(), x(event), y(event));
    report.of(EventKind::Output).iter().map(place).collect()
}

fn assert_places(report: &Report, expected: &[(&str, f64, f64)]) {
    let places = places(report);
    assert_eq!(places.len(), expected.len(), "{places:?}");
    for ((function, x, y), (name, at_x, at_y)) in places.iter().zip(expected) {
        assert_eq!(function, name, "{places:?}");
        at(*x, *at_x);
        at(*y, *at_y);
    }
}

#[test]
fn t27_the_example_and_what_it_stands_for() {
    let joined = "%J\nN05 V.G.M_FCT[500].PRE_OUTP_PATH = 0.05\nN10 G00 G90 X0 Y0\nN15 L Laser_on.sub\nN20 G01 F5000\n\
                  N25 Y7\nN30 M500 M300\nN35 Y10\nN40 X14\nN45 M500 M300\nN50 X20\nN55 L Laser_off.sub\nN99 M30\n";
    let explicit = "%E\nN05 G00 G90 X0 Y0\nN10 L Laser_on.sub\nN15 G01 F5000\nN20 Y6.95\nN25 M500\nN30 Y7\nN35 M300\n\
                    N40 Y10\nN45 X13.95\nN50 M500\nN55 X14\nN60 M300\nN65 X20\nN70 L Laser_off.sub\nN99 M30\n";
    let list = list("m_synch[300] MOS\nm_synch[500] MOS\n");
    let run = |program: &str| {
        let bench = Bench::new(program, &list);
        let bench = bench.subroutine("Laser_on.sub", "M300\nM29\n");
        bench.subroutine("Laser_off.sub", "M500\nM29\n").run()
    };
    let expected = [
        ("M300", 0.0, 0.0),
        ("M500", 0.0, 6.95),
        ("M300", 0.0, 7.0),
        ("M500", 13.95, 10.0),
        ("M300", 14.0, 10.0),
        ("M500", 20.0, 10.0),
    ];
    let joined = run(joined);
    let explicit = run(explicit);
    assert!(joined.completed, "{:?}", joined.error);
    assert!(explicit.completed, "{:?}", explicit.error);
    assert_places(&explicit, &expected);
    // The last M500 has its lead too.
    let mut with_lead = expected;
    with_lead[5].1 = 19.95;
    assert_places(&joined, &with_lead);
    for (a, b) in joined
        .of(EventKind::Output)
        .iter()
        .zip(explicit.of(EventKind::Output))
        .take(5)
    {
        assert!((a.t - b.t).abs() < 1e-9, "{a:?} {b:?}");
    }
}

fn many(flush: bool) -> String {
    let mut program = "%microjoint4\nN01 G00 G90 X0 Y0\nN02 G01 F10000\nN03 V.G.M_FCT[100].PRE_OUTP_PATH = 28.6\nN20 G91 Y1\n".to_owned();
    for number in 21..=49 {
        program += &format!("N{number} Y1\n");
        if flush && number == 44 {
            program += "N400 #FLUSH\n";
        }
    }
    program + "N50 M100 M26\nN99 M30\n"
}

#[test]
fn t28_the_window_has_ten_blocks() {
    let functions = "m_synch[100] MOS\nm_synch[26] MOS\n";
    let report = Bench::new(&many(false), &list(functions)).run();
    assert_places(&report, &[("M100", 0.0, 20.0), ("M26", 0.0, 30.0)]);
    assert_eq!(report.warnings.len(), 1);
    let more = format!("{functions}configuration.path_preparation.m_pre_output_lookahead 30\n");
    let report = Bench::new(&many(false), &list(&more)).run();
    assert_places(&report, &[("M100", 0.0, 1.4), ("M26", 0.0, 30.0)]);
    assert!(report.warnings.is_empty());
}

#[test]
fn t29_nothing_is_output_ahead_across_a_flush() {
    let report = Bench::new(&many(true), &list("m_synch[100] MOS\nm_synch[26] MOS\n")).run();
    assert_places(&report, &[("M100", 0.0, 25.0), ("M26", 0.0, 30.0)]);
}

#[test]
fn t30_joints_do_not_overlap() {
    let program = "%microjoint5\nN01 G00 G90 X0 Y0\nN02 G01 F10000\nN03 V.G.M_FCT[101].PRE_OUTP_PATH = 5\n\
                   N04 V.G.M_FCT[102].PRE_OUTP_PATH = 23\nN05 V.G.M_FCT[103].PRE_OUTP_PATH = 31\nN20 X10\nN30 M101 M26\n\
                   N40 X30\nN50 M102 M26\nN60 X40\nN70 M103 M26\nN80 M30\n";
    let functions = "m_synch[101] MOS\nm_synch[102] MOS\nm_synch[103] MOS\nm_synch[26] MOS\n";
    let report = Bench::new(program, &list(functions)).run();
    let expected = [
        ("M101", 5.0, 0.0),
        ("M26", 10.0, 0.0),
        ("M102", 10.0, 0.0),
        ("M26", 30.0, 0.0),
        ("M103", 30.0, 0.0),
        ("M26", 40.0, 0.0),
    ];
    assert_places(&report, &expected);
}

#[test]
fn t31_not_between_output_and_wait_of_mvs_sns() {
    let program = "%M\nN01 G01 G90 X0 Y0 F1000\nN10 X10 M200\nN20 X30\nN30 X40 M100\nN40 X0 Y0\nN50 M30\n";
    let functions = "m_synch[100] MVS_SVS\nm_pre_outp[100] 210000\nm_synch[200] MVS_SNS\n";
    let report = Bench::new(program, &list(functions)).run();
    assert_places(&report, &[("M200", 0.0, 0.0), ("M100", 10.0, 0.0)]);
    at(report.wait("M100").2, 10.0);
}

/// Entry with 20 mm/min, 8 mm before the end; the rest with 5000 mm/min.
fn slow_entry(lead: u32, n40: &str) -> Report {
    let program = format!(
        "%microjoint16\nN01 G00 G90 X0 Y0\nN02 G01 F100\nN05 #CHANNEL SET [M_PRE_OUTPUT E=20 F=5000]\n\
         N10 V.G.M_FCT[100].PRE_OUTP_PATH = {lead}\nN20 G91 Y1\nN30 Y10\nN40 {n40}\nN50 M100 M26\nN99 M30\n"
    );
    Bench::new(&program, &list("m_synch[100] MOS\nm_synch[26] MOS\n")).run()
}

/// The greatest velocity of the samples of a stretch of the path, mm/min.
fn fastest(report: &Report, from: f64, to: f64) -> f64 {
    let within = report
        .samples
        .iter()
        .filter(|one| (from..=to).contains(&one.distance_mm));
    within.map(|one| one.v).fold(0.0, f64::max)
}

#[test]
fn t32_entry_and_feed_of_a_joint() {
    let report = slow_entry(8, "Y10");
    assert_places(&report, &[("M100", 0.0, 13.0), ("M26", 0.0, 21.0)]);
    let entry = report.output("M100");
    assert!((entry.v - 20.0).abs() < 1e-6, "{}", entry.v);
    assert!((fastest(&report, 0.0, 12.9) - 100.0).abs() < 1e-6);
    // 8 mm from nearly standstill to standstill reach sqrt(a · 8) mm/s at most, which is above F5000.
    assert!((A * 8.0).sqrt() > 5000.0 / 60.0);
    assert!((fastest(&report, 13.1, 21.0) - 5000.0).abs() < 1e-6);
}

#[test]
fn t33_the_feed_of_a_joint_replaces_that_of_its_blocks() {
    let report = slow_entry(15, "G91 Y10 F7500");
    assert_places(&report, &[("M100", 0.0, 6.0), ("M26", 0.0, 21.0)]);
    assert!((report.output("M100").v - 20.0).abs() < 1e-6);
    assert!((fastest(&report, 6.1, 21.0) - 5000.0).abs() < 1e-6);
}

fn limited(more: &str, blocks: u32) -> Report {
    let mut program = "%microjoint16\n\"MOS\"=\"1\"\nV.G.M_FCT[11].SYNCH = \"MOS\"\nV.G.M_FCT[11].PRE_OUTP_PATH = 125\n\
                       V.G.M_FCT[12].SYNCH = \"MOS\"\nV.G.M_FCT[12].PRE_OUTP_PATH = 325\n\
                       N300 #CHANNEL SET [M_PRE_OUTPUT E=250 F=1500]\nN01 X-222 G01 F1000\nN10 X10\nN20 X100\n\
                       N30 X200 M11\nN32 #VECTOR LIMIT ON[VEL=500]\n"
        .to_owned();
    program += &format!("N35 #CHANNEL SET [M_PRE_OUTPUT E=150 F=750 {more}]\nN40 X300\n");
    for number in 41..=49 {
        program += &format!("N{number} X{}\n", 310 + 10 * (number - 41));
    }
    program += "N50 X500\nN60 M12\nN70 X600\nN80 X700\nM30\n";
    let functions = format!("configuration.path_preparation.m_pre_output_lookahead {blocks}\n");
    let mut bench = Bench::new(&program, &list(&functions));
    bench.start = [-222.0, 0.0];
    bench.run()
}

#[test]
fn t34_joints_under_a_vector_limit() {
    for (more, after) in [("", 500.0), ("VECTOR_LIMIT_OFF", 750.0)] {
        for blocks in [12, 20] {
            let report = limited(more, blocks);
            assert!(report.completed, "{:?}", report.error);
            assert_places(&report, &[("M11", -25.0, 0.0), ("M12", 175.0, 0.0)]);
            assert!((report.output("M11").v - 250.0).abs() < 1e-6);
            assert!((report.output("M12").v - 150.0).abs() < 1e-6);
            // The path begins at X-222.
            let fastest = |from: f64, to: f64| fastest(&report, from + 222.0, to + 222.0);
            assert!((fastest(-220.0, -25.1) - 1000.0).abs() < 1e-6);
            assert!((fastest(-24.0, 99.0) - 1500.0).abs() < 1e-6);
            assert!((fastest(101.0, 174.0) - 1000.0).abs() < 1e-6);
            assert!((fastest(176.0, 199.0) - 750.0).abs() < 1e-6);
            assert!((fastest(201.0, 499.0) - after).abs() < 1e-6, "{more}");
            assert!((fastest(501.0, 699.0) - 500.0).abs() < 1e-6);
        }
    }
    // Ten blocks reach back to X300 only.
    let cut = limited("", 10);
    at(x(cut.output("M12")), 300.0);
}

/// Each by itself where it was planned, and together by the rule of overlaps.
#[test]
fn positions_of_several_functions() {
    let head = "%MicroJoint\n\"MVS_SVS\"=\"2\"\nV.G.M_FCT[11].SYNCH = 262144\nV.G.M_FCT[11].PRE_OUTP_PATH = 11\n\
                V.G.M_FCT[13].SYNCH = 8\nV.G.M_FCT[13].PRE_OUTP_PATH = 23\nV.G.H_FCT[12].PRE_OUTP_PATH = 12\n\
                V.G.H_FCT[12].SYNCH = \"MVS_SVS\"\nN01 X0 G01 F500\nN10 X100\n";
    let run = |functions: &str| {
        let program = format!("{head}N20 X200 {functions}\nN30 X300\nM30\n");
        Bench::new(&program, ENABLED).run()
    };
    for (function, place) in [("H12", 88.0), ("M11", 89.0), ("M13", 177.0)] {
        at(x(run(function).output(function)), place);
    }
    let all = run("M11 H12 M13");
    assert_places(
        &all,
        &[("M11", 89.0, 0.0), ("H12", 100.0, 0.0), ("M13", 177.0, 0.0)],
    );
    at(all.wait("M13").2, 177.0);
}

/// Of two MNS_SNS in a block the one without a lead stays at its end; a lead beyond the start begins there.
#[test]
fn microjoint9() {
    let program = "%microjoint9\nN01 G01 G90 X0 Y0 F10000\nN20 X10\nN40 X30 M100 M200\nN60 X40\nM30\n";
    let functions = "m_synch[100] 8\nm_pre_outp[100] 356000\nm_synch[200] 8\n";
    let report = Bench::new(program, &list(functions)).run();
    assert_places(&report, &[("M100", 0.0, 0.0), ("M200", 30.0, 0.0)]);
}

/// A function that is waited for at the end of its block where the block was split for it, and at once at a block limit.
#[test]
fn mvs_sns_with_a_lead() {
    let program = "%S\nN10 G01 X100 F5000\nN20 X200 M50\nN30 X300\nM30\n";
    let run = |lead: u32| {
        let functions = format!("m_synch[50] MVS_SNS\nm_pre_outp[50] {lead}\n");
        Bench::new(program, &list(&functions)).script("M50 ack 5").run()
    };
    let split = run(300_000);
    at(x(split.output("M50")), 70.0);
    at(split.wait("M50").2, 100.0);
    let limit = run(1_000_000);
    at(x(limit.output("M50")), 0.0);
    at(limit.wait("M50").2, 0.0);
}

#[test]
fn a_deviation_above_the_tolerance_is_an_error() {
    let functions = "m_synch[100] MOS\nm_synch[26] MOS\npre_output_tolerance 100000\n";
    let report = Bench::new(&many(false), &list(functions)).run();
    let error = report.error.unwrap();
    assert_eq!(
        (error.code.as_str(), error.block.as_str()),
        ("P-ERR-120815", "N50")
    );
    let wide = functions.replace("100000", "190000");
    assert!(Bench::new(&many(false), &list(&wide)).run().completed);
}

#[test]
fn t38_a_lead_without_micro_joints_is_a_licence_error() {
    let program = "%T38\nN10 G01 X10 F1000\nN20 V.G.M_FCT[96].SYNCH = 1\nN30 M96\nN40 X20\nM30\n";
    let functions = "m_synch[96] MEP_SVS\nm_pre_outp[96] 50000\n";
    let report = Bench::new(program, functions).run();
    let error = report.error.unwrap();
    assert!(!report.completed);
    assert_eq!((error.code.as_str(), error.block.as_str()), ("licence", "N30"));
    // Without the lead it is an ordinary function.
    let without = program.replace("SYNCH = 1\n", "SYNCH = 1\nN25 V.G.M_FCT[96].PRE_OUTP_PATH = 0\n");
    assert!(Bench::new(&without, functions).run().completed);
}

/// Micro Joints are of the channel alone [004:111]: a lead in the brackets of an axis, or of a default axis, is refused at its
/// block; a lead by MEP_SVS goes to any range.
#[test]
fn a_lead_to_an_axis_is_refused() {
    let program = "%T\nN10 G01 X40 F5000\nN20 X60 X[M11]\nM30\n";
    let enabled = "configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n";
    let list = |kind: &str| format!("{enabled}m_synch[11] {kind}\nm_pre_outp[11] 100000\n");
    for kind in ["MOS", "MVS_SVS", "MVS_SNS", "MNS_SNS", "MOS_TS"] {
        let error = Bench::new(program, &list(kind)).run().error.unwrap();
        assert_eq!((&*error.code, &*error.block), ("micro-joint", "N20"), "{kind}");
        assert!(error.message.contains("X takes no lead"), "{}", error.message);
        let by_default = format!("{}m_default_outp_ax_name[11] X\n", list(kind));
        let error = Bench::new(&program.replace("X[M11]", "M11"), &by_default)
            .run()
            .error;
        assert_eq!(error.unwrap().code, "micro-joint", "{kind}");
    }
    let report = Bench::new(program, &list("MEP_SVS")).run();
    at(x(report.output("M11")), 30.0);
    assert!(report.error.is_none());
}
