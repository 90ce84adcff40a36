//! Sessions of a scripted editor: every request in every language, and how sessions begin, break off and end.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use serde_json::{Value, json};

use support::client::Client;
use support::{Folder, InProcess, script};

/// A client with the documents of the script.
fn session() -> (Client<InProcess>, Folder) {
    let folder = Folder::new();
    script::lay_out(folder.path());
    (Client::start(InProcess::start(), Value::Null), folder)
}

#[test]
fn plain_language() {
    let (mut client, folder) = session();
    script::plain(&mut client, folder.path());
    client.end().ended().unwrap();
}

#[test]
fn din_iso() {
    let (mut client, folder) = session();
    script::iso(&mut client, folder.path());
    client.end().ended().unwrap();
}

#[test]
fn programs_are_converted() {
    let (mut client, folder) = session();
    script::conversions(&mut client, folder.path());
    client.end().ended().unwrap();
}

#[test]
fn din_66025() {
    let (mut client, folder) = session();
    script::din(&mut client, folder.path());
    client.end().ended().unwrap();
}

/// Faults and warnings of a program and of the cycle that it calls, what words mean, where blocks and parameters are.
#[test]
fn of_a_system_900() {
    let (mut client, folder) = session();
    std::fs::write(folder.path().join("Z71.900"), "N10 X1 FOO7\n").unwrap();
    let text = "{ Prüfung }\nn100  p7950 : 1 { 𝄞 }\nN110 M1\nN120 P7960<10.110\nN130 P7960=10.200\n; Tasche\nN140 G71\n\
                N150 M24.110.5\nN200 G41 X:P7961 BAR1\n";
    let mut document = client.open_text(&folder.path().join("P1.900"), "system-900", text);
    let found = client.diagnostics(&document);
    let marked: Vec<&str> = found
        .iter()
        .map(|fault| document.marked(&fault["range"]))
        .collect();
    assert_eq!(marked, ["BAR1", "G71"], "{found:?}");
    assert!(
        found[1]["message"]
            .as_str()
            .unwrap()
            .contains("Z71.900, block N10: unknown word FOO7")
    );
    client.edit(&mut document, " BAR1", " H1");
    let found = client.diagnostics(&document);
    assert_eq!(found[0]["severity"], 2, "{found:?}");
    std::fs::write(folder.path().join("Z71.900"), "N10 X1\n").unwrap();
    client.edit(&mut document, " H1", "");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);

    for (place, said) in [
        ("G41", "Radius correction, tool to the left"),
        ("M24", "jumps back"),
        ("X:P7961", "q110"),
        ("G71", "Milling cycles"),
        ("M1\n", "look-ahead"),
    ] {
        let hover = client.hover(&document, place, 1);
        assert!(hover.contains(said), "{place}: {hover}");
    }
    let hover = client.hover(&document, "P7960<", 2);
    assert!(
        hover.contains("P7960: Parameter") && hover.contains("*Read in lines:* 4, 5"),
        "{hover}"
    );
    let hover = client.hover(&document, "N110 M1", 2);
    assert!(
        hover.contains("*Stands in line:* 3") && hover.contains("*Jumps in lines:* 4, 8"),
        "{hover}"
    );
    let definition = client.places(&document, "textDocument/definition", "200\n;", 1);
    assert_eq!(definition, ["N200 G41 X:P7961"]);
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(
        (&outline[0]["name"], &outline[1]["name"]),
        (&json!("Prüfung"), &json!("Tasche"))
    );
    let words = client.completions(&document, "G71", 1);
    assert!(words.iter().any(|(label, _)| label == "G147"), "{words:?}");
    let mut params = document.id();
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let edits = client.request("textDocument/formatting", params);
    let listed = document.text.replace("n100  p7950 : 1", "N100 P7950:1");
    assert_eq!(client.edited(&document, &edits), listed);
    client.end().ended().unwrap();
}

#[test]
fn plc_programs() {
    let (mut client, folder) = session();
    script::plc(&mut client, folder.path());
    client.end().ended().unwrap();
}

#[test]
fn parameter_lists() {
    let (mut client, folder) = session();
    script::list(&mut client, folder.path());
    client.end().ended().unwrap();
}

/// Channel lists: what `bahn technology` says of them, and what a parameter and a synchronisation type mean.
#[test]
fn channel_lists() {
    let (mut client, folder) = session();
    let text = "# glue\nm_synch[25]  MVS_SVS\nm_synch[1000]  MVS_SVS\n";
    let mut document = client.open_text(&folder.path().join("glue.lis"), "tf-channel", text);
    let found = client.diagnostics(&document);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(document.marked(&found[0]["range"]), "1000");
    let hover = client.hover(&document, "m_synch[25]", 3);
    assert!(
        hover.contains("P-CHAN-00041") && hover.contains("*Source:*"),
        "{hover}"
    );
    let hover = client.hover(&document, "MVS_SVS", 2);
    assert!(
        hover.contains("0x00000002") && hover.contains("*Output:*"),
        "{hover}"
    );
    let outline = client.request("textDocument/documentSymbol", document.id());
    assert_eq!(outline[0]["name"], "m_synch[25]");
    let names = client.completions(&document, "m_synch[1000]", 3);
    assert!(
        names.iter().any(|(label, _)| label == "m_prozess_zeit[i]"),
        "{names:?}"
    );
    client.edit(&mut document, "[1000]", "[100]");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    client.end().ended().unwrap();
}

/// A program in plain language that is named `.nc` is read as one, and so is what is typed into it.
#[test]
fn a_program_in_plain_language_may_be_named_nc() {
    let (mut client, folder) = session();
    let text = "0 BEGIN PGM 1 MM\n1 CC X+0 Y+0\n2 L X+1..5 R0 FMAX\n3 END PGM 1 MM\n";
    let mut document = client.open_text(&folder.path().join("shop.nc"), "din-66025", text);
    let found = client.diagnostics(&document);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(document.marked(&found[0]["range"]), "+1..5");
    client.edit(&mut document, "X+1..5", "X+1.5");
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    let hover = client.hover(&document, "CC", 1);
    assert!(hover.contains("CC"), "{hover}");
    client.end().ended().unwrap();
}

/// A subroutine that is a file is gone to where a run finds it: below the folder of the program, nowhere else.
#[test]
fn files_of_subroutines_lie_below_the_program() {
    let (mut client, folder) = session();
    let parts = folder.path().join("parts");
    std::fs::create_dir_all(&parts).unwrap();
    for file in [folder.path().join("outside.sub"), parts.join("inside.sub")] {
        std::fs::write(file, "N10 G90\nN20 M17\n").unwrap();
    }
    let text = "N10 L inside.sub\nN20 L ../outside.sub\nN30 M30\n";
    let document = client.open_text(&parts.join("main.nc"), "din-66025", text);
    let inside = client.at(&document, "textDocument/definition", "inside.sub", 3);
    assert!(
        inside["uri"]
            .as_str()
            .is_some_and(|uri| uri.ends_with("parts/inside.sub")),
        "{inside}"
    );
    let outside = client.at(&document, "textDocument/definition", "outside.sub", 3);
    assert!(outside["uri"].is_null(), "{outside}");
    client.end().ended().unwrap();
}

/// P02 of G83 is the depth of cycle 1, in the order in which the dialogue asks; P01 of D68 is Q1 of the cycle
/// [000:17966-17984].
#[test]
fn p_words_of_cycles_are_explained() {
    let (mut client, folder) = session();
    let text = "%1 G71 *\nN10 T1 G17 S500 *\nN20 G83 P01 -2 P02 -20 P03 -10 P04 0.5 P05 80 *\nN30 D68 P1+8 *\nN99 %1 G71 *\n";
    let document = client.open_text(&folder.path().join("p.I"), "tnc-iso", text);
    for (word, meaning) in [
        ("P02 -20", "1.2 "),
        ("P04 0.5", "in s"),
        ("P05 80", "in mm/min"),
        ("P1+8", "Q1 of cycle 68"),
    ] {
        let hover = client.hover(&document, word, 1);
        assert!(hover.contains(meaning), "{word}: {hover}");
    }
    client.end().ended().unwrap();
}

#[test]
fn other_documents_and_requests() {
    let (mut client, folder) = session();
    script::others(&mut client, folder.path());
    client.end().ended().unwrap();
}

/// What is open counts, not what lies on the disk.
#[test]
fn a_called_program_is_the_one_in_the_editor() {
    let (mut client, folder) = session();
    let mut called = client.open(&folder.path().join("15.H"), "tnc-plain");
    client.edit(&mut called, "X+1..5", "X+1.5");
    assert_eq!(client.diagnostics(&called), [] as [Value; 0]);
    let caller = client.open(&folder.path().join("7.H"), "tnc-plain");
    assert_eq!(client.diagnostics(&caller), [] as [Value; 0]);
    client.end().ended().unwrap();
}

/// A hover that waits for a run is answered when the run has ended, or refused when the editor takes it back.
#[test]
fn a_hover_waits_for_the_run() {
    let (mut client, folder) = session();
    let endless = "0 BEGIN PGM 3 MM\n1 FN 0: Q1 = +0\n2 LBL 1\n3 FN 1: Q1 = +Q1 + +1\n4 FN 9: IF +1 EQU +1 GOTO LBL 1\n\
                   5 END PGM 3 MM\n";
    let mut document = client.open_text(&folder.path().join("3.H"), "tnc-plain", endless);
    let place = document.place("Q1 = +0", 0);
    let taken_back = client.ask("textDocument/hover", place.clone());
    let waiting = client.ask("textDocument/hover", place);
    client.notify("$/cancelRequest", json!({"id": taken_back}));
    let error = client.answer(taken_back).unwrap_err();
    assert_eq!(error["code"], -32800);
    // A newer version breaks the run off.
    client.edit(&mut document, "EQU +1", "EQU +2");
    let hover = client.answer(waiting).unwrap();
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.contains("end of a run:* 1\n"), "{text}");
    client.end().ended().unwrap();
}

#[test]
fn settings_come_from_the_editor() {
    let (mut client, folder) = session();
    // A TNC 360 has Q123 at most.
    let text = "0 BEGIN PGM 3 MM\n1 FN 0: Q200 = +0\n2 END PGM 3 MM\n";
    let document = client.open_text(&folder.path().join("3.H"), "tnc-plain", text);
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    client.published.clear();
    client.notify(
        "workspace/didChangeConfiguration",
        json!({"settings": {"bahn": {"model": "tnc360"}}}),
    );
    let found = client.diagnostics(&document);
    assert!(
        found[0]["message"].as_str().unwrap().contains("0 to 123"),
        "{found:?}"
    );
    client.end().ended().unwrap();
}

#[test]
fn an_editor_that_goes_without_a_word_ends_the_server() {
    let (client, _folder) = session();
    let wire = client.into_wire();
    assert!(wire.ended().is_err());
}
