//! The text of a list keeps its lines; faults say where they are; a list that lacks something is refused.

use bahn_parameters::{ControlModel, Definition, ListText, ParameterError, ParameterId, ParameterList};
use proptest::prelude::*;

const MODEL: ControlModel = ControlModel::Tnc415b;

fn id(number: u16, index: impl Into<Option<u8>>) -> ParameterId {
    ParameterId {
        number,
        index: index.into(),
    }
}

fn changed(text: &str, id: ParameterId, value: f64) -> String {
    let mut list = ListText::from_bytes(MODEL, text.as_bytes());
    list.set(id, value).unwrap();
    String::from_utf8(list.to_bytes()).unwrap()
}

#[test]
fn every_fault_has_line_column_length_and_the_control_s_number_and_text() {
    let text = "hello\n  MP1 : 1\nMP1010 : 1\nMP7430 : 1 mm ;c\nMP7430:x\nMP7431:0.1\nMP7410:1\nMP7410:0\n MP7420 :\nMP7320:$FFFFFFFFF\n";
    let found: Vec<_> = ListText::from_bytes(MODEL, text.as_bytes())
        .faults()
        .iter()
        .map(|f| {
            (
                f.span.line,
                f.span.column,
                f.span.length,
                f.error.number(),
                f.error.control_text(),
            )
        })
        .collect();
    // The numbers and texts of the list editor [000:10054-10062].
    assert_eq!(
        found,
        [
            (1, 1, 5, 0, "No MP number found"),
            (2, 3, 3, 1, "Invalid MP number"),
            (3, 1, 6, 1, "Invalid MP number"),
            (4, 12, 2, 2, "No separator \";\" found"),
            (5, 8, 1, 3, "Entry value incorrect"),
            (6, 8, 3, 3, "Entry value incorrect"),
            (8, 1, 6, 4, "MP doubly defined"),
            (9, 10, 0, 3, "Entry value incorrect"),
            (10, 8, 10, 6, "MP can not be stored"),
        ]
    );
}

/// MP7224.0 disables datum tables, pallet tables and text files: binary "%111 000", hexadecimal "$ 38", decimal 56
/// [000:10025-10040].
#[test]
fn the_value_of_the_manual_s_example_in_its_three_forms() {
    let value = 2f64.powi(3) + 2f64.powi(4) + 2f64.powi(5);
    for written in ["%111 000", "$ 38", "$38", "56"] {
        let text = format!("MP7224.0 : {written} ; types\n");
        let list = ListText::from_bytes(MODEL, text.as_bytes());
        assert_eq!(list.faults(), [], "{written}");
        assert_eq!(list.entries()[0].value, value, "{written}");
        let mut entered = ParameterList::reference(MODEL);
        entered.assign(&format!("MP7224.0={written}")).unwrap();
        assert_eq!(entered.get(7224, 0), Some(value), "{written}");
    }
}

/// A line with an entry that is incorrect [000:10059] takes the right one; its comment and the other lines stay.
#[test]
fn a_line_that_cannot_be_read_is_mended() {
    let text = "; mill\nMP7430 : x ;overlap\nMPX : 3\nMP7410 : 1\n";
    let mut list = ListText::from_bytes(MODEL, text.as_bytes());
    let lines: Vec<u32> = list.faults().iter().map(|fault| fault.span.line).collect();
    assert_eq!(lines, [2, 3]);
    assert_eq!(
        list.fault_of(id(7430, None)).map(|fault| fault.span.line),
        Some(2)
    );
    assert_eq!(list.fault_of(id(7410, None)), None);
    list.set(id(7430, None), 1.2).unwrap();
    list.remove_line(3);
    assert_eq!(list.faults(), []);
    let mended = String::from_utf8(list.to_bytes()).unwrap();
    assert_eq!(mended, "; mill\nMP7430   : 1.2          ;overlap\nMP7410 : 1\n");
}

/// What is mended is the value: comment and line end stay to the byte, in whatever code an editor of 1990 has written them.
#[test]
fn a_mended_line_keeps_its_bytes() {
    for (text, mended) in [
        (
            &b"MP7430 : x ;\xDCberlappung\n"[..],
            &b"MP7430   : 1.2          ;\xDCberlappung\n"[..],
        ),
        (
            b"MP7430 : \xDC;\x81 ;; \xC3\xBC\r\nMP7410 : 1\n",
            b"MP7430   : 1.2          ;\x81 ;; \xC3\xBC\r\nMP7410 : 1\n",
        ),
        (b"MP7430 : x ;last", b"MP7430   : 1.2          ;last"),
    ] {
        let mut list = ListText::from_bytes(MODEL, text);
        list.set(id(7430, None), 1.2).unwrap();
        let found = list.to_bytes();
        assert_eq!(found, mended, "{}", found.escape_ascii());
    }
    // Without a comment the line gets its name, and keeps its end.
    let mut list = ListText::from_bytes(MODEL, b"MP7430 : \xDC\r\nMP7410 : 1\n");
    list.set(id(7430, None), 1.2).unwrap();
    let found = list.to_bytes();
    let after = found.strip_prefix(b"MP7430   : 1.2          ;").unwrap();
    assert!(after.ends_with(b"\r\nMP7410 : 1\n"), "{}", found.escape_ascii());
    assert_eq!(list.faults(), []);
}

#[test]
fn a_list_that_lacks_parameters_is_refused_with_all_of_them() {
    let faults = ParameterList::load(MODEL, b"MP10 : %00111\nMP7430 : 1.2\n").unwrap_err();
    assert!(
        faults
            .iter()
            .all(|fault| fault.error.number() == 5 && fault.span.line == 2)
    );
    let missing = |id| {
        faults
            .iter()
            .any(|fault| fault.error == ParameterError::NotDefined(id))
    };
    assert!(missing(id(1010, 0)) && missing(id(7460, None)) && !missing(id(10, None)));
    // MP7264 belongs to old software versions, MP1391 to new ones.
    assert!(!missing(id(7264, None)) && !missing(id(1391, None)));
    let required = Definition::all(MODEL)
        .iter()
        .filter(|row| !row.is_optional())
        .count();
    assert_eq!(faults.len(), required - 2);
}

#[test]
fn a_list_without_entries_is_the_list_that_the_control_makes() {
    for text in ["", "\n\n", "; nothing yet\n"] {
        assert_eq!(
            ParameterList::load(MODEL, text.as_bytes()),
            Ok(ParameterList::smallest(MODEL)),
            "{text:?}"
        );
    }
    // One entry that cannot be read is a list all the same.
    assert!(ParameterList::load(MODEL, b"MP7430 : x").is_err());
}

#[test]
fn a_completed_list_is_taken() {
    for model in ControlModel::ALL {
        let mut text = ListText::from_bytes(model, ParameterList::reference_text(model).as_bytes());
        text.complete();
        assert_eq!(text.all_faults(), [], "{model}");
        assert_eq!(text.missing().count(), 0, "{model}");
        assert_eq!(
            ParameterList::load(model, &text.to_bytes()),
            Ok(ParameterList::reference(model)),
            "{model}"
        );
        // What was there stays as it was.
        let bytes = text.to_bytes();
        assert!(
            bytes.starts_with(ParameterList::reference_text(model).as_bytes()),
            "{model}"
        );
        let before = text.clone();
        text.complete();
        assert_eq!(text, before, "{model}: complete already");
    }
}

#[test]
fn a_value_changes_in_its_place_and_comments_keep_their_column() {
    let text = "; mill\nMP7430 : 1.2     ;overlap\n\n* old\nMP7420:%00000\n";
    assert_eq!(
        changed(text, id(7430, None), 0.75),
        "; mill\nMP7430 : 0.75    ;overlap\n\n* old\nMP7420:%00000\n"
    );
    assert_eq!(
        changed(text, id(7420, 0), 5.0),
        "; mill\nMP7430 : 1.2     ;overlap\n\n* old\nMP7420:%00101\n",
        "in the format of the parameter"
    );
    // A value that does not fit pushes the comment, one blank stays.
    assert_eq!(
        changed("MP1010.0 : 15 ;c", id(1010, 0), 15_000.0),
        "MP1010.0 : 15000 ;c"
    );
    assert_eq!(
        changed("MP1010.0 : 15000 ;c", id(1010, 0), 15.0),
        "MP1010.0 : 15    ;c"
    );
    assert_eq!(changed("MP1010.0:15;c", id(1010, 0), 150.0), "MP1010.0:150;c");
}

#[test]
fn a_new_value_is_appended_with_its_name() {
    assert_eq!(
        changed("MP7420:0", id(7430, None), 1.0),
        "MP7420:0\nMP7430   : 1            ;Overlap factor for pocket milling\n"
    );
    assert_eq!(
        changed("MP7420:0\r\n", id(1060, 2), 1.5),
        "MP7420:0\r\nMP1060.2 : 1.5          ;Acceleration, Z axis\r\n",
        "line ends stay those of the file"
    );
}

#[test]
fn bytes_of_comments_stay_whatever_their_code() {
    let bytes = b"\xEF\xBB\xBF\x02MP7430 : 1.2 ;\x8Aberlappung\r\n\x03";
    let mut text = ListText::from_bytes(MODEL, bytes);
    assert_eq!(text.to_bytes(), bytes);
    text.set(id(7430, None), 0.5).unwrap();
    assert_eq!(
        text.to_bytes(),
        b"\xEF\xBB\xBF\x02MP7430 : 0.5 ;\x8Aberlappung\r\n\x03"
    );
}

#[test]
fn wrong_values_change_nothing() {
    let mut text = ListText::from_bytes(MODEL, b"MP7430 : 1.2 ;overlap\n");
    let before = text.clone();
    assert!(matches!(
        text.set(id(7430, None), 9.0),
        Err(ParameterError::OutOfRange { .. })
    ));
    assert_eq!(
        text.set(id(1010, None), 9.0),
        Err(ParameterError::IndexMissing(id(1010, None)))
    );
    assert_eq!(
        text.set(id(9999, None), 9.0),
        Err(ParameterError::UnknownNumber(id(9999, None)))
    );
    assert_eq!(text, before);
}

fn any_model() -> impl Strategy<Value = ControlModel> {
    prop::sample::select(ControlModel::ALL.as_slice())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn changing_a_value_changes_this_value_only(
        model in any_model(),
        place in any::<prop::sample::Index>(),
        part in 0.0..=1.0f64,
    ) {
        let definition = place.get(Definition::all(model));
        prop_assume!(definition.min.is_finite());
        let value = definition.min + part * (definition.max - definition.min);
        let value = if definition.decimals == 0 { value.round() } else { value };
        // Some parameters take only a few values between their least and their greatest.
        prop_assume!(!matches!(definition.check(value), Err(ParameterError::NoChoice(..))));
        let reference = ParameterList::reference_text(model);
        let mut text = ListText::from_bytes(model, reference.as_bytes());
        text.set(definition.id, value).unwrap();
        prop_assert_eq!(text.faults(), []);
        let mut read = ParameterList::smallest(model);
        read.take(&text);
        let mut expected = ParameterList::reference(model);
        expected.set(definition.id.number, definition.id.index.unwrap_or(0), value).unwrap();
        prop_assert_eq!(read, expected);
        // All other lines stay.
        let bytes = text.to_bytes();
        let new = String::from_utf8(bytes).unwrap();
        let differing = reference.lines().zip(new.lines()).filter(|(old, new)| old != new).count();
        prop_assert!(differing <= 1);
        prop_assert!(new.lines().count() <= reference.lines().count() + 1);
    }

    #[test]
    fn any_bytes_are_kept_and_give_faults_in_their_lines(
        model in any_model(),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        let text = ListText::from_bytes(model, &bytes);
        prop_assert_eq!(text.to_bytes(), bytes);
        for fault in text.all_faults() {
            let line = text.line(fault.span.line as usize);
            let end = (fault.span.column - 1 + fault.span.length) as usize;
            prop_assert!(end <= line.chars().count() + 1, "{fault:?} {line:?}");
        }
    }

    #[test]
    fn typed_values_answer_whatever_the_list_holds(
        model in any_model(),
        places in prop::collection::vec((any::<prop::sample::Index>(), 0.0..=1.0f64), 1..300),
    ) {
        let mut list = ParameterList::reference(model);
        for (place, part) in places {
            let definition = place.get(Definition::all(model));
            if definition.min.is_finite() {
                let value = definition.min + part * (definition.max - definition.min);
                let value = if definition.decimals == 0 { value.round() } else { value };
                let set = list.set(definition.id.number, definition.id.index.unwrap_or(0), value);
                prop_assert!(matches!(set, Ok(_) | Err(ParameterError::NoChoice(..))), "{set:?}");
            }
        }
        for index in 0..=u8::MAX {
            let axis = list.axis_parameters(index);
            prop_assert!(axis.lag.kv > 0.0 && axis.lag.kink_factor > 0.0 && axis.motion.rapid_mm_min > 0.0);
            prop_assert!(axis.precontrol.kv.is_finite() && axis.encoder.interpolation > 0);
            prop_assert!(!axis.active || index < model.limits().axes_max);
        }
        let spindle = list.spindle_parameters();
        prop_assert!(spindle.settings.gears.iter().all(|gear| gear.max_rpm.is_finite()));
        list.plc_parameters();
        list.operation_parameters();
        list.characteristics();
        list.user_parameters();
        list.inconsistencies();
        prop_assert!(list.spindle_run_up_s(1000.0).is_finite());
    }

    #[test]
    fn almost_valid_lines_give_faults_inside_the_line(
        model in any_model(),
        line in "[\t ]?(MP|mp|é)? ?[0-9]{0,7}[. ]?[0-9]{0,4} ?[:= ]? ?[-+%$]?[0-9A-Fa-f.,eEé ]{0,25}(;.*)?",
        value in 0.0..2.0f64,
    ) {
        let mut text = ListText::from_bytes(model, line.as_bytes());
        prop_assert!(text.entries().len() + text.faults().len() <= 1);
        for fault in text.faults() {
            let end = (fault.span.column.max(1) - 1 + fault.span.length) as usize;
            prop_assert!(fault.span.column >= 1 && end <= line.chars().count(), "{fault:?}");
        }
        let _ = text.set(ParameterId { number: 7430, index: None }, value);
        text.complete();
        prop_assert_eq!(text.missing().count(), 0);
    }
}

/// A file that is no list has a fault in each of its lines: a thousand are kept, the others counted, and what can
/// be read is read.
#[test]
fn a_thousand_faults_are_listed() {
    let list = format!("{}MP7430 : 0.9\n", "junk\n".repeat(2500));
    let text = ListText::from_bytes(ControlModel::Tnc415b, list.as_bytes());
    assert_eq!((text.faults().len(), text.not_listed()), (1000, 1500));
    assert_eq!(text.entries().len(), 1);
    let text = ListText::from_bytes(ControlModel::Tnc415b, b"junk\n");
    assert_eq!((text.faults().len(), text.not_listed()), (1, 0));
}

/// A comment stands after a semicolon and the value [000:10017]; another one takes its place and its column.
#[test]
fn a_comment_is_written_after_the_value() {
    let mut text = ListText::from_bytes(
        ControlModel::Tnc415b,
        b"MP7430 : 1.2   ;overlap\r\nMP7420 : %101\r\nMP7440 : 3",
    );
    assert_eq!(text.comment(id(7430, None)), "overlap");
    assert_eq!(text.comment(id(7420, None)), "");
    text.set_comment(id(7430, None), "overlap of pockets");
    text.set_comment(id(7420, None), "as in\nthe plan");
    text.set_comment(id(7440, None), "last");
    // There is no such line.
    text.set_comment(id(7410, None), "nothing");
    assert_eq!(
        String::from_utf8(text.to_bytes()).unwrap(),
        "MP7430 : 1.2   ; overlap of pockets\r\nMP7420 : %101 ; as inthe plan\r\nMP7440 : 3 ; last"
    );
    assert!(text.faults().is_empty());
    text.set_comment(id(7430, None), " ");
    assert!(text.to_bytes().starts_with(b"MP7430 : 1.2\r\n"));
    assert_eq!(text.entries().len(), 3);
}
