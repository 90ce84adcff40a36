//! The table as a page: one file with everything in it, pictures too.

use std::io::{self, Write};

use bahn_viewer::{base64, escaped};

use super::crew::Done;
use super::row::Row;
use super::table::class;
use super::{About, Totals};
use crate::text::clock;

/// Warnings of a program that are listed.
const WARNINGS: usize = 20;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Writes the table as a page that needs no other file.
pub fn write(out: &mut impl Write, done: &[Done], totals: &Totals, about: &About) -> io::Result<()> {
    let model = about.model.to_string().to_uppercase();
    write!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{programs} programs, {model}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <header><h1>{programs} programs</h1><p>{model}</p></header>\n<ul class=\"totals\">",
        programs = totals.programs,
    )?;
    for (value, name, class) in sums(totals, about) {
        write!(
            out,
            "<li class=\"{class}\"><b>{}</b> {name}</li>",
            escaped(&value)
        )?;
    }
    out.write_all(
        b"</ul>\n<p class=\"find\"><input id=\"find\" type=\"search\" placeholder=\"Find a program, message or tool\"></p>\n\
          <table>\n<thead><tr><th></th><th>Program</th><th>Result</th><th class=\"n\">Time</th>\
          <th class=\"n\">Feed m</th><th class=\"n\">Rapid m</th><th>Blank and finished, mm</th>\
          <th class=\"n\">Removed cm\xc2\xb3</th><th>Tools</th><th>Travel, mm</th></tr></thead>\n<tbody>\n",
    )?;
    for done in done {
        program(out, done)?;
    }
    write!(
        out,
        "</tbody>\n</table>\n<script>{SCRIPT}</script>\n</body>\n</html>\n"
    )
}

fn sums(totals: &Totals, about: &About) -> Vec<(String, &'static str, &'static str)> {
    let metres = |mm: f64| format!("{:.1}", mm / 1000.0);
    let mut sums = vec![
        (totals.ok.to_string(), "OK", "ok"),
        (
            totals.errors.to_string(),
            "with errors",
            if totals.errors > 0 { "bad" } else { "" },
        ),
        (clock(totals.machining_time_s), "machining time", ""),
        (metres(totals.feed_mm), "m feed", ""),
        (metres(totals.rapid_mm), "m rapid", ""),
        (format!("{:.1}", totals.removed_mm3 / 1000.0), "cm³ removed", ""),
    ];
    if let Some(density) = about.density {
        sums.push((
            format!("{:.2}", totals.removed_mm3 * density * 1e-6),
            "kg removed",
            "",
        ));
    }
    if totals.called > 0 {
        sums.push((totals.called.to_string(), "called by others", "open"));
    }
    if totals.not_run > 0 {
        sums.push((totals.not_run.to_string(), "not run", "open"));
    }
    if about.compared {
        sums.push((totals.changed.to_string(), "changed", "warned"));
    }
    sums
}

fn program(out: &mut impl Write, done: &Done) -> io::Result<()> {
    let row = &done.row;
    write!(out, "<tr class=\"{}\"><td>", class(row))?;
    if let Some(png) = &done.picture {
        write!(
            out,
            "<img loading=\"lazy\" width=\"200\" height=\"150\" alt=\"the finished part\" \
             src=\"data:image/png;base64,{}\">",
            base64(png)
        )?;
    }
    writeln!(
        out,
        "</td><td><b>{}</b>{}</td><td>{}{}</td><td class=\"n\">{}</td><td class=\"n\">{:.3}</td>\
         <td class=\"n\">{:.3}</td><td>{}</td><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>",
        escaped(&row.path),
        list("changes", row.changes.iter().map(String::as_str)),
        row.result.text(),
        said(row),
        row.machining_time_s.map_or("no feed".into(), clock),
        row.feed_mm / 1000.0,
        row.rapid_mm / 1000.0,
        sizes(row),
        removed(row),
        tools(row),
        travel(row),
    )
}

/// The cell with the error and the first warnings.
fn said(row: &Row) -> String {
    let error = row.error_text();
    let warnings = row.warnings.iter().take(WARNINGS).map(|said| {
        let times = if said.count > 1 {
            format!(" ({} times)", said.count)
        } else {
            String::new()
        };
        format!("block {}: {}{times}", said.block, said.message)
    });
    let more = row.warnings.len().saturating_sub(WARNINGS);
    let more = (more > 0).then(|| format!("and {more} more"));
    let warnings: Vec<String> = warnings.chain(more).collect();
    let error = match error.as_str() {
        "" => String::new(),
        error => format!("<p class=\"error\">{}</p>", escaped(error)),
    };
    error + &list("warnings", warnings.iter().map(String::as_str))
}

fn sizes(row: &Row) -> String {
    let text = |size: [f64; 3]| {
        let sides = size.map(|side| format!("{side:.1}"));
        sides.join(" × ")
    };
    match (row.blank_mm, row.finished_mm) {
        (Some(blank), Some(finished)) => format!("{}<br>{}", text(blank), text(finished)),
        (Some(blank), None) => text(blank),
        _ => "no blank".into(),
    }
}

fn removed(row: &Row) -> String {
    let Some(removed) = row.removed_mm3 else {
        return "-".into();
    };
    let volume = format!("{:.2}", removed / 1000.0);
    match (row.removed_kg, row.finished_kg) {
        (Some(removed), Some(finished)) => {
            format!("{volume}<br>{removed:.3} kg<br>leaves {finished:.3} kg")
        }
        _ => volume,
    }
}

fn tools(row: &Row) -> String {
    let tools: Vec<String> = row
        .tools
        .iter()
        .map(|used| {
            let name = used.tool.map_or("none".to_owned(), |tool| format!("T{tool}"));
            format!(
                "{name} R{:.3}: {}, {:.3} m",
                used.radius_mm,
                clock(used.time_s),
                used.feed_mm / 1000.0
            )
        })
        .collect();
    tools.join("<br>")
}

fn travel(row: &Row) -> String {
    let axes: Vec<String> = row
        .travel
        .iter()
        .map(|(axis, travel)| {
            let class = if travel.fits { "" } else { " class=\"beyond\"" };
            let [from, to] = travel.limits;
            format!(
                "<span{class} title=\"the machine has {from} to {to}\">{axis} {:.1} to {:.1}</span>",
                travel.least, travel.greatest
            )
        })
        .collect();
    axes.join("<br>")
}

fn list<'a>(class: &str, items: impl Iterator<Item = &'a str>) -> String {
    let items: Vec<String> = items.map(|item| format!("<li>{}</li>", escaped(item))).collect();
    if items.is_empty() {
        return String::new();
    }
    format!("<ul class=\"{class}\">{}</ul>", items.join(""))
}
