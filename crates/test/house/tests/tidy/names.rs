//! Names in the files of a room, and where what they name is defined.

use std::collections::BTreeMap;
use std::path::Path;

use crate::source::{code_of, has_word, is_of_name, source_files};

/// The name of the file `lib.rs`, which stands above all others.
const FRONT: &str = "lib";

/// Names are passed on no more often than this.
const PASSED_ON: usize = 16;

/// The texts of the files of a room, by their names: `channel::drive` for `channel/drive.rs`.
pub struct Texts(BTreeMap<String, Text>);

impl Texts {
    /// Those of the files below a folder.
    pub fn below(folder: &Path) -> Texts {
        let name = |file: &Path| {
            let relative = file.strip_prefix(folder).unwrap().with_extension("");
            let parts: Vec<_> = relative.iter().map(|part| part.to_str().unwrap()).collect();
            parts.join("::").trim_end_matches("::mod").to_owned()
        };
        let texts = source_files(folder)
            .into_iter()
            .map(|file| (name(&file), code_of(&file)));
        Texts::of(texts.filter(|(name, _)| name != "main"))
    }

    /// Those of files, given by their names and texts.
    pub fn of(texts: impl IntoIterator<Item = (String, String)>) -> Texts {
        let texts = texts.into_iter().map(|(name, text)| (name, Text::of(&text)));
        Texts(texts.collect())
    }
}

/// The text of a file: its `use` lines, and what is left without them.
struct Text {
    /// What stands between `use` and the semicolon, and whether others can have it from here.
    uses: Vec<(String, bool)>,
    body: String,
}

impl Text {
    fn of(text: &str) -> Text {
        let mut uses = Vec::new();
        let mut body = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("use ") {
            body.push_str(before);
            let line = before
                .rsplit([';', '{', '}', ']', '\n'])
                .next()
                .unwrap_or_default()
                .trim();
            let is_visible = line.starts_with("pub") && line.ends_with(['b', ')']);
            rest = match after.split_once(';') {
                Some((used, after)) if line.is_empty() || is_visible => {
                    uses.push((used.to_owned(), is_visible));
                    after
                }
                _ => after,
            };
        }
        body.push_str(rest);
        // A part that is declared is not used.
        let is_of_part = |line: &&str| line.trim_end().ends_with(';') && has_word(line, "mod");
        let body = body.lines().filter(|line| !is_of_part(line)).collect::<Vec<_>>();
        Text {
            uses,
            body: body.join("\n"),
        }
    }
}

/// A name that a file has from elsewhere in its crate.
pub struct Import<'a> {
    /// What it is called here; `*` stands for all names of the path.
    pub name: &'a str,
    /// From the root of the crate.
    path: Vec<&'a str>,
    /// Whether others can have it from here.
    pub is_public: bool,
}

/// The files of a room by their names, with what each imports and the text beside that.
pub struct Files<'a>(BTreeMap<&'a str, (Vec<Import<'a>>, &'a str)>);

impl<'a> Files<'a> {
    /// Those of a room.
    pub fn of(texts: &'a Texts) -> Files<'a> {
        let bare = texts
            .0
            .iter()
            .map(|(name, text)| (name.as_str(), (Vec::new(), text.body.as_str())));
        let mut files = Files(bare.collect());
        for (file, text) in &texts.0 {
            let mut imports = Vec::new();
            for (used, is_public) in &text.uses {
                let mut written = Vec::new();
                names(used, &mut Vec::new(), &mut written);
                imports.extend(written.into_iter().filter_map(|(path, name)| {
                    let path = files.rooted(file, &path)?;
                    Some(Import {
                        name,
                        path,
                        is_public: *is_public,
                    })
                }));
            }
            files.0.insert(file, (imports, &text.body));
        }
        files
    }

    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        self.0.keys().copied()
    }

    /// The text of a file beside its `use` lines.
    pub fn body(&self, file: &str) -> &'a str {
        self.0.get(file).map_or("", |(_, body)| body)
    }

    /// What a file imports from its crate.
    pub fn imports(&self, file: &str) -> &[Import<'a>] {
        self.0.get(file).map_or(&[], |(imports, _)| imports)
    }

    /// The file that defines what a file imports, and its name there; nothing, if that is a whole file.
    pub fn imported(&self, import: &Import<'a>) -> Option<(&'a str, &'a str)> {
        self.defining(&import.path, 0)
    }

    /// The file that defines what a path in a file names, and its name there; nothing, if that is a whole file or of
    /// another crate.
    pub fn named(&self, file: &'a str, path: &[&'a str]) -> Option<(&'a str, &'a str)> {
        let (first, after) = path.split_first()?;
        let path = match self.imports(file).iter().find(|import| import.name == *first) {
            Some(import) => [&import.path, after].concat(),
            None => self.rooted(file, path)?,
        };
        self.defining(&path, 0)
    }

    /// The path that a file writes, from the root of its crate; nothing, if it leads into another crate.
    fn rooted(&self, file: &'a str, path: &[&'a str]) -> Option<Vec<&'a str>> {
        let here: Vec<&str> = file.split("::").filter(|part| *part != FRONT).collect();
        let (first, rest) = path.split_first()?;
        match *first {
            "crate" => Some(rest.to_vec()),
            "self" => Some([&here, rest].concat()),
            "super" => {
                let up = path.iter().take_while(|part| **part == "super").count();
                Some([&here[..here.len().saturating_sub(up)], &path[up..]].concat())
            }
            first => {
                let child = [&here[..], &[first]].concat().join("::");
                let is_child = self.0.contains_key(child.as_str());
                is_child.then(|| [&here, path].concat())
            }
        }
    }

    /// The file that defines what a path from the root names, and its name there; nothing, if that is a whole file.
    fn defining(&self, path: &[&'a str], steps: usize) -> Option<(&'a str, &'a str)> {
        let (file, rest) = (0..=path.len()).rev().find_map(|count| {
            let name = match count {
                0 => FRONT.to_owned(),
                count => path[..count].join("::"),
            };
            let (file, _) = self.0.get_key_value(name.as_str())?;
            Some((*file, &path[count..]))
        })?;
        let (name, after) = rest.split_first()?;
        let ways = self.imports(file).iter().filter(|_| steps < PASSED_ON);
        if let Some(import) = ways.clone().find(|import| import.name == *name) {
            return self.defining(&[&import.path, after].concat(), steps + 1);
        }
        let of_all = ways.filter(|import| import.name == "*").find_map(|all| {
            let (file, name) = self.defining(&[&all.path[..], &[*name]].concat(), steps + 1)?;
            defines(self.body(file), name).then_some((file, name))
        });
        of_all.or(Some((file, *name)))
    }
}

/// Whether a text defines a name.
fn defines(code: &str, name: &str) -> bool {
    let kinds = ["fn", "struct", "enum", "trait", "type", "const", "static", "mod"];
    kinds.iter().any(|kind| has_word(code, &format!("{kind} {name}")))
}

/// The paths of a `use`, of each branch where it has braces, with the name that each gives; what is left behind it.
fn names<'a>(text: &'a str, before: &mut Vec<&'a str>, found: &mut Vec<(Vec<&'a str>, &'a str)>) -> &'a str {
    let depth = before.len();
    let mut rest = text.trim_start();
    loop {
        if let Some(group) = rest.strip_prefix('{') {
            rest = group.trim_start();
            while !rest.is_empty() && !rest.starts_with('}') {
                rest = names(rest, before, found).trim_start_matches([',', ' ', '\n']);
            }
            rest = rest.strip_prefix('}').unwrap_or(rest);
            break;
        }
        let end = rest.find(|c| !(is_of_name(c) || c == '*')).unwrap_or(rest.len());
        let (name, after) = rest.split_at(end);
        let is_part = name != "*" && (name != "self" || before.is_empty());
        if is_part {
            before.push(name);
        }
        if let Some(more) = after.strip_prefix("::") {
            rest = more;
            continue;
        }
        let (renamed, after) = after.split_at(after.find([',', '}']).unwrap_or(after.len()));
        let name = renamed.trim().strip_prefix("as ").map_or(
            if name == "*" {
                name
            } else {
                before[before.len() - 1]
            },
            str::trim,
        );
        found.push((before.clone(), name));
        rest = after;
        break;
    }
    before.truncate(depth);
    rest
}
