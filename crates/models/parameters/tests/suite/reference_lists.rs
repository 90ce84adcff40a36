//! The shipped reference lists: valid for their model, and every getter answers sensibly from them.

use std::collections::HashSet;

use bahn_parameters::machining::{Decimal, ScaledAxes};
use bahn_parameters::{ControlModel, Definition, ParameterList};
use bahn_path::{Axis, AxisSet};

#[test]
fn every_line_is_accepted_by_its_model() {
    for model in ControlModel::FAMILIES {
        let text = ParameterList::reference_text(model);
        let errors = ParameterList::smallest(model).read(text.as_bytes());
        assert!(errors.is_empty(), "{model}: {errors:?}");
    }
}

#[test]
fn every_group_of_values_gives_its_reason() {
    // The first line of a number's group has a comment; its other indices share it.
    for model in ControlModel::FAMILIES {
        let mut explained = HashSet::new();
        for line in ParameterList::reference_text(model)
            .lines()
            .filter(|line| line.starts_with("MP"))
        {
            let number = line.split(['.', ' ', ':']).next().unwrap();
            if line
                .split_once(';')
                .is_some_and(|(_, comment)| !comment.trim().is_empty())
            {
                explained.insert(number);
            }
            let consecutive = matches!(model, ControlModel::Tnc151 | ControlModel::Tnc155);
            let shared = number == "MP3515";
            assert!(
                consecutive || shared || explained.contains(number),
                "{model}: {line}"
            );
        }
    }
}

#[test]
fn every_value_is_in_its_range() {
    for model in ControlModel::FAMILIES {
        let list = ParameterList::reference(model);
        for definition in Definition::all(model) {
            let id = definition.id;
            let value = list.get(id.number, id.index.unwrap_or(0)).unwrap();
            if definition.min.is_finite() {
                assert!(
                    (definition.min..=definition.max).contains(&value),
                    "{model} {id}: {value}"
                );
            }
            assert_eq!(definition.check(value), Ok(value), "{model} {id}");
        }
    }
}

#[test]
fn axis_getters_answer_for_every_axis_of_every_model() {
    for model in ControlModel::FAMILIES {
        let list = ParameterList::reference(model);
        assert!(list.axes().len() <= usize::from(model.limits().axes_max));
        for axis in Axis::ALL {
            // A milling machine: 5 to 20 m/min or degrees in thousands, 0.1 to 5 m/s².
            assert!(
                (5000.0..=20_000.0).contains(&list.rapid_traverse_mm_min(axis)),
                "{model} {axis}"
            );
            assert!(
                (0.1..=5.0).contains(&list.acceleration_m_s2(axis)),
                "{model} {axis}"
            );
            assert!(
                list.manual_feed_mm_min(axis) < list.rapid_traverse_mm_min(axis),
                "{model} {axis}"
            );
            let [min, max] = list.traverse_range(axis);
            // A mill for parts of half a metre.
            assert!(min <= -100.0 && max >= 30.0, "{model} {axis}: {min} to {max}");
            assert_eq!(
                (list.machine_datum(axis), list.m92_datum(axis)),
                (0.0, 0.0),
                "{model} {axis}"
            );
        }
    }
}

#[test]
fn machining_getters_answer_on_every_model() {
    for model in ControlModel::FAMILIES {
        let list = ParameterList::reference(model);
        assert!(list.radial_acceleration_m_s2() >= 0.25, "{model}");
        assert!((1.0..=15.0).contains(&list.corner_angle_deg()), "{model}");
        assert!((0.1..=1.414).contains(&list.pocket_overlap()), "{model}");
        assert_eq!(list.arc_tolerance_mm(), 0.016, "{model} [003:2801]");
        assert!(list.feed_precontrol() && list.spindle_zero_permitted(), "{model}");
        assert!(
            list.program_end_clearing().status && list.program_end_clearing().at_program_end,
            "{model}"
        );
        let m = list.m_functions();
        assert!(
            m.m6_stops && m.m89_calls_cycle && m.axes_wait && m.axes_wait_for_speed,
            "{model}"
        );
        assert_eq!(list.scaled_axes(), ScaledAxes::All, "{model}");
        assert_eq!(list.decimal(), Decimal::Point, "{model}");
        assert!((1..=31).all(|cycle| !list.cycle_inhibited(cycle)), "{model}");
        assert!(!list.paraxial_inhibited(), "{model}");
        assert_eq!(list.tool_table_size(), 0, "{model}");
        assert_eq!(list.spindle_speed_max_rpm(), 30_000.0, "{model}");
        assert_eq!(list.spindle_override_percent(), [0.0, 150.0], "{model}");
        assert_eq!(list.tapping().override_percent, [90.0, 110.0], "{model}");
        let probe = list.probe();
        assert!(
            0.0 < probe.clearance_mm && probe.clearance_mm < probe.range_mm,
            "{model}"
        );
        assert!(
            0.0 < probe.feed_mm_min && probe.feed_mm_min < probe.rapid_mm_min,
            "{model}"
        );
        assert!(!probe.keeps_tool_data, "{model}");
        let pocket = list.contour_pocket();
        assert!(
            !pocket.pocket_clockwise && !pocket.clear_out_first && !pocket.merge_programmed,
            "{model}"
        );
        assert!(
            !list.graphics().third_angle && !list.graphics().plane_rotated,
            "{model}"
        );
    }
}

#[test]
fn the_old_list_answers_under_its_own_numbers() {
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    for (assignment, old) in [
        ("MP1=9000", 1),
        ("MP54=0.8", 54),
        ("MP55=0.4", 55),
        ("MP91=1.5", 91),
        ("MP93=1.1", 93),
        ("MP241=7", 241),
    ] {
        assert!(list.assign(assignment).is_ok(), "MP{old}");
    }
    assert_eq!(list.rapid_traverse_mm_min(Axis::Y), 9000.0);
    assert_eq!(list.acceleration_m_s2(Axis::Z), 0.8);
    assert_eq!(list.radial_acceleration_m_s2(), 0.4);
    assert_eq!(list.corner_angle_deg(), 1.5);
    assert_eq!(list.pocket_overlap(), 1.1);
    let pocket = list.contour_pocket();
    assert!(pocket.pocket_clockwise && pocket.clear_out_first && pocket.merge_programmed);
    assert!(!pocket.each_infeed, "no such bit on the TNC 155");
    // +8: no standstill for M output, +4: none when TOOL CALL only outputs a speed [001:1650-1652].
    list.assign("MP214=13").unwrap();
    let m = list.m_functions();
    assert!(!m.m6_stops && !m.m89_calls_cycle && !m.axes_wait && !m.axes_wait_for_speed);
}

#[test]
fn mp7420_and_mp7440_bits_mean_what_the_manual_says() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    list.assign("7420=%10010").unwrap();
    let pocket = list.contour_pocket();
    assert!(pocket.clear_out_first && pocket.end_at_clearance);
    assert!(!pocket.pocket_clockwise && !pocket.merge_programmed && !pocket.each_infeed);
    list.assign("MP7440=%00101").unwrap();
    let m = list.m_functions();
    assert!(!m.m6_stops && !m.m89_calls_cycle && !m.axes_wait && !m.m105_works && !m.m103_works);
}

#[test]
fn mp7300_clears_as_its_table_says() {
    // Status, Q parameters, tool data, also at program end [000:6593-6601].
    let table = [
        (true, true, true, false),
        (true, true, true, true),
        (true, false, true, false),
        (true, false, true, true),
        (true, true, false, false),
        (true, true, false, true),
        (true, false, false, false),
        (true, false, false, true),
    ];
    let mut list = ParameterList::reference(ControlModel::Tnc407);
    for (value, expected) in (0u8..).zip(table) {
        list.set(7300, 0, value.into()).unwrap();
        let clearing = list.program_end_clearing();
        let found = (
            clearing.status,
            clearing.q_parameters,
            clearing.tool,
            clearing.at_program_end,
        );
        assert_eq!(found, expected, "MP7300 = {value}");
    }
}

#[test]
fn cycles_are_inhibited_by_their_bits() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    list.assign("7245.0=$0004").unwrap(); // bit 2: cycle 2 [000:6663]
    list.assign("7245.1=%10").unwrap(); // bit 1: cycle 17 [000:6685]
    let inhibited: Vec<u32> = (0..40).filter(|cycle| list.cycle_inhibited(*cycle)).collect();
    assert_eq!(inhibited, [2, 17]);
}

#[test]
fn axes_follow_mp10_and_mp410() {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    let of = |letters: &[Axis]| letters.iter().copied().collect::<AxisSet>();
    assert_eq!(list.axes(), of(&[Axis::X, Axis::Y, Axis::Z, Axis::C, Axis::A]));
    list.assign("410.3=3").unwrap(); // 4th axis U
    list.assign("1010.3=6000").unwrap();
    assert_eq!(list.axis_index(Axis::U), Some(3));
    assert_eq!(list.rapid_traverse_mm_min(Axis::U), 6000.0);
    assert_eq!(
        list.rapid_traverse_mm_min(Axis::V),
        list.rapid_traverse_mm_min(Axis::Y),
        "V answers like Y"
    );
    assert_eq!(list.axis_index(Axis::C), None);
    list.assign("1010.4=5400").unwrap();
    assert_eq!(
        list.rapid_traverse_mm_min(Axis::B),
        5400.0,
        "B answers like A, the rotary axis there is"
    );
    list.assign("10=%00111").unwrap();
    assert_eq!(list.axes(), of(&[Axis::X, Axis::Y, Axis::Z]));
}

#[test]
fn the_spindle_runs_up_along_its_ramp() {
    let list = ParameterList::reference(ControlModel::Tnc415b);
    // Gear 1: 9 V at 3000 rpm, 0.01 V/ms: 1500 rpm are 4.5 V, that is 450 ms.
    assert!((list.spindle_run_up_s(1500.0) - 0.45).abs() < 1e-12);
    // Gear 2: 9 V at 30 000 rpm: 6000 rpm are 1.8 V, 180 ms.
    assert!((list.spindle_run_up_s(6000.0) - 0.18).abs() < 1e-12);
    assert_eq!(list.spindle_run_up_s(40_000.0), 0.0, "no gear has it");
}

#[test]
fn the_list_of_smallest_values_is_a_programming_station_in_standard_colours() {
    let list = ParameterList::smallest(ControlModel::Tnc415b);
    assert_eq!(list.get(7210, 0), Some(1.0));
    assert_eq!(list.get(1010, 0), Some(10.0));
    assert_eq!(
        list.get(7351, 0),
        Some(f64::from(0x03F_3F0F)),
        "error messages [000:6314]"
    );
    assert_eq!(
        ParameterList::smallest(ControlModel::Tnc151).get(0, 0),
        Some(180.0)
    );
}

/// A control starts on the list, and its axes run in closed loop with lag and with pre-control.
#[test]
fn a_machine_runs_in_closed_loop() {
    for model in ControlModel::FAMILIES {
        let list = ParameterList::reference(model);
        let radial = list.radial_acceleration_m_s2();
        for index in (0..5).filter(|index| list.axis_parameters(*index).active) {
            let axis = list.axis_parameters(index);
            let place = format!("{model} {index}: {axis:?}");
            let (motion, lag, precontrol) = (axis.motion, axis.lag, axis.precontrol);
            assert!(axis.controlled && axis.shown && !axis.plc_axis, "{place}");
            // Lag at rapid traverse, no kink: feed in m/min / kv, monitored at 1.2 and 1.4 times it
            // [000:9806-9817]; the TNC 155 has one value for all axes.
            let lag_mm = motion.rapid_mm_min / 1000.0 / lag.kv;
            assert!(
                (1.05 * lag_mm..=2.0 * lag_mm).contains(&lag.monitoring_mm),
                "{place}"
            );
            assert!(
                (lag.monitoring_mm..=2.0 * lag_mm).contains(&lag.emergency_mm),
                "{place}"
            );
            assert!((lag.kink_factor, lag.kink_percent) == (1.0, 100.0), "{place}");
            assert!(
                (0.9..=2.0).contains(&precontrol.kv) && lag.kv_m105 == lag.kv,
                "{place}"
            );
            assert!(
                axis.precontrol_in_automatic && !axis.precontrol_in_manual,
                "{place}"
            );
            assert!(precontrol.monitoring_mm < precontrol.emergency_mm, "{place}");
            // What stands inside the window does not trip the monitoring of standstill or contour.
            let monitoring = axis.monitoring;
            assert!(2.0 * monitoring.window_mm < monitoring.standstill_mm, "{place}");
            assert!(monitoring.standstill_mm <= precontrol.monitoring_mm, "{place}");
            assert!((0.1..=2.0).contains(&monitoring.movement_volts), "{place}");
            // One step of the output moves the axis by less than its window in the lag of one step.
            let steps_per_um = axis.output.rapid_volts * 1000.0 / (lag_mm * 1000.0) / 2.44;
            assert!(steps_per_um * monitoring.window_mm * 1000.0 > 1.0, "{place}");
            assert!(motion.manual_mm_min < motion.rapid_mm_min, "{place}");
            assert!(motion.plc_mm_min >= 500.0, "{place}");
            // The radial acceleration is 0.5 to 1 times that of the axes [000:5080-5092].
            assert!(
                index > 2 || (0.5..=1.0).contains(&(radial / motion.acceleration_m_s2)),
                "{place}"
            );
            // From rapid traverse the axis stops within its range.
            let v = motion.rapid_mm_min / 60.0;
            let stopping_mm = v * v / (2.0 * 1000.0 * motion.acceleration_m_s2) + lag_mm;
            for [min, max] in axis.travel.ranges_mm {
                assert!(max - min > 2.0 * stopping_mm, "{place}");
            }
            assert!(axis.reference.feed_mm_min < motion.rapid_mm_min, "{place}");
            assert!(
                axis.reference.place.is_some() && axis.reference.leaving_mm_min <= 500.0,
                "{place}"
            );
            assert_eq!(
                axis.reference.place == Some(0),
                axis.letter == Some(Axis::Z),
                "{place}"
            );
        }
        let mut places: Vec<_> = (0..5)
            .filter_map(|i| list.axis_parameters(i).reference.place)
            .collect();
        places.sort_unstable();
        let every_place: Vec<u8> = (0..places.len() as u8).collect();
        assert_eq!(
            (places.len(), places),
            (list.axes().len(), every_place),
            "{model}"
        );
        // Integral factor and cyclic adjustment must not both be active [000:5012].
        let first = list.axis_parameters(0);
        assert!(
            first.output.integral_factor == 0.0 || first.offset_interval_s == 0.0,
            "{model}"
        );
        let tapping = list.spindle_parameters().tapping;
        assert!(
            tapping.window_mm <= list.axis_parameters(2).monitoring.window_mm,
            "{model}"
        );
    }
}
