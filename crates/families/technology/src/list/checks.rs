//! What does not go together in a list, each with the line that is to be changed.
//!
//! Decision: With gear stages M40 to M45 that a list writes otherwise than MVS_SVS are errors; those that it does not
//! write are P-ERR-20157 when they are programmed

use std::collections::BTreeSet;
use std::fmt;

use bahn_path::Synchronisation;
use bahn_text::{Diagnostic, Severity};

use super::{Entry, Value};
use crate::settings::{ChannelSettings, FunctionSettings, SPINDLE_M};

/// Blocks up to which the look-ahead of the interpolator need not be changed [004:222].
const BLOCKS_WITHOUT_BUFFER: u32 = 70;

/// The gear stages of the main spindle [004:174].
const GEARS: std::ops::RangeInclusive<u32> = 40..=45;

/// What does not go together where a contour cycle takes so long, µs: errors and warnings.
pub(super) fn check(
    settings: &ChannelSettings,
    entries: &[Entry],
    cycle_us: u32,
) -> (Vec<Diagnostic>, Vec<Diagnostic>) {
    let functions = || {
        entries
            .iter()
            .filter_map(|entry| Some((entry, of_function(entry)?)))
    };
    let with_lead: BTreeSet<(bool, u32)> = functions()
        .filter(|(_, of)| of.field == "pre_outp")
        .map(|(_, of)| (of.is_m, of.number))
        .collect();
    let mut errors = Vec::new();
    let mut warnings = Vec::new();
    for (entry, of) in functions() {
        let table = if of.is_m { &settings.m } else { &settings.h };
        let Some(function) = table.get(of.number) else {
            continue;
        };
        let has_lead = with_lead.contains(&(of.is_m, of.number));
        match of.field {
            "synch" => {
                errors.extend(gear_stage(settings, entry, &of));
                // A lead that nobody wrote is 0.
                if !has_lead {
                    warnings.extend(short_lead(entry, &of, function, cycle_us));
                }
            }
            "pre_outp" => warnings.extend(lead((settings, cycle_us), entry, &of, function)),
            "prozess_zeit" => warnings.extend(process_time(entry, &of, function)),
            _ if of.is_gear(settings) => warnings.push(entry.at_name(format!(
                "{of} selects a gear stage and goes to the main spindle: the name has no effect"
            ))),
            _ => {}
        }
    }
    for entry in entries {
        warnings.extend(look_ahead(entries, entry));
        warnings.extend(unknown_functions(entry));
        warnings.extend(spindle_functions(settings, entry));
    }
    (errors, warnings)
}

/// Which function a line is about, and what it says of it.
struct OfFunction {
    is_m: bool,
    number: u32,
    /// `synch`, `pre_outp`, `prozess_zeit`, `default_outp_ax_name`.
    field: &'static str,
}

/// A function as it is written, `M25`.
impl fmt::Display for OfFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", if self.is_m { 'M' } else { 'H' }, self.number)
    }
}

impl OfFunction {
    /// Whether it selects a gear stage of the main spindle.
    fn is_gear(&self, settings: &ChannelSettings) -> bool {
        self.is_m && settings.gear_change && GEARS.contains(&self.number)
    }
}

fn of_function(entry: &Entry) -> Option<OfFunction> {
    let name = entry.place.definition.name.strip_suffix("[i]")?;
    let number = *entry.place.indices.first()?;
    let (is_m, field) = match (name.strip_prefix("m_"), name.strip_prefix("h_")) {
        (Some(field), _) => (true, field),
        (None, Some(field)) => (false, field),
        (None, None) => return None,
    };
    Some(OfFunction { is_m, number, field })
}

/// M40 to M45 with gear stages must be `MVS_SVS` [004:174].
fn gear_stage(settings: &ChannelSettings, entry: &Entry, of: &OfFunction) -> Option<Diagnostic> {
    let Value::Synch(synch) = entry.value else {
        return None;
    };
    let is_right = synch.is_some_and(|synch| synch.kind == Synchronisation::MvsSvs);
    (of.is_gear(settings) && !is_right).then(|| {
        let message = format!("{of} selects a gear stage of the main spindle and must be MVS_SVS");
        Diagnostic {
            severity: Severity::Error,
            ..entry.at_value(message)
        }
    })
}

/// A lead that is not one for its type.
fn lead(
    (settings, cycle_us): (&ChannelSettings, u32),
    entry: &Entry,
    of: &OfFunction,
    function: &FunctionSettings,
) -> Option<Diagnostic> {
    let Some(synch) = function.synch else {
        let message = format!("{of} has a lead and no synchronisation type: to program it is P-ERR-20157");
        return Some(entry.at_name(message));
    };
    let kind = synch.kind;
    if kind.leads_by_time() {
        return short_lead(entry, of, function, cycle_us);
    }
    if function.lead == 0 || kind.is_pre_output() {
        return None;
    }
    if !settings.micro_joint.enabled {
        let message = format!(
            "{of} is {kind} and has a lead, which makes a Micro Joint: to program it is a licence error unless \
             P-CHAN-00600 has FCT_M_PRE_OUTPUT"
        );
        return Some(entry.at_value(message));
    }
    if !kind.takes_micro_joint() {
        return Some(entry.at_value(format!("{kind} has no lead: that of {of} has no effect")));
    }
    let target = function.default_target.as_deref()?;
    Some(entry.at_value(format!(
        "Micro Joints are of the range of the channel: {of} goes to {target}, and to program it is the error micro-joint"
    )))
}

/// A lead by time that is shorter than a cycle is as long as that (public: message 21203).
fn short_lead(
    entry: &Entry,
    of: &OfFunction,
    function: &FunctionSettings,
    cycle_us: u32,
) -> Option<Diagnostic> {
    let leads_by_time = function.synch.is_some_and(|synch| synch.kind.leads_by_time());
    (leads_by_time && function.lead < cycle_us).then(|| {
        entry.at_value(format!(
            "the lead of {of}, {} us, is shorter than a contour cycle and becomes one (message 21203; {cycle_us} us \
             here)",
            function.lead
        ))
    })
}

/// A process time where nobody waits (public: message 20760).
fn process_time(entry: &Entry, of: &OfFunction, function: &FunctionSettings) -> Option<Diagnostic> {
    if function.process_time_us == 0 {
        return None;
    }
    match function.synch.map(|synch| synch.kind) {
        Some(Synchronisation::Mos) => Some(entry.at_value(format!(
            "{of} is MOS and has a process time: it becomes 0 (message 20760)"
        ))),
        None => Some(entry.at_name(format!(
            "{of} has a process time and no synchronisation type: to program it is P-ERR-20157"
        ))),
        _ => None,
    }
}

/// The correction of message 20760 (public).
pub(super) fn drop_process_times(settings: &mut ChannelSettings) {
    for table in [&mut settings.m, &mut settings.h] {
        for function in table.iter_mut() {
            if function
                .synch
                .is_some_and(|synch| synch.kind == Synchronisation::Mos)
            {
                function.process_time_us = 0;
            }
        }
    }
}

/// Which of two lines counts for M3, M4, M5 and M19: that of the spindle, or, when they are free, that of the channel
/// [004:51] [004:159]. Without its line a function is refused where it is programmed.
fn spindle_functions(settings: &ChannelSettings, entry: &Entry) -> Option<Diagnostic> {
    let is_free = settings.spindle_m_free;
    if entry.place.definition.name == "spindle_m_fct_free" && is_free {
        let of = |number: &u32| settings.m.get(*number).and_then(|function| function.synch);
        let without: Vec<String> = SPINDLE_M
            .iter()
            .filter(|number| of(number).is_none())
            .map(|number| format!("M{number}"))
            .collect();
        return (!without.is_empty()).then(|| {
            entry.at_value(format!(
                "{} without m_synch: free, and to program them is P-ERR-20157",
                without.join(", ")
            ))
        });
    }
    let field = entry.place.definition.name.strip_prefix("spindel[i].m");
    let of_spindle = field.and_then(|field| field.strip_suffix("_synch"));
    if let Some(number) = of_spindle.filter(|_| is_free) {
        return Some(entry.at_name(format!(
            "M{number} is free with spindle_m_fct_free 1: m_synch[{number}] counts, and this line does nothing"
        )));
    }
    let number = *entry.place.indices.first()?;
    let of_channel = entry.place.definition.name == "m_synch[i]" && SPINDLE_M.contains(&number);
    let mut spindles = settings.spindles.values();
    let beside = spindles.any(|spindle| spindle.m(number).is_some_and(|of| of.synch.is_some()));
    (of_channel && !is_free && beside).then(|| {
        entry.at_name(format!(
            "M{number} is of a spindle: spindel[i].m{number}_synch counts, and this line only for X[M{number}] and with \
             spindle_m_fct_free 1"
        ))
    })
}

/// More blocks of look-ahead than the interpolator has [004:222].
fn look_ahead(entries: &[Entry], entry: &Entry) -> Option<Diagnostic> {
    let Value::Number(blocks) = entry.value else {
        return None;
    };
    if entry.place.definition.name != "m_h_pre_outp_nbr_block" || blocks <= BLOCKS_WITHOUT_BUFFER {
        return None;
    }
    let buffer = entries.iter().rev().find_map(|entry| match entry.value {
        Value::Number(blocks) if entry.place.definition.name == "configuration.interpolator.parameter" => {
            Some(blocks)
        }
        _ => None,
    });
    (buffer.unwrap_or_default() < blocks).then(|| {
        entry.at_value(format!(
            "{blocks} blocks need a look-ahead as long in P-CHAN-00653 (configuration.interpolator.parameter)"
        ))
    })
}

/// Constants of functions that Bahn does not know; a misspelt one is among them.
fn unknown_functions(entry: &Entry) -> Option<Diagnostic> {
    let Value::Functions(names) = &entry.value else {
        return None;
    };
    let is_preparation = entry
        .place
        .definition
        .name
        .starts_with("configuration.path_preparation.");
    let known = ["FCT_DEFAULT", "FCT_M_PRE_OUTPUT"];
    let unknown: Vec<&str> = names
        .iter()
        .map(String::as_str)
        .filter(|name| !known.contains(name))
        .collect();
    (is_preparation && !unknown.is_empty())
        .then(|| entry.at_value(format!("{} has no effect here", unknown.join(", "))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::ChannelList;

    fn list(text: &str) -> ChannelList {
        ChannelList::from_bytes(text.as_bytes())
    }

    fn messages(faults: &[Diagnostic]) -> Vec<(u32, u32, &str)> {
        faults
            .iter()
            .map(|fault| (fault.span.line, fault.span.column, fault.message.as_str()))
            .collect()
    }

    #[test]
    fn gear_stages_are_mvs_svs_wherever_the_gear_change_stands() {
        let text = "m_synch[40] MOS\nm_synch[41] 0x2\nm_synch[46] MOS\nh_synch[40] MOS\nmain_spindle_gear_change 1\n";
        let found = list(text);
        let message = "M40 selects a gear stage of the main spindle and must be MVS_SVS";
        assert_eq!(messages(found.errors()), [(1, 13, message)]);
        assert!(list(&text.replace("change 1", "change 0")).errors().is_empty());
        let not_valid = list("main_spdl_gear_change 1\nm_synch[45] NOT_VALID\n");
        assert_eq!(not_valid.errors().len(), 1);
    }

    #[test]
    fn a_lead_without_micro_joints_is_warned_of() {
        let text = "m_synch[5] MOS\nm_pre_outp[5] 500\n";
        let found = list(text);
        assert!(found.errors().is_empty());
        let [warning] = found.warnings() else {
            panic!("{:?}", found.warnings())
        };
        assert_eq!((warning.span.line, warning.span.column), (2, 15));
        assert!(warning.message.contains("licence error"));
        let enabled =
            format!("{text}configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n");
        assert!(list(&enabled).warnings().is_empty());
        assert!(list(&text.replace("500", "0")).warnings().is_empty());
        assert!(list(&text.replace("MOS", "MEP_SVS")).warnings().is_empty());
        let late = enabled.replace("MOS", "MVS_SLM");
        assert!(list(&late).warnings()[0].message.contains("MVS_SLM has no lead"));
    }

    #[test]
    fn messages_of_the_start_up_are_warnings() {
        let found = list("m_synch[7] MOS\nm_prozess_zeit[7] 500\nh_synch[7] MET_SVS\nh_pre_outp[7] 2999\n");
        let places: Vec<_> = found
            .warnings()
            .iter()
            .map(|fault| (fault.span.line, fault.span.column))
            .collect();
        assert_eq!(places, [(2, 19), (4, 15)]);
        assert!(found.warnings()[0].message.contains("20760"));
        assert!(found.warnings()[1].message.contains("21203"));
        assert_eq!(found.settings().m.get(7).unwrap().process_time_us, 0);
        assert_eq!(list("h_synch[7] MET_MOS\n").warnings().len(), 1, "a lead of 0");
        assert!(
            list("h_synch[7] MET_SVS\nh_pre_outp[7] 3000\n")
                .warnings()
                .is_empty()
        );
        // A cycle of the machine that runs it.
        let text = b"h_synch[7] MET_SVS\nh_pre_outp[7] 2999\n";
        assert!(ChannelList::for_cycle(text, 0.002).warnings().is_empty());
        let slow = ChannelList::for_cycle(text, 0.006);
        assert!(slow.warnings()[0].message.contains("6000 us here"));
    }

    #[test]
    fn more_blocks_need_a_longer_look_ahead() {
        let text = "m_h_pre_outp_nbr_block 100\n";
        assert_eq!(list(text).warnings().len(), 1);
        let enough = format!("{text}configuration.channel[0].interpolator.parameter 100\n");
        let warnings = list(&enough);
        assert_eq!(warnings.warnings().len(), 1, "the buffer itself has no effect");
        assert_eq!(warnings.warnings()[0].span.line, 2);
        assert!(list("m_h_pre_outp_nbr_block 70\n").warnings().is_empty());
    }

    /// The manual has both lines for M3: that of the spindle, and that of the channel [004:51].
    #[test]
    fn it_is_said_which_line_of_a_spindle_function_counts() {
        let both = "spindel[0].m3_synch MVS_SVS\nm_synch[3] MVS_SVS\n";
        let warnings_of = |text: &str| -> Vec<(u32, String)> {
            let found = list(text);
            assert!(found.errors().is_empty(), "{:?}", found.errors());
            let warnings = found.warnings().iter();
            warnings
                .map(|fault| (fault.span.line, fault.message.clone()))
                .collect()
        };
        let [(line, message)] = warnings_of(both).try_into().unwrap();
        assert_eq!(line, 2);
        assert!(message.contains("spindel[i].m3_synch counts"), "{message}");
        let free = format!("{both}m_synch[4] MOS\nm_synch[5] MOS\nspindle_m_fct_free 1\n");
        let [(first, counts), (second, without)] = warnings_of(&free).try_into().unwrap();
        assert_eq!((first, second), (1, 5));
        assert!(counts.contains("m_synch[3] counts"), "{counts}");
        assert!(without.starts_with("M19 without m_synch"), "{without}");
        assert!(warnings_of(&format!("{free}m_synch[19] MOS\n")).len() == 1);
    }

    #[test]
    fn misspelt_functions_are_reported() {
        let found = list("configuration.path_preparation.function FCT_DEFAULT | FCT_M_PREOUTPUT\n");
        assert!(
            found.warnings()[0]
                .message
                .contains("FCT_M_PREOUTPUT has no effect")
        );
        assert!(!found.settings().micro_joint.enabled);
    }
}
