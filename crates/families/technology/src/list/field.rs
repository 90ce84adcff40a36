//! From a parameter to the field of the settings, and back.

use super::{Place, Value};
use crate::settings::{ChannelSettings, FunctionSettings, SpindleFunction, SpindleSettings};

/// The constant that enables Micro Joints [004:111] [004:231].
const MICRO_JOINTS: &str = "FCT_M_PRE_OUTPUT";

/// Sets what a line says; false when nothing here has it.
pub(super) fn set(settings: &mut ChannelSettings, place: &Place, value: &Value) -> bool {
    let name = place.definition.name;
    let index = place.indices.first().copied();
    if let (Some(field), Some(index)) = (name.strip_prefix("spindel[i]."), index) {
        let spindle = settings.spindles.entry(index as usize).or_default();
        return set_spindle(spindle, field, value);
    }
    match (name, value) {
        ("main_spindle_gear_change", Value::Flag(value)) => settings.gear_change = *value,
        ("spindle_m_fct_free", Value::Flag(value)) => settings.spindle_m_free = *value,
        ("m6_implicit_call", Value::Flag(value)) => settings.m6_implicit_call = *value,
        ("m6_prog_file", Value::Name(_)) => settings.m6_implicit_call = true,
        ("prog_start.late_sync_ready", Value::Flag(value)) => settings.late_sync_ready = *value,
        ("main_spindle_ax_nr", Value::Number(value)) => settings.main_spindle_axis = Some(*value),
        ("main_spindle_name", Value::Name(value)) => settings.main_spindle_name.clone_from(value),
        ("m_h_pre_outp_time_calc_mode", Value::Flag(value)) => settings.pre_output.active_profile = *value,
        ("m_h_pre_outp_calc_value_to_go", Value::Flag(value)) => settings.pre_output.value_to_go = *value,
        ("m_h_pre_outp_nbr_block", Value::Number(value)) => settings.pre_output.blocks = *value,
        ("configuration.path_preparation.function", Value::Functions(names)) => {
            settings.micro_joint.enabled = names.iter().any(|name| name == MICRO_JOINTS);
        }
        ("configuration.path_preparation.fct_enable[i]", Value::Functions(names)) if index == Some(0) => {
            settings.micro_joint.enabled = names.iter().any(|name| name == MICRO_JOINTS);
        }
        ("configuration.path_preparation.m_pre_output_lookahead", Value::Number(value)) => {
            settings.micro_joint.blocks = *value;
        }
        ("configuration.path_preparation.m_pre_output_max_distance", Value::Number(value)) => {
            settings.micro_joint.distance = *value;
        }
        ("pre_output_tolerance", Value::Number(value)) => settings.micro_joint.tolerance = *value,
        ("kasto_residual_path", Value::Number(value)) => settings.edge_banding.residual_path = *value,
        _ => return set_function(settings, name, index, value),
    }
    true
}

/// `m_` and `h_`, with the number of a function.
fn set_function(settings: &mut ChannelSettings, name: &str, index: Option<u32>, value: &Value) -> bool {
    let (table, field) = match (name.strip_prefix("m_"), name.strip_prefix("h_")) {
        (Some(field), _) => (&mut settings.m, field),
        (None, Some(field)) => (&mut settings.h, field),
        (None, None) => return false,
    };
    let Some(function) = index.and_then(|number| table.get_mut(number)) else {
        return false;
    };
    match (field, value) {
        ("synch[i]", Value::Synch(value)) => function.synch = *value,
        ("pre_outp[i]", Value::Number(value)) => function.lead = *value,
        ("prozess_zeit[i]", Value::Number(value)) => function.process_time_us = *value,
        ("default_outp_ax_name[i]", Value::Name(value)) => function.default_target = Some(value.clone()),
        _ => return false,
    }
    true
}

fn set_spindle(spindle: &mut SpindleSettings, field: &str, value: &Value) -> bool {
    let function = match field.split('_').next() {
        Some("s") => Some(&mut spindle.s),
        Some("m3") => Some(&mut spindle.m3),
        Some("m4") => Some(&mut spindle.m4),
        Some("m5") => Some(&mut spindle.m5),
        Some("m19") => Some(&mut spindle.m19),
        _ => None,
    };
    match (function, value, field) {
        (Some(function), Value::Synch(value), _) => function.synch = *value,
        (Some(function), Value::Number(value), _) => function.process_time_us = *value,
        (None, Value::Name(value), "bezeichnung") => spindle.label = Some(value.clone()),
        (None, Value::Number(value), "log_achs_nr") => spindle.log_axis = Some(*value),
        (None, Value::Flag(value), "plc_control") => spindle.plc_control = *value,
        (None, Value::Number(value), "achs_mode") => {
            spindle.plc_spindle = value & SpindleSettings::EXTERNAL != 0;
        }
        _ => return false,
    }
    true
}

/// What a parameter says; `None` where the settings do not have it, or leave it open.
pub(super) fn get(settings: &ChannelSettings, place: &Place) -> Option<Value> {
    let name = place.definition.name;
    let index = place.indices.first().copied();
    if let Some(field) = name.strip_prefix("spindel[i].") {
        return get_spindle(settings.spindles.get(&(index? as usize))?, field);
    }
    Some(match name {
        "main_spindle_gear_change" => Value::Flag(settings.gear_change),
        "spindle_m_fct_free" => Value::Flag(settings.spindle_m_free),
        "m6_implicit_call" => Value::Flag(settings.m6_implicit_call),
        "prog_start.late_sync_ready" => Value::Flag(settings.late_sync_ready),
        "main_spindle_ax_nr" => Value::Number(settings.main_spindle_axis?),
        "main_spindle_name" => Value::Name(settings.main_spindle_name.clone()),
        "m_h_pre_outp_time_calc_mode" => Value::Flag(settings.pre_output.active_profile),
        "m_h_pre_outp_calc_value_to_go" => Value::Flag(settings.pre_output.value_to_go),
        "m_h_pre_outp_nbr_block" => Value::Number(settings.pre_output.blocks),
        "configuration.path_preparation.function" => {
            let names = ["FCT_DEFAULT", MICRO_JOINTS].map(str::to_owned).to_vec();
            let count = if settings.micro_joint.enabled { 2 } else { 1 };
            Value::Functions(names.into_iter().take(count).collect())
        }
        "configuration.path_preparation.m_pre_output_lookahead" => Value::Number(settings.micro_joint.blocks),
        "configuration.path_preparation.m_pre_output_max_distance" => {
            Value::Number(settings.micro_joint.distance)
        }
        "pre_output_tolerance" => Value::Number(settings.micro_joint.tolerance),
        "kasto_residual_path" => Value::Number(settings.edge_banding.residual_path),
        _ => return get_function(settings, name, index?),
    })
}

fn get_function(settings: &ChannelSettings, name: &str, number: u32) -> Option<Value> {
    let m = name.strip_prefix("m_").map(|field| (&settings.m, field));
    let (table, field) = m.or_else(|| Some((&settings.h, name.strip_prefix("h_")?)))?;
    let FunctionSettings {
        synch,
        lead,
        process_time_us,
        default_target,
    } = table.get(number)?;
    Some(match field {
        "synch[i]" => Value::Synch(*synch),
        "pre_outp[i]" => Value::Number(*lead),
        "prozess_zeit[i]" => Value::Number(*process_time_us),
        "default_outp_ax_name[i]" => Value::Name(default_target.clone()?),
        _ => return None,
    })
}

fn get_spindle(spindle: &SpindleSettings, field: &str) -> Option<Value> {
    let time = |function: SpindleFunction| Value::Number(function.process_time_us);
    let synch = |function: SpindleFunction| Some(Value::Synch(Some(function.synch?)));
    match field {
        "bezeichnung" => Some(Value::Name(spindle.label.clone()?)),
        "log_achs_nr" => Some(Value::Number(spindle.log_axis?)),
        "plc_control" => Some(Value::Flag(spindle.plc_control)),
        "achs_mode" => Some(Value::Number(if spindle.plc_spindle {
            SpindleSettings::EXTERNAL
        } else {
            0
        })),
        "s_synch" => synch(spindle.s),
        "m3_synch" => synch(spindle.m3),
        "m4_synch" => synch(spindle.m4),
        "m5_synch" => synch(spindle.m5),
        "m19_synch" => synch(spindle.m19),
        "s_prozess_zeit" => Some(time(spindle.s)),
        "m3_prozess_zeit" => Some(time(spindle.m3)),
        "m4_prozess_zeit" => Some(time(spindle.m4)),
        "m5_prozess_zeit" => Some(time(spindle.m5)),
        "m19_prozess_zeit" => Some(time(spindle.m19)),
        _ => None,
    }
}
