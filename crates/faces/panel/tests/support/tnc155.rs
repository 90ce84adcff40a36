//! The knee mill with a TNC 151 or 155, and lines of its list in place of its own.

use std::fs;
use std::path::Path;

use bahn_parameters::ControlModel;

/// Gives the folder of the knee mill a control and lines of its list.
pub fn fit(folder: &Path, model: ControlModel, lines: &[&str]) {
    let change = |name: &str, how: &dyn Fn(String) -> String| {
        let path = folder.join(name);
        fs::write(&path, how(fs::read_to_string(&path).unwrap())).unwrap();
    };
    change("machine.toml", &|text| {
        text.replace("\"tnc155\"", &format!("\"{}\"", model.id()))
    });
    change("parameters.mp", &|list| with_lines(list, lines));
}

/// The list, in which the lines stand.
fn with_lines(mut list: String, lines: &[&str]) -> String {
    let name = |line: &str| line.split(':').next().unwrap_or_default().trim().to_owned();
    for own in lines {
        let others = list.lines().filter(|line| name(line) != name(own));
        list = others.map(|line| format!("{line}\n")).collect::<String>() + own + "\n";
    }
    list
}
