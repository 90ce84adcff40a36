//! Any bytes are a list of machine parameters: kept as they are, faults in their lines, values in range.
#![no_main]

use bahn_fuzz as _;
use bahn_parameters::{ControlModel, Definition, ListText, ParameterId, ParameterList};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: (u8, f64, &[u8])| {
    let (model, value, bytes) = data;
    let model = ControlModel::ALL[usize::from(model) % ControlModel::ALL.len()];
    let mut text = ListText::from_bytes(model, bytes);
    assert_eq!(text.to_bytes(), bytes);
    for fault in text.all_faults() {
        assert!(fault.span.column as usize <= text.line(fault.span.line as usize).chars().count() + 1);
    }
    let mut list = ParameterList::smallest(model);
    list.take(&text);
    for definition in Definition::all(model) {
        let found = list.get(definition.id.number, definition.id.index.unwrap_or(0));
        assert!(found.is_some_and(|found| definition.check(found) == Ok(found)));
        definition.meaning(value);
    }
    let mut copy = ParameterList::smallest(model);
    assert!(copy.read(list.to_string().as_bytes()).is_empty());
    assert_eq!(copy, list);
    // The typed values answer whatever the list holds.
    for index in 0..8 {
        list.axis_parameters(index);
    }
    list.spindle_parameters();
    list.plc_parameters();
    list.operation_parameters();
    list.characteristics();
    list.user_parameters();
    list.inconsistencies();
    let _ = text.set(
        ParameterId {
            number: 1060,
            index: Some(0),
        },
        value,
    );
    text.complete();
    assert_eq!(text.missing().count(), 0);
});
