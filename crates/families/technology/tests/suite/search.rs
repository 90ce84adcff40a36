//! Block search: a run that begins at a block, and what it says of the functions before that.

use crate::common::{Asked, Bench, at, ramp_s, when, x};
use bahn_path::Axis;
use bahn_technology::{EventKind, Report, Value};

/// F6000, mm/s.
const V: f64 = 100.0;
const LIST: &str = "m_synch[7] MOS\nm_synch[8] MVS_SVS\nm_synch[24] MVS_SLM\nh_synch[5] MOS\n\
    spindel[0].bezeichnung S1\nspindel[0].m3_synch MVS_SVS\nspindel[0].m4_synch MVS_SVS\nspindel[0].m5_synch MVS_SVS\n\
    spindel[0].s_synch MOS\nspindel[1].bezeichnung S2\n";

/// `target:function=value block` of what was passed over.
fn skipped(report: &Report) -> Vec<String> {
    let skipped = report.skipped.as_ref().unwrap();
    let text = skipped.iter().map(|one| {
        let value = match &one.value {
            Value::Integer(value) => format!("={value}"),
            Value::Number(value) => format!("={value}"),
            _ => String::new(),
        };
        format!(
            "{}:{}{value} {} {}",
            one.target, one.function, one.program, one.block
        )
    });
    text.collect()
}

/// Of each range the last of each function; M3, M4 and M5 of a spindle replace one another.
#[test]
fn the_last_state_of_what_is_passed_over() {
    let program = "%T\nN10 M3 S1000 M7\nN20 G01 X10 F6000 M7=4 X[M7] H5=1\nN30 S2[M3 REV300] M24\nN40 M5 H5=2\nN50 X20 M8\n\
        N60 M4 S500\nN70 X30 M99\nN80 X40 M7\nM30\n";
    let report = Bench::new(program, LIST).from("N80").run();
    assert!(report.completed, "{:?}", report.error);
    assert_eq!(
        skipped(&report),
        [
            "channel:M7=4 p1.nc N20",
            "X:M7 p1.nc N20",
            "S2:M3 p1.nc N30",
            "S2:S=300 p1.nc N30",
            "channel:M24 p1.nc N30",
            "channel:H5=2 p1.nc N40",
            "channel:M8 p1.nc N50",
            "S1:M4 p1.nc N60",
            "S1:S=500 p1.nc N60",
        ]
    );
    // Nothing of that is output, and the feed block does not wait for the late function.
    assert_eq!(report.order(), ["channel:M7"]);
    assert!(report.waits.is_empty());
    at(x(report.of(EventKind::Go)[0]), 30.0);
    when(report.time_s, ramp_s(10.0, V));
    // A run from the beginning passes over nothing.
    assert!(Bench::new("%T\nM30\n", LIST).run().skipped.is_none());
    let all = serde_json::to_value(&report).unwrap();
    assert_eq!(
        all["skipped"][0],
        serde_json::json!({ "function": "M7", "value": 4, "target": "channel", "program": "p1.nc", "block": "N20" })
    );
}

/// A free M3 is a function as any other.
#[test]
fn free_functions_have_no_groups() {
    let list = "spindle_m_fct_free 1\nm_synch[3] MOS\nm_synch[4] MOS\n";
    let report = Bench::new("%T\nN10 M3\nN20 M4\nN30 G01 X5 F6000\nM30\n", list)
        .from("N30")
        .run();
    assert_eq!(skipped(&report), ["channel:M3 p1.nc N10", "channel:M4 p1.nc N20"]);
}

#[test]
fn blocks_of_subroutines_are_found() {
    let program = "%T\nN10 G01 X10 F6000 M7\nN20 L SUB\nN30 L SUB\nN40 X60\nM30\n";
    let sub = "%SUB\nN100 G91 X10 M7=2\nN110 X10 M8\nM17\n";
    let bench = Bench::new(program, LIST).subroutine("SUB", sub);
    // The first call that comes to it; after it everything is as always.
    let report = bench.clone().from("N110").run();
    assert!(report.completed, "{:?}", report.error);
    assert_eq!(skipped(&report), ["channel:M7=2 SUB N100"]);
    assert_eq!(report.order(), ["channel:M8", "channel:M7", "channel:M8"]);
    at(x(report.outputs("M8")[0]), 20.0);
    at(report.path_end.0[Axis::X], 110.0);
    // A block of the program itself goes before one of a subroutine.
    let own = bench.from("N40").subroutine("OTHER", "%O\nN40 X1\nM17\n").run();
    assert_eq!(own.order(), [""; 0]);
}

/// It passes over no more blocks than a run may have: N10 to N70 are seven.
#[test]
fn a_search_has_its_bounds() {
    let blocks = (1..=7).map(|number| format!("N{number}0 G01 X{number} F6000\n"));
    let program = format!("%T\n{}N80 X10\nM30\n", blocks.collect::<String>());
    let mut bench = Bench::new(&program, LIST).from("N80");
    bench.bounds.blocks = 7;
    assert!(bench.run().completed);
    bench.bounds.blocks = 6;
    let error = bench.run().error.unwrap();
    assert_eq!(
        (error.code.as_str(), error.message.as_str()),
        ("endless", "more than 6 blocks")
    );
}

/// A file with several programs is searched from the first to the last; then the ones after it run.
#[test]
fn other_programs_of_the_file() {
    let file = "%ONE\nN10 G01 X10 F6000 M7=1\nM30\n%TWO\nN20 G01 X20 F6000 M7=2\nN30 X30 M8\nM30\n%THREE\nN40 X35 F6000 G01\nM30\n";
    let report = Bench::new(file, LIST)
        .and("%NEXT\nN50 G01 F6000 X40\nM30\n")
        .from("N30")
        .run();
    assert!(report.completed, "{:?}", report.error);
    assert_eq!(skipped(&report), ["channel:M7=2 p1.nc N20"]);
    assert_eq!(report.order(), ["channel:M8"]);
    at(x(report.output("M8")), 20.0);
    at(report.path_end.0[Axis::X], 40.0);
    assert_eq!(report.programs.len(), 3);
    // Other files are not searched.
    let other = Bench::new(file, LIST)
        .and("%NEXT\nN50 G01 F6000 X40\nM30\n")
        .from("N50")
        .run();
    let error = other.error.unwrap();
    assert_eq!(
        (error.message.as_str(), error.block.as_str()),
        ("block N50 is not in the program", "N10")
    );
    assert!(!other.completed && other.events.is_empty() && other.programs.len() == 1);
}
