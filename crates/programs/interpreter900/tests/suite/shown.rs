//! What the look-ahead shows of the block that it has read last [002:5026-5228].

use bahn_path::{ElementSource, LiveData, Step};
use bahn_reader::Reader;

use crate::support::{number, reader_with};

/// Reads so many elements and holds of a program, its first block alone where it is 0, and tells what parameters show then.
fn shown(text: &str, more: &str, cycles: &[(&str, &str)], steps: usize, names: &[&str]) -> Vec<Option<f64>> {
    let mut reader = reader_with(text, more, cycles);
    if steps == 0 {
        reader.allow(1);
        assert!(matches!(reader.next(), Step::Starved));
    }
    for _ in 0..steps {
        match reader.next() {
            Step::Element(_) => {}
            Step::Barrier(_) => reader.resume(LiveData::default()),
            _ => panic!("{text} is over"),
        }
    }
    let memory = reader.take_memory().unwrap();
    names.iter().map(|name| number(&memory, name)).collect()
}

/// What is printed as the content at the start of a program [002:5075-5143], and after G functions that change it.
#[test]
fn g_functions_are_shown_as_they_are_read() {
    const SHOWN: [&str; 19] = [
        "P9340", "P9343", "P9345", "P9350", "P9351", "P9352", "P9353", "P9358", "P9364", "P9365", "P9366",
        "P9367", "P9369", "P9370", "P9371", "P9372", "P9378", "P9379", "P9336",
    ];
    let of = |text: &str| {
        let found = shown(text, "P163: 90\n", &[], 1, &SHOWN);
        found
            .into_iter()
            .map(|one| one.unwrap() as i64)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        of("G4 F1\n"),
        [
            1, 7, 11, 17, 1, 2, 3, 29, 40, 43, 46, 147, 53, 60, 60, 60, 90, 0, 0
        ]
    );
    assert_eq!(
        of("G5 G10 G18 G28\nG44 G45 G47 G55\nG61 G62 G63 G91 F250\nG92 Y1\nG4 F1\n"),
        [
            1, 5, 10, 18, 3, 1, 2, 28, 40, 44, 45, 47, 55, 61, 62, 63, 91, 92, 250
        ]
    );
    assert_eq!(of("G2 X2 R1 F100 G64\n")[0], 2);
    assert_eq!(of("G41\nG1 X1 F1\nG1 X2\nX3\nX4\n")[8], 41);
}

/// The words of the block itself are shown while it is the last one; what it does not say is cleared.
#[test]
fn words_are_shown_as_they_are_read() {
    const SHOWN: [&str; 13] = [
        "P9341", "P9344", "P9346", "P9318", "P9319", "P9732", "P9733", "P9735", "P9739", "P9700", "P9702",
        "P9326", "P9781",
    ];
    let of = |text: &str| shown(text, "", &[], 1, &SHOWN);
    let none = None;
    assert_eq!(
        of("G2 G8 X10 I5 J0 F300 S2:70\n"),
        [
            none,
            Some(8.0),
            none,
            Some(5.0),
            Some(0.0),
            Some(5.0),
            Some(0.0),
            none,
            Some(300.0),
            Some(10.0),
            none,
            Some(70.0),
            Some(70.0)
        ]
    );
    assert_eq!(of("G4 F1.5\n")[0], Some(1.5));
    // The corner holds its block until the next one is read.
    assert_eq!(
        shown("P71:1 G12 X20 F100\n", "", &[], 0, &["P9346"]),
        [Some(12.0)]
    );
    let radius = shown(
        "G2 X2 R1.5 F100 G9\n",
        "",
        &[],
        1,
        &["P9735", "P9320", "P9734", "P9344"],
    );
    assert_eq!(radius, [Some(1.5), none, none, Some(9.0)]);
    // G and M functions in their order, with what stands after their points.
    let names = [
        "P9740", "P9741", "P9742", "P9750", "P9751", "P9752", "P9753", "P9754", "P9757",
    ];
    let found = shown(
        "N10 G1 G90 X1 F1 M7.10 M4\n",
        "P11051: $10050601\n",
        &[],
        1,
        &names,
    );
    let wanted = [1.0, 90.0, f64::NAN, 7.0, 10.0, f64::NAN, 4.0, f64::NAN, f64::NAN];
    let wanted = wanted.map(|one: f64| Some(one).filter(|one| !one.is_nan()));
    assert_eq!(found, wanted);
    let shift = shown("G92 Y2.5\nG4 F1\n", "", &[], 1, &["P9500", "P9501"]);
    assert_eq!(shift, [Some(0.0), Some(2.5)]);
}

/// Program, block, cycle and its block, level, loops.
#[test]
fn places_are_shown_as_they_are_read() {
    const SHOWN: [&str; 6] = ["P9300", "P9301", "P9303", "P9304", "P9305", "P9334"];
    let text = "N10 G91 F100 X1\nN20 M24.10.2\nN30 M77\nN40 X5\n";
    let cycles = [("Z77.900", "N5 X2\n")];
    let of = |steps| shown(text, "P11069: $00004000\n", &cycles, steps, &SHOWN);
    let found = |numbers: [f64; 6]| numbers.map(|one| Some(one).filter(|one| !one.is_nan()));
    let none = f64::NAN;
    assert_eq!(of(1), found([1000.0, 10.0, 0.0, none, none, 0.0]));
    assert_eq!(of(2), found([1000.0, 10.0, 0.0, none, none, 1.0]));
    assert_eq!(of(4), found([1000.0, 30.0, 1.0, 77.0, 5.0, 0.0]));
    assert_eq!(of(5), found([1000.0, 40.0, 0.0, none, none, 0.0]));
}
