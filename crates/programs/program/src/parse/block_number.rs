//! The number before a block.

use std::io::Write;

use super::cursor::Cursor;

/// Reads optional block number, perhaps after N, and `/`, in either order, and the blanks after; whether the block is
/// optional.
#[inline]
pub(crate) fn prefix(c: &mut Cursor) -> bool {
    c.skip_blanks();
    let mut skip = false;
    if c.peek() == b'/' {
        skip = true;
        c.advance(1);
        c.skip_blanks();
    }
    if c.peek_upper() == b'N' && c.peek_at(1).is_ascii_digit() {
        c.advance(1);
    }
    while c.peek().is_ascii_digit() {
        c.advance(1);
    }
    c.skip_blanks();
    if c.peek() == b'/' {
        skip = true;
        c.advance(1);
        c.skip_blanks();
    }
    skip
}

/// Appends a block's text with another number before it.
pub(crate) fn renumber(text: &[u8], number: u32, new: &mut Vec<u8>) {
    let mut c = Cursor::new(text);
    let skip = prefix(&mut c);
    // Writing to a vector cannot fail.
    let _ = write!(new, "{number}");
    new.extend_from_slice(if skip { b" / " } else { b" " });
    new.extend_from_slice(c.rest());
}
