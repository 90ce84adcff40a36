//! The table for spreadsheets, and back from there for a comparison.

use bahn_path::Axis;

use super::row::{Fault, Row, Said, Travel, Use, Verdict};
use crate::path_csv::push_number;
use bahn_text::{MARK, printable, without_mark};

const COLUMNS: [&str; 22] = [
    "path",
    "result",
    "message",
    "program",
    "block",
    "line",
    "detail",
    "time_s",
    "feed_mm",
    "rapid_mm",
    "blocks",
    "blank_X",
    "blank_Y",
    "blank_Z",
    "finished_X",
    "finished_Y",
    "finished_Z",
    "removed_mm3",
    "removed_kg",
    "finished_kg",
    "tools",
    "warnings",
];
/// Columns after those of the axes in use.
const LAST_COLUMNS: [&str; 3] = ["beyond_range", "warning_texts", "changes"];

/// How numbers and fields are separated.
#[derive(Clone, Copy)]
pub struct Style {
    comma: bool,
}

impl Style {
    /// Decimal commas with semicolons, or points with commas.
    pub fn new(comma: bool) -> Style {
        Style { comma }
    }

    fn separator(self) -> char {
        if self.comma { ';' } else { ',' }
    }

    fn number(self, value: f64) -> String {
        let mut digits = Vec::new();
        if value.is_finite() {
            push_number(&mut digits, value);
        }
        let text = String::from_utf8(digits).unwrap_or_default();
        if self.comma { text.replace('.', ",") } else { text }
    }

    fn known(self, value: Option<f64>) -> String {
        value.map_or(String::new(), |value| self.number(value))
    }

    fn field(self, text: &str) -> String {
        let lines: Vec<String> = text.split('\n').map(printable).collect();
        let text = lines.join("\n");
        if text.contains([self.separator(), '"', '\n', '\r']) {
            format!("\"{}\"", text.replace('"', "\"\""))
        } else {
            text
        }
    }
}

/// All rows with a header line; German spreadsheets know UTF-8 by its mark only.
pub fn write(rows: &[&Row], style: Style) -> String {
    let axes: Vec<String> = Axis::ALL
        .iter()
        .map(Axis::to_string)
        .filter(|axis| rows.iter().any(|row| row.travel.contains_key(axis)))
        .collect();
    let mut out: String = [MARK].into_iter().filter(|_| style.comma).collect();
    let mut line = |fields: Vec<String>| {
        let fields: Vec<String> = fields.iter().map(|field| style.field(field)).collect();
        out += &fields.join(&style.separator().to_string());
        out += "\r\n";
    };
    let of_axes = axes
        .iter()
        .flat_map(|axis| [format!("{axis}_least"), format!("{axis}_greatest")]);
    let header = COLUMNS.iter().map(|name| (*name).to_owned()).chain(of_axes);
    line(header.chain(LAST_COLUMNS.map(str::to_owned)).collect());
    for row in rows {
        line(fields(row, &axes, style));
    }
    out
}

fn fields(row: &Row, axes: &[String], style: Style) -> Vec<String> {
    let error = row.error.as_ref();
    let place = |value: Option<u32>| value.filter(|_| error.is_some_and(|error| error.line > 0));
    let whole = |value: Option<u32>| value.map_or(String::new(), |value| value.to_string());
    let text = |of: fn(&Fault) -> &String| error.map_or(String::new(), |error| of(error).clone());
    let tools: Vec<String> = row.tools.iter().map(|tool| tool_text(tool, style)).collect();
    let warnings: Vec<String> = row.warnings.iter().map(warning_text).collect();
    let mut fields = vec![
        row.path.clone(),
        row.result.text().to_owned(),
        text(|error| &error.message),
        text(|error| &error.program),
        whole(place(error.map(|error| error.block))),
        whole(place(error.map(|error| error.line))),
        text(|error| &error.detail),
        style.known(row.machining_time_s),
        style.number(row.feed_mm),
        style.number(row.rapid_mm),
        row.blocks_executed.to_string(),
    ];
    for size in [row.blank_mm, row.finished_mm] {
        fields.extend([0, 1, 2].map(|k| style.known(size.map(|size| size[k]))));
    }
    fields.extend([row.removed_mm3, row.removed_kg, row.finished_kg].map(|value| style.known(value)));
    fields.extend([tools.join(" | "), row.warnings.len().to_string()]);
    for axis in axes {
        let travel = row.travel.get(axis);
        fields.push(style.known(travel.map(|travel: &Travel| travel.least)));
        fields.push(style.known(travel.map(|travel| travel.greatest)));
    }
    fields.extend([row.beyond(), warnings.join(" | "), row.changes.join(" | ")]);
    fields
}

/// `T5: 12.5 s 480 mm`.
fn tool_text(tool: &Use, style: Style) -> String {
    let name = tool.tool.map_or("-".to_owned(), |tool| format!("T{tool}"));
    let rounded = |value: f64| style.number((value * 10.0).round() / 10.0);
    format!("{name}: {} s {} mm", rounded(tool.time_s), rounded(tool.feed_mm))
}

fn warning_text(said: &Said) -> String {
    format!("{} block {}: {}", said.program, said.block, said.message)
}

/// The rows of a table that [`write`] wrote; `None` when the text is none. What a comparison needs is there,
/// not more.
pub fn read(text: &str) -> Option<Vec<Row>> {
    let text = without_mark(text);
    let comma = text.starts_with("path;result;");
    if !comma && !text.starts_with("path,result,") {
        return None;
    }
    let style = Style { comma };
    let mut lines = records(text, style.separator()).into_iter();
    let header = lines.next()?;
    let rows = lines.map(|fields| {
        let field = |name: &str| {
            let at = header.iter().position(|column| column == name);
            at.and_then(|at| fields.get(at)).map_or("", String::as_str)
        };
        let number = |name: &str| field(name).replace(',', ".").parse::<f64>().ok();
        let whole = |name: &str| field(name).parse::<u32>().unwrap_or_default();
        let tools = field("tools").split(" | ").filter_map(|text| {
            let (name, _) = text.split_once(':')?;
            Some(Use {
                tool: name.strip_prefix('T').and_then(|number| number.parse().ok()),
                radius_mm: 0.0,
                time_s: 0.0,
                feed_mm: 0.0,
                rapid_mm: 0.0,
            })
        });
        let travel = |axis: &str| {
            let travel = Travel {
                least: 0.0,
                greatest: 0.0,
                limits: [0.0; 2],
                fits: false,
            };
            (axis.to_owned(), travel)
        };
        let warning = Said {
            message: String::new(),
            program: String::new(),
            block: 0,
            count: 1,
        };
        Row {
            path: field("path").to_owned(),
            result: verdict(field("result")),
            error: (!field("message").is_empty()).then(|| Fault {
                message: field("message").to_owned(),
                program: field("program").to_owned(),
                block: whole("block"),
                line: whole("line"),
                detail: field("detail").to_owned(),
            }),
            machining_time_s: number("time_s"),
            feed_mm: number("feed_mm").unwrap_or_default(),
            rapid_mm: number("rapid_mm").unwrap_or_default(),
            removed_mm3: number("removed_mm3"),
            tools: tools.collect(),
            travel: field("beyond_range").split_whitespace().map(travel).collect(),
            warnings: vec![warning; whole("warnings").min(10_000) as usize],
            ..Row::default()
        }
    });
    Some(rows.collect())
}

fn verdict(text: &str) -> Verdict {
    [
        Verdict::Ok,
        Verdict::Stopped,
        Verdict::Error,
        Verdict::Called,
        Verdict::Unreadable,
        Verdict::TimeLimit,
        Verdict::Interrupted,
    ]
    .into_iter()
    .find(|verdict| verdict.text() == text)
    .unwrap_or(Verdict::NotRun)
}

/// Lines of fields; a quoted field may hold separators, quotes and line ends.
fn records(text: &str, separator: char) -> Vec<Vec<String>> {
    let mut records = Vec::new();
    let mut record = Vec::new();
    let mut field = String::new();
    let mut quoted = false;
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if quoted && characters.next_if_eq(&'"').is_some() => field.push('"'),
            '"' => quoted = !quoted,
            '\r' if !quoted => {}
            '\n' if !quoted => {
                record.push(std::mem::take(&mut field));
                records.push(std::mem::take(&mut record));
            }
            _ if character == separator && !quoted => record.push(std::mem::take(&mut field)),
            _ => field.push(character),
        }
    }
    if !field.is_empty() || !record.is_empty() {
        record.push(field);
        records.push(record);
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let row = Row {
            path: "a;b, \"c\".H".into(),
            result: Verdict::Error,
            error: Some(Fault {
                message: "TOOL RADIUS TOO LARGE".into(),
                program: "a".into(),
                block: 7,
                line: 8,
                detail: "two\nlines".into(),
            }),
            machining_time_s: Some(1234.5),
            feed_mm: 0.25,
            ..Row::default()
        };
        for comma in [false, true] {
            let text = write(&[&row, &row], Style::new(comma));
            let rows = read(&text).unwrap();
            assert_eq!(rows, [row.clone(), row.clone()], "{text}");
            assert_eq!(text.contains("1234,5"), comma);
        }
        assert_eq!(read("T R\n1 5\n"), None);
    }
}
