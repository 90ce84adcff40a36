//! Locks: what switches choose, and whom it holds back.

use bahn_system900::{
    Channels, Lock, Locks, Memory, Name, Part, ProgramName, SpaceError, Status, Value, Writer, refusing,
};
use proptest::prelude::*;

use crate::memory::{memory, name};

/// Two axes, zero points from P20000 on, tools from P21000 on.
const MACHINE: [(&str, &str); 14] = [
    ("q102", "10000"),
    ("q103", "5000"),
    ("q104", "18000"),
    ("q105", "2000"),
    ("q110", "$01010058"),
    ("q170", "20000"),
    ("q171", "1"),
    ("q173", "3"),
    ("q175", "21000"),
    ("q176", "10"),
    ("q178", "20"),
    ("q2", "2"),
    ("q202", "20000"),
    ("q203", "2000"),
];

const EVERYBODY: [Writer; 5] = [
    Writer::Editor,
    Writer::Page,
    Writer::Program,
    Writer::Plc,
    Writer::Control,
];

/// Who is held back from the value of a parameter, and by what.
fn held_back(memory: &Memory, text: &str) -> Vec<(Writer, Lock)> {
    let lock = |writer| refusing(memory, writer, Part::Value, name(text)).unwrap();
    let all = EVERYBODY.into_iter();
    all.filter_map(|writer| Some((writer, lock(writer)?))).collect()
}

/// A closed switch chooses its definition, P11008 that of P11018 [002:5235-5270] [002:5318-5365]; the active locks follow
/// when they are updated.
#[test]
fn switches_choose_locks() {
    let pairs = [
        ("P11000", "P11010"),
        ("P11001", "P11011"),
        ("P11002", "P11012"),
        ("P11003", "P11013"),
        ("P11008", "P11018"),
    ];
    for (switch, definition) in pairs {
        // Locks 1 and 4, cycles, tools.
        let mut memory = memory(&[(definition, "$10020009"), (switch, "1")]);
        let active = |memory: &Memory| -> Vec<Lock> {
            let active = Locks::active(memory);
            Lock::ALL.into_iter().filter(|lock| active.has(*lock)).collect()
        };
        assert_eq!(active(&memory), [], "not before the change is taken");
        memory.update_locks(Channels::NONE);
        let wanted = [
            Lock::Parameters(1),
            Lock::Parameters(4),
            Lock::Cycles,
            Lock::Tools,
        ];
        assert_eq!(active(&memory), wanted, "{switch}");
        assert_eq!(Locks::chosen(&memory, Channels::NONE), Locks::active(&memory));
        memory.write(name(switch), Value::Cleared).unwrap();
        memory.update_locks(Channels::NONE);
        assert_eq!(active(&memory), []);
    }
}

/// P11020 to P11023, P11036, P11037 and P11044 to P11049 are 1 for a lock that is active, else 0 [002:5370-5417].
#[test]
fn active_locks_have_parameters() {
    let of = |definition: &str| -> Vec<String> {
        let mut memory = memory(&[("P11010", definition), ("P11000", "1")]);
        memory.update_locks(Channels::NONE);
        let all = (11_020..11_050).map(|number| Name::P(1, number));
        let value = |name: Name| memory.cell(name).unwrap().number();
        let known: Vec<_> = all.filter(|name| value(*name).is_some()).collect();
        assert_eq!(known.len(), 12);
        let active = known.into_iter().filter(|name| value(*name) == Some(1.0));
        active.map(|name| name.to_string()).collect()
    };
    for (definition, parameters) in [
        ("$00000001", &["P11020"][..]),
        ("$00000008", &["P11023"]),
        ("$00010000", &["P11036"]),
        ("$00020000", &["P11037"]),
        ("$01000000", &["P11044"]),
        ("$02000000", &["P11045"]),
        ("$04000000", &["P11046"]),
        ("$08000000", &["P11047"]),
        ("$10000000", &["P11048"]),
        ("$20000000", &["P11049"]),
        // What is free locks nothing.
        ("$C0FCFFF0", &[]),
    ] {
        assert_eq!(of(definition), parameters, "{definition}");
    }
}

/// In AUTO P8510 of the channel counts beside the switches: parameter locks, programs, cycles [002:3387-3411].
#[test]
fn auto_locks_more() {
    let mut memory = memory(&MACHINE);
    memory
        .write(name("2:P8510"), "$FF030002".parse().unwrap())
        .unwrap();
    memory
        .write(name("P11010"), "$00000001".parse().unwrap())
        .unwrap();
    memory.write(name("P11000"), "1".parse().unwrap()).unwrap();
    let mut active = |auto| {
        memory.update_locks(auto);
        Lock::ALL
            .into_iter()
            .filter(|lock| Locks::active(&memory).has(*lock))
            .collect::<Vec<_>>()
    };
    let one = Lock::Parameters(1);
    assert_eq!(active(Channels::NONE), [one]);
    assert_eq!(active(Channels::one(1)), [one], "its own P8510 is cleared");
    let both = [one, Lock::Parameters(2), Lock::Programs, Lock::Cycles];
    assert_eq!(active(Channels::one(2)), both, "no editing locks");
    assert_eq!(active(Channels::up_to(2)), both);
}

/// A parameter lock holds operator and program back, not the PLC, and not from the status [002:340-362].
#[test]
fn parameter_locks_hold_values_back() {
    let mut memory = memory(&MACHINE);
    memory
        .set_status(name("P100"), Status::from_word(0x000A_0000))
        .unwrap();
    let held = [Writer::Editor, Writer::Page, Writer::Program];
    for (lock, holds) in [(1, false), (2, true), (3, false), (4, true)] {
        memory.set_lock(lock, true);
        let wanted: Vec<_> = held
            .iter()
            .filter(|_| holds)
            .map(|writer| (*writer, Lock::Parameters(lock)))
            .collect();
        assert_eq!(held_back(&memory, "P100"), wanted, "{lock}");
        assert_eq!(held_back(&memory, "P101"), [], "it has no lock");
        for writer in EVERYBODY {
            assert_eq!(refusing(&memory, writer, Part::Status, name("P100")), Ok(None));
        }
        memory.set_lock(lock, false);
    }
}

/// Editing locks hold back who edits at the panel, where the data belong to them [002:5342-5358].
#[test]
fn editing_locks_hold_the_panel_back() {
    let mut memory = memory(&MACHINE);
    let mut with = |definition: &str| {
        memory.write(name("P11018"), definition.parse().unwrap()).unwrap();
        memory.write(name("P11008"), "1".parse().unwrap()).unwrap();
        memory.update_locks(Channels::NONE);
        memory.clone()
    };
    let values = with("$01000000");
    for text in ["P100", "P12004", "P20000", "P21000"] {
        assert_eq!(
            held_back(&values, text),
            [(Writer::Editor, Lock::Values)],
            "{text}"
        );
    }
    for (definition, lock, texts, others) in [
        (
            "$04000000",
            Lock::Axes,
            &["P12004", "q2004", "q2204", "P11480", "P11640", "q1799"][..],
            &["P100", "P20000", "P21000", "P11479", "P11800"][..],
        ),
        (
            "$08000000",
            Lock::ZeroPoints,
            &["P20000", "P20020", "q18000"],
            &["P12004", "P20021", "P21000"],
        ),
        (
            "$10000000",
            Lock::Tools,
            &["P21000", "P21199", "q19000"],
            &["P12004", "P20000", "P21200"],
        ),
    ] {
        let memory = with(definition);
        for text in texts {
            assert_eq!(
                held_back(&memory, text),
                [(Writer::Editor, lock), (Writer::Page, lock)],
                "{text}"
            );
        }
        for text in others {
            assert_eq!(held_back(&memory, text), [], "{text}");
        }
    }
    let statuses = with("$02000000");
    assert_eq!(held_back(&statuses, "P100"), []);
    for writer in EVERYBODY {
        let lock = refusing(&statuses, writer, Part::Status, name("P100")).unwrap();
        let at_panel = matches!(writer, Writer::Editor | Writer::Page);
        assert_eq!(lock, at_panel.then_some(Lock::Statuses));
    }
}

#[test]
fn a_refused_entry_changes_nothing() {
    let mut memory = memory(&MACHINE);
    memory
        .write(name("P11018"), "$03010000".parse().unwrap())
        .unwrap();
    memory.write(name("P11008"), "1".parse().unwrap()).unwrap();
    memory.update_locks(Channels::NONE);
    let before = memory.clone();
    let p = name("P100");
    let value: Value = "5".parse().unwrap();
    assert_eq!(memory.enter(p, value), Err(SpaceError::Closed(p, Lock::Values)));
    let status = Status::from_word(0x0300_0000);
    let refused = memory.enter_status(Writer::Editor, p, status).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "P100 is locked by the editing lock of statuses"
    );
    assert_eq!(memory, before);
    assert!(
        memory.is_program_locked(ProgramName::Program(1000))
            && !memory.is_program_locked(ProgramName::Cycle(6))
    );
    memory.enter_as(Writer::Program, p, value).unwrap();
    memory.enter_status(Writer::Plc, p, status).unwrap();
    // The four bytes are 5 still, and the status has three decimals.
    assert_eq!(memory.cell(p).unwrap().written(), "0.005");
    let nowhere = name("P6000");
    assert!(matches!(
        refusing(&memory, Writer::Plc, Part::Value, nowhere),
        Err(SpaceError::BeyondBlock { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What is active is what a closed switch names, whatever else the words have; the PLC writes past all of it.
    #[test]
    fn active_is_what_closed_switches_name(
        words in proptest::array::uniform5(any::<u32>()), closed in 0u8..32, auto in any::<u32>(), in_auto in any::<bool>(),
    ) {
        let mut memory = memory(&MACHINE);
        let mut wanted = 0;
        for (at, (place, word)) in [0u32, 1, 2, 3, 8].into_iter().zip(words).enumerate() {
            let is_closed = closed >> at & 1 != 0;
            memory.write(Name::P(1, 11_010 + place), format!("${word:X}").parse().unwrap()).unwrap();
            memory.write(Name::P(1, 11_000 + place), u8::from(is_closed).to_string().parse().unwrap()).unwrap();
            wanted |= if is_closed { word } else { 0 };
        }
        memory.write(name("P8510"), format!("${auto:X}").parse().unwrap()).unwrap();
        wanted |= if in_auto { auto & 0x0003_000F } else { 0 };
        memory.update_locks(if in_auto { Channels::one(1) } else { Channels::NONE });
        for (lock, bit) in Lock::ALL.into_iter().zip([0u32, 1, 2, 3, 16, 17, 24, 25, 26, 27, 28, 29]) {
            prop_assert_eq!(memory.is_locked(lock), wanted >> bit & 1 != 0, "{}", lock);
        }
        memory.set_status(name("P100"), Status::from_word(0x000F_0000)).unwrap();
        let held = memory.enter_as(Writer::Program, name("P100"), "1".parse().unwrap()).is_err();
        prop_assert_eq!(held, wanted & 0xF != 0);
        prop_assert!(memory.enter_as(Writer::Plc, name("P100"), "2".parse().unwrap()).is_ok());
    }
}
