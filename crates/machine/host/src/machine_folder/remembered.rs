//! What the control remembers, as a file: text that people can read, with a check sum in its last line.
//!
//! Decision: What the control remembered and cannot be read starts no machine; the damaged file is kept, and who
//! mends it says so in its last line

use std::collections::BTreeMap;
use std::fmt::Write as _;

use bahn_parameters::{PLC_AXES, PerPlcAxis};
use bahn_path::{Axis, Position};
use bahn_plc::TableKind;
use bahn_tnc::{
    AxisLimit, Calibration, MovedTool, Position0, ProbeMemory, Remembered, SelectedLine,
    ToolProbeCalibration, WrittenElement,
};
use serde::Deserialize;

/// The form of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Form {
    tool: u32,
    tool_length: f64,
    tool_axis: Option<char>,
    /// Of the contact of the tool probe: found, and in the list.
    tool_probe: Option<[[f64; 4]; 2]>,
    parameter_list: Option<String>,
    program: Option<String>,
    pallet_line: Option<i32>,
    datum_table: Option<String>,
    /// Line of the compensation assignment, and the active one that its file named.
    compensation_line: Option<Vec<usize>>,
    offsets_volts: [f64; PLC_AXES],
    datum: [BTreeMap<char, f64>; 3],
    /// Pocket now and pocket in the tool table, by tool; -1 is none.
    #[serde(default)]
    pockets: BTreeMap<String, [i32; 2]>,
    /// Table (T tools, P pockets), line, element, value, value in the file.
    #[serde(default)]
    written: Vec<(char, i32, usize, f64, f64)>,
    /// Datum table, line, element, value, value in the file.
    #[serde(default)]
    written_datums: Vec<(String, i32, usize, f64, f64)>,
    /// Axis, traverse range, least and greatest position.
    #[serde(default)]
    axis_limits: Vec<(char, u8, f64, f64)>,
    /// Length, radius, offset in both axes of the plane.
    probe_calibration: Option<[f64; 4]>,
    #[serde(default)]
    basic_rotation: f64,
    #[serde(default)]
    q: BTreeMap<String, f64>,
}

/// What the control remembers as a file, with its end mark.
pub fn write(remembered: &Remembered) -> String {
    with_end(text(remembered))
}

/// A text with its end mark.
pub(super) fn with_end(text: String) -> String {
    let end = end_mark(text.as_bytes());
    text + &end
}

/// What a file says.
///
/// # Errors
/// What of it is damaged.
pub fn read(file: &[u8]) -> Result<Remembered, String> {
    content_of(whole(file)?)
}

/// A file without its last line.
pub(super) fn split_end(file: &[u8]) -> (&[u8], &[u8]) {
    let whole = file.strip_suffix(b"\n").unwrap_or(file);
    let end = whole
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |newline| newline + 1);
    file.split_at(end)
}

/// The text of a file that is as it was written, or mended by hand, without its last line.
///
/// # Errors
/// What of it is damaged.
pub(super) fn whole(file: &[u8]) -> Result<&str, String> {
    let (content, mark) = split_end(file);
    if mark != end_mark(content).as_bytes() && mark.trim_ascii() != MENDED.as_bytes() {
        return Err(match mark.starts_with(b"# end") {
            true => "its check sum is wrong".to_owned(),
            false => "its end is missing".to_owned(),
        });
    }
    str::from_utf8(content).map_err(|error| error.to_string())
}

/// The last line: it shows that the file is whole, and that it is as it was written.
fn end_mark(content: &[u8]) -> String {
    format!("# end, check {:08x}\n", crc32fast::hash(content))
}

/// What who mends a file writes instead.
pub(super) const MENDED: &str = "# end, check by hand";

fn text(remembered: &Remembered) -> String {
    let mut text = String::from("# What the control remembers over power-off. It writes this file itself.\n");
    // Writing to a string cannot fail.
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("tool", remembered.tool.to_string());
    line("tool_length", number(remembered.tool_length));
    if let Some(axis) = remembered.tool_axis {
        line("tool_axis", format!("\"{}\"", axis.letter()));
    }
    if let Some(probe) = &remembered.tool_probe {
        let [found, file] = [probe.found, probe.list].map(|place| list(place.map(number)));
        line(
            "# Contact of the tool probe, X, Y, Z and width: found, and in the list of machine parameters then\ntool_probe",
            format!("[{found}, {file}]"),
        );
    }
    if let Some(list) = &remembered.parameter_list {
        line("parameter_list", toml::Value::from(list.as_str()).to_string());
    }
    if let Some(program) = &remembered.program {
        line("program", toml::Value::from(program.as_str()).to_string());
    }
    if let Some(number) = remembered.pallet_line {
        line("pallet_line", number.to_string());
    }
    if let Some(table) = &remembered.datum_table {
        line("datum_table", toml::Value::from(table.as_str()).to_string());
    }
    if let Some(selected) = remembered.compensation_line {
        let SelectedLine { line: chosen, file } = selected;
        line(
            "# Line of the compensation assignment, and the active one in its file then\ncompensation_line",
            file.map_or(format!("[{chosen}]"), |file| format!("[{chosen}, {file}]")),
        );
    }
    written(remembered, &mut line);
    if let Some(probe) = remembered.probe.calibration {
        let [x, y] = probe.offset_mm;
        let values = [probe.length_mm, probe.radius_mm, x, y].map(number);
        line(
            "# Touch probe: effective length and radius, centre offset in both axes of the plane\nprobe_calibration",
            list(values),
        );
    }
    if remembered.probe.basic_rotation_deg != 0.0 {
        line("basic_rotation", number(remembered.probe.basic_rotation_deg));
    }
    axis_limits(remembered, &mut line);
    line("offsets_volts", list(remembered.offsets_volts.map(number).0));
    let datum = |Position0(datum): &Position0| {
        let known = Axis::ALL.into_iter().filter_map(|axis| {
            let value = datum.get(axis).filter(|value| value.is_finite())?;
            Some(format!("{} = {}", axis.letter(), number(value)))
        });
        format!("{{ {} }}", known.collect::<Vec<_>>().join(", "))
    };
    line(
        "# Workpiece datum of each traverse range, machine coordinates\ndatum",
        list([0, 1, 2].map(|range| remembered.datums.get(range).map(datum).unwrap_or_default())),
    );
    if !remembered.pockets.is_empty() {
        text.push_str("\n# Tools that are elsewhere than in the pocket of the tool table: pocket now, pocket there\n[pockets]\n");
        for moved in &remembered.pockets {
            let [pocket, table] = [moved.pocket, moved.table].map(|pocket| pocket.map_or(-1, i32::from));
            let _ = writeln!(text, "{} = [{pocket}, {table}]", moved.tool);
        }
    }
    if !remembered.q.is_empty() {
        text.push_str("\n[q]\n");
        for (q, value) in remembered.q.iter().filter(|(_, value)| value.is_finite()) {
            let _ = writeln!(text, "{q} = {}", number(*value));
        }
    }
    text
}

/// AXIS LIMIT of MOD.
fn axis_limits(remembered: &Remembered, line: &mut impl FnMut(&str, String)) {
    if !remembered.axis_limits.is_empty() {
        let rows = remembered.axis_limits.iter().map(|own| {
            let [least, greatest] = own.limits.map(number);
            format!(
                "\n  [\"{}\", {}, {least}, {greatest}],",
                own.axis.letter(),
                own.range
            )
        });
        line(
            "# AXIS LIMIT: axis, traverse range, least and greatest position, machine coordinates\naxis_limits",
            format!("[{}\n]", rows.collect::<String>()),
        );
    }
}

/// What the PLC wrote into tables.
fn written(remembered: &Remembered, line: &mut impl FnMut(&str, String)) {
    if !remembered.written.is_empty() {
        let rows = remembered
            .written
            .iter()
            .map(|row| element_of(letter_of(row.table).to_string(), row));
        line(
            "# Elements of tool (T) and pocket (P) table that the PLC wrote: line, element, value, value in the file\nwritten",
            format!("[{}\n]", rows.collect::<String>()),
        );
    }
    if !remembered.written_datums.is_empty() {
        let rows = remembered.written_datums.iter();
        let rows = rows.map(|(table, row)| element_of(table.clone(), row));
        line(
            "# Elements of datum tables that the PLC wrote: line, element, value, value in the file\nwritten_datums",
            format!("[{}\n]", rows.collect::<String>()),
        );
    }
}

/// The tables by their letters.
const TABLES: [(TableKind, char); 3] = [
    (TableKind::Tool, 'T'),
    (TableKind::Datum, 'D'),
    (TableKind::Pocket, 'P'),
];

/// An element that the PLC wrote, as a row of a list.
fn element_of(table: String, row: &WrittenElement) -> String {
    let (value, file) = (number(row.value), number(row.file));
    let table = toml::Value::from(table);
    format!("\n  [{table}, {}, {}, {value}, {file}],", row.line, row.element)
}

fn letter_of(table: TableKind) -> char {
    TABLES
        .into_iter()
        .find(|(known, _)| *known == table)
        .map_or('T', |(_, letter)| letter)
}

fn list<const N: usize>(values: [String; N]) -> String {
    format!("[{}]", values.join(", "))
}

/// A number that reads back as the same one, with a point.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn content_of(text: &str) -> Result<Remembered, String> {
    let form: Form = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| {
            text.get(..span.start)
                .map_or(1, |before| before.matches('\n').count() + 1)
        });
        format!("line {line}: {}", error.message())
    })?;
    let mut datums = [Position0::default(); 3];
    for (datum, values) in datums.iter_mut().zip(&form.datum) {
        let mut position = Position::ZERO;
        for (letter, value) in values {
            position[axis(*letter)?] = finite(*value)?;
        }
        *datum = Position0(position);
    }
    let mut pockets = Vec::new();
    for (name, [pocket, table]) in form.pockets {
        let tool = name.parse().map_err(|_| format!("`{name}` is no tool number"))?;
        let place = |number: i32| match number {
            -1 => Ok(None),
            _ => u16::try_from(number)
                .map(Some)
                .map_err(|_| format!("{number} is no pocket")),
        };
        let (pocket, table) = (place(pocket)?, place(table)?);
        pockets.push(MovedTool { tool, pocket, table });
    }
    pockets.sort_by_key(|moved| moved.tool);
    let mut written = Vec::new();
    for (letter, line, element, value, file) in form.written {
        let table = TABLES.into_iter().find(|(_, known)| *known == letter);
        let (table, _) = table.ok_or_else(|| format!("`{letter}` is no table"))?;
        written.push(written_element(table, line, element, [value, file])?);
    }
    let mut written_datums = Vec::new();
    for (name, line, element, value, file) in form.written_datums {
        let row = written_element(TableKind::Datum, line, element, [value, file])?;
        written_datums.push((name, row));
    }
    let mut q = Vec::new();
    for (name, value) in &form.q {
        let number = name.parse().map_err(|_| format!("`{name}` is no Q parameter"))?;
        q.push((number, finite(*value)?));
    }
    q.sort_by_key(|(number, _)| *number);
    let limits = form.axis_limits.iter();
    let axis_limits = limits.map(axis_limit).collect::<Result<_, _>>()?;
    for volts in form.offsets_volts {
        finite(volts)?;
    }
    for value in form.tool_probe.iter().flatten().flatten() {
        finite(*value)?;
    }
    Ok(Remembered {
        datums,
        probe: probe_memory(form.probe_calibration, form.basic_rotation)?,
        tool: form.tool,
        tool_length: finite(form.tool_length)?,
        tool_axis: form.tool_axis.map(axis).transpose()?,
        tool_probe: form
            .tool_probe
            .map(|[found, list]| ToolProbeCalibration { found, list }),
        pockets,
        written,
        axis_limits,
        q,
        offsets_volts: PerPlcAxis(form.offsets_volts),
        parameter_list: form.parameter_list,
        program: form.program,
        pallet_line: form.pallet_line,
        datum_table: form.datum_table,
        compensation_line: form.compensation_line.as_deref().map(selected_line).transpose()?,
        written_datums,
    })
}

fn selected_line(lines: &[usize]) -> Result<SelectedLine, String> {
    match *lines {
        [line] => Ok(SelectedLine { line, file: None }),
        [line, file] => Ok(SelectedLine {
            line,
            file: Some(file),
        }),
        _ => Err("compensation_line has one or two numbers".to_owned()),
    }
}

fn axis(letter: char) -> Result<Axis, String> {
    u8::try_from(letter)
        .ok()
        .and_then(Axis::from_letter)
        .ok_or_else(|| format!("`{letter}` is no axis"))
}

fn axis_limit(&(letter, range, least, greatest): &(char, u8, f64, f64)) -> Result<AxisLimit, String> {
    match range {
        1..=3 => Ok(AxisLimit {
            axis: axis(letter)?,
            range,
            limits: [finite(least)?, finite(greatest)?],
        }),
        _ => Err(format!("{range} is no traverse range")),
    }
}

fn probe_memory(calibration: Option<[f64; 4]>, basic_rotation: f64) -> Result<ProbeMemory, String> {
    let calibration = match calibration {
        Some([length, radius, x, y]) => Some(Calibration {
            length_mm: finite(length)?,
            radius_mm: finite(radius)?,
            offset_mm: [finite(x)?, finite(y)?],
        }),
        None => None,
    };
    Ok(ProbeMemory {
        calibration,
        basic_rotation_deg: finite(basic_rotation)?,
    })
}

fn written_element(
    table: TableKind,
    line: i32,
    element: usize,
    [value, file]: [f64; 2],
) -> Result<WrittenElement, String> {
    Ok(WrittenElement {
        table,
        line,
        element,
        value: finite(value)?,
        file: finite(file)?,
    })
}

fn finite(value: f64) -> Result<f64, String> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("{value} is no value"))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A file in which every part is written.
    fn full() -> Remembered {
        let mut position = Position::ZERO;
        position[Axis::X] = 412.5;
        position[Axis::C] = -0.001;
        Remembered {
            datums: [Position0(position), Position0::default(), Position0(position)],
            tool: 12,
            tool_length: 81.25,
            tool_axis: Some(Axis::Z),
            tool_probe: Some(ToolProbeCalibration {
                found: [560.01, 40.0, 59.98, 40.002],
                list: [560.0, 40.0, 60.0, 40.0],
            }),
            pockets: vec![
                MovedTool {
                    tool: 3,
                    pocket: Some(14),
                    table: Some(3),
                },
                MovedTool {
                    tool: 12,
                    pocket: None,
                    table: Some(14),
                },
            ],
            written: vec![
                WrittenElement {
                    table: TableKind::Tool,
                    line: 12,
                    element: 7,
                    value: 31.0,
                    file: 0.0,
                },
                WrittenElement {
                    table: TableKind::Pocket,
                    line: 3,
                    element: 3,
                    value: 1.0,
                    file: -0.5,
                },
            ],
            q: vec![(1, 0.5), (107, -1e-4)],
            offsets_volts: PerPlcAxis([0.0, 0.0015, 0.0, 0.0, 0.0]),
            axis_limits: vec![AxisLimit {
                axis: Axis::Z,
                range: 2,
                limits: [-12.5, 350.0],
            }],
            probe: ProbeMemory {
                calibration: Some(Calibration {
                    length_mm: 148.25,
                    radius_mm: 1.9987,
                    offset_mm: [0.01, -0.0025],
                }),
                basic_rotation_deg: -2.5,
            },
            parameter_list: Some("LATHE.MP".to_owned()),
            program: Some("7432.H".to_owned()),
            pallet_line: Some(3),
            datum_table: Some("ZERO \"1\".D".to_owned()),
            compensation_line: Some(SelectedLine {
                line: 1,
                file: Some(0),
            }),
            written_datums: vec![(
                "ZERO.D".to_owned(),
                WrittenElement {
                    table: TableKind::Datum,
                    line: 7,
                    element: 1,
                    value: -12.5,
                    file: 0.25,
                },
            )],
        }
    }

    /// Whether it is refused, or what is read is wholly kept: it comes back when it is written.
    fn is_whole(bytes: &[u8]) -> bool {
        let Ok(remembered) = read(bytes) else { return true };
        read(write(&remembered).as_bytes()) == Ok(remembered)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_is_written_is_read(
            tool in 0..99u32,
            values in prop::array::uniform5(-1e5..1e5f64),
            tool_axis in prop::option::of(prop::sample::select(Axis::ALL.to_vec())),
            program in prop::option::of(".{0,12}"),
            pockets in prop::collection::btree_map(0..300u32, any::<(Option<u16>, Option<u16>)>(), 0..5),
            q in prop::collection::btree_map(0..300u16, -1e9..1e9f64, 0..5),
        ) {
            let moved = |(tool, (pocket, table))| MovedTool { tool, pocket, table };
            let remembered = Remembered {
                tool,
                tool_length: values[2],
                tool_axis,
                pockets: pockets.into_iter().map(moved).collect(),
                q: q.into_iter().collect(),
                offsets_volts: PerPlcAxis(values),
                program,
                ..full()
            };
            prop_assert_eq!(read(write(&remembered).as_bytes()), Ok(remembered));
        }

        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            prop_assert!(read(&bytes).is_err());
            prop_assert!(is_whole(&[&bytes, MENDED.as_bytes()].concat()));
        }

        #[test]
        fn any_text_is_read_or_refused(text in "([a-z_]{1,8}( = |\\[|\\])[0-9a-z\\[\\]{}\"., -]{0,12}\n){0,8}") {
            let text = format!("{text}{MENDED}");
            prop_assert!(is_whole(text.as_bytes()));
        }
    }

    /// Whatever bit flips: nothing wrong is loaded.
    #[test]
    fn every_flipped_bit_is_found() {
        let whole = write(&full()).into_bytes();
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut damaged = whole.clone();
                damaged[at] ^= 1 << bit;
                assert!(read(&damaged).is_err(), "bit {bit} of byte {at}");
            }
        }
    }

    /// Wherever it is cut: nothing is loaded.
    #[test]
    fn every_truncation_is_found() {
        let whole = write(&full()).into_bytes();
        for length in 0..whole.len() {
            assert!(read(&whole[..length]).is_err(), "{length} bytes");
        }
        assert_eq!(read(&whole), Ok(full()));
    }

    /// What was written before there were pallets and datum tables is read.
    #[test]
    fn an_older_file_is_read() {
        let text = "tool = 3\ntool_length = 81.25\nprogram = \"1.H\"\noffsets_volts = [0.0, 0.0, 0.0, 0.0, 0.0]\n\
            datum = [{ X = 12.5 }, {  }, {  }]\n";
        let remembered = read((text.to_owned() + &end_mark(text.as_bytes())).as_bytes()).unwrap();
        assert_eq!((remembered.tool, remembered.program.as_deref()), (3, Some("1.H")));
        assert_eq!(remembered.datums[0].0[Axis::X], 12.5);
        assert_eq!((remembered.pallet_line, remembered.datum_table), (None, None));
    }

    /// Who has mended a file says so in its last line; what he wrote is read as strictly.
    #[test]
    fn a_file_can_be_mended_by_hand() {
        let whole = write(&full());
        let content = &whole[..whole.rfind("# end").unwrap()];
        assert_eq!(read(format!("{content}{MENDED}\r\n").as_bytes()), Ok(full()));
        assert_eq!(read(format!("{content}{MENDED}").as_bytes()), Ok(full()));
        let wrong = content.replace("tool_length = 81.25", "tool_length = 8l.25");
        let error = read(format!("{wrong}{MENDED}").as_bytes()).unwrap_err();
        assert!(error.starts_with("line 3: "), "{error}");
    }
}
