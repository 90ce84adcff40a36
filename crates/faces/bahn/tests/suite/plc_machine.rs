//! `bahn plc trace` and `diagram` on a machine that runs.

use crate::support::Folder;
use serde_json::Value;

const BLOCKS: &str =
    "TOOL CALL 1 Z S1000\nL Z+50 R0 FMAX M3\nL X+0 Y+0 R0 FMAX\nL X+20 F1500 M8\nL Z+100 R0 FMAX M5";

fn lines(values: &Value) -> Vec<i64> {
    values
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_i64().unwrap())
        .collect()
}

/// The handshake of M3: the NC sets the strobe, the PLC switches the spindle on and acknowledges at speed, the NC takes the
/// strobe back, the PLC the acknowledgement.
#[test]
fn a_diagram_draws_the_running_control() {
    let folder = Folder::with_mill(BLOCKS);
    let run = folder.bahn(
        "plc diagram mill --part main.H --show M2045,M2482,M2485,W260 --trigger M2045=1 --before 3 --cycles 64 --format json",
    );
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let course = |index: usize| lines(&report["operands"][index]["values"]);
    let (strobe, acknowledged, m3, number) = (course(0), course(1), course(2), course(3));
    assert_eq!(strobe.len(), 64);
    let trigger = report["trigger_cycle"].as_u64().unwrap() - report["first_cycle"].as_u64().unwrap();
    assert_eq!(trigger, 3);
    assert_eq!(
        (strobe[..5].to_vec(), m3[..5].to_vec()),
        (vec![0, 0, 0, 1, 1], vec![0, 0, 0, 1, 1])
    );
    assert!(number[3..].starts_with(&[3, 3, 3]));
    let first = |values: &[i64], wanted: i64, from: usize| {
        values
            .iter()
            .skip(from)
            .position(|value| *value == wanted)
            .map(|at| at + from)
    };
    let at_speed = first(&acknowledged, 1, 0).unwrap();
    // The spindle needs its time to the speed; then the NC sees it at the end of the scan, and the next scan both.
    assert!(at_speed > 10, "{at_speed}");
    assert_eq!(first(&strobe, 0, 3), Some(at_speed + 1));
    assert_eq!(first(&acknowledged, 0, at_speed), Some(at_speed + 1));
    // As text, the first lines.
    let run = folder
        .bahn("plc diagram mill --part main.H --show M2045,W260 --trigger M2045=1 --before 3 --cycles 8");
    let begin = report["first_cycle"].as_u64().unwrap();
    let expected = format!(
        "cycles {begin} to {}\n            v trigger\n   M2045 ___\u{2580}\u{2580}\u{2580}\u{2580}\u{2580}\n    W260 |0 |3\n",
        begin + 7
    );
    assert_eq!(run.out(), expected, "{}", run.err());
}

/// The scan in which M3 reaches the PLC: it begins with line 10 of the main program, and the module of the M functions sets M2485.
#[test]
fn a_trace_shows_a_scan_of_the_running_control() {
    let folder = Folder::with_mill(BLOCKS);
    let run = folder.bahn("plc trace mill --part main.H --trigger M2045=1 --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let traced = report.as_array().unwrap();
    let source = folder.read("mill/plc/MAIN.PLC");
    let source: Vec<&str> = source.lines().collect();
    let begin = source
        .iter()
        .position(|line| line.contains("L     M2719"))
        .unwrap();
    assert_eq!(traced[0]["line"], begin + 1);
    assert_eq!(traced[0]["instruction"], "L M2719");
    // One scan: every line has the same cycle, and the last one ends the main program.
    assert!(traced.iter().all(|line| line["cycle"] == traced[0]["cycle"]));
    assert_eq!(traced.last().unwrap()["instruction"], "EM");
    // Each line is what stands there.
    for line in traced {
        let text = source[line["line"].as_u64().unwrap() as usize - 1];
        let words: Vec<&str> = text.split(';').next().unwrap().split_whitespace().collect();
        assert_eq!(line["instruction"].as_str().unwrap(), words.join(" "));
    }
    let set = traced
        .iter()
        .find(|line| line["instruction"] == "S M2485")
        .unwrap();
    assert_eq!((&set["logic"], &set["operand"]), (&1.into(), &1.into()));
    // The same scan by its number, for people.
    let cycle = traced[0]["cycle"].as_u64().unwrap();
    let run = folder.bahn(&format!("plc trace mill --part main.H --cycle {cycle}"));
    assert_eq!(run.code(), 0, "{}", run.err());
    let text = run.out();
    let mut shown = text.lines();
    assert_eq!(shown.next(), Some(format!("cycle {cycle}, MAIN.PLC").as_str()));
    assert_eq!(
        shown.next(),
        Some(" LINE  INSTRUCTION               OPERAND  LOGIC         WORD")
    );
    let first = format!("{:>5}  L M2719                         1      1", begin + 1);
    assert!(shown.next().unwrap().starts_with(&first), "{text}");
    assert_eq!(text.lines().count(), traced.len() + 2);
}

/// The script of a machine is played: a wire breaks, and what it expects in vain is said.
#[test]
fn scripts_are_played_on_the_machine() {
    let folder = Folder::with_mill(BLOCKS);
    folder.write(
        "s.txt",
        "20: fault input I5 0\n+0.2: expect M2925=1, I5=0\n+0: expect mode full\n+1: end\n",
    );
    let run = folder.bahn(
        "plc diagram mill --script s.txt --show I5,M2925 --trigger I5=0 --cycles 4 --before 2 --format json",
    );
    let report = run.json();
    assert_eq!(lines(&report["operands"][0]["values"]), [1, 1, 0, 0]);
    assert_eq!(lines(&report["operands"][1]["values"]), [0, 0, 1, 1]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let run = folder.bahn("plc diagram mill --script s.txt --show M2925 --trigger M2925=1 --cycles 40");
    assert!(
        run.code() == 1 && run.err().contains("s.txt:3:1"),
        "{}",
        run.err()
    );
    // The script ends the run before the cycle comes.
    let run = folder.bahn("plc trace mill --script s.txt --cycle 100000");
    assert!(
        run.code() == 1 && run.err().contains("the script has ended the run"),
        "{}",
        run.err()
    );
    for (arguments, said) in [
        ("trace mill --set I4=1", "fault input I4 1"),
        ("trace mill --parameters x.mp", "of the bench"),
        ("trace mill --model tnc360", "this machine has a tnc415b"),
        ("run mill", "bahn run"),
    ] {
        let run = folder.bahn(&format!("plc {arguments}"));
        assert!(
            run.code() == 2 && run.err().contains(said),
            "{arguments}: {}",
            run.err()
        );
    }
    folder.write("MAIN.PLC", "L I4\n= O2\nEM\n");
    let run = folder.bahn("plc trace MAIN.PLC --part main.H");
    assert!(
        run.code() == 2 && run.err().contains("folder of a machine"),
        "{}",
        run.err()
    );
    // A trigger on the bench.
    folder.write("door.txt", "cycle 3: I4=1\n");
    let run = folder.bahn("plc trace MAIN.PLC --script door.txt --trigger O2=1");
    assert!(
        run.out().starts_with("cycle 3, MAIN.PLC\n"),
        "{}{}",
        run.out(),
        run.err()
    );
}

/// Both channels of a machine run the programs of its machine.toml: M60 is their wait mark, answered in both at once.
#[test]
fn all_channels_of_a_machine_run() {
    let twin = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/twin");
    let run = Folder::new().bahn(&format!(
        "plc diagram {twin} --show M2482,M334,W260,W128 --trigger M334=1 --before 2 --cycles 4 --format json"
    ));
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let course = |index: usize| lines(&report["operands"][index]["values"]);
    // M334 is the acknowledgement in the window of the second channel, W128 its M function.
    assert_eq!(course(1)[..3], [0, 0, 1]);
    assert!(course(3)[2] > 0, "{report}");
}
