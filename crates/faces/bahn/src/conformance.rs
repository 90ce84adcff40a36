//! `bahn conformance`: what each function of a control does here, from the registry of the control models.

use bahn_parameters::ControlModel;
use bahn_parameters::conformance::Kind;
use bahn_report::conformance::{Asked, EFFECTS, Model, SYSTEM_900, Table};
use bahn_report::text;
use clap::{Args, ValueEnum};

use crate::{Outcome, UsageError, console};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn conformance                              everything, for all control models
  bahn conformance --model tnc360 --kind m      the M functions of a TNC 360
  bahn conformance --effect none --kind parameter
      Machine parameters that are read and have no effect.
  bahn conformance --model system900 --kind parameter --effect partly
      A System 900 is listed when it is named: its parameters.
  bahn conformance --format json

acts: all that the manual says; partly: without what is named; none: read and passed over; stored: a parameter
of a System 900 that is kept, while nothing runs by it, none: that the manual gives no function. Programs that use
what moves differently on the control (`moves`) are refused unless --skip-unknown is given.
JSON: totals (kind, model, acts, partly, none) and entries (kind, name, controls, effect, moves, missing,
source, proof).";

/// Options of `bahn conformance`.
#[derive(Args, Debug)]
pub(crate) struct ConformanceOptions {
    /// Control model; without it all but the System 900.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<Model>,
    /// Only one kind of functions.
    #[arg(long, value_name = "KIND", value_parser = kind_parser())]
    pub kind: Option<Kind>,
    /// Only what acts, acts partly, is stored or has no effect.
    #[arg(long, value_name = "EFFECT", value_parser = EFFECTS.map(bahn_system900::Effect::id))]
    pub effect: Option<String>,
    /// How the table is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: TableFormat,
}

/// How the table is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Lines for people.
    #[default]
    Text,
    /// JSON for programs.
    Json,
    /// For docs/conformance.md.
    Markdown,
}

fn kind_parser() -> impl clap::builder::TypedValueParser<Value = Kind> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let named = |id: String| Kind::ALL.into_iter().find(|kind| kind.id() == id);
    PossibleValuesParser::new(Kind::ALL.map(Kind::id)).try_map(move |id| named(id).ok_or("unknown kind"))
}

fn model_parser() -> impl clap::builder::TypedValueParser<Value = Model> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let ids = ControlModel::ALL.map(ControlModel::id).into_iter();
    PossibleValuesParser::new(ids.chain([SYSTEM_900])).try_map(|id| match id.parse() {
        Ok(model) => Ok(Model::Tnc(model)),
        Err(_) if id.eq_ignore_ascii_case(SYSTEM_900) => Ok(Model::System900),
        Err(error) => Err(error),
    })
}

pub(crate) fn command(options: &ConformanceOptions) -> Result<Outcome, UsageError> {
    let table = Table::of(&Asked {
        model: options.model,
        kind: options.kind,
        effect: options.effect.clone(),
    });
    let text = match options.format {
        TableFormat::Text => table.text(),
        TableFormat::Markdown => table.markdown(),
        TableFormat::Json => text::json(&table)?,
    };
    console::print(&text)?;
    Ok(Outcome::Fine)
}
