//! Modules 9080 to 9083: the PLC window of the screen [000:15247-15326].

use super::{Call, Outcome};
use crate::{Bar, PlcError, PlcWindow};

/// 9080: deletes the window.
pub(super) fn clear(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    if call.from_submit {
        call.nc.window().clear();
    }
    Ok(Outcome::of(call.from_submit))
}

/// 9081: whether the window is shown: bit 0 on the selected screen, bit 1 that screen is in the foreground.
/// Its page is lost; M3171 keeps its value.
pub(super) fn status(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let view = call.nc.window_view();
    call.result(i32::from(view.displayed) | i32::from(view.in_foreground) << 1)?;
    Ok(Outcome::Untouched)
}

/// 9082: shows a string. A colour that does not exist is an error too (inferred).
pub(super) fn show_text(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [line, column, colour, string] = call.arguments()?;
    let text = call.text(string).map(|text| call.resolved(&text));
    let (Some(line), Some(column), Some(colour), Some(text)) = (
        line_number(line),
        column_number(column),
        colour_number(colour),
        text,
    ) else {
        return Ok(Outcome::Failed);
    };
    if !call.from_submit || column + text.len() > PlcWindow::COLUMNS {
        return Ok(Outcome::Failed);
    }
    call.nc.window().write(line, column, colour, &text);
    Ok(Outcome::Done)
}

/// 9083: shows a bar chart. Its call is lost; the arguments are in the order in which the text names them,
/// and only a submit job may call (inferred).
pub(super) fn show_bar(call: &mut Call<'_>) -> Result<Outcome, PlcError> {
    let [line, maximum, current, bar_colour, scale_colour] = call.arguments()?;
    let (Some(line), Ok(maximum), Ok(current), Some(bar_colour), Some(scale_colour)) = (
        line_number(line),
        u32::try_from(maximum),
        u32::try_from(current),
        colour_number(bar_colour),
        colour_number(scale_colour),
    ) else {
        return Ok(Outcome::Failed);
    };
    if call.from_submit {
        let bar = Bar::new(maximum, current, bar_colour, scale_colour);
        call.nc.window().show_bar(line, bar);
    }
    Ok(Outcome::of(call.from_submit))
}

fn line_number(line: i32) -> Option<usize> {
    usize::try_from(line).ok().filter(|line| *line < PlcWindow::LINES)
}

fn column_number(column: i32) -> Option<usize> {
    usize::try_from(column)
        .ok()
        .filter(|column| *column < PlcWindow::COLUMNS)
}

fn colour_number(colour: i32) -> Option<u8> {
    u8::try_from(colour).ok().filter(|colour| *colour <= 15)
}
