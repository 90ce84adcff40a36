//! Expectations as JUnit XML, which build servers read: one test case for each.

use std::fmt::Write;
use std::io::Write as _;
use std::path::Path;

pub use bahn_host::{Case, Verdict};

use crate::ReportError;
use bahn_host::files::{self, NewFile};

/// Writes the cases of a run. `stopped` is the error that ended it, a case of its own.
pub fn write(path: &Path, suite: &str, cases: &[Case], stopped: Option<&str>) -> Result<(), ReportError> {
    let mut file = NewFile::create(path)?;
    file.write_all(xml(suite, cases, stopped).as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}

fn xml(suite: &str, cases: &[Case], stopped: Option<&str>) -> String {
    let count = |wanted: fn(&Verdict) -> bool| cases.iter().filter(|case| wanted(&case.verdict)).count();
    let failed = count(|verdict| matches!(verdict, Verdict::Failed(_)));
    let skipped = count(|verdict| matches!(verdict, Verdict::NotReached));
    let errors = usize::from(stopped.is_some());
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"{}\" tests=\"{}\" \
         failures=\"{failed}\" errors=\"{errors}\" skipped=\"{skipped}\">\n",
        escaped(suite),
        cases.len() + errors,
    );
    for case in cases {
        let head = format!(
            "    <testcase classname=\"{}\" name=\"{}\"",
            escaped(&case.place),
            escaped(&case.name)
        );
        // Writing to a string cannot fail.
        let _ = match &case.verdict {
            Verdict::Held => writeln!(text, "{head}/>"),
            Verdict::Failed(found) => writeln!(
                text,
                "{head}>\n      <failure message=\"{}\"/>\n    </testcase>",
                escaped(found)
            ),
            Verdict::NotReached => {
                writeln!(
                    text,
                    "{head}>\n      <skipped message=\"the run ended before\"/>\n    </testcase>"
                )
            }
        };
    }
    if let Some(error) = stopped {
        let (suite, error) = (escaped(suite), escaped(error));
        let _ = writeln!(
            text,
            "    <testcase classname=\"{suite}\" name=\"the run ends as it should\">\n      \
             <error message=\"{error}\"/>\n    </testcase>"
        );
    }
    text + "  </testsuite>\n</testsuites>\n"
}

/// Text of an attribute; XML has no control characters.
fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => result += "&amp;",
            '<' => result += "&lt;",
            '>' => result += "&gt;",
            '"' => result += "&quot;",
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => result.push(' '),
            c => result.push(c),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_expectation_is_a_case() {
        let case = |name: &str, verdict| Case {
            place: "door.txt:3".to_owned(),
            name: name.to_owned(),
            verdict,
        };
        let cases = [
            case("O2=1", Verdict::Held),
            case("S0=\"A<B\"", Verdict::Failed("found \"A\u{1b}&\"".to_owned())),
            case("O3=1", Verdict::NotReached),
        ];
        let text = xml("door", &cases, Some("53 time out"));
        assert!(
            text.contains("tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"1\""),
            "{text}"
        );
        assert!(
            text.contains("classname=\"door.txt:3\" name=\"O2=1\"/>"),
            "{text}"
        );
        assert!(text.contains("name=\"S0=&quot;A&lt;B&quot;\""), "{text}");
        assert!(
            text.contains("<failure message=\"found &quot;A &amp;&quot;\"/>"),
            "{text}"
        );
        assert!(text.contains("<error message=\"53 time out\"/>"), "{text}");
        assert_eq!(text.matches("<testcase").count(), 4);
        assert_eq!(text.matches("</testcase>").count(), 3);
    }
}
