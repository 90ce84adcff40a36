//! What the typed getters read of a list, field by field.

use std::collections::BTreeMap;
use std::fmt::Debug;

use bahn_parameters::ParameterList;
use bahn_path::Axis;

/// What all getters say of a list: the path of a field, `axis_parameters.lag.kv`, with its value as text.
pub type Readings = BTreeMap<String, String>;

/// Asks every getter.
pub fn readings(list: &ParameterList) -> Readings {
    let mut all = Readings::new();
    for index in 0..5 {
        note(&mut all, "axis_parameters", &list.axis_parameters(index));
    }
    for axis in Axis::ALL {
        note(&mut all, "axis_index", &list.axis_index(axis));
        note(
            &mut all,
            "rapid_traverse_mm_min",
            &list.rapid_traverse_mm_min(axis),
        );
        note(&mut all, "manual_feed_mm_min", &list.manual_feed_mm_min(axis));
        note(&mut all, "acceleration_m_s2", &list.acceleration_m_s2(axis));
        note(&mut all, "machine_datum", &list.machine_datum(axis));
        note(&mut all, "m92_datum", &list.m92_datum(axis));
        note(&mut all, "traverse_range", &list.traverse_range(axis));
    }
    for speed in [100.0, 1000.0, 5000.0] {
        note(&mut all, "spindle_run_up_s", &list.spindle_run_up_s(speed));
    }
    for place in 0..48 {
        note(&mut all, "timer_preset", &list.timer_preset(place));
        note(&mut all, "counter_preset", &list.counter_preset(place));
    }
    let spindle = list.spindle_parameters();
    note(&mut all, "rigid_ramps", &spindle.rigid_ramps());
    note(&mut all, "tapping_lead_s", &spindle.tapping_lead_s(500.0));
    for cycle in 1..=31 {
        note(&mut all, "cycle_inhibited", &list.cycle_inhibited(cycle));
    }
    for index in 0..16 {
        note(
            &mut all,
            "plc_number",
            &[0, 1].map(|place| list.plc_number(place, index)),
        );
    }
    note(&mut all, "interface_parameters", &list.interface_parameters());
    note(&mut all, "printer_characters", &list.printer_characters());
    note(&mut all, "drip_feed_memory", &list.drip_feed_memory());
    note(&mut all, "swivel_links", &list.swivel_links());
    note(&mut all, "axes", &list.axes());
    note(
        &mut all,
        "radial_acceleration_m_s2",
        &list.radial_acceleration_m_s2(),
    );
    note(&mut all, "corner_angle_deg", &list.corner_angle_deg());
    note(&mut all, "feed_precontrol", &list.feed_precontrol());
    note(&mut all, "spindle_speed_max_rpm", &list.spindle_speed_max_rpm());
    note(&mut all, "spindle_zero_permitted", &list.spindle_zero_permitted());
    note(
        &mut all,
        "spindle_override_percent",
        &list.spindle_override_percent(),
    );
    note(&mut all, "tapping", &list.tapping());
    note(&mut all, "spindle_parameters", &list.spindle_parameters());
    note(&mut all, "characteristics", &list.characteristics());
    note(&mut all, "digitizing", &list.digitizing());
    note(&mut all, "measuring_probe", &list.measuring_probe());
    note(&mut all, "contour_pocket", &list.contour_pocket());
    note(&mut all, "pocket_overlap", &list.pocket_overlap());
    note(&mut all, "arc_tolerance_mm", &list.arc_tolerance_mm());
    note(&mut all, "m_functions", &list.m_functions());
    note(&mut all, "scaled_axes", &list.scaled_axes());
    note(&mut all, "paraxial_inhibited", &list.paraxial_inhibited());
    note(&mut all, "tool_table_size", &list.tool_table_size());
    note(&mut all, "program_end_clearing", &list.program_end_clearing());
    note(&mut all, "probe", &list.probe());
    note(&mut all, "graphics", &list.graphics());
    note(&mut all, "decimal", &list.decimal());
    note(&mut all, "operation_parameters", &list.operation_parameters());
    note(&mut all, "user_parameters", &list.user_parameters());
    note(&mut all, "table_parameters", &list.table_parameters());
    note(&mut all, "tool_probe", &list.tool_probe());
    note(&mut all, "plc_parameters", &list.plc_parameters());
    all
}

/// The fields whose values differ.
pub fn changed(before: &Readings, after: &Readings) -> Vec<String> {
    before
        .keys()
        .chain(after.keys().filter(|path| !before.contains_key(*path)))
        .filter(|path| before.get(*path) != after.get(*path))
        .cloned()
        .collect()
}

/// Adds what a getter returned, one line of its pretty text to each field.
fn note(all: &mut Readings, getter: &str, value: &impl Debug) {
    let text = format!("{value:#?}");
    let mut path: Vec<(usize, &str)> = Vec::new();
    for line in text.lines() {
        let depth = line.len() - line.trim_start().len();
        path.retain(|(at, _)| *at < depth);
        let line = line.trim_start();
        if let Some((name, _)) = line.split_once(": ")
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        {
            path.push((depth, name));
        }
        let names: Vec<&str> = path.iter().map(|(_, name)| *name).collect();
        let key = [&[getter], names.as_slice()].concat().join(".");
        let entry = all.entry(key).or_default();
        entry.push_str(line);
        entry.push('\n');
    }
}
