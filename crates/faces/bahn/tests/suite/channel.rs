//! `bahn channel`: lists of channel parameters on the command line.

use crate::support::{Folder, Run};
use serde_json::{Value, json};

/// Line and column of errors or warnings.
fn places(report: &Value, kind: &str) -> Vec<(u64, u64)> {
    let items = report[kind].as_array().cloned().unwrap_or_default();
    let at = |item: &Value, key: &str| item[key].as_u64().unwrap_or_default();
    items
        .iter()
        .map(|item| (at(item, "line"), at(item, "column")))
        .collect()
}

/// Checks a list as JSON.
fn check(text: &str) -> (i32, Value) {
    let folder = Folder::new();
    folder.write("a.lis", text);
    let run = folder.bahn("channel check a.lis --format json");
    (run.code(), run.json())
}

#[test]
fn a_right_list_is_ok_and_nothing_else_is_said() {
    let (code, report) =
        check("# nothing\nm_synch[25] 0x2 MVS_SVS\n:\nspindle[0].m3_sync PLC_INFO | MVS_SVS\n");
    assert_eq!(code, 0);
    assert_eq!(report, json!({ "ok": true, "errors": [], "warnings": [] }));
}

/// Each fault that keeps a list from being used, one in a line.
#[test]
fn every_fault_has_its_place() {
    let lines = [
        ("m_synchro[1] MOS", (1, 1)),
        ("m_synch[1000] MOS", (2, 9)),
        ("h_synch[-1] MOS", (3, 9)),
        ("m_pre_outp[1] 1O", (4, 15)),
        ("m_h_pre_outp_nbr_block 201", (5, 24)),
        ("m_synch[2] MVS", (6, 12)),
        ("m_synch[3] 0x80000000", (7, 12)),
        ("m_synch[4] 0x00000006", (8, 12)),
        ("m_synch[5] PLC_INFO | MOS | MVS_SVS", (9, 12)),
        ("h_synch[1] MVS_SLM", (10, 12)),
        ("h_synch[2] 0x8000", (11, 12)),
        ("h_synch[3] MOS_TS", (12, 12)),
        ("spindel[0].m3_synch MEP_MOS", (13, 21)),
        ("spindel[0].s_synch 0x02000000", (14, 20)),
        ("main_spindle_gear_change 1", (0, 0)),
        ("m_synch[40] MVS_SNS", (16, 13)),
        ("m_synch[41] MVS_SVS", (0, 0)),
        ("m_prozess_zeit[1] 4294967296", (18, 19)),
        ("spindle_m_fct_free 2", (19, 20)),
        ("m_default_outp_ax_name[1] ABCDEFGHIJKLMNOPQ", (20, 27)),
    ];
    let text: String = lines.iter().map(|(line, _)| format!("{line}\n")).collect();
    let (code, report) = check(&text);
    let expected: Vec<(u64, u64)> = lines.iter().map(|(_, at)| *at).filter(|at| at.0 > 0).collect();
    assert_eq!(code, 1);
    assert_eq!(report["ok"], false);
    assert_eq!(places(&report, "errors"), expected, "{report}");
    assert_eq!(report.as_object().map(|fields| fields.len()), Some(3));
}

#[test]
fn a_list_that_is_odd_can_be_used() {
    let (code, report) = check("m_synch[7] MOS\nm_pre_outp[7] 500\nm_prozess_zeit[7] 3\nspdl_anzahl 1\n");
    assert_eq!((code, &report["ok"]), (0, &json!(true)));
    assert_eq!(places(&report, "warnings"), [(2, 15), (3, 19), (4, 1)]);
}

/// Several lists are told apart by their names; what cannot be read keeps the others from nothing.
#[test]
fn several_lists_are_an_array() {
    let folder = Folder::new();
    folder.write("a.lis", "m_synch[1] MOS\n");
    folder.write("b.lis", "m_synch[1] MOSS\n");
    let run = folder.bahn("channel check a.lis b.lis --format json");
    let report = run.json();
    assert_eq!(run.code(), 1);
    assert_eq!(
        (&report[0]["file"], &report[0]["ok"]),
        (&json!("a.lis"), &json!(true))
    );
    assert_eq!(
        (&report[1]["file"], &report[1]["ok"]),
        (&json!("b.lis"), &json!(false))
    );
    let missing = folder.bahn("channel check a.lis none.lis --format json");
    assert_eq!(
        (missing.code(), missing.json()[0]["ok"].clone()),
        (2, json!(true))
    );
    assert_eq!(folder.bahn("channel check none.lis").code(), 2);
    assert_eq!(folder.bahn("channel check").code(), 2);
}

#[test]
fn people_see_the_line() {
    let folder = Folder::new();
    folder.write("a.lis", "m_synch[5] MVS_SVX  on\n");
    let run = folder.bahn("channel check a.lis");
    assert_eq!((run.code(), run.out()), (1, String::new()));
    let said = run.err();
    assert!(
        said.contains("--> a.lis:1:12") && said.contains("^^^^^^^"),
        "{said}"
    );
    assert!(
        said.ends_with("a.lis: 0 parameters, 1 error, 0 warnings\n"),
        "{said}"
    );
}

/// Everything that is asked for by name, number or value; none of it twice.
#[test]
fn explanations_are_found_by_any_name() {
    let folder = Folder::new();
    let found = |wanted: &str| -> Vec<String> {
        let run: Run = folder.bahn(&format!("channel explain {wanted} --format json"));
        assert_eq!(run.code(), 0, "{wanted}: {}", run.err());
        let name = |row: &Value| row["name"].as_str().unwrap_or_default().to_owned();
        run.json()
            .as_array()
            .map(|rows| rows.iter().map(name).collect())
            .unwrap_or_default()
    };
    for wanted in [
        "m_synch",
        "m_synch[25]",
        "P-CHAN-00041",
        "p-chan-41",
        "M_SYNCH[i]",
    ] {
        assert_eq!(found(wanted), ["m_synch[i]"], "{wanted}");
    }
    assert_eq!(found("spindle[3].m3_sync"), ["spindel[i].m3_synch"]);
    assert_eq!(found("m3_synch"), ["spindel[i].m3_synch"]);
    assert_eq!(
        found("P-STUP-00061"),
        ["configuration.path_preparation.m_pre_output_lookahead"]
    );
    assert_eq!(found("0x00020004"), ["MVS_SNS", "PLC_INFO"]);
    assert_eq!(found("mvs_slm"), ["MVS_SLM"]);
    assert_eq!(found("PLC_INFO"), ["PLC_INFO"]);
    assert_eq!(found("NOT_VALID"), ["m_synch[i]", "h_synch[i]"]);
    assert_eq!(
        found("").len(),
        bahn_technology::list::Definition::all().len() + 17
    );
    assert_eq!(folder.bahn("channel explain nothing").code(), 2);
    let text = folder.bahn("channel explain P-CHAN-00274").out();
    for part in [
        "m_h_pre_outp_nbr_block",
        "50 to 200",
        "blocks",
        "TF5200",
        "chapter 6.2",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// A new list is right, has no entry, and replaces nothing unless it is told to.
#[test]
fn a_new_list_replaces_nothing() {
    let folder = Folder::new();
    assert_eq!(folder.bahn("channel new -o new.lis").code(), 0);
    let text = folder.read("new.lis");
    assert_eq!(text, folder.bahn("channel new").out());
    assert_eq!(
        folder.bahn("channel check new.lis --format json").json()["ok"],
        true
    );
    folder.write("new.lis", "m_synch[1] MOS\n");
    let refused = folder.bahn("channel new -o new.lis");
    assert_eq!(
        (refused.code(), folder.read("new.lis").as_str()),
        (2, "m_synch[1] MOS\n")
    );
    assert!(refused.err().contains("--force"), "{}", refused.err());
    assert_eq!(folder.bahn("channel new -o new.lis --force").code(), 0);
    assert_eq!(folder.read("new.lis"), text);
}

/// Types and parameters as docs/channel-lists.md has them, from its second half on.
fn tables() -> String {
    use bahn_technology::list::{Definition, Owner, SynchRow};
    let mut text =
        "## Synchronisation types\n\n| | value | output | waited for | for |\n|---|---|---|---|---|\n"
            .to_owned();
    let owners = [(Owner::M, "M"), (Owner::H, "H"), (Owner::Spindle, "spindle")];
    for row in SynchRow::all() {
        let of = owners
            .iter()
            .filter(|(owner, _)| row.is_for(*owner))
            .map(|(_, name)| *name);
        let of = of.collect::<Vec<_>>().join(", ");
        let (name, bits) = (row.name, row.bits);
        text += &match row.is_bit {
            true => format!(
                "| `{name}` | 0x{bits:08X} | joined to a type: {} | | {of} |\n",
                row.meaning
            ),
            false => format!(
                "| `{name}` | 0x{bits:08X} | {} | {} | {of} |\n",
                row.output, row.wait
            ),
        };
    }
    text += "\n## Parameters\n\n| | | values | unit | default | |\n|---|---|---|---|---|---|\n";
    for row in Definition::all() {
        let effect = match row.without_effect {
            "" => String::new(),
            why => format!(" **No effect here**: {why}."),
        };
        let values = match row.kind {
            bahn_technology::list::Kind::Synch(_) => "a type".to_owned(),
            kind => kind.range(),
        };
        text += &format!(
            "| {} | `{}` | {} | {} | {} | {}{effect} |\n",
            row.id,
            row.name,
            values.replace('|', "\\|"),
            row.unit,
            row.default,
            row.meaning.replace('|', "\\|"),
        );
    }
    text
}

/// The tables of docs/channel-lists.md are those that lists are read by. They are written anew with BAHN_WRITE_DOCS=1.
#[test]
fn the_document_has_every_parameter() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/channel-lists.md");
    let document = std::fs::read_to_string(&path).unwrap_or_default();
    let prose = document
        .split("## Synchronisation types")
        .next()
        .unwrap_or_default();
    let expected = format!("{prose}{}", tables());
    if std::env::var_os("BAHN_WRITE_DOCS").is_some() {
        assert!(std::fs::write(&path, &expected).is_ok());
        return;
    }
    assert!(
        document == expected,
        "BAHN_WRITE_DOCS=1 writes the tables of docs/channel-lists.md anew"
    );
}
