//! What an editor does with documents of each language: every request, with what it must answer. The same script runs
//! against the server in the process and against the command.

use std::path::Path;

use serde_json::{Value, json};

use super::client::{Client, Document, Wire};

pub const PART: &str = "\
0 BEGIN PGM 7 MM
1 ; Höhe 𝄞 der Tasche
2 TOOL DEF 1 L+0 R+5
3 TOOL CALL 1 Z S1000
4 FN0: Q5 = +2
5 LBL 7 ; Bohrung
6 FN1: Q5 = +Q5 + +3
7 L X+10 Y+Q5 R0 F200 M3
8 LBL 0
9 CALL LBL 7
10 CYCL DEF 1.0 PECKING
11 CYCL DEF 1.1 SET UP: -2
12 CYCL DEF 1.2 DEPTH -20
13 CYCL DEF 1.3 PECKG -5
14 CYCL DEF 1.4 DWELL 0
15 CYCL DEF 1.5 F100
16 CALL PGM 15
17 FN9: IF +Q5 EQU +8 GOTO LBL 7
18 L Z+50 R0 FMAX M2
19 END PGM 7 MM
";
const CALLED: &str = "0 BEGIN PGM 15 MM\n1 L X+0 R0 FMAX\n2 L X+1..5 FMAX\n3 END PGM 15 MM\n";
const ISO: &str = "%9 G71 *\nN10 G99 T1 L+0 R+5 *\nN20 T1 G17 S1000 *\nN30 D00 Q05 P01 +60 *\nN40 G98 L3 *\n\
                   N50 G00 G40 G90 X+10 Y+Q5 M3 *\nN60 L3,2 *\nN70 G00 Z+50 M2 *\nN99999 %9 G71 *\n";
const DIN: &str = "%L BORE\nN10 G91 G01 Z-5 F100 (Höhe)\nN20 Z5\nN30 M17\n%MAIN\nN10 G00 G90 X10 Y0 Z0\nN20 V.G.RW = 5\n\
                   N30 L BORE\nN40 P1 = V.G.RW * 2\nN50 G01 X[M54=567 H4] X20 F500 ; ü\nN60 #EXPL SYN\nN70 M30\n";
const MAIN: &str = "USES DOOR.PLC\nEXTERN OPEN\n; Tür\n  L I4 ; Knöpfe\n  S M2485\n  IFT\n  CM OPEN\n  CM 9036\n  ENDI\n\
                    LBL 20\n  L W260\n  = W8\n  JP 20\n  EM\n";
const DOOR: &str = "GLOBAL OPEN\nLBL OPEN\n  L I5\n  = O2\n  EM\n";
const LIST: &str = "; TNC 415 B\nMP1010.0 : 10000 ;Eilgang X\nMP7430:1.2\nMP7430 : 0.9\nMP1060.0 : abc\n";

/// Writes the documents into a folder.
pub fn lay_out(folder: &Path) {
    let files = [
        ("7.H", PART),
        ("15.H", CALLED),
        ("9.I", ISO),
        ("a.nc", DIN),
        ("MAIN.PLC", MAIN),
        ("DOOR.PLC", DOOR),
        ("list.MP", LIST),
    ];
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
}

fn lines(places: &[String]) -> Vec<&str> {
    places.iter().map(String::as_str).collect()
}

fn messages(diagnostics: &[Value]) -> Vec<(&Value, &str)> {
    let all = diagnostics
        .iter()
        .map(|one| (&one["range"], one["message"].as_str().unwrap()));
    all.collect()
}

fn names(symbols: &Value) -> Vec<String> {
    let all = symbols.as_array().unwrap().iter().flat_map(|symbol| {
        let own = symbol["name"].as_str().unwrap().to_owned();
        let children = symbol.get("children").map(names).unwrap_or_default();
        std::iter::once(own).chain(children)
    });
    all.collect()
}

fn folds(answer: &Value) -> Vec<(u64, u64)> {
    let all = answer.as_array().unwrap().iter();
    all.map(|fold| {
        (
            fold["startLine"].as_u64().unwrap(),
            fold["endLine"].as_u64().unwrap(),
        )
    })
    .collect()
}

/// Words by colour: what each token marks, and its name in the legend.
fn tokens<W: Wire>(client: &mut Client<W>, document: &Document) -> Vec<(String, String)> {
    let answer = client.request("textDocument/semanticTokens/full", document.id());
    let legend = client.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"].clone();
    let numbers: Vec<u64> = answer["data"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_u64().unwrap())
        .collect();
    let (mut line, mut character) = (0, 0);
    let mut found = Vec::new();
    for token in numbers.chunks(5) {
        if token[0] > 0 {
            character = 0;
        }
        line += token[0];
        character += token[1];
        let end = character + token[2];
        let range =
            json!({"start": {"line": line, "character": character}, "end": {"line": line, "character": end}});
        let kind = legend[token[3] as usize].as_str().unwrap().to_owned();
        found.push((document.marked(&range).to_owned(), kind));
    }
    found
}

/// Plain language: every request.
pub fn plain<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let mut document = client.open(&folder.join("7.H"), "tnc-plain");
    // The called program has an error: it is reported at the call, with the place over there.
    let found = client.diagnostics(&document);
    let [fault] = &found[..] else { panic!("{found:?}") };
    assert_eq!(document.marked(&fault["range"]), "16 CALL PGM 15");
    assert!(
        fault["message"].as_str().unwrap().starts_with("15.H, block 2: "),
        "{fault}"
    );
    let there = &fault["relatedInformation"][0]["location"];
    assert!(
        there["uri"].as_str().unwrap().ends_with("15.H") && there["range"]["start"]["line"] == 2,
        "{there}"
    );
    plain_edits(client, &mut document);
    plain_words(client, &document, folder);
    plain_shape(client, &document);
    plain_changes(client, &document);
    client.close(&document);
}

/// Errors follow what is typed, after umlauts and pairs of units, too.
fn plain_edits<W: Wire>(client: &mut Client<W>, document: &mut Document) {
    client.edit(document, "16 CALL PGM 15\n", "");
    assert_eq!(client.diagnostics(document), [] as [Value; 0]);
    client.edit(document, "L X+10 Y+Q5", "L X+1..0 Y+Q5");
    let found = client.diagnostics(document);
    let [(range, _)] = messages(&found)[..] else {
        panic!("{found:?}")
    };
    assert_eq!(document.marked(range), "+1..0");
    client.edit(document, "X+1..0", "X+10");
    client.edit(document, "; Höhe 𝄞 der", "/ FOO ; 𝄞ä");
    let found = client.diagnostics(document);
    assert!(
        messages(&found)
            .iter()
            .any(|(range, _)| document.marked(range) == "FOO"),
        "{found:?}"
    );
    client.edit(document, "/ FOO ; 𝄞ä", "; Höhe 𝄞 der");
    assert_eq!(client.diagnostics(document), [] as [Value; 0]);
    client.edit(document, "17 FN9", "16 CALL PGM 15\n17 FN9");
}

/// Hover, definition, references, highlights, completion.
fn plain_words<W: Wire>(client: &mut Client<W>, document: &Document, folder: &Path) {
    let hover = client.hover(document, "F200", 0);
    assert!(
        hover.contains("Feed") && hover.contains("mm/min") && hover.contains("*Source:*"),
        "{hover}"
    );
    let hover = client.hover(document, "M3", 1);
    assert!(
        hover.contains("Spindle on, clockwise") && hover.contains("at the start"),
        "{hover}"
    );
    let hover = client.hover(document, "SET UP", 0);
    assert!(
        hover.contains("CYCL DEF 1 PECKING") && hover.contains("SETUP CLEARANCE?"),
        "{hover}"
    );
    // 3 more for each way through the section: by itself, by the call, by the jump when it is 8, by the call again.
    let hover = client.hover(document, "Q5 = +2", 0);
    let ends = 2 + 4 * 3;
    assert!(hover.contains(&format!("end of a run:* {ends}")), "{hover}");
    let hover = client.hover(document, "CALL LBL", 0);
    assert!(
        hover.contains("Call of a label") && hover.contains("1 to 254"),
        "{hover}"
    );
    assert_eq!(client.hover(document, "; Höhe", 3), "");

    let definition = client.places(document, "textDocument/definition", "CALL LBL 7", 9);
    assert_eq!(lines(&definition), ["5 LBL 7 ; Bohrung"]);
    let references = client.places(document, "textDocument/references", "LBL 7", 4);
    assert_eq!(
        lines(&references),
        [
            "5 LBL 7 ; Bohrung",
            "9 CALL LBL 7",
            "17 FN9: IF +Q5 EQU +8 GOTO LBL 7"
        ]
    );
    let references = client.places(document, "textDocument/references", "Q5 = +2", 1);
    assert_eq!(references.len(), 5, "{references:?}");
    let highlights = client.at(document, "textDocument/documentHighlight", "Q5 = +2", 1);
    let written = highlights
        .as_array()
        .unwrap()
        .iter()
        .filter(|one| one["kind"] == 3)
        .count();
    assert_eq!(written, 2, "{highlights}");
    let there = client.at(document, "textDocument/definition", "CALL PGM 15", 10);
    assert_eq!(there["uri"], format!("file://{}", folder.join("15.H").display()));

    let labels = client.completions(document, "CALL LBL 7", 9);
    assert_eq!(labels, [("7".to_owned(), "7".to_owned())]);
    let cycles = client.completions(document, "CYCL DEF 1.0", 5);
    let pecking = cycles
        .iter()
        .find(|(label, _)| label == "CYCL DEF 1 PECKING")
        .unwrap();
    assert!(
        pecking.1.contains("${1:SETUP CLEARANCE?}") && pecking.1.lines().count() == 6,
        "{pecking:?}"
    );
    let words = client.completions(document, "R0 F200", 0);
    assert!(words.iter().any(|(label, _)| label == "RL") && words.iter().any(|(label, _)| label == "M8"));
    let parameters = client.completions(document, "Y+Q5", 3);
    assert_eq!(parameters, [("Q5".to_owned(), "Q5".to_owned())]);
    let programs = client.completions(document, "CALL PGM 15", 9);
    assert!(programs.iter().any(|(label, _)| label == "9"), "{programs:?}");
}

/// Outline, folding, colours.
fn plain_shape<W: Wire>(client: &mut Client<W>, document: &Document) {
    let outline = client.request("textDocument/documentSymbol", document.id());
    let names = names(&outline);
    assert_eq!(
        names,
        [
            "PGM 7",
            "TOOL CALL 1 Z S1000",
            "LBL 7",
            "CYCL DEF 1 PECKING",
            "CALL PGM 15"
        ]
    );
    let folding = client.request("textDocument/foldingRange", document.id());
    let folds = folds(&folding);
    assert!(folds.contains(&(5, 8)) && folds.contains(&(10, 15)), "{folds:?}");
    let tokens = tokens(client, document);
    let has = |text: &str, kind: &str| tokens.iter().any(|(own, name)| own == text && name == kind);
    assert!(
        has("TOOL CALL", "keyword") && has("; Höhe 𝄞 der Tasche", "comment") && has("+Q5", "variable"),
        "{tokens:?}"
    );
}

/// Listing, other label numbers, conversion.
fn plain_changes<W: Wire>(client: &mut Client<W>, document: &Document) {
    let mut params = document.id();
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params.clone());
    assert_eq!(edits, json!([]), "it is a listing");
    let mut other = client.open_text(
        Path::new("/none/8.H"),
        "tnc-plain",
        "BEGIN PGM 8 MM\nl x5 r0 f 100 ; ä\nEND PGM 8 MM\n",
    );
    params["textDocument"]["uri"] = json!(other.uri);
    let edits = client.request("textDocument/formatting", params.clone());
    let listing = client.edited(&other, &edits);
    assert_eq!(listing, "0 BEGIN PGM 8 MM\n1 L X+5 R0 F100 ; ä\n2 END PGM 8 MM\n");
    client.edit(&mut other, "BEGIN PGM 8 MM\n", "");
    let reason = client.refused("textDocument/formatting", params);
    assert!(reason.contains("BEGIN PGM"), "{reason}");
    client.close(&other);

    let prepared = client.at(document, "textDocument/prepareRename", "GOTO LBL 7", 9);
    assert_eq!(prepared["placeholder"], "7");
    assert_eq!(
        client.at(document, "textDocument/prepareRename", "X+10", 2),
        Value::Null
    );
    let mut params = document.place("CALL LBL 7", 9);
    params["newName"] = json!("9");
    let edit = client.request("textDocument/rename", params.clone());
    let text = client.edited(document, &edit["changes"][&document.uri]);
    let expected = document.text.replace("LBL 7", "LBL 9");
    assert_eq!(text, expected);
    for (name, reason) in [("0", "1 to 254"), ("255", "1 to 254"), ("7", "block 5 already")] {
        params["newName"] = json!(name);
        let refused = client.refused("textDocument/rename", params.clone());
        assert!(refused.contains(reason), "{refused}");
    }
}

/// The text that a code action makes of a document, and the name of its file.
fn converted<W: Wire>(client: &mut Client<W>, document: &Document, title: &str) -> (String, String) {
    let mut params = document.id();
    params["range"] = document.range(0, 0);
    params["context"] = json!({"diagnostics": []});
    let actions = client.request("textDocument/codeAction", params);
    let found = actions
        .as_array()
        .unwrap()
        .iter()
        .find(|action| action["title"] == title);
    let action = client.request("codeAction/resolve", found.unwrap().clone());
    let changes = &action["edit"]["documentChanges"];
    assert_eq!(changes[0]["kind"], "create");
    assert_eq!(changes[0]["uri"], changes[1]["textDocument"]["uri"]);
    let uri = changes[0]["uri"].as_str().unwrap();
    let name = uri.rsplit('/').next().unwrap().to_owned();
    (
        changes[1]["edits"][0]["newText"].as_str().unwrap().to_owned(),
        name,
    )
}

/// Code actions: a program becomes one in the other language, and G-code.
pub fn conversions<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let text = "0 BEGIN PGM 5 MM\n1 TOOL DEF 1 L+0 R+5\n2 TOOL CALL 1 Z S1000\n3 L X+10 Y+5 R0 FMAX M3\n\
                4 L X+20 F200\n5 END PGM 5 MM\n";
    let document = client.open_text(&folder.join("5.H"), "tnc-plain", text);
    let (iso, name) = converted(client, &document, "Convert to DIN/ISO");
    assert_eq!(name, "5.I");
    assert!(
        iso.starts_with("%5 G71 *\nN10 G99 T1 L+0 R+5 *\nN20 T1 G17 S1000 *\n"),
        "{iso}"
    );
    let back = client.open_text(&folder.join("5.I"), "tnc-iso", &iso);
    assert_eq!(
        converted(client, &back, "Convert to plain language"),
        (text.to_owned(), "5.H".to_owned())
    );
    let (gcode, name) = converted(client, &document, "Convert to G-code for LinuxCNC");
    assert!(name == "5.ngc" && gcode.contains("X20"), "{gcode}");
    let data = json!({"title": "x", "data": {"uri": "file:///none/none.H", "target": "iso"}});
    let reason = client.refused("codeAction/resolve", data);
    assert!(reason.contains("not open"), "{reason}");
    client.close(&document);
    client.close(&back);
}

/// DIN/ISO: every request.
pub fn iso<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let mut document = client.open(&folder.join("9.I"), "tnc-iso");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    client.edit(&mut document, "L3,2", "L4,2");
    let found = client.diagnostics(&document);
    assert!(
        !found.is_empty() && document.line_of(&found[0]["range"]).starts_with("N60"),
        "{found:?}"
    );
    client.edit(&mut document, "L4,2", "L3,2");

    let hover = client.hover(&document, "G98", 0);
    assert!(hover.contains("Label"), "{hover}");
    let hover = client.hover(&document, "Q05", 1);
    assert!(hover.contains("end of a run:* 60"), "{hover}");
    let hover = client.hover(&document, "S1000", 0);
    assert!(hover.contains("rpm"), "{hover}");
    let definition = client.places(&document, "textDocument/definition", "L3,2", 1);
    assert_eq!(lines(&definition), ["N40 G98 L3 *"]);
    let references = client.places(&document, "textDocument/references", "Q05", 1);
    assert_eq!(references.len(), 2, "{references:?}");
    let highlights = client.at(&document, "textDocument/documentHighlight", "L3,2", 1);
    assert_eq!(highlights.as_array().unwrap().len(), 2);
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(names(&outline), ["PGM 9", "T1 G17 S1000", "LBL 3"]);
    let folding = client.request("textDocument/foldingRange", document.id());
    assert!(!folds(&folding).is_empty(), "{folding}");
    let codes = client.completions(&document, "G00 G40", 1);
    let pecking = codes.iter().find(|(label, _)| label == "G83").unwrap();
    assert!(
        pecking.1.starts_with("G83 P01 ${1:SETUP CLEARANCE?}"),
        "{pecking:?}"
    );
    let mut params = document.place("L3,2", 1);
    params["newName"] = json!("8");
    let edit = client.request("textDocument/rename", params);
    let text = client.edited(&document, &edit["changes"][&document.uri]);
    assert_eq!(text, document.text.replace("L3", "L8"));
    let mut params = document.id();
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params);
    let listing = client.edited(&document, &edits);
    assert!(
        listing.contains("N50 G00 G40") && listing.contains("D00 Q5 P01 +60"),
        "{listing}"
    );
    let tokens = tokens(client, &document);
    assert!(
        tokens
            .iter()
            .any(|(text, kind)| text == "G98" && kind == "keyword"),
        "{tokens:?}"
    );
    client.close(&document);
}

/// DIN 66025: every request.
pub fn din<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let mut document = client.open(&folder.join("a.nc"), "din-66025");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    client.edit(&mut document, "N20 Z5", "N20 Z5 FOO7");
    let found = client.diagnostics(&document);
    let [(range, message)] = messages(&found)[..] else {
        panic!("{found:?}")
    };
    assert!(
        document.marked(range).starts_with("FOO") && message.contains("FOO"),
        "{found:?}"
    );
    client.edit(&mut document, " FOO7", "");
    client.edit(&mut document, "(Höhe)", "(𝄞) BAR1");
    let found = client.diagnostics(&document);
    assert!(
        document.marked(&found[0]["range"]).starts_with("BAR"),
        "{found:?}"
    );
    client.edit(&mut document, "(𝄞) BAR1", "(Höhe)");

    let hover = client.hover(&document, "G91", 1);
    assert!(hover.contains("Incremental"), "{hover}");
    let hover = client.hover(&document, "F500", 0);
    assert!(hover.contains("mm/min"), "{hover}");
    let hover = client.hover(&document, "#EXPL", 2);
    assert!(hover.contains("synchronisation"), "{hover}");
    let hover = client.hover(&document, "V.G.RW", 3);
    assert!(
        hover.contains("*Set in lines:* 7") && hover.contains("*Used in lines:* 9"),
        "{hover}"
    );
    let definition = client.places(&document, "textDocument/definition", "L BORE\nN40", 3);
    assert_eq!(lines(&definition), ["%L BORE"]);
    let references = client.places(&document, "textDocument/references", "V.G.RW", 2);
    assert_eq!(references.len(), 2, "{references:?}");
    let highlights = client.at(&document, "textDocument/documentHighlight", "BORE", 1);
    assert_eq!(highlights.as_array().unwrap().len(), 2, "{highlights}");
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(names(&outline), ["%L BORE", "%MAIN"]);
    let folding = client.request("textDocument/foldingRange", document.id());
    assert_eq!(folds(&folding), [(0, 3), (4, 11)]);
    let calls = client.completions(&document, "L BORE\nN40", 2);
    assert!(
        calls.contains(&("BORE".to_owned(), "BORE".to_owned())),
        "{calls:?}"
    );
    let words = client.completions(&document, "G01 X[", 1);
    assert!(words.iter().any(|(label, _)| label == "#FLUSH WAIT"), "{words:?}");
    let mut params = document.place("BORE", 1);
    params["newName"] = json!("DRILL");
    let edit = client.request("textDocument/rename", params.clone());
    let text = client.edited(&document, &edit["changes"][&document.uri]);
    assert_eq!(text, document.text.replace("BORE", "DRILL"));
    let hover = client.hover(&document, "P1 =", 0);
    assert!(hover.contains("*At the end of a run:* 10\n"), "{hover}");
    let hover = client.hover(&document, "V.G.RW", 3);
    assert!(hover.contains("*At the end of a run:* 5\n"), "{hover}");
    client.edit(
        &mut document,
        "N40 P1 = V.G.RW * 2",
        "n40p1 = v.g.rw* 2+V.E.FORCE (Maß)",
    );
    let hover = client.hover(&document, "p1 =", 0);
    assert!(
        hover.contains("not known: it follows from what only the channel knows\n"),
        "{hover}"
    );
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params);
    let text = client.edited(&document, &edits);
    let listed = document.text.replace(
        "n40p1 = v.g.rw* 2+V.E.FORCE (Maß)",
        "N40 P1=V.G.RW*2+V.E.FORCE (Maß)",
    );
    assert_eq!(text, listed);
}

/// Programs of the PLC: every request.
pub fn plc<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let mut document = client.open(&folder.join("MAIN.PLC"), "tnc-plc");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    client.edit(&mut document, "  L I4 ; Knöpfe", "  FOO I4 ; Knöpfe");
    let found = client.diagnostics(&document);
    assert!(
        messages(&found)
            .iter()
            .any(|(range, text)| document.marked(range) == "FOO" && text.contains("not a valid")),
        "{found:?}"
    );
    client.edit(&mut document, "FOO", "L");

    let hover = client.hover(&document, "M2485", 0);
    assert!(
        hover.contains("M2485") && hover.contains("*Set by:*") && hover.contains("*Set in lines:* 5"),
        "{hover}"
    );
    let hover = client.hover(&document, "IFT", 1);
    assert!(hover.contains("LA = 1"), "{hover}");
    let hover = client.hover(&document, "9036", 1);
    assert!(hover.contains("write status information"), "{hover}");
    let definition = client.places(&document, "textDocument/definition", "JP 20", 3);
    assert_eq!(lines(&definition), ["LBL 20"]);
    let there = client.at(&document, "textDocument/definition", "CM OPEN", 4);
    assert!(there["uri"].as_str().unwrap().ends_with("DOOR.PLC"), "{there}");
    assert_eq!(there["range"]["start"], json!({"line": 1, "character": 4}));
    let there = client.at(&document, "textDocument/definition", "DOOR.PLC", 2);
    assert_eq!(there["range"]["start"]["line"], 0);
    let references = client.places(&document, "textDocument/references", "LBL 20", 5);
    assert_eq!(lines(&references), ["LBL 20", "  JP 20"]);
    let highlights = client.at(&document, "textDocument/documentHighlight", "W260", 1);
    assert_eq!(highlights.as_array().unwrap().len(), 1);
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(names(&outline), ["USES DOOR.PLC", "LBL 20"]);
    let folding = client.request("textDocument/foldingRange", document.id());
    assert_eq!(folds(&folding), [(5, 8), (9, 13)]);
    let labels = client.completions(&document, "JP 20", 3);
    assert!(labels.contains(&("20".to_owned(), "20".to_owned())), "{labels:?}");
    let operands = client.completions(&document, "S M2485", 3);
    assert!(
        operands
            .iter()
            .any(|(label, text)| label.starts_with("M2485 ") && text == "M2485")
    );
    let instructions = client.completions(&document, "IFT", 1);
    assert!(instructions.iter().any(|(label, _)| label == "WHILET"));
    plc_changes(client, &document);
    client.close(&document);

    // A linked file is looked at as a part of its program: nothing is wrong with it.
    let linked = client.open(&folder.join("DOOR.PLC"), "tnc-plc");
    assert_eq!(client.diagnostics(&linked), [] as [Value; 0]);
    client.close(&linked);
}

fn plc_changes<W: Wire>(client: &mut Client<W>, document: &Document) {
    let mut params = document.place("JP 20", 3);
    params["newName"] = json!("DOORS");
    let edit = client.request("textDocument/rename", params);
    let text = client.edited(document, &edit["changes"][&document.uri]);
    assert_eq!(
        text,
        document
            .text
            .replace("LBL 20", "LBL DOORS")
            .replace("JP 20", "JP DOORS")
    );
    let mut params = document.place("CM OPEN", 4);
    params["newName"] = json!("SHUT");
    let reason = client.refused("textDocument/rename", params);
    assert!(reason.contains("EXTERN"), "{reason}");
    let mut params = document.id();
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params);
    let listing = client.edited(document, &edits);
    assert!(listing.contains("\n    CM    OPEN\n"), "inside of IFT: {listing}");
    assert!(
        listing.contains("\n  L     I4                     ; Knöpfe\n"),
        "{listing}"
    );
    let tokens = tokens(client, document);
    assert!(
        tokens
            .iter()
            .any(|(text, kind)| text == "M2485" && kind == "variable"),
        "{tokens:?}"
    );
    assert!(
        tokens
            .iter()
            .any(|(text, kind)| text == "; Knöpfe" && kind == "comment"),
        "{tokens:?}"
    );
}

/// Lists of machine parameters: every request.
pub fn list<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let mut document = client.open(&folder.join("list.MP"), "tnc-parameters");
    let found = client.diagnostics(&document);
    let marked: Vec<&str> = messages(&found)
        .iter()
        .map(|(range, _)| document.marked(range))
        .collect();
    assert_eq!(marked[..2], ["MP7430", "abc"], "{found:?}");
    assert_eq!(
        document.line_of(&found[0]["relatedInformation"][0]["location"]["range"]),
        "MP7430:1.2"
    );
    client.edit(&mut document, "abc", "2.5");
    assert_eq!(client.diagnostics(&document).len(), found.len() - 1);

    let hover = client.hover(&document, "MP1010.0", 3);
    assert!(
        hover.contains("mm/min") && hover.contains("*Range:*") && hover.contains("*Source:*"),
        "{hover}"
    );
    let references = client.places(&document, "textDocument/references", "MP1010.0", 3);
    assert_eq!(lines(&references), ["MP1010.0 : 10000 ;Eilgang X"]);
    let definition = client.places(&document, "textDocument/definition", "MP1010.0", 3);
    assert_eq!(definition.len(), 1);
    let highlights = client.at(&document, "textDocument/documentHighlight", "MP1010.0", 3);
    assert_eq!(highlights.as_array().unwrap().len(), 1);
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(names(&outline)[0], "Positioning");
    client.request("textDocument/foldingRange", document.id());
    let numbers = client.completions(&document, "MP7430:1.2", 3);
    let overlap = numbers.iter().find(|(label, _)| label == "MP7430").unwrap();
    assert!(overlap.1.starts_with("MP7430   : ${1:"), "{overlap:?}");
    let reason = {
        let mut params = document.place("MP7430", 3);
        params["newName"] = json!("MP7431");
        client.refused("textDocument/rename", params)
    };
    assert!(reason.contains("only labels"), "{reason}");
    let mut params = document.id();
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params);
    let listing = client.edited(&document, &edits);
    assert!(
        listing.contains("MP1010.0 : 10000        ;Eilgang X\nMP7430   : 1.2\n"),
        "{listing}"
    );
    let tokens = tokens(client, &document);
    assert_eq!(
        tokens[1],
        ("MP1010.0".to_owned(), "property".to_owned()),
        "{tokens:?}"
    );
    client.close(&document);
}

/// What the server does not offer, and documents of other languages.
pub fn others<W: Wire>(client: &mut Client<W>, folder: &Path) {
    let reason = client.refused("textDocument/willSaveWaitUntil", json!({}));
    assert!(reason.contains("not offered"), "{reason}");
    let document = client.open_text(&folder.join("notes.txt"), "plaintext", "L X+1..5\n");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    assert_eq!(client.hover(&document, "X", 0), "");
    client.close(&document);
}
