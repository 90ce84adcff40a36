//! What is said of parameters by their names: `explain`, `map`, `get`, `set`, `diff`.

use bahn_parameters::chapters;
use bahn_system900::{Change, Explanation, Held, Mapped, Name, differences};

use super::options::{DiffOptions, ExplainOptions, NamesOptions, SetOptions};
use super::source;
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console, diagnostics, files};
use bahn_report::count;
use bahn_report::paragraph::{labelled, labelled_lines};

fn name(word: &str) -> Result<Name, UsageError> {
    word.parse::<Name>()
        .map_err(|error| UsageError::new(error.to_string()))
}

/// What is wrong is shown; nothing else comes out.
fn refused(why: &str) -> Outcome {
    diagnostics::print_usage_error(why);
    Outcome::ProgramError
}

pub(super) fn explain(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let names = options.names.iter().map(|word| name(word));
    let names = names.collect::<Result<Vec<Name>, _>>()?;
    let mut rows = Vec::new();
    for name in names {
        match Explanation::of(name) {
            Some(row) => rows.push(row),
            None => {
                return Ok(refused(&format!(
                    "{name}: the manual does not explain this number"
                )));
            }
        }
    }
    match options.format {
        Format::Json => console::print_json(&rows)?,
        Format::Text => {
            let texts: Vec<String> = rows.iter().map(explained).collect();
            console::print_bytes(texts.join("\n").as_bytes())?;
        }
    }
    Ok(Outcome::Fine)
}

fn explained(row: &Explanation) -> String {
    let base = match row.name.to_string() == row.base {
        true => String::new(),
        false => format!(" (as {})", row.base),
    };
    let title = format!("{}{base}  {}", row.name, row.title);
    let mut text = format!("{}\n", Style::of_output().bold(&title));
    let mut line = |label: &str, content: &str| text += &labelled(label, content);
    line("does:", row.meaning);
    line("kind:", row.kind);
    line("values:", row.values);
    line("unit:", row.unit);
    line("default:", row.default);
    line("needs:", row.needs_words);
    let effect = format!("{}: {}", row.effect, row.reason);
    line("effect:", effect.trim_end_matches(": "));
    line("PLC:", &row.plc.join(", "));
    text + &labelled_lines("source:", &chapters(row.source))
}

pub(super) fn map(options: &NamesOptions) -> Result<Outcome, UsageError> {
    let Some(file) = source::readable(&options.file.file)? else {
        return Ok(Outcome::ProgramError);
    };
    let words = options.names.iter();
    let found: Vec<Mapped> = words.map(|word| Mapped::of(file.memory(), word)).collect();
    match options.file.format {
        Format::Json => console::print_json(&found)?,
        Format::Text => {
            for Mapped { name, q, error } in &found {
                match (q, error) {
                    (Some(q), _) => console::print(&format!("{name}  q{q}\n"))?,
                    (None, error) => diagnostics::print_usage_error(error.as_deref().unwrap_or(name)),
                }
            }
        }
    }
    let is_wrong = found.iter().any(|found| found.error.is_some());
    Ok(if is_wrong {
        Outcome::ProgramError
    } else {
        Outcome::Fine
    })
}

pub(super) fn get(options: &NamesOptions) -> Result<Outcome, UsageError> {
    let names = options.names.iter().map(|word| name(word));
    let names = names.collect::<Result<Vec<Name>, _>>()?;
    let Some(file) = source::readable(&options.file.file)? else {
        return Ok(Outcome::ProgramError);
    };
    let held = names.into_iter().map(|name| Held::of(file.memory(), name));
    match held.collect::<Result<Vec<Held>, _>>() {
        Ok(held) => {
            show(&held, options.file.format)?;
            Ok(Outcome::Fine)
        }
        Err(error) => Ok(refused(&error.to_string())),
    }
}

fn show(held: &[Held], format: Format) -> Result<(), UsageError> {
    if format == Format::Json {
        return console::print_json(&held);
    }
    held.iter()
        .try_for_each(|held| console::print(&format!("{held}\n")))
}

/// A name and what it is given.
fn given(word: &str) -> Result<(Name, &str), UsageError> {
    let (named, given) = word
        .split_once('=')
        .ok_or_else(|| UsageError::new(format!("`{word}` is not NAME=VALUE")))?;
    Ok((name(named)?, given))
}

pub(super) fn set(options: &SetOptions) -> Result<Outcome, UsageError> {
    let mut changes = Vec::new();
    for word in &options.values {
        let (name, value) = given(word)?;
        let (value, status) = (Some(value.to_owned()), None);
        changes.push(Change { name, value, status });
    }
    for word in &options.status {
        let (name, status) = given(word)?;
        let status = status
            .parse()
            .map_err(|error| UsageError::new(format!("{name}: {error}")))?;
        let (value, status) = (None, Some(status));
        changes.push(Change { name, value, status });
    }
    let output = &options.output;
    if output.is_file() && !options.force {
        let there = format!("{} is there already; --force replaces it", output.display());
        return Err(UsageError::new(there));
    }
    let Some(file) = source::readable(&options.file.file)? else {
        return Ok(Outcome::ProgramError);
    };
    let file = match file.changed(&changes) {
        Ok(file) => file,
        Err(why) => return Ok(refused(&why)),
    };
    files::write_whole(output, &file.bytes())?;
    let mut names: Vec<Name> = changes.iter().map(|change| change.name).collect();
    names.dedup();
    let held = names
        .into_iter()
        .filter_map(|name| Held::of(file.memory(), name).ok());
    show(&held.collect::<Vec<_>>(), options.file.format)?;
    Ok(Outcome::Fine)
}

pub(super) fn diff(options: &DiffOptions) -> Result<Outcome, UsageError> {
    let (Some(a), Some(b)) = (source::readable(&options.a)?, source::readable(&options.b)?) else {
        return Ok(Outcome::ProgramError);
    };
    let found = differences(a.memory(), b.memory());
    if options.format == Format::Json {
        console::print_json(&found)?;
        return Ok(Outcome::Fine);
    }
    let lines: String = found.iter().map(|found| format!("{found}\n")).collect();
    console::print(&format!("{lines}{}\n", count(found.len(), "difference")))?;
    Ok(Outcome::Fine)
}
