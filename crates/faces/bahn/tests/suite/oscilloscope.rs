//! `bahn run --oscilloscope`: the memory of the control's oscilloscope.

use crate::support::*;

fn dig425(blocks: &str) -> Folder {
    let folder = Folder::with_program(blocks);
    copy(&machines().join("dig425"), &folder.path("dig425"));
    folder
}

/// Times, the first curve, and the row of the trigger.
fn memory(table: &str) -> (Vec<f64>, Vec<f64>, Option<usize>) {
    let rows = rows(table);
    let column = |at: usize| {
        rows.iter()
            .map(|row| row[at].parse::<f64>().unwrap())
            .collect::<Vec<f64>>()
    };
    let trigger = rows.iter().position(|row| row.last() == Some(&"trigger"));
    (column(0), column(1), trigger)
}

/// The datum lies at X 200 of the machine: X goes from 200 to 250 and back, 2.5 s each, after 3 s of dwell.
const BLOCKS: &str =
    "L Z+50 R0 FMAX\nL X+0 Y+0 FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 3\nL X+50 F1200\nL X+0";

/// 4096 samples of 0.6 ms are 2.4576 s [000:18748]; a pre-trigger of 25 % puts the trigger at sample 1024.
#[test]
fn the_memory_has_4096_samples_and_a_pre_trigger() {
    let folder = dig425(BLOCKS);
    for (percent, at) in [(0, 0), (25, 1024), (50, 2048), (75, 3072)] {
        let run = folder.bahn(&format!(
            "run main.H --machine dig425 --fresh --no-graphics --oscilloscope o.csv --channels X.s-nominal,X.diff,X.n-int,X.u \
             --trigger X.s-nominal>230 --pre-trigger {percent}"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        assert!(
            run.err().contains("4096 samples of 0.6 ms (2.4576 s)"),
            "{}",
            run.err()
        );
        let text = folder.read("o.csv");
        assert!(text.starts_with("time [s],X.s-nominal [mm],X.diff [mm],X.n-int [mm/min],X.u [mV],event\n"));
        let (times, positions, trigger) = memory(&text);
        assert_eq!((times.len(), trigger), (4096, Some(at)), "{percent} %");
        assert!((times[4095] - times[0] - 4095.0 * 0.0006).abs() < 2e-4);
        assert!(
            positions[at] > 230.0 && (at == 0 || positions[at - 1] <= 230.0),
            "it passes the threshold there"
        );
    }
}

/// Falling slope, free run, single shot, other sample times; `bahn scope` reads the memory.
#[test]
fn triggers_and_sample_times() {
    let folder = dig425(BLOCKS);
    let run = |arguments: &str| {
        let run = folder.bahn(&format!(
            "run main.H --machine dig425 --fresh --no-graphics --oscilloscope o.csv --channels X.s-actual,X.diff {arguments}"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        memory(&folder.read("o.csv"))
    };
    let (times, positions, trigger) = run("--trigger X.s-actual<240 --pre-trigger 50");
    let at = trigger.unwrap();
    assert!(positions[at] < 240.0 && positions[at - 1] >= 240.0 && times.len() <= 4096);
    let (times, positions, trigger) = run("--trigger free --sample-time 1.2");
    assert_eq!(trigger, None);
    // The last ones: the program ends at its datum, X 200 of the machine.
    assert!((positions.last().unwrap() - 200.0).abs() < 0.01);
    assert!((times[1] - times[0] - 0.0012).abs() < 1.1e-4);
    let (times, _, trigger) = run("--trigger single");
    assert_eq!((trigger, times.len()), (Some(0), 4096));
    let scope = folder.bahn("scope o.csv --all --cursor 5.0,5.5 -o o.png");
    assert_eq!(scope.code(), 0, "{}{}", scope.out(), scope.err());
    assert!(folder.path("o.png").exists() && scope.out().contains("X.diff"));
}

/// A step of 240 mm/min by a direction key: the speed overshoots by at most 40 % [000:18594], the voltage stays below 8 V.
#[test]
fn a_step_of_the_speed_controller() {
    let folder = dig425(BLOCKS);
    folder.write(
        "step.txt",
        "8: output step 240\n+0.1: key X+ press\n+0.4: key X+ release\n+0.5: end\n",
    );
    let run = folder.bahn(
        "run --machine dig425 --fresh --script step.txt --oscilloscope o.csv --channels X.n-actual,X.n-nominal,X.u \
         --trigger X.n-nominal>1 --pre-trigger 25",
    );
    assert!(
        run.err().contains("trigger at sample"),
        "{} {}",
        run.out(),
        run.err()
    );
    let text = folder.read("o.csv");
    let (_, speeds, trigger) = memory(&text);
    let volts = rows(&text)
        .iter()
        .map(|row| row[3].parse::<f64>().unwrap().abs())
        .fold(0.0, f64::max);
    let greatest = speeds.iter().copied().fold(0.0, f64::max);
    assert!(greatest > 240.0 && greatest < 1.4 * 240.0, "{greatest}");
    assert!(volts > 100.0 && volts < 8000.0, "{volts}");
    // It is put out at once: 10 ms later the speed is there.
    assert!(speeds[trigger.unwrap() + 17] > 0.9 * 240.0);
}

/// After code number 688 379 START and STOP are the operator's: FREE RUN ends by hand, and a second START forgets the first
/// recording [000:18691] [000:18776-18778].
#[test]
fn start_and_stop_by_hand() {
    let folder = dig425(BLOCKS);
    let recorded = |script: &str| {
        folder.write("osci.txt", script);
        let run = folder.bahn(
            "run main.H --machine dig425 --fresh --no-graphics --script osci.txt --oscilloscope o.csv \
             --channels X.s-nominal --trigger free",
        );
        assert_eq!(run.code(), 0, "{}", run.err());
        memory(&folder.read("o.csv"))
    };
    // Half a second of 0.6 ms; a contour cycle may lie before and after.
    let by_hand = "start+1: code 688379\n+0: oscilloscope start\n+0.5: oscilloscope stop\n";
    let (first, _, trigger) = recorded(by_hand);
    assert_eq!(trigger, None);
    assert!((828..=840).contains(&first.len()), "{}", first.len());
    let (second, _, _) = recorded(&format!(
        "{by_hand}+1: oscilloscope start\n+0.25: oscilloscope stop\n"
    ));
    assert!((411..=423).contains(&second.len()), "{}", second.len());
    assert!((second[0] - first[0] - 1.5).abs() < 0.01);
    // Without START nothing is recorded.
    assert!(recorded("1: code 688379\n").0.is_empty());
}

#[test]
fn wrong_use_says_what_is_right() {
    let folder = dig425(BLOCKS);
    copy(&machines().join("mill-tnc360"), &folder.path("mill360"));
    let run = folder.bahn("run main.H --machine mill360 --fresh --oscilloscope o.csv");
    assert_eq!(run.code(), 2, "{}", run.err());
    assert!(run.err().contains("the tnc360 has none"), "{}", run.err());
    for (arguments, expected) in [
        (
            "--channels X.w",
            "is no curve of the oscilloscope; there are v-actual",
        ),
        (
            "--channels C.diff",
            "the machine has no axis C; there are X, Y, Z",
        ),
        (
            "--channels X.diff --trigger X.u>5",
            "the trigger X.u is none of the channels",
        ),
        ("--trigger sometimes", "is no trigger"),
        ("--sample-time 1", "a servo step of the tnc425 is 0.6 ms"),
        ("--sample-time 6.6", "the sample time is 0.6 to 6 ms"),
        ("--pre-trigger 30", "0, 25, 50, 75 or 100 %"),
        ("--channels X.u,Y.u,Z.u,X.diff,Y.diff", "1 to 4 channels"),
        (
            "--mp 1900=0 --channels X.n-actual",
            "X has no digital speed controller",
        ),
    ] {
        let run = folder.bahn(&format!(
            "run main.H --machine dig425 --fresh --oscilloscope o.csv {arguments}"
        ));
        assert_eq!(run.code(), 2, "{arguments}: {}", run.err());
        assert!(run.err().contains(expected), "{arguments}: {}", run.err());
    }
}
