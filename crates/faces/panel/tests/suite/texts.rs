//! Every text of the panel and of the rooms that it is made of has its translation.

use std::path::Path;

use bahn_screen::texts::{Language, translation};

/// The rooms whose sources have texts of the screen.
const ROOMS: [&str; 6] = ["panel", "panel900", "screen", "graphics", "why", "teaching"];

/// Texts in the sources of these rooms: what stands in `words("...")`, and the names of soft keys in tables.
fn used() -> Vec<String> {
    let mut found = Vec::new();
    let rooms = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut folders: Vec<_> = ROOMS.iter().map(|room| rooms.join(room).join("src")).collect();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let source = std::fs::read_to_string(&path).unwrap();
                // A long text stands on a line of its own.
                let places = source.split("words(").skip(1).map(str::trim_start);
                let texts = places.filter_map(|rest| rest.strip_prefix('"')?.split('"').next());
                found.extend(texts.map(str::to_owned));
                let tables = source.split("SOFT_KEYS: [&str; ").skip(1);
                let tables = tables.filter_map(|rest| rest.split(';').next());
                let names = tables.flat_map(|table| table.split('"').skip(1).step_by(2));
                // A sign is the same in every language.
                let names = names.filter(|name| name.contains(char::is_alphabetic));
                found.extend(names.map(str::to_owned));
            }
        }
    }
    found
}

#[test]
fn every_text_of_the_panel_is_translated() {
    let used = used();
    assert!(used.len() > 15, "{}", used.len());
    assert!(
        used.contains(&"LAST LINE".to_owned()),
        "tables of soft keys are read"
    );
    let missing: Vec<_> = used
        .iter()
        .filter(|text| translation(Language::German, text).is_none())
        .collect();
    assert!(missing.is_empty(), "{missing:#?}");
}
