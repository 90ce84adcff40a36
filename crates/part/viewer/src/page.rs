//! The page: everything in one file.

use std::io::{self, Write};

use bahn_workpiece::Part;

use crate::bytes::base64;
use crate::scene::{self, About, Recording};

/// A file of the viewer for a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WebFile {
    /// Its name; modules import each other by it.
    pub name: &'static str,
    /// Its type for HTTP.
    pub mime: &'static str,
    /// Its content, UTF-8.
    pub text: &'static str,
}

macro_rules! files {
    ($($name:literal $mime:literal,)*) => {
        /// The modules and styles of the viewer. A module stands after those that it imports.
        pub const FILES: &[WebFile] = &[
            $(WebFile { name: $name, mime: $mime, text: include_str!(concat!("../web/", $name)) },)*
        ];
    };
}

files! {
    "codec.js" "text/javascript",
    "camera.js" "text/javascript",
    "shaders.js" "text/javascript",
    "relief.js" "text/javascript",
    "lines.js" "text/javascript",
    "tool.js" "text/javascript",
    "view.js" "text/javascript",
    "overlay.js" "text/javascript",
    "controls.js" "text/javascript",
    "list.js" "text/javascript",
    "page.js" "text/javascript",
    "viewer.css" "text/css",
}

/// The body of a page that shows the part alone.
const BODY: &str = include_str!("../web/page.html");

/// What stands around the part: canvas, keys and readout, in a page of any other, too, at its [`STAGE_PLACE`].
pub const STAGE: &str = include_str!("../web/stage.html");

/// Where the stage stands in a page.
pub const STAGE_PLACE: &str = "<!-- stage -->\n";

/// Nothing is fetched from anywhere.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

/// Writes the page of a run: one file that needs nothing else, with the part at moments along the path.
///
/// # Errors
/// When it cannot be written.
pub fn write_page(
    out: &mut impl Write,
    recording: Recording,
    part: Option<&Part>,
    about: &About,
) -> io::Result<()> {
    let data = scene::write(recording, part, about)?;
    write!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <title>{title}</title>\n<style>\n",
        title = escaped(&about.title)
    )?;
    for file in FILES.iter().filter(|file| file.mime == "text/css") {
        out.write_all(file.text.as_bytes())?;
    }
    write!(
        out,
        "</style>\n</head>\n<body>\n{body}<script id=\"data\" type=\"application/octet-stream\">{}</script>\n\
         <script type=\"module\">\n",
        base64(&data),
        body = BODY.replace(STAGE_PLACE, STAGE)
    )?;
    for file in FILES.iter().filter(|file| file.mime == "text/javascript") {
        out.write_all(as_one(file.text).as_bytes())?;
    }
    out.write_all(b"</script>\n</body>\n</html>\n")
}

/// A module as a piece of one script: the names that it imports are there already.
fn as_one(module: &str) -> String {
    let mut text = String::with_capacity(module.len());
    for line in module.lines().filter(|line| !line.starts_with("import ")) {
        text.push_str(line.strip_prefix("export ").unwrap_or(line));
        text.push('\n');
    }
    text
}

/// Text in which nothing is taken for HTML, neither between tags nor in the value of an attribute.
///
/// ```
/// assert_eq!(bahn_viewer::escaped("R<6 & \"T1\""), "R&lt;6 &amp; &quot;T1&quot;");
/// ```
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            other if other.is_control() => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_become_one_script() {
        let module = "// one\nimport { a } from './a.js';\nexport const b = a;\nconst c = 'import ';\n";
        assert_eq!(as_one(module), "// one\nconst b = a;\nconst c = 'import ';\n");
    }

    /// What a module imports stands before it, or the one script would miss it.
    #[test]
    fn modules_stand_after_those_that_they_import() {
        let mut before: Vec<&str> = Vec::new();
        for file in FILES.iter().filter(|file| file.mime == "text/javascript") {
            for line in file.text.lines().filter(|line| line.starts_with("import ")) {
                let from = line.split("'./").nth(1).unwrap().split('\'').next().unwrap();
                assert!(
                    line.ends_with(';'),
                    "{}: an import stands on one line: {line}",
                    file.name
                );
                assert!(before.contains(&from), "{} imports {from}", file.name);
            }
            assert!(!file.text.contains("</script"), "{}", file.name);
            before.push(file.name);
        }
    }

    #[test]
    fn names_are_no_markup() {
        assert_eq!(escaped("<b>&\"\u{1b}"), "&lt;b&gt;&amp;&quot; ");
    }
}
