//! Whatever is typed into a document, every request is answered and the server lives on.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use std::cell::RefCell;
use std::path::Path;

use proptest::prelude::*;
use serde_json::{Value, json};

use support::InProcess;
use support::client::{Client, Document};

const ABOUT_PLACES: [&str; 6] = [
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/documentHighlight",
    "textDocument/completion",
    "textDocument/prepareRename",
    "textDocument/references",
];
const ABOUT_DOCUMENTS: [&str; 4] = [
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/codeAction",
];

/// All requests about a document, at a few places of it.
fn ask_everything(client: &mut Client<InProcess>, document: &Document, places: &[usize]) {
    let boundaries: Vec<usize> = document
        .text
        .char_indices()
        .map(|(at, _)| at)
        .chain([document.text.len()])
        .collect();
    for place in places {
        let at = boundaries[place % boundaries.len()];
        let mut params = document.id();
        params["position"] = document.position(at);
        params["context"] = json!({"includeDeclaration": true, "triggerKind": 1});
        for method in ABOUT_PLACES {
            client.request(method, params.clone());
        }
        params["newName"] = json!("12");
        let id = client.ask("textDocument/rename", params);
        // It may be refused.
        let _ = client.answer(id);
    }
    let mut params = document.id();
    params["context"] = json!({"diagnostics": []});
    params["range"] = document.range(0, document.text.len());
    for method in ABOUT_DOCUMENTS {
        client.request(method, params.clone());
    }
    params["options"] = json!({"tabSize": 2, "insertSpaces": true});
    let id = client.ask("textDocument/formatting", params);
    let _ = client.answer(id);
    client.diagnostics(document);
}

/// Text of any kind, and text that is nearly a document of ours.
fn text() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "BEGIN PGM 1 MM\n",
        "END PGM 1 MM\n",
        "L X+1 ",
        "LBL ",
        "CALL LBL ",
        "7",
        "\n",
        "\r",
        "\r\n",
        "\u{c}",
        "~\n",
        "CYCL DEF 1.1 SET UP -2\n",
        "Q5",
        " = ",
        "FN 1: ",
        "M3",
        "%9 G71 *\n",
        "N10 ",
        "G98 L1 ",
        "L1,5 ",
        "*\n",
        "; ö",
        "𝄞",
        "LBL A\n",
        "JP A\n",
        "IFT\n",
        "ENDI\n",
        "A[\n",
        "]\n",
        "S\"",
        "K",
        "USES X.PLC\n",
        "MP1010.0 : 5\n",
        "MP7430:",
        "\u{feff}",
        "/",
        "TOOL CALL 1 Z S5\n",
        "$N1 ",
        "V.G.X = ",
        "[",
        "G00 X1 M5\n",
        "P7960<10.110",
        "M24.1.5 {",
    ]);
    prop_oneof![
        prop::collection::vec(words, 0..40).prop_map(|words| words.concat()),
        any::<String>(),
        prop::collection::vec(any::<u8>(), 0..80)
            .prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned()),
    ]
}

const LANGUAGES: [&str; 6] = ["a.H", "a.I", "a.PLC", "a.MP", "a.nc", "a.900"];

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn any_document_is_answered(
        text in text(),
        language in 0..LANGUAGES.len(),
        edits in prop::collection::vec((any::<usize>(), any::<usize>(), text()), 0..3),
        places in prop::collection::vec(any::<usize>(), 3),
    ) {
        thread_local! {
            /// One server for all cases: it must outlive them.
            static CLIENT: RefCell<Client<InProcess>> = RefCell::new(Client::start(InProcess::start(), Value::Null));
        }
        CLIENT.with_borrow_mut(|client| {
            client.published.clear();
            let path = Path::new("/none").join(LANGUAGES[language]);
            let mut document = client.open_text(&path, "", &text);
            ask_everything(client, &document, &places);
            for (start, end, new) in edits {
                let places: Vec<usize> = document.text.char_indices().map(|(at, _)| at).chain([document.text.len()]).collect();
                let (start, end) = (places[start % places.len()], places[end % places.len()]);
                // Old text is found by its place here.
                let range = start.min(end)..start.max(end);
                client.replace(&mut document, range, &new);
                ask_everything(client, &document, &[3, 17]);
            }
            client.close(&document);
        });
    }
}
