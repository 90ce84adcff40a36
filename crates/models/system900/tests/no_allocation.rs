//! Writes of a control that runs allocate nothing, whatever they make it do.

use bahn_system900::{Channels, Memory, Name, Status, Traffic, Unit, Value, Writer};

#[test]
fn writes_allocate_nothing() {
    let mut memory = Memory::new();
    for (name, value) in [
        ("q102", "10000"),
        ("q103", "5000"),
        ("q110", "$01010058"),
        ("q170", "1000"),
        ("q173", "3"),
        ("P11271", "$FFFF"),
        ("P8510", "$2"),
        ("P11010", "$10000000"),
    ] {
        memory
            .write(name.parse().unwrap(), value.parse().unwrap())
            .unwrap();
    }
    for number in 0..300 {
        memory
            .set_status(Name::P(1, number), Status::from_word(0x0301_C714))
            .unwrap();
    }
    let mut traffic = Traffic::new();
    let writes: Vec<(Name, Value)> = [
        "P5", "P12111", "P8683", "P11000", "P11308", "P8553", "P8501", "P11279", "q10",
    ]
    .into_iter()
    .flat_map(|name| ["1", "--", "0"].map(|value| (name.parse().unwrap(), value.parse().unwrap())))
    .collect();
    let writers = [
        Writer::Editor,
        Writer::Page,
        Writer::Program,
        Writer::Plc,
        Writer::Control,
    ];
    let mut refused = 0;
    let counted = allocation_counter::measure(|| {
        for round in 0u64..200 {
            memory.update_locks(Channels::from_bits((round % 2) as u8));
            for (name, value) in &writes {
                for writer in writers {
                    refused += u32::from(traffic.write(&mut memory, round, writer, *name, *value).is_err());
                }
            }
        }
    });
    assert_eq!((counted.count_total, refused), (0, 0));
    assert_eq!(Unit::of(&memory), Unit::Metric);
    assert_eq!(traffic.events().count(), 2000);
}
