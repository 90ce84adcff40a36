//! What parameters of a channel say together: `zero`, `tools`, `m`.

use bahn_system900::{DataFile, MFunction, Tools, ZeroPoints, m_number};
use serde::Serialize;

use super::options::{ChannelOptions, MOptions};
use super::source;
use crate::options::Format;
use crate::{Outcome, UsageError, console};
use bahn_report::count;

/// Shows what is found out about a channel of a file.
fn show<T: Serialize>(
    options: &ChannelOptions,
    find: impl Fn(&DataFile) -> T,
    text: impl Fn(&T) -> String,
) -> Result<Outcome, UsageError> {
    let Some(file) = source::readable(&options.file.file)? else {
        return Ok(Outcome::ProgramError);
    };
    let channels = file.memory().channels();
    if options.channel > channels {
        let there = count(channels, "channel");
        let why = format!("--channel {}: the file has {there}", options.channel);
        return Err(UsageError::new(why));
    }
    let found = find(&file);
    match options.file.format {
        Format::Json => console::print_json(&found)?,
        Format::Text => console::print(&text(&found))?,
    }
    Ok(Outcome::Fine)
}

pub(super) fn zero(options: &ChannelOptions) -> Result<Outcome, UsageError> {
    let find = |file: &DataFile| ZeroPoints::of(file.memory(), options.channel);
    show(options, find, |points| {
        format!("{points}{}\n", count(points.count, "parameter"))
    })
}

pub(super) fn tools(options: &ChannelOptions) -> Result<Outcome, UsageError> {
    let find = |file: &DataFile| Tools::of(file.memory(), options.channel);
    show(options, find, |tools| {
        format!("{tools}{}\n", count(tools.count, "record"))
    })
}

pub(super) fn m(options: &MOptions) -> Result<Outcome, UsageError> {
    let number = |word: &String| {
        m_number(word).ok_or_else(|| UsageError::new(format!("`{word}` is no M function from M0 to M999")))
    };
    let numbers = options.functions.iter().map(number);
    let numbers = numbers.collect::<Result<Vec<u16>, _>>()?;
    let channel = options.of.channel;
    let find = |file: &DataFile| match numbers.as_slice() {
        [] => MFunction::defined(file.memory(), channel),
        some => some
            .iter()
            .map(|m| MFunction::of(file.memory(), channel, *m))
            .collect(),
    };
    show(&options.of, find, |found| {
        found.iter().map(|function| format!("{function}\n")).collect()
    })
}
