//! What a control has of what not every control of its model has: hardware options, and the release of its software.
//!
//! Decision: A control of which nobody says otherwise has all options and the newest software; a TNC 151/155 level 8
//!
//! Decision: What a release of one series brought, all releases of later series have; the types of the TNC 415 A and E, which
//! are no models here, are taken for TNC 415 B and F
//!
//! Decision: Spindle orientation is an option of the TNC 151/155, digitizing one of the others that have it: it takes M19, cycle 13
//! and the strobe of the PLC; M2501 turns the spindle without it

use std::fmt;
use std::sync::LazyLock;

use crate::ControlModel;
use crate::conformance::{Kind, Range};

/// A hardware option.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum HardwareOption {
    /// Digitizing with the switching probe TS 120 [000:357-375].
    Ts120,
    /// Digitizing with the measuring probe TM 110; its module enables the TS 120, too [000:7895].
    Tm110,
    /// Spindle orientation of the TNC 151/155, as a fifth axis [001:179-182].
    SpindleOrientation,
}

/// Options and software of a control.
///
/// ```
/// use bahn_parameters::ControlModel::Tnc415b;
/// use bahn_parameters::conformance::Kind;
/// use bahn_parameters::equipment::{Equipment, Release, Use};
/// let mut equipment = Equipment::default();
/// let m126 = Use::of(Kind::MFunction, "M126");
/// assert_eq!(equipment.lacks(Tnc415b, m126), None);
/// equipment.release = Some(Release::read(Tnc415b, "280 54 02").unwrap());
/// assert_eq!(
///     equipment.lacks(Tnc415b, m126).as_deref(),
///     Some("there from software 280 54 04 on; this control has 280 54 02")
/// );
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Equipment {
    /// Bits of the options that it lacks.
    without: u8,
    /// The release of its software; the newest without one.
    pub release: Option<Release>,
}

/// A release of the software of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Release {
    /// The type, as `280 54`; empty for the levels of the TNC 151/155.
    kind: &'static str,
    series: Series,
    /// Version or level.
    pub version: u8,
}

/// Types that were developed together, oldest first; the levels of the TNC 151/155 count for themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Series {
    Level,
    First,
    Second,
    Third,
    Fourth,
}

/// What a program, a list or a PLC program uses of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Use<'a> {
    kind: Option<Kind>,
    object: &'a str,
    /// The value of a machine parameter, and whether the control gives it by itself.
    value: Option<(f64, bool)>,
}

impl<'a> Use<'a> {
    /// A function by its name in the registry: `M126`, `TCH PROBE 5`, `M2717`, `9171`.
    pub const fn of(kind: Kind, object: &'a str) -> Use<'a> {
        Use {
            kind: Some(kind),
            object,
            value: None,
        }
    }

    /// A machine parameter with its value, and whether that is the one that the control gives it by itself.
    pub const fn parameter(id: &'a str, value: f64, standard: bool) -> Use<'a> {
        Use {
            kind: Some(Kind::MachineParameter),
            object: id,
            value: Some((value, standard)),
        }
    }
}

/// What the software does otherwise from some release on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behaviour {
    /// TNC 415 F, TNC 425 E: four instead of three axes on a straight line [000:752-760].
    LinesOfFourAxes,
    /// TNC 151/155: ACK and NAK alone control the flow of a transfer, without DC1, DC3 and RTS [001:1946-1948].
    FlowByAcknowledgement,
    /// TNC 151/155: a hard copy has 8 data bits, whatever MP222 says [001:2178-2180].
    HardCopyOf8Bits,
}

impl Behaviour {
    /// Its name in the table.
    const fn object(self) -> &'static str {
        match self {
            Behaviour::LinesOfFourAxes => "a straight line of four axes",
            Behaviour::FlowByAcknowledgement => "flow by ACK and NAK alone",
            Behaviour::HardCopyOf8Bits => "hard copy with 8 data bits",
        }
    }
}

/// On which value of a parameter a row is about.
#[derive(Clone, Copy, Debug, PartialEq)]
enum When {
    Always,
    Above(f64),
    Below(f64),
    Equals(f64),
    Not(f64),
    Bit(u32),
}

/// A row: what it is about, and what it takes.
struct Row {
    kind: Option<Kind>,
    objects: &'static str,
    when: When,
    takes: Takes,
    source: &'static str,
}

enum Takes {
    Option(HardwareOption),
    /// A release of each series named.
    Since(Vec<(Series, u8)>),
}

/// A type of software.
struct Type {
    /// As `280 54`.
    name: &'static str,
    series: Series,
    models: &'static str,
    versions: &'static str,
}

static TYPES: LazyLock<Vec<Type>> = LazyLock::new(|| {
    include_str!("../data/software.tsv")
        .lines()
        .skip(1)
        .filter_map(software_type)
        .collect()
});

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let releases = include_str!("../data/releases.tsv")
        .lines()
        .skip(1)
        .filter_map(release_row);
    let options = include_str!("../data/options.tsv")
        .lines()
        .skip(1)
        .filter_map(option_row);
    options.chain(releases).collect()
});

fn software_type(line: &'static str) -> Option<Type> {
    let mut columns = line.split('\t');
    Some(Type {
        name: columns.next()?,
        series: Series::read(columns.next()?)?,
        models: columns.next()?,
        versions: columns.next()?,
    })
}

fn release_row(line: &'static str) -> Option<Row> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let (kind, objects, when, since) = (next()?, next()?, next()?, next()?);
    let one = |text: &str| {
        let (series, version) = text.trim().split_once(' ')?;
        Some((Series::read(series)?, version.parse().ok()?))
    };
    Some(Row {
        kind: read_kind(kind)?,
        objects,
        when: When::read(when)?,
        takes: Takes::Since(since.split(',').map(one).collect::<Option<_>>()?),
        source: next()?,
    })
}

fn option_row(line: &'static str) -> Option<Row> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    let option = HardwareOption::named(next()?)?;
    Some(Row {
        kind: read_kind(next()?)?,
        objects: next()?,
        when: When::read(next()?)?,
        takes: Takes::Option(option),
        source: next()?,
    })
}

/// A kind of the registry, or what the software does by itself.
fn read_kind(text: &str) -> Option<Option<Kind>> {
    match text {
        "function" => Some(None),
        _ => Kind::ALL.into_iter().find(|kind| kind.id() == text).map(Some),
    }
}

impl When {
    fn read(text: &str) -> Option<When> {
        let Some((sign, value)) = text.split_once(' ') else {
            return text.is_empty().then_some(When::Always);
        };
        let number: f64 = value.parse().ok()?;
        match sign {
            ">" => Some(When::Above(number)),
            "<" => Some(When::Below(number)),
            "=" => Some(When::Equals(number)),
            "<>" => Some(When::Not(number)),
            "bit" => Some(When::Bit(number as u32)),
            _ => None,
        }
    }

    fn holds(self, value: Option<(f64, bool)>) -> bool {
        let Some((value, standard)) = value else {
            return self == When::Always;
        };
        match self {
            When::Always => !standard,
            When::Not(other) => value != other,
            When::Above(limit) => value > limit,
            When::Below(limit) => value < limit,
            When::Equals(other) => value == other,
            When::Bit(bit) => (value as i64) >> bit & 1 != 0,
        }
    }
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            When::Always => Ok(()),
            When::Above(limit) => write!(f, " above {limit}"),
            When::Below(limit) => write!(f, " below {limit}"),
            When::Equals(value) => write!(f, " = {value}"),
            When::Not(value) => write!(f, " other than {value}"),
            When::Bit(bit) => write!(f, " bit {bit}"),
        }
    }
}

impl Series {
    fn read(text: &str) -> Option<Series> {
        match text {
            "15x" => Some(Series::Level),
            "05x" => Some(Series::First),
            "02x" => Some(Series::Second),
            "93x" => Some(Series::Third),
            "54x" => Some(Series::Fourth),
            _ => None,
        }
    }
}

impl Type {
    fn is_of(&self, model: ControlModel) -> bool {
        let id = model.id().trim_start_matches("tnc");
        self.models.split(' ').any(|own| own == id)
    }

    fn has(&self, version: u8) -> bool {
        self.versions.split(' ').any(|range| {
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            let [first, last] = [first, last].map(|number| number.parse().unwrap_or(u8::MAX));
            (first..=last).contains(&version)
        })
    }
}

/// A text that is no release of the software of a model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReleaseError {
    /// Levels of the TNC 151/155.
    #[error("`{0}` is no level of the software of the {model}; there are 1 to 99, as 8", model = .1.name())]
    NoLevel(String, ControlModel),
    /// Software numbers of the TNC 407/415/425.
    #[error("`{0}` is no software of the {model}; there are {1}", model = .2.name())]
    NoNumber(String, String, ControlModel),
    /// Nothing is known of the releases of the model.
    #[error("no manual tells releases of the {model}; leave `software` out", model = .0.name())]
    NoneKnown(ControlModel),
}

impl Release {
    /// Reads a software number, `280 54 06` or with the digit of the language `280 540 06`, or a level of the TNC 151/155.
    ///
    /// # Errors
    /// [`ReleaseError`], with those that there are.
    pub fn read(model: ControlModel, text: &str) -> Result<Release, ReleaseError> {
        let digits: String = text.chars().filter(|c| *c != ' ').collect();
        if model.limits().has_old_numbers() {
            let level = digits.parse().ok().filter(|level| (1..=99).contains(level));
            return level
                .map(|version| Release {
                    kind: "",
                    series: Series::Level,
                    version,
                })
                .ok_or_else(|| ReleaseError::NoLevel(text.to_owned(), model));
        }
        let mut types = TYPES.iter().filter(|one| one.is_of(model)).peekable();
        if types.peek().is_none() {
            return Err(ReleaseError::NoneKnown(model));
        }
        let is_number = matches!(digits.len(), 7 | 8) && digits.bytes().all(|byte| byte.is_ascii_digit());
        let known: Vec<&Type> = types.collect();
        let release = is_number.then(|| {
            let (kind, version) = (digits.get(..5)?, digits.get(digits.len() - 2..)?.parse().ok()?);
            let own = known.iter().find(|one| one.name.replace(' ', "") == kind)?;
            own.has(version).then_some(Release {
                kind: own.name,
                series: own.series,
                version,
            })
        });
        release.flatten().ok_or_else(|| {
            let names = known.iter().map(|one| {
                let versions = one.versions.split(' ').map(|range| {
                    let numbers = range.split('-').map(|number| format!("{number:0>2}"));
                    numbers.collect::<Vec<_>>().join(" to ")
                });
                format!("{} {}", one.name, versions.collect::<Vec<_>>().join(", "))
            });
            ReleaseError::NoNumber(text.to_owned(), names.collect::<Vec<_>>().join("; "), model)
        })
    }

    /// Whether it has what these releases brought.
    fn has(self, since: &[(Series, u8)]) -> bool {
        let own = since.iter().find(|(series, _)| *series == self.series);
        match own {
            Some((_, version)) => self.version >= *version,
            // Levels have nothing in common with software numbers.
            None if self.series == Series::Level => true,
            None => since
                .iter()
                .any(|(series, _)| *series == Series::Level || *series < self.series),
        }
    }
}

impl fmt::Display for Release {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.series {
            Series::Level => write!(f, "level {:02}", self.version),
            _ => write!(f, "{} {:02}", self.kind, self.version),
        }
    }
}

impl HardwareOption {
    /// All options.
    pub const ALL: [HardwareOption; 3] = [
        HardwareOption::Ts120,
        HardwareOption::Tm110,
        HardwareOption::SpindleOrientation,
    ];

    /// The name used in files: `ts120`.
    pub const fn id(self) -> &'static str {
        match self {
            HardwareOption::Ts120 => "ts120",
            HardwareOption::Tm110 => "tm110",
            HardwareOption::SpindleOrientation => "spindle-orientation",
        }
    }

    /// The option of a name.
    pub fn named(id: &str) -> Option<HardwareOption> {
        HardwareOption::ALL.into_iter().find(|option| option.id() == id)
    }

    /// Whether a model can have it.
    pub fn is_of(self, model: ControlModel) -> bool {
        let old = model.limits().has_old_numbers();
        match self {
            HardwareOption::SpindleOrientation => old,
            HardwareOption::Ts120 => !old,
            HardwareOption::Tm110 => model.limits().measuring_probe,
        }
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

impl Equipment {
    /// A control with these options and no others.
    pub fn with_options(options: &[HardwareOption]) -> Equipment {
        let has = |option: HardwareOption| {
            let by_tm110 = option == HardwareOption::Ts120 && options.contains(&HardwareOption::Tm110);
            options.contains(&option) || by_tm110
        };
        let missing = HardwareOption::ALL.into_iter().filter(|option| !has(*option));
        Equipment {
            without: missing.fold(0, |bits, option| bits | option.bit()),
            release: None,
        }
    }

    /// Why the control lacks what is used, to be said after its name; `None` when it has it.
    pub fn lacks(&self, model: ControlModel, wanted: Use<'_>) -> Option<String> {
        if *self == Equipment::default() {
            return None;
        }
        let object = Range::read(wanted.object);
        let rows = ROWS
            .iter()
            .filter(|row| row.kind == wanted.kind && row.when.holds(wanted.value));
        let mut rows = rows.filter(|row| Range::read(row.objects).contains(&object));
        rows.find_map(|row| self.misses(model, row))
    }

    /// What a row takes that the control has not.
    fn misses(&self, model: ControlModel, row: &Row) -> Option<String> {
        match &row.takes {
            Takes::Option(option) => {
                let missing = self.without & option.bit() != 0 && option.is_of(model);
                missing.then(|| format!("only with the option {}", option.id()))
            }
            Takes::Since(since) => {
                let own = self.release.filter(|own| !own.has(since))?;
                Some(format!(
                    "there from software {} on; this control has {own}",
                    first(model, since, Some(own.series))?
                ))
            }
        }
    }

    /// Whether the software does it so.
    pub fn does(&self, behaviour: Behaviour) -> bool {
        let object = behaviour.object();
        let mut rows = ROWS
            .iter()
            .filter(|row| row.kind.is_none() && row.objects == object);
        rows.all(|row| match (&row.takes, self.release) {
            (Takes::Since(since), Some(release)) => release.has(since),
            _ => true,
        })
    }
}

/// The first release with something, as the numbers of a model have it: of these series if there is one, else of the latest.
fn first(model: ControlModel, since: &[(Series, u8)], of: Option<Series>) -> Option<String> {
    let old = model.limits().has_old_numbers();
    let own = since.iter().filter(|(series, _)| Some(*series) == of);
    own.chain(since.iter().rev()).find_map(|(series, version)| {
        if *series == Series::Level {
            return old.then(|| format!("level {version:02}"));
        }
        let own = TYPES
            .iter()
            .find(|one| one.series == *series && one.is_of(model))?;
        Some(format!("{} {version:02}", own.name))
    })
}

/// What the table says of a model: what is there from which release on, or with which option, and where it is said.
pub fn table(model: ControlModel) -> Vec<[String; 3]> {
    let rows = ROWS.iter().filter_map(|row| {
        let takes = match &row.takes {
            Takes::Option(option) => option.is_of(model).then(|| format!("option {}", option.id()))?,
            Takes::Since(since) => format!("software {}", first(model, since, None)?),
        };
        let what = match row.kind {
            Some(Kind::Module) => format!("module {}", row.objects),
            _ => format!("{}{}", row.objects, row.when),
        };
        Some([what, takes, row.source.to_owned()])
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No row is lost by a slip of the pen.
    #[test]
    fn every_row_is_read() {
        let lines = |text: &str| text.lines().count() - 1;
        let rows = lines(include_str!("../data/releases.tsv")) + lines(include_str!("../data/options.tsv"));
        assert_eq!(ROWS.len(), rows);
        assert_eq!(TYPES.len(), lines(include_str!("../data/software.tsv")));
    }

    /// What the list of machine parameters says of releases, the table of releases has.
    #[test]
    fn the_list_of_parameters_says_the_same() {
        for row in crate::Definition::all(ControlModel::Tnc425) {
            let dated = row.versions.contains("from 259 9") || row.versions.contains("from 280 5");
            let id = row.id.to_string();
            let known = ROWS.iter().any(|own| {
                own.kind == Some(Kind::MachineParameter)
                    && Range::read(own.objects).contains(&Range::read(&id))
            });
            assert!(known || !dated, "{id}: {}", row.versions);
        }
    }

    #[test]
    fn later_series_have_what_earlier_ones_brought() {
        let model = ControlModel::Tnc415b;
        let has = |release: &str, wanted: Use<'_>| {
            let equipment = Equipment {
                release: Release::read(model, release).ok(),
                ..Equipment::default()
            };
            assert!(equipment.release.is_some(), "{release}");
            equipment.lacks(model, wanted).is_none()
        };
        // MP4230 came with 259 96 06, MP951 with 259 96 09, a month after 259 93 10.
        let mp4230 = Use::parameter("MP4230.3", 1.0, false);
        assert!(!has("259 96 05", mp4230) && has("259 96 06", mp4230) && has("259 93 04", mp4230));
        let mp951 = Use::parameter("MP951.0", 1.0, false);
        assert!(!has("259 96 08", mp951) && !has("259 93 09", mp951) && has("280 54 01", mp951));
        // Bit 4 of MP7420 is new, MP7420 is not.
        assert!(
            !has("280 54 04", Use::parameter("MP7420", 16.0, false))
                && has("280 54 04", Use::parameter("MP7420", 15.0, false))
        );
        assert!(!has("280 54 05", Use::parameter("MP1925.0", 1.0, false)));
    }

    #[test]
    fn numbers_are_those_of_the_model() {
        use ControlModel::{Tnc155, Tnc360, Tnc407, Tnc415b, Tnc415f};
        let read = |model, text| Release::read(model, text).map(|release| release.to_string()).ok();
        assert_eq!(read(Tnc415b, "280 540 06").as_deref(), Some("280 54 06"));
        assert_eq!(read(Tnc407, "280 58 06").as_deref(), Some("280 58 06"));
        assert_eq!(read(Tnc155, "5").as_deref(), Some("level 05"));
        for (model, text) in [
            (Tnc415b, "280 58 06"),
            (Tnc415b, "280 54 07"),
            (Tnc415b, "280 54 03"),
            (Tnc415f, "280 54 06"),
            (Tnc415b, "6"),
            (Tnc155, "0"),
            (Tnc155, "100"),
            (Tnc155, "280 54 06"),
            (Tnc360, "280 54 06"),
        ] {
            assert_eq!(read(model, text), None, "{model} {text}");
        }
    }
}
