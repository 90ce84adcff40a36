//! The small mill with a TNC 151 or 155: its list, its encoders of 1 µm, its operating panel at the second board.

use std::fs;
use std::path::Path;

use bahn_parameters::{ControlModel, ParameterList};

/// What the small mill has other than the reference list: no rotary table, one mark, its travel, its spindle, English.
const SMALL_MILL: &[&str] = &[
    "MP72 : 8",
    "MP92 : 3",
    "MP242 : 0",
    "MP243 : 0",
    "MP244 : 0",
    "MP44 : 26",
    "MP45 : -374",
    "MP46 : 23",
    "MP47 : -227",
    "MP48 : 18.5",
    "MP49 : -281.5",
    "MP36 : 0.02",
    "MP37 : 0.02",
    "MP38 : 0.01",
    "MP78 : 4000",
    "MP79 : 0",
    "MP169 : 0.4",
    "MP112 : 200",
    "MP113 : 120",
    "MP118 : 3",
    "MP225 : 99",
];

/// Marks of the ballscrews in the description of the plant, and the one that is left of each.
const MARKS: [(&str, &str); 3] = [
    ("marks_every = 10, marks_from = 4 ", "mark = 374 "),
    ("marks_every = 10, marks_from = 7 ", "mark = 227 "),
    ("marks_every = 10, marks_from = 1.5 ", "mark = 281.5 "),
];

/// Makes the folder of the small mill one with another control.
pub fn fit(folder: &Path, model: ControlModel, lines: &[&str]) {
    let change = |name: &str, how: &dyn Fn(String) -> String| {
        let path = folder.join(name);
        fs::write(&path, how(fs::read_to_string(&path).unwrap())).unwrap();
    };
    // The inputs of the operating panel, 25 from I128 on, are those of the second board, I64 ff.
    let inputs = |text: String| {
        (0..25).fold(text, |text, input| {
            text.replace(&format!("I{}", 128 + input), &format!("I{}", 64 + input))
        })
    };
    change("machine.toml", &|text| {
        text.replace("\"tnc360\"", &format!("\"{}\"", model.id()))
    });
    change("plc/MAIN.PLC", &inputs);
    change("plant.toml", &|text| {
        let text = inputs(text).replace("period_um = 4,", "period_um = 20,");
        MARKS
            .iter()
            .fold(text, |text, (many, one)| text.replace(many, one))
    });
    change("parameters.mp", &|_| list(model, lines));
}

/// The reference list, in which the lines of the machine stand.
fn list(model: ControlModel, lines: &[&str]) -> String {
    let name = |line: &str| line.split(':').next().unwrap_or_default().trim().to_owned();
    let mut list = ParameterList::reference_text(model).to_owned();
    for own in SMALL_MILL.iter().chain(lines) {
        let others = list.lines().filter(|line| name(line) != name(own));
        list = others.map(|line| format!("{line}\n")).collect::<String>() + own + "\n";
    }
    list
}
