//! What the dialogue says, in English and German: `data/prompts.tsv`.

use std::sync::OnceLock;

use crate::Tongue;

/// A text of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prompt {
    id: &'static str,
    english: &'static str,
    german: &'static str,
    source: &'static str,
}

impl Prompt {
    /// What it is found by.
    pub fn id(&self) -> &'static str {
        self.id
    }

    /// The words of the prompt in a language.
    pub fn text(&self, tongue: Tongue) -> &'static str {
        match tongue {
            Tongue::English => self.english,
            Tongue::German => self.german,
        }
    }

    /// Where a manual prints it, as `[003:2591]`, or that it is in the style of those.
    pub fn source(&self) -> &'static str {
        self.source
    }
}

/// All texts in the order of the table.
pub fn prompts() -> &'static [Prompt] {
    static TABLE: OnceLock<Vec<Prompt>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let lines = include_str!("../data/prompts.tsv").lines();
        let rows = lines.filter(|line| !line.starts_with('#'));
        rows.filter_map(|line| {
            let mut cells = line.split('\t');
            Some(Prompt {
                id: cells.next()?,
                english: cells.next()?,
                german: cells.next()?,
                source: cells.next()?,
            })
        })
        .collect()
    })
}

/// The text of an id.
pub(crate) fn prompt(id: &str) -> Option<&'static Prompt> {
    prompts().iter().find(|prompt| prompt.id == id)
}

/// The text of an id in a language; the id itself where the table has none.
pub(crate) fn text_of(id: &'static str, tongue: Tongue) -> &'static str {
    prompt(id).map_or(id, |prompt| prompt.text(tongue))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_line_is_a_complete_text_of_its_own() {
        let lines = include_str!("../data/prompts.tsv").lines();
        let rows: Vec<_> = lines.filter(|line| !line.starts_with('#')).collect();
        assert_eq!(rows.len(), prompts().len());
        let mut ids = HashSet::new();
        for prompt in prompts() {
            assert!(ids.insert(prompt.id), "{} stands twice", prompt.id);
            for text in [prompt.english, prompt.german] {
                assert!(!text.trim().is_empty(), "{} has no text", prompt.id);
                assert_eq!(text, text.to_uppercase(), "screens show capitals");
                assert!(text.chars().count() <= 60, "{text} is too long for the line");
            }
            assert!(!prompt.source.is_empty(), "{}", prompt.id);
        }
        for row in rows {
            assert_eq!(row.split('\t').count(), 4, "{row}");
        }
    }

    #[test]
    fn what_the_manual_prints_is_verbatim() {
        for (id, text) in [
            ("coordinates", "COORDINATES?"),
            ("compensation", "TOOL RADIUS COMP.: RL/RR/NO COMP.?"),
            ("feed_max", "FEED RATE F = ? / F MAX = ENT"),
            ("m", "MISCELLANEOUS FUNCTION M?"),
            ("circle_radius", "CIRCLE RADIUS (SIGN)?"),
            ("turn", "ROTATION CLOCKWISE: DR-?"),
            ("polar_radius", "POLAR COORDINATES RADIUS PR?"),
            ("polar_angle", "POLAR COORDINATES ANGLE PA?"),
            ("program", "PROGRAM NUMBER?"),
            ("cycle PITCH", "THREAD PITCH?"),
            ("probe approach", "AXIS AND DIRECTION OF APPROACH?"),
            ("probe start", "STARTING PROBE AXIS AND DIRECTN?"),
            ("probe TRAVEL:", "LIMIT IN NORMAL LINES DIRECTION?"),
            ("probe L.SPAC:", "LINE SPACING AND DIRECTION?"),
            ("probe P.P. INT:", "MAX. PROBE POINT INTERVAL?"),
        ] {
            let found = prompt(id).unwrap();
            assert_eq!(found.text(Tongue::English), text);
            assert!(found.source().starts_with('['), "{id}");
        }
    }
}
