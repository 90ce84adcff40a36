//! The text of a list: what is accepted, what is an error and where, and that nothing panics.

use bahn_parameters::{ControlModel, Definition, ParameterError, ParameterId, ParameterList};
use proptest::prelude::*;

fn id(number: u16, index: impl Into<Option<u8>>) -> ParameterId {
    ParameterId {
        number,
        index: index.into(),
    }
}

#[test]
fn nine_spellings_of_one_value() {
    for text in [
        "MP7420:4",
        "MP7420 : 4 ;comment",
        "7420=4",
        "7420 4",
        "mp 7420 = %100",
        "MP7420:$4;hex",
        "MP7420.0:4",
        "\t7420 : 4,0 ",
        "MP7420:%00 100",
    ] {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        assert_eq!(list.read(text.as_bytes()), [], "{text}");
        assert_eq!(list.get(7420, 0), Some(4.0), "{text}");
    }
}

#[test]
fn comments_blank_lines_and_frames_are_skipped() {
    let mut list = ParameterList::reference(ControlModel::Tnc407);
    let text = "\u{feff}\r\n; MP7430 : 0.5\r\n* MP7430 : 0.6\r\n\u{2}MP7430 : 0.7 ;0.8\r\n\u{3}";
    assert_eq!(list.read(text.as_bytes()), []);
    assert_eq!(list.get(7430, 0), Some(0.7));
    assert_eq!(
        list.read(b"MP7430:0.9 ;\x8Abersetzung\n"),
        [],
        "an 8-bit code page in a comment"
    );
    assert_eq!(list.get(7430, 0), Some(0.9));
}

#[test]
fn all_errors_are_found_in_one_pass_with_their_lines_and_numbers() {
    let text = "hello\nMP1:1\nMP1010:1\nMP7430:1 mm\nMP7430:x\nMP7431:0.1\nMP7410:1\nMP7410:0\nMP7411:1\n";
    let mut list = ParameterList::smallest(ControlModel::Tnc415b);
    let errors = list.read(text.as_bytes());
    let found: Vec<_> = errors.iter().map(|e| (e.span.line, e.error.number())).collect();
    // The numbers of the list editor [000:10054-10062].
    assert_eq!(found, [(1, 0), (2, 1), (3, 1), (4, 2), (5, 3), (6, 3), (8, 4)]);
    assert_eq!(errors[1].error, ParameterError::UnknownNumber(id(1, None)));
    assert_eq!(errors[2].error, ParameterError::IndexMissing(id(1010, None)));
    assert_eq!(
        errors[3].error,
        ParameterError::NoSeparator(id(7430, None), "mm".into())
    );
    assert_eq!(
        errors[4].error,
        ParameterError::NotANumber(id(7430, None), "x".into())
    );
    let range = ParameterError::OutOfRange {
        id: id(7431, None),
        value: 0.1,
        min: 0.0001,
        max: 0.016,
    };
    assert_eq!(errors[5].error, range);
    assert_eq!(
        errors[6].error,
        ParameterError::DoublyDefined {
            id: id(7410, None),
            first_line: 7
        }
    );
    // What could be read is taken.
    assert_eq!((list.get(7410, 0), list.get(7411, 0)), (Some(1.0), Some(1.0)));
}

#[test]
fn single_assignments() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for (text, number, index, value) in [
        ("7420=4", 7420, 0, 4.0),
        ("1010.0=5000", 1010, 0, 5000.0),
        ("MP7440=%00110", 7440, 0, 6.0),
    ] {
        assert_eq!(list.assign(text).err(), None, "{text}");
        assert_eq!(list.get(number, index), Some(value));
    }
    assert_eq!(
        list.assign("3240=1"),
        Err(ParameterError::IndexMissing(id(3240, None))),
        "only .1 and .2 exist"
    );
    assert_eq!(
        list.assign("9999=1"),
        Err(ParameterError::UnknownNumber(id(9999, None)))
    );
    assert_eq!(list.assign("=1"), Err(ParameterError::NoNumber));
    assert_eq!(
        list.assign("7420"),
        Err(ParameterError::NotANumber(id(7420, None), String::new()))
    );
    assert_eq!(
        list.assign("7420=1.5"),
        Err(ParameterError::NotWhole(id(7420, None), 1.5))
    );
    assert_eq!(
        list.assign("7410=0.4"),
        Err(ParameterError::NotWhole(id(7410, None), 0.4))
    );
    assert!(matches!(
        list.set(7460, 0, f64::NAN),
        Err(ParameterError::OutOfRange { .. })
    ));
}

/// MP54 goes above 1.5 m/s² from software level 08 on [001:1678]; MP237 takes the option. What is out of range on every control
/// is said first, and a refused value changes nothing.
#[test]
fn what_the_control_lacks_is_not_assigned() {
    use bahn_parameters::equipment::{Equipment, Release};
    let model = ControlModel::Tnc155;
    let mut equipment = Equipment::with_options(&[]);
    equipment.release = Some(Release::read(model, "7").unwrap());
    let mut list = ParameterList::reference(model).with_equipment(equipment);
    let before = list.clone();
    assert_eq!(
        list.assign("54=2").unwrap_err().to_string(),
        "MP54 = 2 is there from software level 08 on; this control has level 07"
    );
    assert_eq!(
        list.assign("237=1").unwrap_err().to_string(),
        "MP237 = 1 is only with the option spindle-orientation"
    );
    assert!(matches!(
        list.assign("54=4"),
        Err(ParameterError::OutOfRange { .. })
    ));
    assert_eq!(list, before);
    assert_eq!(list.assign("54=1.5").err(), None);
}

#[test]
fn values_are_rounded_to_what_is_stored() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    // MP7430 has three decimals, MP7460 four.
    list.assign("7430=1.23449").unwrap();
    list.assign("7460=12.34567").unwrap();
    assert_eq!(
        (list.get(7430, 0), list.get(7460, 0)),
        (Some(1.234), Some(12.3457))
    );
}

/// "Up to 3 decimal places can be entered in MP330" [000:3204], from 0.1 on.
#[test]
fn a_signal_period_has_three_decimals() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for (entered, stored) in [
        ("19.9996", 20.0),
        ("1.23449", 1.234),
        ("1.2346", 1.235),
        ("0.0996", 0.1),
    ] {
        list.assign(&format!("330.0={entered}")).unwrap();
        assert_eq!(list.get(330, 0), Some(stored), "{entered}");
    }
    for wrong in ["0.0994", "0", "-20"] {
        assert!(list.assign(&format!("330.0={wrong}")).is_err(), "{wrong}");
    }
    assert_eq!(list.get(330, 0), Some(0.1), "as it was");
    list.assign("330.0=20.48").unwrap();
    let text = list.to_string();
    let line = text.lines().find(|line| line.starts_with("MP330.0 ")).unwrap();
    assert!(line.starts_with("MP330.0  : 20.48 "), "{line}");
}

#[test]
fn bits_and_colours_are_written_in_their_formats() {
    let text = ParameterList::reference(ControlModel::Tnc415b).to_string();
    let line = |start: &str| text.lines().find(|line| line.starts_with(start)).unwrap();
    assert_eq!(line("MP7440 "), "MP7440   : %11010       ;Output of M functions");
    assert_eq!(line("MP7351 "), "MP7351   : $03F3F0F     ;Colour: error messages");
    assert_eq!(
        line("MP1060.3"),
        "MP1060.3 : 0.5          ;Acceleration, 4th axis"
    );
}

fn any_model() -> impl Strategy<Value = ControlModel> {
    prop::sample::select(ControlModel::ALL.as_slice())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_written_list_reads_back_the_same(
        model in any_model(),
        places in prop::collection::vec((any::<prop::sample::Index>(), 0.0..=1.0f64), 1..200),
    ) {
        let mut list = ParameterList::smallest(model);
        for (place, part) in places {
            let definition = place.get(Definition::all(model));
            let value = definition.min + part * (definition.max - definition.min);
            let id = definition.id;
            // Bit-coded parameters take whole numbers only.
            let value = if definition.decimals == 0 { value.round() } else { value };
            if definition.min.is_finite() {
                let set = list.set(id.number, id.index.unwrap_or(0), value);
                prop_assert!(matches!(set, Ok(_) | Err(ParameterError::NoChoice(..))), "{set:?}");
            }
        }
        let mut copy = ParameterList::smallest(model);
        prop_assert_eq!(copy.read(list.to_string().as_bytes()), []);
        prop_assert_eq!(copy, list);
    }

    #[test]
    fn any_bytes_are_read_without_panic_and_leave_values_in_range(
        model in any_model(),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        let mut list = ParameterList::reference(model);
        list.read(&bytes);
        list.read(list.to_string().as_bytes());
    }

    #[test]
    fn any_almost_valid_line_is_read_without_panic(
        model in any_model(),
        line in "(MP|mp|é)? ?[0-9]{0,7}[. ]?[0-9]{0,4} ?[:= ]? ?[-+%$]?[0-9A-Fa-f.,eE ]{0,25}(;.*)?",
    ) {
        let mut list = ParameterList::reference(model);
        let _ = list.assign(&line);
        list.read(line.as_bytes());
        for definition in Definition::all(model).iter().filter(|d| d.min.is_finite()) {
            let value = list.get(definition.id.number, definition.id.index.unwrap_or(0)).unwrap();
            prop_assert!((definition.min..=definition.max).contains(&value));
        }
    }
}
