//! `bahn tune DIR S`: the ramp of the spindle in a thread, and kv of its orientation.

use crate::support::{Folder, copy, machines, number, program};

/// Threads of another depth, pitch and speed than those of the trial.
const THREADS: &str = "TOOL CALL 6 Z S1400
L X+20 Y+20 R0 FMAX M3
L Z+50 FMAX
CYCL DEF 17.0 RIGID TAPPING
CYCL DEF 17.1 SET UP -3
CYCL DEF 17.2 DEPTH -18
CYCL DEF 17.3 PITCH +1.25
L Z+3 FMAX M99
CYCL DEF 18.0 THREAD CUTTING
CYCL DEF 18.1 DEPTH -15
CYCL DEF 18.2 PITCH +1.25
L Z+3 FMAX M99
L Z+50 FMAX";

/// The largest distance of the threads from their depth, mm, and the time of the program, s.
fn threads(folder: &Folder) -> [f64; 2] {
    folder.write("T.H", program(THREADS));
    let run = folder.bahn("run T.H --machine m --fresh --no-graphics --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let cut = report["threads"].as_array().unwrap();
    assert_eq!(cut.len(), 2, "{report}");
    let beyond = cut
        .iter()
        .map(|thread| (number(thread, "/reached_mm") - number(thread, "/depth_mm")).abs());
    [beyond.fold(0.0, f64::max), number(&report, "/machining_time_s")]
}

/// A list whose ramp MP3410.3 is steeper than the drive can follow, without a run-in, and whose kv in the upper gear is a tenth:
/// threads are more than a millimetre too deep, and there each waits long for its orientation. The drive of the mill does
/// 9000 rpm/s, and 9 V are 6000 rpm: 0.0135 V/ms. With what is proposed they keep their depth within
/// 0.02 mm [000:6128], at another speed and pitch, too, and the program takes less time.
#[test]
fn a_spoilt_list_is_set_right() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("m"));
    let spoilt = ["3410.3=1.9", "7130=10", "7140=1", "3440.1=0.2"];
    let list: Vec<String> = folder
        .read("m/parameters.mp")
        .lines()
        .map(|line| {
            let name = line.split(':').next().unwrap().trim();
            let entry = spoilt.iter().find_map(|entry| {
                let (number, value) = entry.split_once('=').unwrap();
                (name == format!("MP{number}")).then(|| format!("MP{number} : {value}"))
            });
            entry.unwrap_or_else(|| line.to_owned())
        })
        .collect();
    folder.write("m/parameters.mp", list.join("\n") + "\n");
    let [beyond, slow] = threads(&folder);
    assert!(beyond > 1.0, "{beyond}");
    let tuned = folder.bahn("tune m S --write --format json");
    assert_eq!(tuned.code(), 0, "{}", tuned.err());
    let report = tuned.json();
    let changed: Vec<&str> = report["changes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|change| change["parameter"].as_str().unwrap())
        .collect();
    assert!(
        changed.contains(&"MP3410.3") && changed.contains(&"MP3440.1"),
        "{report}"
    );
    let ramp = number(&report, "/changes/0/to");
    assert!((0.5 * 0.0135..0.0135).contains(&ramp), "{report}");
    assert!(number(&report, "/before/beyond_mm") > 0.1, "{report}");
    assert!(number(&report, "/after/beyond_mm") <= 0.01, "{report}");
    let orientation = |when: &str| number(&report, &format!("/{when}/orientation_s/1"));
    assert!(orientation("after") < 0.8 * orientation("before"), "{report}");
    let [beyond, time] = threads(&folder);
    assert!(beyond < 0.02, "{beyond}: {report}");
    assert!(time < slow, "{time} instead of {slow}: {report}");
    let again = folder.bahn("tune m S");
    assert!(again.out().contains("beyond the depth, µm"), "{}", again.out());
}

/// A spindle without position control cuts no such threads.
#[test]
fn a_spindle_without_encoder_is_refused() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("m"));
    let refused = folder.bahn("tune m S --mp 3010=3");
    assert_eq!(refused.code(), 1);
    assert!(refused.err().contains("MP3010"), "{}", refused.err());
    let picture = folder.bahn("tune m S --picture p.png");
    assert_eq!(picture.code(), 2);
}
