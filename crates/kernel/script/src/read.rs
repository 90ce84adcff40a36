//! From text to a script.

use std::path::Path;

use bahn_text::{Diagnostic, Span};

use crate::fault::Fault;
use crate::line::{Line, Script};
use crate::times::{Base, Moment, Times};
use crate::words::Words;

/// Faulty lines that are named; after them reading ends.
const FAULTS_MAX: usize = 1000;

/// What a player of scripts knows: what is done, waited for and ruled.
pub trait Verbs {
    /// What a line does at its time.
    type Action;
    /// What a line waits for.
    type Condition;

    /// What stands after a time.
    ///
    /// # Errors
    /// When it is nothing that can be done.
    fn action<'a>(&mut self, what: &'a str) -> Result<Self::Action, Fault<'a>>;

    /// What is done at the end of a span of time at whose beginning this is done. By default nothing has an end.
    ///
    /// # Errors
    /// When it is done in a moment.
    fn end<'a>(&mut self, what: &'a str) -> Result<Self::Action, Fault<'a>> {
        Err(Fault::new(
            what,
            "it has no end: it takes a time, no span of time",
        ))
    }

    /// Whether this only looks at what is so. By default nothing does.
    fn looks(&self, _action: &Self::Action) -> bool {
        false
    }

    /// Why no program is ever started, so that nothing counts from its start. By default one is.
    ///
    /// # Errors
    /// In words.
    fn started(&self) -> Result<(), String> {
        Ok(())
    }

    /// What stands after `when`. By default there are no conditions.
    ///
    /// # Errors
    /// When it is nothing to wait for.
    fn condition<'a>(&mut self, text: &'a str) -> Result<Vec<Self::Condition>, Fault<'a>> {
        Err(Fault::new(text, "there is nothing to wait for here: times only"))
    }

    /// `after message TEXT`. By default there are no messages.
    ///
    /// # Errors
    /// In words.
    fn message(&mut self, _text: &str) -> Result<Vec<Self::Condition>, String> {
        Err("there is nothing to wait for here: times only".to_owned())
    }

    /// A line without a time: it holds all the time. By default there are none.
    ///
    /// # Errors
    /// When it is no rule.
    fn rule<'a>(&mut self, line: &'a str, _words: &mut Words<'a>, _times: &Times) -> Result<(), Fault<'a>> {
        Err(Fault::new(line.trim(), "a line is `TIME: WHAT`"))
    }
}

impl<A, C> Script<A, C> {
    /// Reads a script, with all that is wrong in it; lines with faults do nothing.
    pub fn read<V>(path: &Path, text: &str, times: Times, verbs: &mut V) -> (Script<A, C>, Vec<Diagnostic>)
    where
        V: Verbs<Action = A, Condition = C>,
    {
        let mut script = Script::of_text(path, text);
        let mut faults = Vec::new();
        let mut reader = Reader {
            verbs,
            times,
            conditions: 0,
        };
        for (number, line) in (1..).zip(text.lines()) {
            let content = without_comment(line);
            if content.trim().is_empty() {
                continue;
            }
            if faults.len() == FAULTS_MAX {
                let message = "too many faults: what follows is not read";
                faults.push(script.located(Diagnostic::error(Span::line(number), message)));
                break;
            }
            if let Err(fault) = reader.line(number, content, &mut script.lines) {
                faults.push(script.located(fault.in_line(number, content)));
            }
        }
        (script, faults)
    }
}

/// Reads line after line.
struct Reader<'v, V> {
    verbs: &'v mut V,
    times: Times,
    conditions: usize,
}

impl<V: Verbs> Reader<'_, V> {
    fn line<'a>(
        &mut self,
        number: usize,
        line: &'a str,
        lines: &mut Vec<Line<V::Action, V::Condition>>,
    ) -> Result<(), Fault<'a>> {
        let Some((time, what)) = split_time(line) else {
            let mut words = Words::new(number, line);
            self.verbs.rule(line, &mut words, &self.times)?;
            return words.end();
        };
        let (time, what) = (time.trim(), what.trim());
        let condition = self.condition(time)?;
        let (mut from, to) = match condition.is_empty() {
            false => (self.times.last, None),
            true => self.times.moments(time, &|| self.verbs.started())?,
        };
        let mut action = self.verbs.action(what)?;
        // What is done in a cycle is done before it; what is looked at is so after it.
        let after = condition.is_empty() && from.cycle && self.verbs.looks(&action);
        if after {
            from.us += u64::from(self.times.cycle_us);
        }
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        let of = |moment: Moment, condition, action| Line {
            number,
            base: moment.base,
            offset_us: moment.us,
            after,
            condition,
            action,
        };
        self.times.last = Moment { cycle: false, ..from };
        if let Some(to) = to {
            let end = self.verbs.end(what)?;
            lines.push(of(from, Vec::new(), action));
            action = end;
            from = to;
            self.times.last = Moment { cycle: false, ..to };
        } else if !condition.is_empty() {
            self.times.last = Moment {
                base: Base::Condition(self.conditions),
                us: 0,
                cycle: false,
            };
            self.conditions += 1;
        }
        lines.push(of(from, condition, action));
        Ok(())
    }

    /// `when X.actual > 50`, `when message "TEXT"`, `after message TEXT`; nothing for a time.
    fn condition<'a>(&mut self, time: &'a str) -> Result<Vec<V::Condition>, Fault<'a>> {
        let (word, rest) = time.split_once(char::is_whitespace).unwrap_or((time, ""));
        match word {
            "when" => self.verbs.condition(rest.trim()),
            "after" => {
                let text = rest.trim().strip_prefix("message").map(str::trim);
                let text = text.map(|text| text.trim_matches('"'));
                let text = text.filter(|text| !text.is_empty());
                let text = text.ok_or_else(|| Fault::new(time, "it is written `after message TEXT`"))?;
                let condition = self.verbs.message(text);
                condition.map_err(|message| Fault::new(time, message))
            }
            _ => Ok(Vec::new()),
        }
    }
}

/// What stands before and after the first colon outside quotes.
/// A channel after `when` belongs to the condition: `when 2:X.actual > 50: ce`.
fn split_time(line: &str) -> Option<(&str, &str)> {
    let condition = line.trim_start().strip_prefix("when ").map(str::trim_start);
    let before = condition.map_or(0, |condition| match condition.as_bytes() {
        [b'1'..=b'9', b':', ..] => line.len() - condition.len() + 2,
        [b'm', b'o', b'd', b'u', b'l', b'e', b':', ..] => line.len() - condition.len() + 7,
        _ => 0,
    });
    let mut quoted = false;
    let at = line.get(before..)?.find(|character: char| {
        quoted ^= character == '"';
        character == ':' && !quoted
    })?;
    let at = before + at;
    Some((line.get(..at)?, line.get(at + 1..)?))
}

/// A line without what stands after ; or # outside quotes and words.
fn without_comment(line: &str) -> &str {
    let (mut quoted, mut before) = (false, ' ');
    let end = line.find(|character: char| {
        quoted ^= character == '"';
        let begins = std::mem::replace(&mut before, character).is_whitespace();
        matches!(character, ';' | '#') && begins && !quoted
    });
    line.split_at(end.unwrap_or(line.len())).0
}
