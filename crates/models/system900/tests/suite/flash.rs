//! The FLASH: functions of q10, its file, and what the starting routine makes of it.

use bahn_system900::{
    Flash, FlashError, FlashScene, Listing, Memory, Name, NoFlash, ProgramName, Programs, Reset,
    STORED_BYTES_MAX, STORED_MAX, Status, waits_for_key,
};
use proptest::prelude::*;

use crate::memory::{memory, name};

const STORED: u32 = 0x2000_0000;

const MACHINE: [(&str, &str); 7] = [
    ("q102", "10000"),
    ("q103", "5000"),
    ("q104", "18000"),
    ("q105", "2000"),
    ("q110", "$01010058"),
    ("q111", "$02020059"),
    ("q4", "7"),
];

/// A machine of which some parameters have the bit to be stored.
fn marked(names: &[&str]) -> Memory {
    let mut memory = memory(&MACHINE);
    for text in names {
        let status = memory.cell(name(text)).unwrap().status();
        let word = u32::from_str_radix(status.to_string().trim_start_matches('$'), 16).unwrap();
        memory
            .set_status(name(text), Status::from_word(word | STORED))
            .unwrap();
    }
    memory
}

fn programs(all: &[(&str, &[u8])]) -> Programs {
    let mut programs = Programs::default();
    for (text, bytes) in all {
        programs.insert(text.parse().unwrap(), bytes.to_vec());
    }
    programs
}

fn listed(programs: &Programs) -> Vec<String> {
    programs.iter().map(|(name, _)| name.to_string()).collect()
}

/// Runs a function in HAND.
fn run(
    flash: &mut Flash,
    number: i64,
    memory: &mut Memory,
    programs: &mut Programs,
) -> Result<usize, FlashError> {
    flash.run(
        number,
        FlashScene {
            memory,
            programs,
            is_in_hand: true,
            is_reading: false,
        },
    )
}

fn number(memory: &Memory, text: &str) -> Option<f64> {
    memory.cell(name(text)).unwrap().number()
}

/// 170 stores what is marked, 190 writes q0 to q999 back, 200 all others, 120 erases [002:434-484].
#[test]
fn parameters_are_stored() {
    let mut memory = marked(&["q102", "q103", "q110", "P5", "P6", "P12153", "q10", "q11"]);
    memory.write(name("P5"), "1.25".parse().unwrap()).unwrap();
    memory.write(name("P12153"), "-3".parse().unwrap()).unwrap();
    memory.write(name("P7"), "9".parse().unwrap()).unwrap();
    let (mut flash, mut nc) = (Flash::default(), Programs::default());
    assert_eq!(
        run(&mut flash, 170, &mut memory, &mut nc),
        Ok(6),
        "P6 as cleared; no commands"
    );
    let stored = memory.clone();
    for (text, value) in [
        ("q102", "12000"),
        ("P5", "0"),
        ("P6", "4"),
        ("P7", "8"),
        ("P12153", "5"),
    ] {
        memory.write(name(text), value.parse().unwrap()).unwrap();
    }
    assert_eq!(run(&mut flash, 190, &mut memory, &mut nc), Ok(3));
    let values = |memory: &Memory| ["q102", "P5", "P6", "P7", "P12153"].map(|text| number(memory, text));
    // With q102 as before P5 to P7 lie where they were stored; what was written meanwhile lies elsewhere.
    assert_eq!(
        values(&memory),
        [Some(10_000.0), Some(1.25), None, Some(9.0), Some(5.0)]
    );
    for (text, value) in [("P5", "0"), ("P6", "4"), ("P7", "8")] {
        memory.write(name(text), value.parse().unwrap()).unwrap();
    }
    assert_eq!(run(&mut flash, 200, &mut memory, &mut nc), Ok(3));
    assert_eq!(
        values(&memory),
        [Some(10_000.0), Some(1.25), None, Some(8.0), Some(-3.0)],
        "P7 is not stored"
    );
    assert_eq!(
        memory.cell(name("P5")),
        stored.cell(name("P5")),
        "with its status"
    );
    assert_eq!(run(&mut flash, 120, &mut memory, &mut nc), Ok(6));
    assert_eq!(
        (flash.parameters(), run(&mut flash, 200, &mut memory, &mut nc)),
        (0, Ok(0))
    );
}

/// At most 14000 parameters and 262 kBytes of programs [002:446-447] [002:469-470].
#[test]
fn what_is_too_much_is_refused() {
    let mut memory = memory(&MACHINE);
    let (mut flash, mut nc) = (Flash::default(), Programs::default());
    let most = u32::try_from(STORED_MAX).unwrap();
    for number in 9000..9000 + most {
        memory
            .set_status(Name::Q(number), Status::from_word(STORED))
            .unwrap();
    }
    assert_eq!(run(&mut flash, 170, &mut memory, &mut nc), Ok(14_000));
    memory
        .set_status(Name::Q(8999), Status::from_word(STORED))
        .unwrap();
    let before = flash.clone();
    assert_eq!(
        run(&mut flash, 170, &mut memory, &mut nc),
        Err(FlashError::TooManyParameters(14_001))
    );
    nc.insert(ProgramName::Program(1), vec![b'N'; STORED_BYTES_MAX - 1]);
    assert_eq!(run(&mut flash, 175, &mut memory, &mut nc), Ok(1));
    assert_eq!(flash.parameters(), before.parameters());
    nc.insert(ProgramName::Cycle(6), vec![b'N'; 2]);
    let before = flash.clone();
    for function in [175, 176] {
        assert_eq!(
            run(&mut flash, function, &mut memory, &mut nc),
            Err(FlashError::TooManyBytes(262_145))
        );
    }
    assert_eq!(flash, before);
    assert_eq!(
        FlashError::TooManyBytes(262_145).to_string(),
        "q10: the programs have 262145 bytes, and 262144 go in"
    );
}

/// 175 stores programs and cycles, 176 cycles, 205 writes them back, 125 erases [002:466-484]; 500 and 501 choose what the
/// directory shows [002:488-489].
#[test]
fn programs_are_stored() {
    let mut memory = memory(&MACHINE);
    let mut nc = programs(&[("P1000", b"N10 X1\n"), ("Z6", b"N10 M30\n"), ("Z234", b"")]);
    let mut flash = Flash::default();
    assert_eq!(run(&mut flash, 176, &mut memory, &mut nc), Ok(2));
    assert_eq!(listed(flash.programs()), ["Z6", "Z234"]);
    assert_eq!(run(&mut flash, 175, &mut memory, &mut nc), Ok(3));
    assert_eq!(flash.programs(), &nc);
    // Cycles anew leave the programs that are stored.
    nc.remove(ProgramName::Cycle(234));
    nc.insert(ProgramName::Program(1000), b"N10 X2\n".to_vec());
    assert_eq!(run(&mut flash, 176, &mut memory, &mut nc), Ok(1));
    assert_eq!(listed(flash.programs()), ["P1000", "Z6"]);
    nc.insert(ProgramName::Program(2), Vec::new());
    assert_eq!(run(&mut flash, 205, &mut memory, &mut nc), Ok(2));
    assert_eq!(listed(&nc), ["P2", "P1000", "Z6"]);
    assert_eq!(nc.get(ProgramName::Program(1000)), Some(&b"N10 X1\n"[..]));
    assert_eq!(flash.listing(), Listing::Memory);
    for (function, listing) in [(501, Listing::Flash), (500, Listing::Memory)] {
        assert_eq!(run(&mut flash, function, &mut memory, &mut nc), Ok(0));
        assert_eq!(flash.listing(), listing);
    }
    assert_eq!(run(&mut flash, 125, &mut memory, &mut nc), Ok(2));
    assert_eq!(flash.programs().count(), 0);
}

/// 510 to 531 are executed only with their number in q11, which counts once [002:491-521].
#[test]
fn switches_are_confirmed() {
    let (mut memory, mut nc, mut flash) = (memory(&MACHINE), Programs::default(), Flash::default());
    let state = |flash: &Flash| {
        let switches = flash.switches();
        (switches.no_dll, switches.no_dma, switches.plc_big)
    };
    for (function, wanted) in [
        (521, (false, true, false)),
        (531, (false, true, true)),
        (510, (true, true, true)),
        (520, (true, false, true)),
        (530, (true, false, false)),
    ] {
        let before = state(&flash);
        for confirmation in ["--", "1", "511"] {
            memory.write(name("q11"), confirmation.parse().unwrap()).unwrap();
            let refused = Err(FlashError::NotConfirmed(function));
            assert_eq!(run(&mut flash, function, &mut memory, &mut nc), refused);
        }
        assert_eq!(state(&flash), before);
        memory
            .write(name("q11"), function.to_string().parse().unwrap())
            .unwrap();
        assert_eq!(run(&mut flash, function, &mut memory, &mut nc), Ok(0));
        assert_eq!((state(&flash), number(&memory, "q11")), (wanted, None));
        assert_eq!(Flash::read(&flash.bytes()).map(|flash| state(&flash)), Ok(wanted));
    }
}

/// Only in HAND; 99 while a file is read [002:403-430].
#[test]
fn functions_are_for_hand() {
    let (mut memory, mut nc, mut flash) = (memory(&MACHINE), Programs::default(), Flash::default());
    memory.write(name("q11"), "510".parse().unwrap()).unwrap();
    let before = memory.clone();
    for function in [
        120, 125, 170, 175, 176, 190, 200, 205, 500, 501, 510, 520, 521, 530, 531,
    ] {
        let scene = FlashScene {
            memory: &mut memory,
            programs: &mut nc,
            is_in_hand: false,
            is_reading: false,
        };
        assert_eq!(
            flash.run(function, scene),
            Err(FlashError::NotInHand),
            "{function}"
        );
    }
    assert_eq!(
        run(&mut flash, 99, &mut memory, &mut nc),
        Err(FlashError::NotReading)
    );
    let scene = FlashScene {
        memory: &mut memory,
        programs: &mut nc,
        is_in_hand: false,
        is_reading: true,
    };
    assert_eq!(flash.run(99, scene), Ok(0));
    for unknown in [0, 1, 98, 121, 511, 999, -1, i64::MAX] {
        assert_eq!(
            run(&mut flash, unknown, &mut memory, &mut nc),
            Err(FlashError::NoFunction(unknown))
        );
    }
    assert_eq!((memory, flash), (before, Flash::default()));
}

/// `Reset NC memory` clears programs and writes those of the FLASH back; q52 says it, q53 until the user clears it
/// [002:472-478] [002:589-595].
#[test]
fn the_nc_memory_is_written_back() {
    let mut memory = memory(&MACHINE);
    let mut nc = programs(&[("P1000", b"N10\n"), ("Z6", b"")]);
    let mut flash = Flash::default();
    run(&mut flash, 175, &mut memory, &mut nc).unwrap();
    nc.insert(ProgramName::Program(1), Vec::new());
    let info = |memory: &Memory| [50, 51, 52, 53].map(|q| memory.cell(Name::Q(q)).unwrap().number());
    Reset::default().start(&mut memory, &mut nc, &flash);
    assert_eq!(listed(&nc), ["P1", "P1000", "Z6"]);
    assert_eq!(info(&memory), [Some(0.0), None, Some(0.0), None]);
    Reset {
        programs: true,
        parameters: false,
    }
    .start(&mut memory, &mut nc, &flash);
    assert_eq!(listed(&nc), ["P1000", "Z6"]);
    assert_eq!(info(&memory), [Some(0.0), None, Some(1.0), Some(1.0)]);
    Reset::default().start(&mut memory, &mut nc, &flash);
    assert_eq!(
        info(&memory),
        [Some(0.0), None, Some(0.0), Some(1.0)],
        "q53 stays"
    );
    memory.write(name("q53"), "0".parse().unwrap()).unwrap();
    Reset::default().start(&mut memory, &mut nc, &flash);
    assert_eq!(info(&memory)[3], Some(0.0), "the user has cleared it");
}

/// `Clear parameter` leaves what the FLASH has; q50 and q51 say it, q53 of another time stays [002:522-533] [002:580-595].
#[test]
fn parameters_are_written_back() {
    let mut memory = marked(&["q102", "q103", "q110", "P5"]);
    memory.write(name("P5"), "1.25".parse().unwrap()).unwrap();
    let (mut flash, mut nc) = (Flash::default(), programs(&[("P1", b"")]));
    run(&mut flash, 170, &mut memory, &mut nc).unwrap();
    memory.write(name("P5"), "7".parse().unwrap()).unwrap();
    memory.write(name("q53"), "1".parse().unwrap()).unwrap();
    memory.write(name("P11000"), "1".parse().unwrap()).unwrap();
    Reset {
        parameters: true,
        programs: false,
    }
    .start(&mut memory, &mut nc, &flash);
    assert_eq!(
        ["q102", "P5"].map(|text| number(&memory, text)),
        [Some(10_000.0), Some(1.25)]
    );
    assert_eq!(
        (number(&memory, "q4"), number(&memory, "q104")),
        (None, None),
        "they were not stored"
    );
    let info = [50, 51, 52, 53].map(|q| memory.cell(Name::Q(q)).unwrap().number());
    assert_eq!(info, [Some(1.0), Some(1.0), Some(0.0), Some(1.0)]);
    assert_eq!(listed(&nc), ["P1"]);
}

/// Another number of parameters formats the NC memory when parameters are cleared [002:373-374] [002:384-385].
#[test]
fn another_size_formats_the_nc_memory() {
    let mut memory = marked(&["q102", "q103"]);
    memory.write(name("q3"), "40000".parse().unwrap()).unwrap();
    memory.set_status(name("q3"), Status::from_word(STORED)).unwrap();
    let (mut flash, mut nc) = (Flash::default(), programs(&[("P1", b"")]));
    run(&mut flash, 170, &mut memory, &mut nc).unwrap();
    Reset::default().start(&mut memory, &mut nc, &flash);
    assert_eq!(
        (memory.count(), listed(&nc).len()),
        (30_000, 1),
        "not without clearing"
    );
    Reset {
        parameters: true,
        programs: false,
    }
    .start(&mut memory, &mut nc, &flash);
    assert_eq!((memory.count(), listed(&nc).len()), (40_000, 0));
    assert_eq!(number(&memory, "q52"), Some(1.0));
    Reset {
        parameters: true,
        programs: false,
    }
    .start(&mut memory, &mut nc, &flash);
    assert_eq!(number(&memory, "q52"), Some(0.0), "the same number");
}

/// Key switch 1 lets the starting routine run through, unless something was cleared [002:5252-5262].
#[test]
fn the_key_lets_the_start_run_through() {
    let mut memory = memory(&MACHINE);
    assert!(waits_for_key(&memory));
    memory.write(name("P11000"), "1".parse().unwrap()).unwrap();
    assert!(!waits_for_key(&memory));
    for q in ["q50", "q52"] {
        memory.write(name(q), "1".parse().unwrap()).unwrap();
        assert!(waits_for_key(&memory), "{q}");
        memory.write(name(q), "0".parse().unwrap()).unwrap();
    }
}

/// The starting routine counts axes [002:376-379] [002:3447-3451], and resets what is for one day [002:4020-4048]
/// [002:4793-4828].
#[test]
fn the_start_counts_axes() {
    let mut memory = memory(&[
        ("q2", "2"),
        ("q102", "10000"),
        ("q103", "5000"),
        ("q110", "$00010058"),
        ("q112", "$00030059"),
        ("q113", "$00000041"),
        ("q202", "20000"),
        ("q203", "2000"),
        ("q214", "$00010058"),
        ("P8757", "17"),
        ("2:P8893", "3"),
    ]);
    Reset::default().start(&mut memory, &mut Programs::default(), &Flash::default());
    assert_eq!(number(&memory, "q1"), Some(2.0), "physical axes 1 and 3");
    let of = |channel| [8550, 8551, 8552].map(|p| memory.cell(Name::P(channel, p)).unwrap().number());
    assert_eq!(of(1), [Some(1.0), Some(2.0), Some(3.0)]);
    assert_eq!(of(2), [Some(2.0), Some(1.0), Some(5.0)]);
    assert_eq!(
        (number(&memory, "P8757"), number(&memory, "2:P8893")),
        (None, None)
    );
}

/// After `Clear parameter` positions, zero points and tool data have the decimals of q159, and lengths of linear axes, of
/// zero points, tools in use and feeds have the inch bit [002:954-965] [002:6335-6350].
#[test]
fn statuses_after_clearing() {
    let stored = [
        "q102", "q103", "q104", "q105", "q110", "q111", "q159", "q170", "q171", "q173", "q175", "q176",
        "q178",
    ];
    let mut memory = marked(&[]);
    let array = [
        ("q170", "20000"),
        ("q171", "1"),
        ("q173", "3"),
        ("q175", "21000"),
        ("q176", "2"),
        ("q178", "20"),
    ];
    for (text, value) in array.into_iter().chain([("q159", "4"), ("q2201", "1")]) {
        memory.write(name(text), value.parse().unwrap()).unwrap();
    }
    for text in stored {
        memory.set_status(name(text), Status::from_word(STORED)).unwrap();
    }
    let (mut flash, mut nc) = (Flash::default(), Programs::default());
    run(&mut flash, 170, &mut memory, &mut nc).unwrap();
    // Its status comes back as it was stored.
    memory
        .set_status(name("P20001"), Status::from_word(STORED | 0x0200_0000))
        .unwrap();
    memory
        .set_status(name("q2201"), Status::from_word(STORED))
        .unwrap();
    run(&mut flash, 170, &mut memory, &mut nc).unwrap();
    Reset {
        parameters: true,
        programs: false,
    }
    .start(&mut memory, &mut nc, &flash);
    let status = |text: &str| {
        let status = memory.cell(name(text)).unwrap().status();
        (status.decimals(), status.is_length())
    };
    for (text, wanted) in [
        ("P20000", (4, true)),
        ("P20020", (4, true)),
        ("P20021", (0, false)),
        ("P20001", (2, false)),
        ("P21009", (0, false)),
        ("P21010", (4, false)),
        ("P21031", (4, false)),
        ("P8110", (0, true)),
        ("P8163", (0, true)),
        ("P8164", (0, false)),
        ("P8754", (0, true)),
        ("P8815", (0, true)),
        ("P8814", (0, false)),
        ("P12150", (4, false)),
        ("P12169", (4, false)),
        ("P12170", (0, false)),
        ("P12153", (4, true)),
        ("P12157", (4, true)),
    ] {
        assert_eq!(status(text), wanted, "{text}");
    }
    // The second axis is a rotary one, P12001 = 1.
    assert_eq!((status("P12353"), status("P12350")), ((4, false), (4, false)));
    // Without q159 there are three decimals.
    let plain = marked(&["q102", "q103", "q110"]);
    let (mut memory, mut flash) = (plain, Flash::default());
    run(&mut flash, 170, &mut memory, &mut nc).unwrap();
    Reset {
        parameters: true,
        programs: false,
    }
    .start(&mut memory, &mut nc, &flash);
    assert_eq!(memory.cell(name("P12150")).unwrap().status().decimals(), 3);
}

/// Something in a FLASH.
fn flash() -> impl Strategy<Value = Flash> {
    let parameters = proptest::collection::vec((4u32..30_000, any::<i32>(), any::<u32>()), 0..40);
    let own = proptest::collection::vec((1u8..=2, 12_153u32..=12_157, any::<i16>()), 0..4);
    let bytes = proptest::collection::vec(any::<u8>(), 0..60);
    let programs = proptest::collection::vec((any::<bool>(), any::<u32>(), bytes), 0..6);
    (parameters, own, programs, any::<bool>()).prop_map(|(parameters, own, all, is_big)| {
        let mut memory = memory(&[]);
        for (number, value, word) in parameters
            .into_iter()
            .filter(|(number, ..)| !(100..1000).contains(number))
        {
            memory
                .write(Name::Q(number), format!("${value:X}").parse().unwrap())
                .unwrap();
            memory
                .set_status(Name::Q(number), Status::from_word(word | STORED))
                .unwrap();
        }
        for (text, value) in [
            ("q2", "2"),
            ("q110", "$00010058"),
            ("q210", "$00010058"),
            ("q11", "531"),
        ] {
            memory.set_status(name(text), Status::default()).unwrap();
            memory.write(name(text), value.parse().unwrap()).unwrap();
        }
        for (channel, number, value) in own {
            let name = Name::P(channel, number);
            memory.write(name, value.to_string().parse().unwrap()).unwrap();
            memory.set_status(name, Status::from_word(STORED)).unwrap();
        }
        let mut nc = Programs::default();
        for (is_cycle, number, bytes) in all {
            let name = if is_cycle {
                ProgramName::Cycle(number)
            } else {
                ProgramName::Program(number)
            };
            nc.insert(name, bytes);
        }
        let mut flash = Flash::default();
        for function in [170, 175] {
            run(&mut flash, function, &mut memory, &mut nc).unwrap();
        }
        if is_big {
            run(&mut flash, 531, &mut memory, &mut nc).unwrap();
        }
        flash
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// What is written is read again; whatever is missing at its end, or is another byte, is noticed.
    #[test]
    fn the_file_of_a_flash_is_whole(flash in flash(), at in any::<prop::sample::Index>(), bit in 0u8..8) {
        let bytes = flash.bytes();
        prop_assert_eq!(Flash::read(&bytes), Ok(flash));
        for length in 0..bytes.len() {
            prop_assert_eq!(Flash::read(&bytes[..length]), Err(NoFlash::NotWhole), "{} of {}", length, bytes.len());
        }
        let mut other = bytes.clone();
        other[at.index(bytes.len())] ^= 1 << bit;
        prop_assert!(Flash::read(&other).is_err());
        other.clone_from(&bytes);
        other.push(b'\n');
        prop_assert!(Flash::read(&other).is_err());
    }

    /// Any bytes are read without harm.
    #[test]
    fn any_bytes_are_no_flash(bytes in proptest::collection::vec(any::<u8>(), 0..100)) {
        prop_assert!(Flash::read(&bytes).is_err());
    }

    /// A check sum that fits does not make a FLASH of lines that say nothing.
    #[test]
    fn lines_say_something(line in "[qprogam1-3:$ a-f\\-]{0,20}") {
        let mut bytes = format!("bahn flash 1\n{line}\n").into_bytes();
        let sum = crc32fast::hash(&bytes);
        bytes.extend(format!("check {sum:08x}\n").bytes());
        if let Ok(flash) = Flash::read(&bytes) {
            prop_assert_eq!(Flash::read(&flash.bytes()), Ok(flash));
        }
    }
}

#[test]
fn lines_that_say_nothing() {
    for line in [
        "q50000 1 $20000001",
        "q5 1",
        "q5 99999999999 $20000001",
        "q5 1 $2000001",
        "9:1:153 1 $20000001",
        "1:33:153 1 $20000001",
        "1:1:152 1 $20000001",
        "1:1:153:1 1 $20000001",
        "q5 1 $20000001\nq5 1 $20000001",
        "switch x",
        "program X1 0\n",
        "program P1 9\n",
        "program P1 0\n\nprogram P1 0\n",
        "",
    ] {
        let mut bytes = format!("bahn flash 1\n{line}\n").into_bytes();
        let sum = crc32fast::hash(&bytes);
        bytes.extend(format!("check {sum:08x}\n").bytes());
        assert!(matches!(Flash::read(&bytes), Err(NoFlash::Line(_))), "{line}");
    }
    assert_eq!(Flash::read(b"another file"), Err(NoFlash::Head));
    assert_eq!(Flash::read(b""), Err(NoFlash::NotWhole));
}
