//! `machine.toml`, which names the files that belong to a machine: what an editor reads and writes of it.

use bahn_host::{LoadedMachine, files};
use bahn_text::{Diagnostic, Encoding, decode};

use crate::site::Site;

/// The file that names what belongs to a machine.
const MACHINE: &str = "machine.toml";

/// What an entry says now; it may have been written since the machine was loaded.
pub(crate) fn value(key: &str, site: &Site) -> Option<String> {
    let text = files::read_table(&site.machine.root.join(MACHINE)).unwrap_or_default();
    entry_of(&decode(&text), key).map(str::to_owned)
}

/// Gives an entry another value; the other lines stay. The machine as it is loaded then.
///
/// # Errors
/// In words: a machine that could not be switched on again stays as it is.
pub(crate) fn set(key: &str, value: &str, site: &Site) -> Result<LoadedMachine, String> {
    let path = site.machine.root.join(MACHINE);
    let before = files::read_table(&path).map_err(|error| error.to_string())?;
    let (text, encoding) = Encoding::read(&before);
    let text = encoding.write(&with_entry(&text, key, value));
    files::write_whole(&path, &text).map_err(|error| error.to_string())?;
    loaded(site).or_else(|why| {
        files::write_whole(&path, &before).map_err(|error| error.to_string())?;
        Err(why)
    })
}

/// The machine as its files are now.
///
/// # Errors
/// The first fault of them, in words.
pub(crate) fn loaded(site: &Site) -> Result<LoadedMachine, String> {
    match LoadedMachine::load(&site.machine.root) {
        Ok(Ok(machine)) => Ok(machine),
        Ok(Err(faults)) => Err(faults.first().map_or_else(String::new, Diagnostic::words)),
        Err(error) => Err(error.to_string()),
    }
}

/// The value of an entry: a string of either kind, in one line.
fn entry_of<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let line = text.lines().find(|line| is_entry(line, key))?;
    split(line).map(|(value, _)| value)
}

/// The string of an entry, and what stands after it.
fn split(line: &str) -> Option<(&str, &str)> {
    let value = line.split_once('=')?.1.trim_start();
    let quote = value.chars().next().filter(|first| matches!(first, '"' | '\''))?;
    value.get(1..)?.split_once(quote)
}

fn is_entry(line: &str, key: &str) -> bool {
    line.split('=').next().map(str::trim) == Some(key)
}

/// The text with another value of an entry, which stands before the first table when it is new.
fn with_entry(text: &str, key: &str, value: &str) -> String {
    let entry = format!("{key} = \"{value}\"");
    let lines: Vec<&str> = text.lines().collect();
    let own = lines.iter().position(|line| is_entry(line, key));
    let table = lines.iter().position(|line| line.trim_start().starts_with('['));
    let mut lines: Vec<String> = lines.into_iter().map(str::to_owned).collect();
    match own {
        Some(at) => {
            if let Some(line) = lines.get_mut(at) {
                // A # within the string begins no comment.
                let after = split(line).map_or(line.as_str(), |(_, after)| after);
                let comment = after.find('#').and_then(|at| after.get(at..));
                *line = comment.map_or_else(|| entry.clone(), |comment| format!("{entry}  {comment}"));
            }
        }
        None => lines.insert(table.unwrap_or(lines.len()), entry),
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_a_string_of_either_kind() {
        let text = "plc_messages='plc/A.ER1'\nplc_dialogues  =  \"plc/O'NEIL.DI1\"  # \"plc/B.DI1\"\nplc_other = 7\n";
        assert_eq!(entry_of(text, "plc_messages"), Some("plc/A.ER1"));
        assert_eq!(entry_of(text, "plc_dialogues"), Some("plc/O'NEIL.DI1"));
        assert_eq!((entry_of(text, "plc_other"), entry_of(text, "plc")), (None, None));
    }

    #[test]
    fn an_entry_takes_another_value_and_the_rest_stays() {
        let text = "name = \"M\"\nplc_messages = \"plc/A.ER1\"   # messages\n\n[datum]\nX = 1\n";
        let other = "name = \"M\"\nplc_messages = \"plc/B.ER1\"  # messages\n\n[datum]\nX = 1\n";
        assert_eq!(with_entry(text, "plc_messages", "plc/B.ER1"), other);
        let hash = "plc = 'plc/A#1.PLC' # main file\nplc_messages = \"plc/#.ER1\"\n";
        let other = "plc = \"plc/B.PLC\"  # main file\nplc_messages = \"plc/#.ER1\"\n";
        assert_eq!(with_entry(hash, "plc", "plc/B.PLC"), other);
        let bare = "plc = 'plc/A#1.PLC' # main file\nplc_messages = \"plc/B.ER1\"\n";
        assert_eq!(with_entry(hash, "plc_messages", "plc/B.ER1"), bare);
        let new = "name = \"M\"\nplc_messages = \"plc/A.ER1\"   # messages\n\nplc_dialogues = \"plc/D.DI1\"\n[datum]\nX = 1\n";
        assert_eq!(with_entry(text, "plc_dialogues", "plc/D.DI1"), new);
    }
}
