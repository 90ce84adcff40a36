//! Lists as they are written: what differs from an empty one, and a template to start from.

use super::table::{Definition, Kind};
use super::{Place, Value, field};
use crate::settings::ChannelSettings;
use crate::synch::Synch;

impl ChannelSettings {
    /// The lines of a list that sets what differs from an empty one; read, it is the same again.
    ///
    /// ```
    /// use bahn_technology::{ChannelList, ChannelSettings};
    /// let list = ChannelList::from_bytes(b"spindle[0].m3_sync 0x20002\n");
    /// assert_eq!(list.settings().to_list(), "spindel[0].m3_synch PLC_INFO | MVS_SVS 0x00020002\n");
    /// ```
    pub fn to_list(&self) -> String {
        let empty = ChannelSettings::default();
        let mut text = String::new();
        for definition in Definition::all() {
            for indices in self.indices(definition) {
                let place = Place {
                    definition,
                    indices,
                    is_of_other_channel: false,
                };
                let Some(value) = field::get(self, &place) else {
                    continue;
                };
                if field::get(&empty, &place).is_none_or(|other| other != value)
                    && !self.says_nothing(&place, &value)
                {
                    text += &format!("{} {}\n", place.name(), written(&value));
                }
            }
        }
        text
    }

    /// The indices that a parameter can have here.
    fn indices(&self, definition: &Definition) -> Vec<Vec<u32>> {
        if definition.name.starts_with("spindel[i].") {
            return self
                .spindles
                .keys()
                .filter_map(|at| Some(vec![u32::try_from(*at).ok()?]))
                .collect();
        }
        match definition.indices.as_slice() {
            [] => vec![Vec::new()],
            [(first, last)] => (*first..=*last).map(|index| vec![index]).collect(),
            _ => Vec::new(),
        }
    }

    /// A spindle that a list has is nowhere in an empty one: 0 need not be written, but for one that has nothing else.
    fn says_nothing(&self, place: &Place, value: &Value) -> bool {
        let is_zero = matches!(value, Value::Number(0) | Value::Flag(false));
        let spindle = place
            .indices
            .first()
            .and_then(|at| self.spindles.get(&(*at as usize)));
        let is_only_sign = place.definition.name == "spindel[i].plc_control"
            && spindle.is_some_and(|spindle| *spindle == crate::SpindleSettings::default());
        place.definition.name.starts_with("spindel[i].") && is_zero && !is_only_sign
    }
}

/// A value as a list has it.
fn written(value: &Value) -> String {
    match value {
        Value::Synch(None) => "NOT_VALID".to_owned(),
        Value::Synch(Some(synch)) => with_bits(*synch),
        Value::Number(number) => number.to_string(),
        Value::Flag(value) => u8::from(*value).to_string(),
        Value::Name(name) => name.clone(),
        Value::Functions(names) => names.join(" | "),
    }
}

/// `MVS_SVS 0x00000002`, as the manual writes it [004:204].
fn with_bits(synch: Synch) -> String {
    format!("{synch} 0x{:08X}", synch.bits())
}

/// A list to start from: each parameter that acts here, with what it means, after `#`.
pub fn template() -> String {
    let mut text = "\
# Channel parameter list.
# A line is a name and a value; # and ; begin comments, and a remark may stand after a value.
# The lines below are those of an empty list: take the # away from what is to be changed.
"
    .to_owned();
    let acting = Definition::all()
        .iter()
        .filter(|row| row.without_effect.is_empty());
    for row in acting {
        let unit = match row.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let range = match row.kind {
            Kind::Synch(_) => "a type of `bahn channel explain`".to_owned(),
            kind => kind.range(),
        };
        text += &format!(
            "\n# {}: {range}{unit}, without an entry {}.\n",
            row.id, row.default
        );
        for line in wrapped(row.meaning) {
            text += &format!("# {line}\n");
        }
        text += &format!("#{} {}\n", row.name_with(&example_index(row)), example_value(row));
    }
    text
}

/// An index that the template shows.
fn example_index(row: &Definition) -> Vec<u32> {
    let index = |(_, last): &(u32, u32)| if *last == 999 { 25 } else { 0 };
    row.indices.iter().map(index).collect()
}

/// The value that the template shows: that of an empty list, or one that can be read.
fn example_value(row: &'static Definition) -> String {
    let place = Place {
        definition: row,
        indices: example_index(row),
        is_of_other_channel: false,
    };
    let mut settings = ChannelSettings::default();
    settings.spindles.entry(0).or_default();
    match (field::get(&settings, &place), row.kind) {
        (Some(value), _) => written(&value),
        (None, Kind::Synch(_)) => "NO_SYNCH".to_owned(),
        (None, Kind::Name { .. }) if row.name.ends_with("_ax_name[i]") => "X".to_owned(),
        (None, Kind::Name { .. }) if row.name.ends_with("_file") => "change.nc".to_owned(),
        (None, Kind::Name { .. }) => "S".to_owned(),
        (None, Kind::Functions) => "FCT_DEFAULT".to_owned(),
        (None, _) => "1".to_owned(),
    }
}

/// Text in lines of at most 100 characters.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.is_empty() => *line = word.to_owned(),
            Some(line) if line.len() + word.len() < 100 => *line += &format!(" {word}"),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        ChannelList, EdgeBanding, FunctionSettings, MicroJoint, PreOutput, SpindleFunction, SpindleSettings,
        Synchronisation,
    };

    /// Each line of the template says what it is for, and is a right one when the `#` is taken away.
    #[test]
    fn the_template_can_be_read_with_and_without_its_signs() {
        let text = template();
        let as_it_is = ChannelList::from_bytes(text.as_bytes());
        assert_eq!((as_it_is.entries(), as_it_is.errors().len()), (0, 0));
        let lines = text
            .lines()
            .filter(|line| line.starts_with('#') && !line.starts_with("# "));
        let opened: Vec<&str> = lines.map(|line| line.trim_start_matches('#')).collect();
        let acting = Definition::all()
            .iter()
            .filter(|row| row.without_effect.is_empty());
        assert_eq!(opened.len(), acting.count());
        let list = ChannelList::from_bytes(opened.join("\n").as_bytes());
        assert_eq!(list.errors(), []);
    }

    /// Every parameter that acts changes the settings, and no other does.
    #[test]
    fn what_acts_changes_the_settings() {
        for row in Definition::all() {
            let index: Vec<u32> = row.indices.iter().map(|_| 0).collect();
            let value = match row.kind {
                Kind::Synch(_) => "MNS_SNS",
                Kind::Number { min, .. } => &(min + 1)
                    .max(0x4_0000)
                    .min(match row.kind {
                        Kind::Number { max, .. } => max,
                        _ => 0,
                    })
                    .to_string(),
                Kind::Flag => "1",
                Kind::Name { .. } => "S7",
                Kind::Functions => "FCT_DEFAULT | FCT_M_PRE_OUTPUT",
            };
            let text = format!("{} {value}\n", row.name_with(&index));
            let mut list = ChannelList::from_bytes(text.as_bytes());
            assert_eq!(list.errors(), [], "{text}");
            let names_spindle = row.name.starts_with("spindel[i].");
            let spindle = list.settings.spindles.remove(&0);
            let changed = spindle.is_some_and(|spindle| spindle != SpindleSettings::default())
                || list.settings != ChannelSettings::default();
            assert_eq!(changed, row.without_effect.is_empty(), "{text}");
            let warned = list
                .warnings
                .iter()
                .any(|fault| fault.message.contains("has no effect here"));
            assert!(changed != warned || names_spindle, "{text} {:?}", list.warnings);
        }
    }

    fn synch(kinds: Vec<Synchronisation>) -> impl Strategy<Value = Synch> {
        let any = (proptest::sample::select(kinds), any::<[bool; 4]>()).prop_map(|(kind, bits)| Synch {
            kind,
            plc_info: bits[0],
            backward: bits[1],
            forward: bits[2],
            flush_and_wait: bits[3],
        });
        any.prop_filter("bits of backward motion need a type", |synch| {
            Synch::from_bits(synch.bits()).is_ok()
        })
    }

    fn name() -> impl Strategy<Value = String> {
        "[A-Za-z_][A-Za-z0-9_]{0,15}"
    }

    fn function(for_h: bool) -> impl Strategy<Value = FunctionSettings> {
        let not_for_h = [
            Synchronisation::MvsSlm,
            Synchronisation::MvsSlp,
            Synchronisation::MosTs,
        ];
        let kinds = Synchronisation::all()
            .filter(|kind| !(for_h && not_for_h.contains(kind)))
            .collect();
        let parts = (
            proptest::option::of(synch(kinds)),
            any::<u32>(),
            any::<u32>(),
            proptest::option::of(name()),
        );
        parts.prop_map(
            |(synch, lead, process_time_us, default_target)| FunctionSettings {
                synch,
                lead,
                // The check takes it away (message 20760).
                process_time_us: if synch.is_some_and(|synch| synch.kind == Synchronisation::Mos) {
                    0
                } else {
                    process_time_us
                },
                default_target,
            },
        )
    }

    fn of_spindle() -> impl Strategy<Value = SpindleFunction> {
        use Synchronisation::*;
        let kinds = vec![NoSynch, Mos, MvsSvs, MvsSns, MnsSns, MneSns, MvsSlm, MvsSlp];
        (proptest::option::of(synch(kinds)), any::<u32>()).prop_map(|(synch, process_time_us)| {
            SpindleFunction {
                synch,
                process_time_us,
            }
        })
    }

    fn spindle() -> impl Strategy<Value = SpindleSettings> {
        let head = (
            proptest::option::of(name()),
            proptest::option::of(0_u32..65536),
            any::<[bool; 2]>(),
        );
        let functions = (
            of_spindle(),
            of_spindle(),
            of_spindle(),
            of_spindle(),
            of_spindle(),
        );
        (head, functions).prop_map(
            |((label, log_axis, [plc_spindle, plc_control]), (s, m3, m4, m5, m19))| SpindleSettings {
                label,
                log_axis,
                plc_spindle,
                plc_control,
                s,
                m3,
                m4,
                m5,
                m19,
            },
        )
    }

    fn settings() -> impl Strategy<Value = ChannelSettings> {
        let functions = (
            proptest::collection::btree_map(0_u32..1000, function(false), 0..20),
            proptest::collection::btree_map(0_u32..1000, function(true), 0..20),
        );
        let spindles = proptest::collection::btree_map(0_usize..16, spindle(), 0..4);
        let main = (proptest::option::of(0_u32..65536), name());
        (
            functions,
            spindles,
            main,
            any::<[bool; 6]>(),
            50_u32..=200,
            any::<[u32; 3]>(),
            0_u32..=1000,
        )
            .prop_map(
                |(
                    (m, h),
                    spindles,
                    (main_spindle_axis, main_spindle_name),
                    flags,
                    ahead,
                    distances,
                    joint_blocks,
                )| {
                    let mut settings = ChannelSettings {
                        spindles,
                        main_spindle_axis,
                        main_spindle_name,
                        gear_change: false,
                        spindle_m_free: flags[0],
                        m6_implicit_call: flags[1],
                        late_sync_ready: flags[2],
                        pre_output: PreOutput {
                            active_profile: flags[3],
                            value_to_go: flags[4],
                            blocks: ahead,
                        },
                        micro_joint: MicroJoint {
                            enabled: flags[5],
                            blocks: joint_blocks,
                            distance: distances[0],
                            tolerance: distances[1],
                        },
                        edge_banding: EdgeBanding {
                            residual_path: distances[2] / 2,
                        },
                        ..ChannelSettings::default()
                    };
                    for (number, function) in m {
                        *settings.m.get_mut(number).unwrap() = function;
                    }
                    for (number, function) in h {
                        *settings.h.get_mut(number).unwrap() = function;
                    }
                    settings
                },
            )
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..Default::default() })]

        /// What is written is read back, whatever is set.
        #[test]
        fn written_lists_are_read_back(settings in settings()) {
            let list = ChannelList::from_bytes(settings.to_list().as_bytes());
            prop_assert_eq!(list.errors(), &[]);
            prop_assert_eq!(list.settings(), &settings);
        }

        /// Any text has its faults within its lines.
        #[test]
        fn any_text_is_a_list(
            text in "((m_synch|h_pre_outp|spindel|configuration\\.channel|gruppe)(\\[[0-9 ]{0,5}\\]?)?[. ]{0,2}\
                     (achse\\[0\\]|m3_synch|0x[0-9A-F]{1,9}|MOS|\\||FCT_A|-1)?.{0,9}\n?){0,30}"
        ) {
            let list = ChannelList::from_bytes(text.as_bytes());
            for fault in list.errors().iter().chain(list.warnings()) {
                prop_assert!(fault.span.line >= 1 && fault.span.column >= 1);
                let line = list.line(fault.span.line as usize);
                prop_assert!(fault.span.column as usize <= line.chars().count() + 1);
            }
        }
    }
}
