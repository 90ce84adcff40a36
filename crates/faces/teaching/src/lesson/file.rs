//! Lessons as text files. `docs/lessons.md` tells how one is written.

use std::path::Path;

use bahn_exchange::parts;
use bahn_host::{Action, Expectation, Operable, Presence, Script, ScriptAction, Stage};
use bahn_parameters::ParameterList;
use bahn_screen::texts::Language;
use bahn_text::{Diagnostic, Span, decode};

/// A text in the languages of the panel; what has no German text is said in English.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Words {
    english: String,
    german: String,
}

impl Words {
    /// The text in a language; English where it has none.
    pub fn of(&self, language: Language) -> &str {
        match language {
            Language::German if !self.german.is_empty() => &self.german,
            _ => &self.english,
        }
    }

    fn add(&mut self, german: bool, text: &str) {
        let own = if german {
            &mut self.german
        } else {
            &mut self.english
        };
        if !own.is_empty() {
            own.push(' ');
        }
        own.push_str(text);
    }

    /// `In English | auf Deutsch`.
    fn pair(text: &str) -> Words {
        let (english, german) = text.split_once('|').unwrap_or((text, ""));
        Words {
            english: english.trim().to_owned(),
            german: german.trim().to_owned(),
        }
    }
}

/// What the machine is when the task begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Begin {
    /// The machine as it stands, whatever was done before.
    Here,
    /// Nothing is broken, and the control was switched on just now.
    PowerOn,
    /// The reference run is after it, too.
    #[default]
    Ready,
}

const BEGINS: [(&str, Begin); 3] = [
    ("here", Begin::Here),
    ("power-on", Begin::PowerOn),
    ("ready", Begin::Ready),
];

/// Something that must be so.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Condition {
    /// As scripts expect it.
    Machine(Expectation),
    /// This text stands on the screen, or does not.
    Screen(String, Presence),
    /// The trainee has done this since the task began, or has not.
    Did(Action, Presence),
}

/// Conditions with the words for them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Check {
    /// What the check asks for, in words.
    pub words: Words,
    /// All of this must be so at the same time.
    pub conditions: Vec<Condition>,
}

/// A lesson: what is asked, what happens, what is looked at.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The name of its file, without the ending.
    pub name: String,
    pub(crate) title: Words,
    pub(crate) task: Words,
    pub(crate) hints: Vec<Words>,
    /// Time for it, s.
    pub(crate) limit_s: f64,
    pub(crate) begin: Begin,
    pub(crate) prepare: Script,
    pub(crate) events: Script,
    pub(crate) checks: Vec<Check>,
    pub(crate) never: Vec<Check>,
}

/// Ending of the files.
pub(crate) const ENDING: &str = "lesson";
/// Time for a lesson that says nothing else, s.
const LIMIT_S: f64 = 600.0;
/// Time for a lesson at most, s.
const LIMIT_MAX_S: f64 = 36_000.0;
/// Faults that are named at most, and checks of a lesson.
const MANY: usize = 100;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Head,
    Prepare,
    Events,
    Checks,
    Never,
}

const SECTIONS: [(&str, Section); 4] = [
    ("[prepare]", Section::Prepare),
    ("[events]", Section::Events),
    ("[checks]", Section::Checks),
    ("[never]", Section::Never),
];

impl Lesson {
    /// Reads a lesson for a machine with its plant.
    ///
    /// # Errors
    /// All faults with their lines.
    pub fn read<P: Operable + Send + Sync + 'static>(
        path: &Path,
        bytes: &[u8],
        plant: &P,
        parameters: &ParameterList,
    ) -> Result<Lesson, Vec<Diagnostic>> {
        let text = decode(bytes);
        let mut reader = Reader {
            path,
            plant,
            faults: Vec::new(),
            lesson: Lesson {
                name: name_of(path),
                title: Words::default(),
                task: Words::default(),
                hints: Vec::new(),
                limit_s: LIMIT_S,
                begin: Begin::default(),
                prepare: Script::default(),
                events: Script::default(),
                checks: Vec::new(),
                never: Vec::new(),
            },
        };
        let mut section = Section::Head;
        // Scripts keep the numbers of their lines.
        let (mut prepare, mut events) = (String::new(), String::new());
        for (number, line) in (1..).zip(text.lines()) {
            prepare.push('\n');
            events.push('\n');
            let content = line.trim();
            if content.is_empty() || content.starts_with([';', '#']) {
                continue;
            }
            if let Some((_, named)) = SECTIONS.iter().find(|(name, _)| *name == content) {
                section = *named;
                continue;
            }
            match section {
                Section::Prepare => push_line(&mut prepare, line),
                Section::Events => push_line(&mut events, line),
                _ => reader.line(section, number, line),
            }
        }
        let stage = Stage::machine(plant, parameters);
        reader.lesson.prepare = reader.script(&prepare, &stage);
        reader.lesson.events = reader.script(&events, &stage);
        reader.finish()
    }
}

/// A line of a script, in its place after the empty ones.
fn push_line(script: &mut String, line: &str) {
    script.pop();
    script.push_str(line);
    script.push('\n');
}

fn name_of(path: &Path) -> String {
    let name = path.file_stem().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

struct Reader<'a> {
    path: &'a Path,
    plant: &'a dyn Operable,
    faults: Vec<Diagnostic>,
    lesson: Lesson,
}

impl Reader<'_> {
    fn line(&mut self, section: Section, number: u32, line: &str) {
        let read = match section {
            Section::Checks | Section::Never => self.check(section, line),
            _ => self.head(line),
        };
        if let Err(what) = read {
            self.fault(number, line, what);
        }
    }

    /// `title: TEXT`, `task de: TEXT`.
    fn head(&mut self, line: &str) -> Result<(), String> {
        let form = || "it is written `WORD: TEXT`; sections are [prepare], [events], [checks], [never]";
        let (word, text) = line.split_once(':').ok_or_else(form)?;
        let text = text.trim();
        let (word, language) = match word.trim().split_once(char::is_whitespace) {
            Some((word, language)) => (word, language.trim()),
            None => (word.trim(), "en"),
        };
        let german = match language {
            "en" => false,
            "de" => true,
            other => return Err(format!("there is no language `{other}`; there are en, de")),
        };
        let lesson = &mut self.lesson;
        match word {
            "title" => lesson.title.add(german, text),
            "task" => lesson.task.add(german, text),
            "hint" if !german && lesson.hints.len() < MANY => lesson.hints.push(Words {
                english: text.to_owned(),
                german: String::new(),
            }),
            // It belongs to the hint above it.
            "hint" => match lesson.hints.last_mut() {
                Some(hint) => hint.add(german, text),
                None => return Err("`hint de` stands below its `hint`".to_owned()),
            },
            "limit" => {
                let seconds = text.parse().ok();
                let seconds = seconds.filter(|seconds| (1.0..=LIMIT_MAX_S).contains(seconds));
                lesson.limit_s =
                    seconds.ok_or_else(|| format!("`{text}` is no time from 1 to {LIMIT_MAX_S} s"))?;
            }
            "begin" => {
                let named = BEGINS.iter().find(|(name, _)| *name == text);
                let (_, begin) = named.ok_or_else(|| {
                    format!("a lesson begins `here`, at `power-on` or `ready`, not `{text}`")
                })?;
                lesson.begin = *begin;
            }
            other => {
                return Err(format!(
                    "there is no `{other}`; there are title, task, hint, limit, begin"
                ));
            }
        }
        Ok(())
    }

    /// `What it is | was es ist => X.actual>50, screen "TEXT"`.
    fn check(&mut self, section: Section, line: &str) -> Result<(), String> {
        let (words, conditions) = line
            .split_once("=>")
            .ok_or("it is written `WORDS | WORTE => CONDITIONS`")?;
        let words = Words::pair(words);
        if words.english.is_empty() {
            return Err("what is looked at has words before =>".to_owned());
        }
        let conditions: Result<Vec<Vec<Condition>>, String> = parts(conditions)
            .map(|condition| self.conditions(condition.trim()))
            .collect();
        let check = Check {
            words,
            conditions: conditions?.into_iter().flatten().collect(),
        };
        let checks = match section {
            Section::Never => &mut self.lesson.never,
            _ => &mut self.lesson.checks,
        };
        if checks.len() == MANY {
            return Err(format!("there are more than {MANY}"));
        }
        checks.push(check);
        Ok(())
    }

    fn conditions(&self, text: &str) -> Result<Vec<Condition>, String> {
        let (there, rest) = match text.strip_prefix("no ") {
            Some(rest) => (Presence::Absent, rest.trim_start()),
            None => (Presence::There, text),
        };
        if let Some(wanted) = rest.strip_prefix("screen ") {
            let wanted = wanted.trim();
            let quoted = wanted
                .strip_prefix('"')
                .and_then(|wanted| wanted.strip_suffix('"'));
            let wanted = quoted.filter(|wanted| !wanted.is_empty());
            let wanted = wanted.ok_or("it is written screen \"TEXT\"")?;
            return Ok(vec![Condition::Screen(wanted.to_owned(), there)]);
        }
        if let Some(action) = rest.strip_prefix("did ") {
            let action = Action::parse(action).map_err(|error| error.to_string())?;
            return Ok(vec![Condition::Did(action, there)]);
        }
        let expected = Expectation::parse_all(text, Some(self.plant))?;
        Ok(expected.into_iter().map(Condition::Machine).collect())
    }

    fn script(&mut self, text: &str, stage: &Stage) -> Script {
        let read = stage.script(self.path, text.as_bytes());
        let script = read.unwrap_or_else(|faults| {
            self.faults.extend(faults);
            Script::default()
        });
        for line in &script.lines {
            let wrong = match line.action {
                ScriptAction::Do(_) | ScriptAction::Set(_) => continue,
                ScriptAction::Expect(_) => "what is expected stands in [checks]",
                ScriptAction::End => "a lesson ends with its checks",
                ScriptAction::Module(_) => "a lesson has no positioning module",
            };
            self.faults
                .push(script.failure(line.number, "the lesson is wrong", wrong.to_owned()));
        }
        script
    }

    fn fault(&mut self, number: u32, line: &str, label: String) {
        if self.faults.len() > MANY {
            return;
        }
        let fault = Diagnostic::error(Span::line(number as usize), "the lesson is wrong");
        self.faults.push(fault.with_detail(label).at(self.path, line));
    }

    fn finish(mut self) -> Result<Lesson, Vec<Diagnostic>> {
        let lesson = &self.lesson;
        let missing = [
            (lesson.title.english.is_empty(), "it has no `title:`"),
            (lesson.task.english.is_empty(), "it has no `task:`"),
            (lesson.checks.is_empty(), "there is nothing in [checks]"),
        ];
        for (is_missing, what) in missing {
            if is_missing {
                self.fault(1, "", what.to_owned());
            }
        }
        match self.faults.is_empty() {
            true => Ok(self.lesson),
            false => {
                self.faults.sort_by_key(|fault| fault.span.line);
                Err(self.faults)
            }
        }
    }
}

/// Reads a lesson for a machine, for fuzzing; errors name their lines.
#[doc(hidden)]
pub fn check_lesson(
    plant: &bahn_machine::Machine,
    parameters: &ParameterList,
    bytes: &[u8],
) -> Result<(), Vec<u32>> {
    let read = Lesson::read(Path::new("L.lesson"), bytes, plant, parameters);
    let lines = |faults: Vec<Diagnostic>| faults.iter().map(|fault| fault.span.line).collect();
    read.map(drop).map_err(lines)
}
