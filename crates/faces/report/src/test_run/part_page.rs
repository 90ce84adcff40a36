//! The page of a run for a browser.

use bahn_reader::Reader;
use std::path::Path;

use bahn_path::BlockRef;
use bahn_viewer::{About, Listing, Recording, Remark};

use super::bench::Tested;
use crate::ReportError;
use crate::record::{Report, WarningReport};
use crate::text::clock;
use bahn_host::files::{self, NewFile};

/// Tool calls that are listed.
const CALLS: usize = 100;

/// Writes the page; a page that was there stays until the new one is whole.
pub fn write_page(
    path: &Path,
    recording: Recording,
    tested: &Tested,
    control: &str,
) -> Result<(), ReportError> {
    let about = about(&recording, tested, control);
    let mut file = NewFile::create(path)?;
    bahn_viewer::write_page(&mut file, recording, tested.part.as_ref(), &about)
        .map_err(|error| files::cannot("write", path, &error))?;
    Ok(file.finish()?)
}

fn about(recording: &Recording, tested: &Tested, control: &str) -> About {
    let (report, run) = (&tested.report, &*tested.reader);
    let listings: Vec<Listing> = recording
        .programs()
        .into_iter()
        .filter_map(|number| listing(run, number))
        .collect();
    let is_listed = |at: &BlockRef| listings.iter().any(|listing| listing.program == at.program);
    let remark = |warning: &WarningReport| Remark {
        text: warning.message.clone(),
        block: warning.at.filter(is_listed),
        count: warning.count,
    };
    About {
        title: report.program.clone(),
        model: control.to_owned(),
        facts: facts(report),
        error: report.error.as_ref().map(|error| Remark {
            text: match error.detail.as_str() {
                "" => error.message.clone(),
                detail => format!("{} ({detail})", error.message),
            },
            block: Some(error.at),
            count: 1,
        }),
        warnings: report.warnings.iter().map(remark).collect(),
        time_s: report.machining_time_s,
        listings,
    }
}

fn listing(run: &dyn Reader, number: u16) -> Option<Listing> {
    let program = run.program(number)?;
    Some(Listing {
        program: number,
        name: files::short_name(program).to_owned(),
        blocks: (0..program.block_count())
            .map(|block| program.text_of(block))
            .collect(),
    })
}

fn facts(report: &Report) -> Vec<(String, String)> {
    let mut facts = vec![
        (
            "Machining time",
            report
                .machining_time_s
                .map_or("without end: the feed is 0".to_owned(), clock),
        ),
        ("Path in feed", format!("{:.3} m", report.path_mm.feed / 1000.0)),
        ("Path in rapid", format!("{:.3} m", report.path_mm.rapid / 1000.0)),
        ("Blocks executed", report.blocks_executed.to_string()),
    ];
    if let Some(removed) = report.removed_mm3 {
        facts.push(("Material removed", format!("{:.2} cm³", removed / 1000.0)));
    }
    facts.push(("Final position", report.final_position.to_string()));
    for call in report.tool_calls.iter().take(CALLS) {
        let tool = call.tool.map_or("no tool".to_owned(), |tool| format!("T{tool}"));
        facts.push((
            "Tool call",
            format!("{tool}, {} rpm, block {}", call.speed_rpm, call.block),
        ));
    }
    for stop in &report.stops {
        facts.push(("Stop", format!("{}, block {}", stop.function, stop.block)));
    }
    for printed in &report.printed {
        facts.push(("Printed", printed.text.clone()));
    }
    let facts = facts.into_iter();
    facts.map(|(name, value)| (name.to_owned(), value)).collect()
}
