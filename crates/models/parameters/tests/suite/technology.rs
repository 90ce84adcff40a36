//! The table of technology functions against the lists of the manuals.

use bahn_parameters::ControlModel;
use bahn_parameters::conformance::{self, Effect, Kind};
use bahn_parameters::technology::{AxisHalts, ControlAction, Output, Technology};
use bahn_path::{At, SpindleOrder, Switch, Synchronisation};

/// M0 to M99, ten in a line: S takes effect at the start, E at the end of its block, B at either. TNC 151/155
/// [001:568-670] and TNC 407/415/425 [000:7081-7184] have the same list, but for M89.
const LIST: &str = "
    EEESSEESSE
    ESESSSSSSE
    SSSSSSSSSS
    ESEEEESSSS
    SSSSSSSSSS
    SSEEESSSSS
    ESSEEEEEEE
    ESSSSSSSSS
    SSSSSSSSSB
    SSSSSEEEEE";

/// TNC 360: with predetermined effect [003:7465-7487], and vacant [003:7497-7577]; M30 stands in the second list once
/// more, with the other effect. Neither has M15.
const AT_END_360: [u16; 31] = [
    0, 2, 5, 6, 9, 30, 95, 96, 97, 98, 99, 1, 10, 12, 19, 32, 33, 34, 35, 52, 53, 54, 60, 63, 64, 65, 66, 67,
    68, 69, 70,
];

#[allow(clippy::panic, reason = "a helper that panics fails its test")]
fn m(model: ControlModel, code: u16) -> &'static Technology {
    Technology::of_m(model, code).unwrap_or_else(|| panic!("{model}: M{code}"))
}

fn list() -> impl Iterator<Item = (u16, char)> {
    (0..).zip(LIST.chars().filter(|c| c.is_ascii_alphabetic()))
}

#[test]
fn begin_and_end_of_block_as_in_the_lists() {
    assert_eq!(list().count(), 100);
    for model in ControlModel::ALL {
        for (code, expected) in list() {
            let at = m(model, code).at;
            match expected {
                'S' => assert_eq!(at, At::Start, "{model}: M{code}"),
                'E' => assert_eq!(at, At::End, "{model}: M{code}"),
                // It is output at the start where it calls no cycle [001:702].
                _ => assert!(m(model, code).does(ControlAction::ModalCycleCall) && at == At::Start),
            }
        }
    }
    let mut at_end = AT_END_360;
    at_end.sort_unstable();
    let in_table: Vec<_> = (0..100)
        .filter(|code| m(ControlModel::Tnc360, *code).at == At::End)
        .collect();
    assert_eq!(in_table, at_end);
}

/// M90 to M99 act on the path alone [001:703-711]; codes of three digits never reach the PLC [000:7206].
#[test]
fn what_goes_to_the_plc() {
    for model in ControlModel::ALL {
        for code in 0..1000 {
            let goes = Technology::of_m(model, code).is_some_and(|row| row.output == Output::Plc);
            assert_eq!(goes, code < 90, "{model}: M{code}");
        }
    }
}

/// Spindle and coolant [003:7465-7475]: "Spindle stop" also with M0, M2, M6 and M30, "Coolant off" with M0, M2 and M30
/// [001:690-701].
#[test]
fn spindle_and_coolant() {
    for model in ControlModel::ALL {
        let with = |action| -> Vec<u16> {
            (0..1000)
                .filter(|code| Technology::of_m(model, *code).is_some_and(|row| row.does(action)))
                .collect()
        };
        assert_eq!(with(ControlAction::Spindle(SpindleOrder::Clockwise)), [3, 13]);
        assert_eq!(
            with(ControlAction::Spindle(SpindleOrder::CounterClockwise)),
            [4, 14]
        );
        assert_eq!(with(ControlAction::Spindle(SpindleOrder::Stop)), [5]);
        assert_eq!(
            with(ControlAction::Spindle(SpindleOrder::StopWithRun)),
            [0, 2, 6, 30]
        );
        assert_eq!(with(ControlAction::Coolant(Switch::On)), [8, 13, 14]);
        assert_eq!(with(ControlAction::Coolant(Switch::Off)), [0, 2, 9, 30]);
        assert_eq!(with(ControlAction::ProgramEnd), [2, 30]);
    }
}

/// Axes that do not halt at M functions halt at a programmed stop all the same [001:1652].
#[test]
fn where_the_path_waits() {
    let on = AxisHalts {
        at_m_functions: false,
        at_speeds: true,
    };
    let halts = AxisHalts {
        at_m_functions: true,
        ..on
    };
    for (code, expected) in list() {
        let row = m(ControlModel::Tnc415b, code);
        let at_end = expected == 'E';
        let waits = match at_end {
            true => Synchronisation::MnsSns,
            false => Synchronisation::MvsSvs,
        };
        let outputs = code < 90;
        let stops = [0, 2, 6, 30].contains(&code);
        let expected = |halts| {
            if outputs && halts {
                waits
            } else {
                Synchronisation::Mos
            }
        };
        assert_eq!(row.synchronisation(halts), expected(true), "M{code}");
        assert_eq!(row.synchronisation(on), expected(stops), "M{code}");
    }
}

/// What the registry says to act does something, and nothing else of three digits.
#[test]
fn registry_and_table_agree() {
    for model in ControlModel::ALL {
        for code in 100..1000 {
            let entry = conformance::find(model, Kind::MFunction, &format!("M{code}"));
            let acts = entry.is_some_and(|entry| entry.effect != Effect::None);
            let does = Technology::of_m(model, code).is_some_and(|row| row.actions().count() > 0);
            assert_eq!(does, acts, "{model}: M{code}");
        }
    }
}
