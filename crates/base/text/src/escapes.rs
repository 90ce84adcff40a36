//! Bytes as text in commands.

/// The bytes of a text with the escapes `\n`, `\r`, `\t`, `\\`, `\'`, `\"` and `\x41`, as commands have it; `None` when
/// it has others.
///
/// ```
/// assert_eq!(bahn_text::unescaped("L X+5\\x20;\\n"), Some(b"L X+5 ;\n".to_vec()));
/// assert_eq!(bahn_text::unescaped("\\q"), None);
/// ```
pub fn unescaped(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        if *first != b'\\' {
            bytes.push(*first);
            continue;
        }
        let (escape, after) = rest.split_first()?;
        rest = after;
        bytes.push(match escape {
            b'n' => b'\n',
            b'r' => b'\r',
            b't' => b'\t',
            b'\\' | b'\'' | b'"' => *escape,
            b'x' => {
                let (digits, after) = rest.split_at_checked(2)?;
                rest = after;
                u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?
            }
            _ => return None,
        });
    }
    Some(bytes)
}

/// The bytes that a text in quotes stands for, `None` when it is not quoted or holds a wrong escape.
pub fn quoted(text: &str) -> Option<Vec<u8>> {
    let inner = text.strip_prefix('"')?.strip_suffix('"')?;
    let read = unescaped(inner)?;
    // A quote that is no escape would end the text.
    let ends = inner.replace("\\\\", "").replace("\\\"", "").contains('"');
    (!ends).then_some(read)
}
