//! How lines are written tidily, whatever the dialect: words one blank apart, comments as they stand.

use crate::line::Glyph;
use crate::source::Source;

/// A text whose lines are written anew, each with its ending; where `written` gives `None` a line stays as it stands.
pub(crate) fn rewritten(source: &Source, written: impl Fn(u32, &str) -> Option<String>) -> String {
    let mut listing = String::new();
    for number in 1..=source.line_count() {
        let text = source.line(number);
        match written(number, text) {
            Some(text) => listing.push_str(&text),
            None => listing.push_str(text),
        }
        listing.push_str(source.ending(number));
    }
    listing
}

/// A line of blanks alone without them; `None` where it needs them.
pub(crate) fn emptied(source: &Source, number: u32) -> Option<String> {
    // Without blanks the last line may be none, and endings around one be a single one.
    let (before, own) = (source.ending(number.saturating_sub(1)), source.ending(number));
    let stays = own.is_empty() || before == "\r" && own == "\n";
    (!stays).then(String::new)
}

/// Whether all characters between comments are of ASCII. Whatever blanks others are in their code page, without them the
/// bytes of the file may be another one.
pub(crate) fn is_plain(glyphs: &[Glyph]) -> bool {
    glyphs.iter().all(|glyph| glyph.character.is_ascii())
}

/// Whether a comment stands within a word.
pub(crate) fn is_parted(word: (u32, u32), comments: &[(u32, String)]) -> bool {
    let (column, length) = word;
    let span = column..column.saturating_add(length);
    comments.iter().any(|(column, _)| span.contains(column))
}

/// Parts of a line, by their columns, a blank apart.
pub(crate) fn in_order(mut parts: Vec<(u32, String)>) -> String {
    parts.sort_by_key(|(column, _)| *column);
    let parts: Vec<String> = parts.into_iter().map(|(_, text)| text).collect();
    parts.join(" ")
}

/// The characters of a word.
pub(crate) fn of_word(glyphs: &[Glyph], column: u32, length: u32) -> impl Iterator<Item = &Glyph> {
    let from = glyphs.iter().skip_while(move |glyph| glyph.column < column);
    from.take_while(move |glyph| glyph.column - column < length)
}

/// Characters of a word in capitals. Of the blanks one stays where letters or digits would join that are no address and
/// its number, and in a command before its brackets.
pub(crate) fn tight<'a>(glyphs: impl Iterator<Item = &'a Glyph>, is_command: bool) -> String {
    let mut text = String::new();
    let mut is_blank = false;
    for glyph in glyphs {
        if glyph.character.is_whitespace() {
            is_blank = true;
            continue;
        }
        let before = text.chars().next_back();
        let joins = |before: char| {
            let is_word = before.is_ascii_alphanumeric() || matches!(before, '_' | '.' | ']' | '\'');
            let is_value = before.is_ascii_alphabetic() && glyph.character.is_ascii_digit();
            let opens = is_command && glyph.character == '[';
            opens || is_word && glyph.character.is_ascii_alphanumeric() && !is_value
        };
        if is_blank && before.is_some_and(joins) {
            text.push(' ');
        }
        is_blank = false;
        text.push(glyph.character.to_ascii_uppercase());
    }
    text
}
