//! What the table says of one program; also the JSON report, which is read back for a comparison.

use std::collections::BTreeMap;
use std::path::Path;

use bahn_parameters::ParameterList;
use bahn_path::{Axis, Position};
use serde::{Deserialize, Serialize};

use crate::record::{End, tidy};
use crate::test_run::{Bench, Survey, Tested};

/// How the run of a program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It came to its end.
    Ok,
    /// At a programmed stop, as wanted.
    Stopped,
    /// It has an error.
    Error,
    /// It fails alone, but another program of the shelf calls it.
    Called,
    /// The file cannot be read, or its part cannot be made.
    Unreadable,
    /// It took too long.
    TimeLimit,
    /// Ctrl-C broke it off.
    Interrupted,
    /// Ctrl-C came before its turn.
    NotRun,
}

impl Verdict {
    /// As the table and the CSV name it.
    pub fn text(self) -> &'static str {
        match self {
            Verdict::Ok => "OK",
            Verdict::Stopped => "stopped",
            Verdict::Error => "error",
            Verdict::Called => "called",
            Verdict::Unreadable => "unreadable",
            Verdict::TimeLimit => "time limit",
            Verdict::Interrupted => "interrupted",
            Verdict::NotRun => "not run",
        }
    }

    /// Whether the exit code tells of it.
    pub fn is_fault(self) -> bool {
        matches!(self, Verdict::Error | Verdict::Unreadable | Verdict::TimeLimit)
    }
}

/// A program of the shelf. Lengths in mm, times in s, volumes in mm³, weights in kg.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Row {
    /// Path of its file.
    pub path: String,
    /// How its run ended.
    pub result: Verdict,
    /// The error that ended it, if one did.
    pub error: Option<Fault>,
    /// Unit of the program: `mm` or `inch`.
    pub unit: String,
    /// `None` when the feed is 0.
    pub machining_time_s: Option<f64>,
    /// Distance in feed, mm.
    pub feed_mm: f64,
    /// Distance in rapid traverse, mm.
    pub rapid_mm: f64,
    /// Blocks that were executed.
    pub blocks_executed: u64,
    /// The tools that are needed.
    pub tools: Vec<Use>,
    /// Sides of the blank along X, Y and Z.
    pub blank_mm: Option<[f64; 3]>,
    /// Those of what is left.
    pub finished_mm: Option<[f64; 3]>,
    /// What was removed; `None` without a blank.
    pub removed_mm3: Option<f64>,
    /// The same by weight.
    pub removed_kg: Option<f64>,
    /// The weight of what is left.
    pub finished_kg: Option<f64>,
    /// The travel of each axis.
    pub travel: BTreeMap<String, Travel>,
    /// What is not as it should be.
    pub warnings: Vec<Said>,
    /// Programs called by CALL PGM, by their paths.
    pub calls: Vec<String>,
    /// What is different from the run that was compared with.
    pub changes: Vec<String>,
}

/// The error that ended a run, with its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    pub message: String,
    pub program: String,
    pub block: u32,
    pub line: u32,
    pub detail: String,
}

/// A tool that is needed, with its length of use.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Use {
    pub tool: Option<u32>,
    pub radius_mm: f64,
    pub time_s: f64,
    pub feed_mm: f64,
    pub rapid_mm: f64,
}

/// The travel of an axis, mm or degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Travel {
    /// Least and greatest position of the tip in workpiece coordinates.
    pub least: f64,
    pub greatest: f64,
    /// Traverse range of the machine from machine zero.
    pub limits: [f64; 2],
    /// The spindle nose stays within the traverse range; where nobody knows the place of the workpiece: the
    /// range is wide enough.
    pub fits: bool,
}

/// A warning, with its block and how often it came.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Said {
    pub message: String,
    pub program: String,
    pub block: u32,
    pub count: u64,
}

impl Default for Row {
    fn default() -> Row {
        Row {
            path: String::new(),
            result: Verdict::NotRun,
            error: None,
            unit: String::new(),
            machining_time_s: None,
            feed_mm: 0.0,
            rapid_mm: 0.0,
            blocks_executed: 0,
            tools: Vec::new(),
            blank_mm: None,
            finished_mm: None,
            removed_mm3: None,
            removed_kg: None,
            finished_kg: None,
            travel: BTreeMap::new(),
            warnings: Vec::new(),
            calls: Vec::new(),
            changes: Vec::new(),
        }
    }
}

impl Row {
    /// A program that was not run to an end of its own.
    pub fn without_run(path: &Path, result: Verdict, why: Option<String>) -> Row {
        Row {
            path: path.display().to_string(),
            result,
            error: why.map(|message| Fault {
                message,
                program: String::new(),
                block: 0,
                line: 0,
                detail: String::new(),
            }),
            ..Row::default()
        }
    }

    /// What a run on a bench came to.
    pub fn of(bench: &Bench, path: &Path, tested: &Tested, density: Option<f64>) -> Row {
        let (list, machine_zero) = (&bench.list, bench.machine_zero());
        let report = &tested.report;
        let mut row = Row {
            result: match tested.end {
                End::Completed => Verdict::Ok,
                End::Stopped => Verdict::Stopped,
                End::Interrupted => Verdict::Interrupted,
                End::Late => Verdict::TimeLimit,
                End::Failed(_) => Verdict::Error,
            },
            error: report.error.as_ref().map(|error| Fault {
                message: error.message.clone(),
                program: error.program.clone(),
                block: error.block,
                line: error.line,
                detail: error.detail.clone(),
            }),
            unit: report.unit.to_owned(),
            machining_time_s: report.machining_time_s,
            feed_mm: report.path_mm.feed,
            rapid_mm: report.path_mm.rapid,
            blocks_executed: report.blocks_executed,
            warnings: report
                .warnings
                .iter()
                .map(|warning| Said {
                    message: warning.message.clone(),
                    program: warning.program.clone(),
                    block: warning.block,
                    count: warning.count,
                })
                .collect(),
            calls: (1..)
                .map_while(|index| tested.reader.program(index))
                .map(|program| program.name().to_owned())
                .collect(),
            ..Row::without_run(path, Verdict::Ok, None)
        };
        if let Some(survey) = &tested.survey {
            row.take_survey(survey, list, machine_zero);
        }
        row.take_part(tested, density);
        row
    }

    fn take_survey(&mut self, survey: &Survey, list: &ParameterList, machine_zero: &Position) {
        self.tools = survey
            .uses()
            .map(|tool| Use {
                tool: tool.tool,
                radius_mm: tidy(tool.radius_mm),
                time_s: tidy(tool.time_s),
                feed_mm: tidy(tool.feed_mm),
                rapid_mm: tidy(tool.rapid_mm),
            })
            .collect();
        self.blank_mm = survey
            .blank
            .map(|blank| [0, 1, 2].map(|k| tidy(blank.max[k] - blank.min[k])));
        for axis in Axis::ALL {
            let Some((tip, nose)) = survey.travel(axis) else {
                continue;
            };
            let limits = list.traverse_range(axis);
            let fits = match machine_zero.get(axis) {
                Some(zero) => nose[0] - zero >= limits[0] && nose[1] - zero <= limits[1],
                None => nose[1] - nose[0] <= limits[1] - limits[0],
            };
            let travel = Travel {
                least: tidy(tip[0]),
                greatest: tidy(tip[1]),
                limits,
                fits,
            };
            self.travel.insert(axis.to_string(), travel);
        }
    }

    fn take_part(&mut self, tested: &Tested, density: Option<f64>) {
        let Some(part) = &tested.part else { return };
        let order = part.axes();
        self.finished_mm = part.extent().map(|[min, max]| {
            // From the order of the part's axes to X, Y, Z.
            [Axis::X, Axis::Y, Axis::Z].map(|axis| {
                let k = order.iter().position(|of| *of == axis).unwrap_or_default();
                tidy(max[k] - min[k])
            })
        });
        let removed = tested.report.removed_mm3;
        self.removed_mm3 = removed;
        let Some(kg_mm3) = density.map(|density| density * 1e-6) else {
            return;
        };
        self.removed_kg = removed.map(|removed| tidy(removed * kg_mm3));
        let whole = self.blank_mm.map(|sides| sides.iter().product::<f64>());
        self.finished_kg = whole
            .zip(removed)
            .map(|(whole, removed)| tidy((whole - removed) * kg_mm3));
    }

    /// The axes that leave the machine's range, as `X Z`.
    pub fn beyond(&self) -> String {
        let beyond = self.travel.iter().filter(|(_, travel)| !travel.fits);
        let axes: Vec<&str> = beyond.map(|(axis, _)| axis.as_str()).collect();
        axes.join(" ")
    }

    /// The error in one line, empty without one.
    pub fn error_text(&self) -> String {
        let Some(error) = &self.error else {
            return String::new();
        };
        if error.line == 0 {
            return error.message.clone();
        }
        let elsewhere = match Path::new(&self.path).file_name() {
            Some(name) if name.to_string_lossy() == error.program => String::new(),
            _ => format!("{} ", error.program),
        };
        let detail = match error.detail.as_str() {
            "" => String::new(),
            detail => format!(" ({detail})"),
        };
        format!("{} at {elsewhere}block {}{detail}", error.message, error.block)
    }
}
