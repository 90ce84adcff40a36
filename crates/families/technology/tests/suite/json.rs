//! The report as JSON, key by key.

use crate::common::Bench;
use serde_json::{Value, json};

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn all_keys_are_there() {
    let program = "%T\nN010 G01 X10 F6000\nN20 M025=7\nX20 H5\nN30 M96\nN40 X30\nM30\n";
    let list = "m_synch[25] MVS_SVS\nh_synch[5] MOS\nm_synch[96] MEP_SVS\nm_pre_outp[96] 50000\nm_h_pre_outp_calc_value_to_go 1\n";
    let report = Bench::new(program, list).script("M25 ack 0.5").run();
    let report = serde_json::to_value(&report).unwrap();
    let expected = [
        "completed",
        "cycle_s",
        "error",
        "events",
        "path_end",
        "programs",
        "time_s",
        "waits",
        "warnings",
    ];
    let mut found = keys(&report);
    found.sort_unstable();
    assert_eq!(found, expected);
    assert_eq!(
        (&report["completed"], &report["error"]),
        (&json!(true), &Value::Null)
    );
    assert_eq!(report["cycle_s"], json!(0.001));
    assert_eq!(report["path_end"], json!({"X": 30.0, "Y": 0.0}));

    let events = report["events"].as_array().unwrap();
    let kinds = ["output", "fetch", "acknowledge", "stop", "go", "active"];
    for event in events {
        assert!(kinds.contains(&event["kind"].as_str().unwrap()), "{event}");
        let mut found = keys(event);
        found.retain(|key| *key != "to_go");
        found.sort_unstable();
        let expected = [
            "block",
            "function",
            "kind",
            "offset_us",
            "position",
            "t",
            "target",
            "v",
            "value",
        ];
        assert_eq!(found, expected);
    }
    let find = |kind: &str, function: &str| {
        let mut found = events
            .iter()
            .filter(|event| event["kind"] == kind && event["function"] == function);
        found.next().unwrap_or_else(|| panic!("{kind} {function}"))
    };
    let output = find("output", "M25");
    assert_eq!(output["value"], json!(7));
    assert_eq!(output["target"], json!("channel"));
    assert_eq!(
        (&output["block"], &output["offset_us"]),
        (&json!("N20"), &Value::Null)
    );
    assert_eq!(output["position"], json!({"X": 10.0, "Y": 0.0}));
    // Without a number it is the line; without a value there is none.
    let by_line = find("output", "H5");
    assert_eq!(
        (&by_line["block"], &by_line["value"]),
        (&json!("#4"), &Value::Null)
    );
    let active = find("active", "M");
    assert_eq!(
        (&active["value"], &active["target"]),
        (&json!([25]), &json!("channel"))
    );
    let ahead = find("output", "M96");
    assert_eq!(ahead["to_go"]["path"], json!(50_000));
    assert!(ahead["to_go"]["time"].as_i64().unwrap() > 0);
    let go = events.iter().find(|event| event["kind"] == "go").unwrap();
    assert_eq!(
        (&go["block"], &go["t"], &go["function"]),
        (&json!("N10"), &json!(0.0), &Value::Null)
    );

    waits(&report);
}

fn waits(report: &Value) {
    let wait = &report["waits"][0];
    let mut found = keys(wait);
    found.sort_unstable();
    assert_eq!(found, ["block", "from_s", "function", "position", "to_s"]);
    assert_eq!(
        (&wait["function"], &wait["block"]),
        (&json!("M25"), &json!("N20"))
    );
}

#[test]
fn an_error_has_code_message_program_and_block() {
    let report = Bench::new("%T\nN10 M99\nM30\n", "").run();
    let report = serde_json::to_value(&report).unwrap();
    let error = &report["error"];
    let mut found = keys(error);
    found.sort_unstable();
    assert_eq!(found, ["block", "code", "line", "message", "program"]);
    assert_eq!(
        (&error["code"], &error["block"]),
        (&json!("P-ERR-20157"), &json!("N10"))
    );
    assert_eq!(error["program"], json!("p1.nc"));
    let stuck = Bench::new("%T\nN10 M7\nM30\n", "m_synch[7] MVS_SVS")
        .script("M7 ack never")
        .run();
    let stuck = serde_json::to_value(&stuck).unwrap();
    assert_eq!(
        (&stuck["completed"], &stuck["error"]),
        (&json!(false), &Value::Null)
    );
    assert_eq!(stuck["waits"][0]["to_s"], Value::Null);
}
