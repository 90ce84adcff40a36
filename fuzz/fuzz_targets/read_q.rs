//! Any bytes are a data file of a System 900: faults at their places, and a change leaves all other parameters as they are.
#![no_main]

use bahn_fuzz as _;
use bahn_system900::{Change, DataFile, MFunction, Name, Tools, ZeroPoints, check, differences};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: (u32, &str, &[u8])| {
    let (number, value, bytes) = data;
    let file = DataFile::read(bytes);
    let lines: Vec<&str> = file.text().split('\n').collect();
    for fault in check(&file).faults {
        let line = lines[fault.span.line as usize - 1];
        assert!(fault.span.column >= 1 && fault.span.column as usize <= line.chars().count() + 1);
    }
    let memory = file.memory();
    for channel in 1..=memory.channels() {
        assert!(ZeroPoints::of(memory, channel).cells.len() <= 40_000);
        assert!(Tools::of(memory, channel).records.len() <= 40_000);
        MFunction::defined(memory, channel);
    }
    assert!(differences(memory, DataFile::read(&file.bytes()).memory()).is_empty());
    let name = Name::Q(1000 + number % 7400);
    let change = Change {
        name,
        value: Some(value.to_owned()),
        status: None,
    };
    if let Ok(changed) = file.changed(&[change]) {
        let found = differences(memory, changed.memory());
        let place = memory.place(name).unwrap();
        assert!(found.len() <= 1 && found.iter().all(|found| found.name == memory.name_of(place)));
    }
});
