//! Rows of the screen of the knee mill: what it shows and what it takes.

use std::path::Path;

use bahn_parameters::ControlModel::Tnc155;

use crate::bench::{Probe, Row, Verdict, holds, same};
use crate::trainee::Trainee;

pub const ROWS: &[Row] = &[
    Row(65..=65, Probe::Acts(resolution)),
    Row(191..=191, Probe::Acts(speed_before_start)),
    Row(217..=217, Probe::Acts(language)),
    Row(236..=236, Probe::Acts(graphics)),
    Row(237..=237, Probe::Acts(axis_v)),
];

/// The knee mill with lines of its list, after the reference run.
fn ready(lines: &[&str]) -> Trainee {
    let mut trainee = Trainee::with_tnc155(Tnc155, lines);
    trainee.ready();
    trainee
}

/// A datum of 12.344 mm is taken in steps of 1 µm and refused in steps of 5 µm, as is a block with it; what is shown ends with 0
/// or 5 then, wherever the axis stands [001:1612-1614].
fn resolution(_: u16) -> Verdict {
    let seen = ["MP65 : 0", "MP65 : 1"].map(|line| {
        let mut trainee = ready(&[line]);
        trainee.press("X").number("12.344").press("ENT").wait(0.2);
        let taken = trainee.messages().is_empty();
        trainee.press("CE END").wait(0.1);
        let mut steps = true;
        for key in ["X-", "Y-", "Z-"] {
            trainee.give(&format!("{{\"key\":\"{key}\",\"down\":true}}"));
            trainee.wait(0.317);
            trainee.give(&format!("{{\"key\":\"{key}\",\"down\":false}}"));
            trainee.wait(0.3);
            let shown = trainee.position(key.chars().next().unwrap());
            steps &= shown.ends_with(['0', '5']);
        }
        trainee
            .press("PROGRAM PGM_NR 9 9 ENT ENT L X")
            .number("1.002")
            .press("ENT")
            .wait(0.2);
        let refused = trainee
            .messages()
            .iter()
            .any(|text| text == "ENTRY VALUE INCORRECT");
        (taken, steps, refused)
    });
    same(seen, [(true, false, false), (false, true, true)])
}

/// S600 was called, and the spindle stands: 1 shows it [001:1577].
fn speed_before_start(_: u16) -> Verdict {
    let seen = ["MP191 : 0", "MP191 : 1"].map(|line| {
        let mut trainee = ready(&[line, "MP62 : 5", "MP61 : 0"]);
        let program = "BEGIN PGM 7 MM\nTOOL CALL 0 Z S600\nEND PGM 7 MM\n";
        trainee.write("programs/7.H", program);
        trainee.press("FULL PGM_NR 7 ENT NC_START").wait(2.0);
        trainee.screen().status.s
    });
    same(seen, [0.0, 600.0])
}

/// A new program has blocks in dialogue, or in ISO [001:1653].
fn language(_: u16) -> Verdict {
    let seen = ["MP217 : 0", "MP217 : 1"].map(|line| {
        let mut trainee = Trainee::with_tnc155(Tnc155, &[line]);
        trainee.until(5.0, |screen| !screen.messages.is_empty());
        trainee.press("CE").wait(2.0);
        trainee.press("PROGRAM PGM_NR 7 7 ENT ENT").wait(0.2);
        [trainee.has("programs/77.H"), trainee.has("programs/77.I")]
    });
    same(seen, [[true, false], [false, true]])
}

/// A blank of 40 x 30 x 10 mm with a groove of 5 mm along its edge at Y 0, which MP236 does not change.
const GROOVE: &str = "BEGIN PGM 8 MM
BLK FORM 0.1 Z X+0 Y+0 Z-10
BLK FORM 0.2 X+40 Y+30 Z+0
TOOL DEF 1 L+0 R+5
TOOL CALL 1 Z S2000
L Z+50 R0 F9999 M3
L X-10 Y+0
L Z-5
L X+50 F600
L Z+50 F9999 M2
END PGM 8 MM
";

/// The three views of the part, pixels.
fn views(mp236: u8) -> [Vec<[u8; 3]>; 3] {
    let line = format!("MP236 : {mp236}");
    let mut trainee = Trainee::with_tnc155(Tnc155, &[&line, "MP225 : 0", "MP61 : 0"]);
    trainee.write("programs/8.H", GROOVE);
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    trainee.press("CE TEST PGM_NR 8 ENT START").wait(2.0);
    [0, 1, 2].map(|_: u8| {
        trainee.press("GRAPHICS").wait(0.2);
        let picture = trainee.station.picture();
        picture
            .and_then(|picture| picture.pixels(320, 240).ok()?)
            .unwrap_or_default()
    })
}

/// Third angle has the plan view above the front view; +2 turns the coordinate system by 90 degrees in all views [001:1654].
fn graphics(_: u16) -> Verdict {
    let [german, american, turned] = [0, 1, 2].map(views);
    holds(german.iter().all(|view| view.len() == 320 * 240), || {
        "no pictures".to_owned()
    })?;
    let like = |other: &[Vec<[u8; 3]>; 3]| [0, 1, 2].map(|view: usize| german[view] == other[view]);
    same(like(&american), [true, false, true])?;
    same(like(&turned), [false, false, false])
}

/// 0: no orientation, no display; 1: M19 orients; 2: axis V is shown in place of axis IV, too; 3 to 5: it is only shown, as A, B or
/// C [001:3109]. The spindle turns first, past its mark.
fn axis_v(number: u16) -> Verdict {
    crate::spindle::orientation_by(number)?;
    let seen = [0, 1, 2, 3, 4, 5].map(|value: u8| {
        let line = format!("MP237 : {value}");
        let mut trainee = Trainee::with("mill-tnc155", |folder| with_axis_v(folder, &line));
        let program = "BEGIN PGM 7 MM\nTOOL CALL 0 Z S300\nL M3\nL M5\nEND PGM 7 MM\n";
        trainee.write("programs/7.H", program);
        trainee.ready();
        trainee.press("FULL PGM_NR 7 ENT NC_START").wait(6.0);
        let letters = trainee.screen().status.axes;
        letters.iter().map(|axis| axis.letter).collect::<String>()
    });
    same(
        seen,
        ["XYZ", "XYZ", "XYZV", "XYZA", "XYZB", "XYZC"].map(str::to_owned),
    )
}

/// The spindle of the knee mill with an encoder, and a line of its list.
fn with_axis_v(folder: &Path, line: &str) {
    let change = |name: &str, how: &dyn Fn(String) -> String| {
        let path = folder.join(name);
        std::fs::write(&path, how(std::fs::read_to_string(&path).unwrap())).unwrap();
    };
    let encoder = "[spindle]\nencoder = { input = \"X5\", lines = 1024, mark_deg = 0 }\n";
    change("plant.toml", &|text| text.replacen("[spindle]\n", encoder, 1));
    change("parameters.mp", &|text| format!("{text}{line}\n"));
}
