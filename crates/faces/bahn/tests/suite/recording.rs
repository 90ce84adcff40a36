//! Everything that can be recorded has the value that it must have.

use crate::support::*;

/// The columns of a recording by their names, without units; what happened is the last one.
struct Recorded {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Recorded {
    fn of(table: &str) -> Recorded {
        let mut lines = table
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let names = lines.next().unwrap();
        let names = names
            .iter()
            .map(|name| name.split(" [").next().unwrap().to_owned());
        Recorded {
            names: names.collect(),
            rows: lines.collect(),
        }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.names.iter().position(|own| own == name).unwrap();
        self.rows.iter().map(|row| row[at].parse().unwrap()).collect()
    }

    fn events(&self) -> impl Iterator<Item = &str> {
        self.rows.iter().map(|row| row.last().unwrap().as_str())
    }
}

fn recorded(folder: &Folder, arguments: &str) -> (i32, Recorded) {
    let run = folder.bahn(&format!(
        "run --machine mill --fresh --no-graphics --record r.csv {arguments}"
    ));
    assert!(run.code() < 2, "{}", run.err());
    (run.code(), Recorded::of(&folder.read("r.csv")))
}

/// Blocks from BEGIN, which is 0: Q5 is 3 in block 4, 7 in block 6, 0 in block 8.
const BLOCKS: &str = "TOOL CALL 1 Z S1000\nL Z+50 R0 FMAX M3\nQ5 = 3\nL X+0 Y+0 R0 FMAX\nQ5 = Q5 + 4\n\
    L X+100 F1500\nQ5 = 0\nL X+0";

/// The datum of the mill lies at X 200 [mm] of the machine.
const DATUM_X: f64 = 200.0;

#[test]
fn positions_and_distances() {
    let folder = Folder::with_mill(BLOCKS);
    let signals = "X.actual,X.displayed,X.ref,X.table,X.nominal,X.distance,path.distance,path.speed,path.block,C.actual,\
        C.ref,mode,run,tool,Q5";
    let (code, recorded) = recorded(&folder, &format!("main.H --signals {signals}"));
    assert_eq!(code, 0);
    let [actual, displayed, reference, table, nominal, distance] = [
        "X.actual",
        "X.displayed",
        "X.ref",
        "X.table",
        "X.nominal",
        "X.distance",
    ]
    .map(|name| recorded.column(name));
    let [rest, speed, block, q, run, mode, tool] = [
        "path.distance",
        "path.speed",
        "path.block",
        "Q5",
        "run",
        "mode",
        "tool",
    ]
    .map(|name| recorded.column(name));
    let [c, c_ref] = ["C.actual", "C.ref"].map(|name| recorded.column(name));
    // Block 6 goes from X 0 to X 100 along X alone.
    let mut steady = 0;
    for row in 0..speed.len() {
        assert!(
            (displayed[row] - (actual[row] - DATUM_X)).abs() < 1.1e-5,
            "row {row}"
        );
        assert_eq!(actual[row], reference[row]);
        // A rotary axis shows less than a turn.
        assert!((c[row].rem_euclid(360.0) - c_ref[row]).abs() < 1.1e-5 && c_ref[row] < 360.0);
        if block[row] == 6.0 && speed[row] > 0.0 {
            let end = DATUM_X + 100.0;
            // The loop is on its way to the nominal position of the cycle.
            let cycle = speed[row] / 60.0 * 0.003 + 1.1e-5;
            assert!((distance[row] - (end - nominal[row])).abs() <= cycle, "row {row}");
            assert!((rest[row] - distance[row]).abs() < 1.1e-5, "row {row}");
            assert_eq!(
                (q[row], run[row], mode[row], tool[row]),
                (7.0, 1.0, 5.0, 1.0),
                "row {row}"
            );
            // The encoder of 20 µm sits at the table, its step is 20 nm; marks and machine datum fit the plant.
            // What is measured at the beginning of a servo step is recorded after it.
            assert!((table[row] - actual[row]).abs() < 0.002 + cycle, "row {row}");
            steady += 1;
        }
        if speed[row] > 0.0 && run[row] == 1.0 && [2.0, 4.0, 8.0].contains(&block[row]) {
            let expected = match block[row] as u32 {
                2 => 0.0,
                4 => 3.0,
                _ => 0.0,
            };
            assert_eq!(q[row], expected, "block {} row {row}", block[row]);
        }
    }
    let (truth, shown) = (table.last().unwrap(), actual.last().unwrap());
    assert!((truth - shown).abs() < 0.001, "{truth} {shown}");
    // 100 mm at 25 mm/s are 4 s of 3 ms, and a bit for the ramps.
    assert!((1333..1400).contains(&steady), "{steady}");
    // Reference run, then full sequence; before the program no tool is in the spindle.
    assert!(mode.contains(&7.0) && mode.last() == Some(&5.0));
    assert!(tool.first() == Some(&0.0) && run.last() == Some(&0.0));
}

#[test]
fn voltages_forces_and_the_circuit() {
    let folder = Folder::with_mill(BLOCKS);
    let signals =
        "path.speed,path.block,X.volts,output.1,S.volts,output.S,output.7,X.force,X41/34,X42/4,S.angle,S.rpm";
    let (_, recorded) = recorded(&folder, &format!("main.H --signals {signals}"));
    let column = |name: &str| recorded.column(name);
    assert_eq!(column("X.volts"), column("output.1"));
    assert_eq!(column("S.volts"), column("output.S"));
    assert!(column("output.7").iter().all(|volts| *volts == 0.0));
    // At 1500 mm/min of 15 000 at 9 V: 0.9 V, with the offset and noise of the amplifier left to the loop; the motor
    // overcomes 250 N of friction.
    let (speed, block) = (column("path.speed"), column("path.block"));
    let (volts, force) = (column("X.volts"), column("X.force"));
    let steady: Vec<usize> = (0..speed.len())
        .filter(|row| block[*row] == 6.0 && speed[*row] == 1500.0)
        .skip(100)
        .collect();
    let mean = |values: &[f64]| steady.iter().map(|row| values[*row]).sum::<f64>() / steady.len() as f64;
    assert!(steady.len() > 1000);
    assert!((mean(&volts) - 0.9).abs() < 0.005, "{}", mean(&volts));
    assert!((mean(&force) - 250.0).abs() < 5.0, "{}", mean(&force));
    // Three processors drop the output one after the other, and the voltage falls behind it by the relay [000:6175-6228].
    let falls = |values: &[f64]| -> Vec<usize> {
        (1..values.len())
            .filter(|row| values[*row] == 0.0 && values[*row - 1] == 1.0)
            .collect()
    };
    let (output, acknowledgement) = (falls(&column("X41/34")), falls(&column("X42/4")));
    assert_eq!((output.len(), acknowledgement.len()), (3, 3));
    for (output, acknowledgement) in output.iter().zip(&acknowledgement) {
        // 25 ms to drop out, in cycles of 3 ms.
        assert!(
            (8..=10).contains(&(acknowledgement - output)),
            "{output} {acknowledgement}"
        );
    }
    // 6 degrees a second for one rpm.
    let (angle, rpm) = (column("S.angle"), column("S.rpm"));
    for row in &steady {
        let turned = angle[*row] - angle[*row - 1];
        assert!(
            (turned - rpm[*row] * 6.0 * 0.003).abs() < 0.2,
            "{turned} {}",
            rpm[*row]
        );
    }
}

/// A marker that is set and reset within a scan shows nothing at its ends: the event column tells of it.
#[test]
fn pulses_inside_a_scan_are_reported() {
    let folder = Folder::with_mill("L X+1 R0 F1000");
    let plc = folder.read("mill/plc/MAIN.PLC");
    let begin = "; ---- Main program ----\n";
    // M900 in the scans in which M901 is set from outside; W902 passes 5 in every tenth scan.
    let inserted = "       L     M901\n       S     M900\n       R     M900\n       R     M901\n       L     W904\n\
                           +     K+1\n       =     W904\n       L     W904\n       >=    K+10\n       IFT\n\
                           L     K+0\n       =     W904\n       L     K+5\n       =     W902\n       L     K+0\n\
                           =     W902\n       ENDI\n";
    assert!(plc.contains(begin));
    folder.write(
        "mill/plc/MAIN.PLC",
        plc.replace(begin, &format!("{begin}{inserted}")),
    );
    folder.write("s.txt", "15: M901=1\n16: M901=1\n17: end\n");
    let (_, recorded) = recorded(&folder, "--script s.txt --signals M900,M901,W902,W904");
    assert!(recorded.column("M900").iter().all(|value| *value == 0.0));
    assert!(recorded.column("W902").iter().all(|value| *value == 0.0));
    let reported = |what: &str| recorded.events().filter(|event| event.contains(what)).count();
    assert_eq!(reported("M900 pulse"), 2);
    // A scan of 20 ms in ten.
    let scans = recorded
        .column("W904")
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count();
    assert!(
        (reported("W902 pulse") as i64 - scans as i64 / 10).abs() <= 1,
        "{} {scans}",
        reported("W902 pulse")
    );
    // The drawing has a line for each.
    let table = folder.read("r.csv");
    folder.write("without.csv", table.replace("M900 pulse", ""));
    let lines = |name: &str| {
        let run = folder.bahn(&format!("scope {name}.csv --signals M900 --all -o {name}.svg"));
        assert_eq!(run.code(), 0, "{}", run.err());
        folder.read(&format!("{name}.svg")).matches("<polyline").count()
    };
    assert_eq!(lines("r"), lines("without") + 2);
    // With fewer rows nothing is lost.
    let run = folder.bahn(
        "run --machine mill --fresh --no-graphics --script s.txt --record r.csv --every 500 --signals M900,W902",
    );
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        Recorded::of(&folder.read("r.csv"))
            .events()
            .filter(|event| event.contains("M900 pulse"))
            .count(),
        2
    );
    // The run itself is the same bit by bit, whether somebody looks or not.
    for name in ["a", "b"] {
        let signals = if name == "a" {
            "X.actual,S.rpm"
        } else {
            "X.actual,S.rpm,M900,W902"
        };
        let run = folder.bahn(&format!(
            "run main.H --machine mill --fresh --no-graphics --record {name}.csv --signals {signals}"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
    }
    let [without, with] = ["a.csv", "b.csv"].map(|name| Recorded::of(&folder.read(name)));
    assert_eq!(without.column("X.actual"), with.column("X.actual"));
    assert_eq!(without.column("S.rpm"), with.column("S.rpm"));
}

/// The measuring system fails: the display stands still, the truth goes on being recorded.
#[test]
fn recording_goes_on_after_a_fault() {
    let folder = Folder::with_mill(BLOCKS);
    folder.write(
        "s.txt",
        "when X.displayed > 50: fault encoder X amplitude\nafter message MEASURING SYSTEM: force X 2000\n+1: force X 0\n\
         +0.5: power off\n+0.5: end\n",
    );
    let (code, recorded) = recorded(
        &folder,
        "main.H --script s.txt --signals X.actual,X.table,X.force,X42/4,run,Q5",
    );
    assert_eq!(code, 1, "an incomplete run");
    let fault = recorded
        .events()
        .position(|event| event.contains("MEASURING SYSTEM"))
        .unwrap();
    let times = recorded.column("time [s]".split(" [").next().unwrap());
    // 2 s after it there is a row for each contour cycle.
    assert!((times.last().unwrap() - times[fault] - 2.0).abs() < 0.01);
    assert!((times.len() - fault) as i64 - (2.0f64 / 0.003) as i64 <= 4);
    // 2000 N push against friction and brake, 1750 N: the table moves and stands again.
    let table = recorded.column("X.table");
    assert!(
        table.last().unwrap() - table[fault] > 1.0,
        "{} {}",
        table[fault],
        table.last().unwrap()
    );
    let force = recorded.column("X.force");
    assert!(force[fault + 100..].iter().all(|force| *force == 0.0));
    assert_eq!(recorded.column("X42/4").last(), Some(&0.0));
    assert!(recorded.column("Q5").iter().all(|value| value.is_finite()));
}

#[test]
fn what_is_not_there_is_refused() {
    let folder = Folder::with_mill(BLOCKS);
    for (signal, said) in [
        ("V.table", "the machine has no axis V"),
        ("Q300", "the tnc415b has Q0 to Q299"),
        ("output.6", "is no signal"),
    ] {
        let run = folder.bahn(&format!(
            "run main.H --machine mill --fresh --record r.csv --signals {signal}"
        ));
        assert!(run.code() == 2 && run.err().contains(said), "{}", run.err());
    }
}

/// Inputs and outputs of a TNC 155 are E and A, in the first line of the table and beside a pulse, however they were asked for; a
/// drawing takes both names.
#[test]
fn a_tnc_155_has_its_own_words() {
    let folder = Folder::new();
    folder.write(
        "MAIN.H",
        "BEGIN PGM MAIN MM\nL IX+1 R0 F500 M8\nL M30\nEND PGM MAIN MM\n",
    );
    assert_eq!(folder.bahn("machine new m --model tnc155").code(), 0);
    let run = "run MAIN.H --machine m --fresh --no-graphics --record r.csv --signals A18,O7,E17,I18,M2045";
    assert_eq!(folder.bahn(run).code(), 0);
    let table = folder.read("r.csv");
    let names = table.lines().next().unwrap();
    assert_eq!(names, "time [s],A18,A7,E17,E18,M2045,event");
    // M08 is on A18 while its code is on the lines.
    let recorded = Recorded::of(&table);
    assert!(recorded.column("A18").contains(&1.0));
    for names in ["A18,E17", "O18,I17"] {
        let scope = folder.bahn(&format!("scope r.csv --signals {names} --format json"));
        assert_eq!(scope.code(), 0, "{}", scope.err());
        assert!(
            scope.out().contains("\"A18\"") && scope.out().contains("\"E17\""),
            "{}",
            scope.out()
        );
    }
}
