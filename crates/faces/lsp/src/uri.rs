//! Names of documents: URIs for the editor, paths here.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use lsp_types::Uri;

/// The path that a URI means. One of another scheme than `file` leads to no file, but its ending tells the language.
pub(crate) fn path_of(uri: &Uri) -> PathBuf {
    let text = uri.as_str();
    let (scheme, rest) = text.split_once(':').unwrap_or(("", text));
    let rest = rest.strip_prefix("//").map_or(rest, |after| {
        // After the two strokes stands the host, mostly none.
        after.find('/').and_then(|at| after.get(at..)).unwrap_or(after)
    });
    let path = decoded(rest);
    if scheme != "file" {
        return PathBuf::from(format!("{scheme}:{path}"));
    }
    // A drive letter stands after a stroke of its own: /C:/parts.
    match path.as_bytes() {
        [b'/', drive, b':', ..] if drive.is_ascii_alphabetic() => {
            PathBuf::from(path.get(1..).unwrap_or_default())
        }
        _ => PathBuf::from(path),
    }
}

/// The `file:` URI of a path; `None` where it would be none.
pub(crate) fn uri_of(path: &Path) -> Option<Uri> {
    let text = path.to_string_lossy().replace('\\', "/");
    let stroke = if text.starts_with('/') { "" } else { "/" };
    let mut uri = format!("file://{stroke}");
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => {
                uri.push(char::from(byte))
            }
            _ => uri += &format!("%{byte:02X}"),
        }
    }
    Uri::from_str(&uri).ok()
}

fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let code = after.get(..2).and_then(|code| std::str::from_utf8(code).ok());
        let code = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        match code.filter(|_| *first == b'%') {
            Some(byte) => {
                bytes.push(byte);
                rest = after.get(2..).unwrap_or_default();
            }
            None => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_come_back() {
        for path in ["/parts/7.H", "/my parts/Höhe 100%.H", "/a#b?c/MAIN.PLC"] {
            let uri = uri_of(Path::new(path)).unwrap();
            assert_eq!(path_of(&uri), Path::new(path), "{}", uri.as_str());
        }
        let of = |text: &str| path_of(&Uri::from_str(text).unwrap());
        assert_eq!(of("file:///c%3A/parts/7.H"), Path::new("c:/parts/7.H"));
        assert_eq!(of("untitled:Untitled-1.H").extension().unwrap(), "H");
        assert_eq!(of("file://server/parts/7.H"), Path::new("/parts/7.H"));
    }
}
