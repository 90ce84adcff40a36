//! Turns `data/signals.tsv` into named constants, so that the table is the only place that names a fixed
//! marker or word.

use std::error::Error;
use std::fmt::Write;
use std::{env, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let table = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("data/signals.tsv");
    println!("cargo::rerun-if-changed={}", table.display());
    let text = fs::read_to_string(&table)?;
    let mut constants = String::new();
    let mut rows = String::new();
    for (line, row) in text.lines().enumerate().skip(1) {
        let columns: Vec<&str> = row.split('\t').collect();
        let [
            address,
            name,
            function,
            set_by,
            reset_by,
            role,
            values,
            tnc355,
            replaced_by,
            notes,
            source,
        ] = columns[..]
        else {
            return Err(format!("signals.tsv:{}: {} columns", line + 1, columns.len()).into());
        };
        let (kind, value, operand) =
            operand(address).ok_or_else(|| format!("signals.tsv:{}: {address}", line + 1))?;
        let values_doc = if values.is_empty() {
            String::new()
        } else {
            format!(" Values: {}.", escape(values))
        };
        writeln!(
            constants,
            "/// {address}: {}; set by {}, reset by {}.{values_doc} {source}\npub const {name}: {kind} = {value};",
            escape(function),
            party(set_by),
            party(reset_by),
        )?;
        writeln!(
            rows,
            "    Signal {{ name: {name:?}, operand: SignalOperand::{operand}({name}), function: {function:?}, \
             set_by: {set_by:?}, reset_by: {reset_by:?}, role: {role:?}, values: {values:?}, \
             tnc355: {}, replaced_by: {replaced_by:?}, notes: {notes:?}, source: {source:?} }},",
            tnc355 != "no",
        )?;
    }
    let out = format!("{constants}\npub(super) const TABLE: &[Signal] = &[\n{rows}];\n");
    fs::write(Path::new(&env::var("OUT_DIR")?).join("signals.rs"), out)?;
    Ok(())
}

/// Type, value and variant of an address as `M2045`, `W260` or `M1900-M1999`.
fn operand(address: &str) -> Option<(&'static str, String, &'static str)> {
    let area = |text: &str| Some((text.chars().next()?, text.get(1..)?.parse::<u16>().ok()?));
    if let Some((first, last)) = address.split_once('-') {
        let ((letter, first), (_, last)) = (area(first)?, area(last)?);
        let count = last.checked_sub(first)?.checked_add(1)?;
        return match letter {
            'M' => Some(("BitRange", format!("BitRange::fixed({first}, {count})"), "Bits")),
            'B' => Some((
                "ByteRange",
                format!("ByteRange::fixed({first}, {count})"),
                "Bytes",
            )),
            _ => None,
        };
    }
    let (letter, number) = area(address)?;
    let number_of = |size: &str| {
        (
            "Number",
            format!("Number::fixed(Size::{size}, {number})"),
            "Number",
        )
    };
    match letter {
        'M' => Some(("Bit", format!("Bit::fixed(BitArea::M, {number})"), "Bit")),
        'B' => Some(number_of("Byte")),
        'W' => Some(number_of("Word")),
        'D' => Some(number_of("Double")),
        _ => None,
    }
}

fn escape(text: &str) -> String {
    text.replace('<', "\\<").replace('[', "\\[")
}

fn party(text: &str) -> String {
    if text.is_empty() {
        "nobody (not printed)".to_owned()
    } else {
        text.replace(';', " or ")
    }
}
