//! Text that steers no terminal.

/// Lines of text of which each is [`printable`].
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// Text in which every character that would steer the terminal is shown by a picture of it, one for one: the
/// start of an escape sequence as \u{241b}. A tab is a blank.
pub fn printable(text: &str) -> String {
    const PICTURES: u32 = 0x2400;
    let picture = |c: char| char::from_u32(PICTURES + u32::from(c)).unwrap_or(char::REPLACEMENT_CHARACTER);
    text.chars()
        .map(|c| match c {
            '\t' => ' ',
            '\0'..='\x1f' => picture(c),
            '\x7f' => '\u{2421}',
            // What turns the direction of writing can hide what a line says.
            '\u{80}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                char::REPLACEMENT_CHARACTER
            }
            c => c,
        })
        .collect()
}
