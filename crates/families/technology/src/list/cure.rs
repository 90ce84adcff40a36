//! What is probably meant in a line of a list that cannot be read.

use bahn_text::nearest;

use super::line::Line;
use super::table::{Definition, Kind, SynchRow, pattern};

/// What to do about it, where that can be guessed.
pub(super) fn cure(line: &Line) -> Option<String> {
    if line.name.contains('[') && !line.name.contains(']') {
        return Some(format!("did you mean `{}]`?", line.name.trim_end()));
    }
    let Some(definition) = Definition::named(line.name) else {
        return name(line.name).map(|name| format!("did you mean `{name}`?"));
    };
    match definition.kind {
        Kind::Synch(owner) => {
            let known = || {
                SynchRow::all()
                    .iter()
                    .filter(|row| row.is_for(owner))
                    .map(|row| row.name)
            };
            let words = line
                .value
                .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
            let odd = words.filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic()));
            let near = odd
                .filter(|word| known().all(|name| !name.eq_ignore_ascii_case(word)))
                .find_map(|word| nearest(word, known()));
            let all = || format!("it takes {}", definition.kind.range());
            Some(near.map_or_else(all, |name| format!("did you mean `{name}`?")))
        }
        Kind::Number { .. } | Kind::Flag | Kind::Name { .. } | Kind::Functions => {
            Some(format!("it takes {}", definition.kind.range()))
        }
    }
}

/// The name of a parameter that is nearest to an unknown one, with its indices.
fn name(written: &str) -> Option<String> {
    let wanted = pattern(written);
    let names = Definition::all().iter().flat_map(Definition::names);
    let patterns: Vec<(String, &str)> = names.map(|name| (pattern(name), name)).collect();
    let near = nearest(&wanted, patterns.iter().map(|(pattern, _)| pattern.as_str()))?;
    let (_, name) = patterns.iter().find(|(pattern, _)| pattern == near)?;
    let mut indices = written
        .split('[')
        .skip(1)
        .filter_map(|part| part.split(']').next());
    let mut parts = name.split("[i]").flat_map(|part| part.split("[j]"));
    let mut meant = parts.next()?.to_owned();
    for part in parts {
        meant += &format!("[{}]{part}", indices.next().unwrap_or("0"));
    }
    Some(meant)
}

#[cfg(test)]
mod tests {
    use super::super::ChannelList;

    #[test]
    fn slips_are_guessed() {
        for (text, meant) in [
            ("m_sinch[8] MOS", "`m_synch[8]`"),
            ("m_synch[8 MOS", "`m_synch[8]`"),
            ("m_synch[8] MVS_SSV", "`MVS_SVS`"),
            ("spindel[2].m3_snych MOS", "`spindel[2].m3_synch`"),
            ("h_synch[8] MVS_SLM", "MVS_SVS"),
            ("spindle_m_fct_free yes", "0 or 1"),
            ("m_h_pre_outp_nbr_block 5", "50 to 200"),
        ] {
            let list = ChannelList::from_bytes(text.as_bytes());
            let [error] = list.errors() else {
                panic!("{text}: {:?}", list.errors())
            };
            let help = error.help.clone().unwrap_or_default();
            assert!(help.contains(meant), "{text}: {error:?}");
        }
        let none = ChannelList::from_bytes(b"qwertz 5");
        assert_eq!(none.errors()[0].help, None);
    }
}
