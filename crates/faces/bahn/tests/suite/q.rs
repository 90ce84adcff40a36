//! `bahn q`: parameters of a System 900.

use std::path::Path;

use crate::support::{Folder, Run};
use serde_json::{Value, json};

/// The sample of the documents, and what is made of it.
fn desk() -> Folder {
    let folder = Folder::new();
    let sample =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/system900/tests/data/two-channels.q");
    folder.write("data.q", std::fs::read_to_string(sample).unwrap());
    folder.write("faulty.q", "q2: 9\nP0: 1\nq5: x\n");
    folder
}

fn q(folder: &Folder, arguments: &str) -> Run {
    folder.bahn(&format!("q {arguments}"))
}

fn report(folder: &Folder, arguments: &str) -> (i32, Value) {
    let run = q(folder, &format!("{arguments} --format json"));
    (run.code(), run.json())
}

#[test]
fn explain() {
    let folder = desk();
    let (code, rows) = report(&folder, "explain P12360 q152 q0");
    assert_eq!(code, 0);
    let expected = json!({
        "name": "P12360", "base": "P12160", "title": "Actual lag", "kind": "status", "unit": "mm, degree",
        "values": "", "default": "", "default_number": null, "source": "[002:8370] [002:8387]",
        "needs": "nothing", "effect": "acts", "reason": "", "plc": [],
    });
    assert_eq!(rows[0], expected);
    // $030201 = 3 * 65536 + 2 * 256 + 1.
    assert_eq!(
        (&rows[1]["default_number"], &rows[1]["needs"]),
        (&json!(197_121.0), &json!("restart"))
    );
    assert_eq!(rows[2]["effect"], "none");
    let text = q(&folder, "explain q2360");
    assert!(
        text.out().starts_with("q2360 (as P12160)  Actual lag\n"),
        "{}",
        text.out()
    );
    assert_eq!(
        (
            q(&folder, "explain P500").code(),
            q(&folder, "explain 500").code()
        ),
        (1, 2)
    );
}

#[test]
fn map() {
    let folder = desk();
    let (code, found) = report(&folder, "map data.q P7000 k2:p7000 P20000 P12153 P5000 x");
    assert_eq!(code, 1);
    let found: Vec<(&str, Option<u64>, bool)> = found
        .as_array()
        .unwrap()
        .iter()
        .map(|item| {
            (
                item["name"].as_str().unwrap(),
                item["q"].as_u64(),
                item["error"].is_string(),
            )
        })
        .collect();
    assert_eq!(
        found,
        [
            ("P7000", Some(15_000), false),
            ("2:P7000", Some(22_000), false),
            ("P20000", Some(18_000), false),
            ("P12153", None, true),
            ("P5000", None, true),
            ("x", None, true),
        ]
    );
    assert_eq!(report(&folder, "map data.q P7000").0, 0);
    assert_eq!(q(&folder, "map data.q P7000").out(), "P7000  q15000\n");
    assert_eq!(q(&folder, "map faulty.q P11000").code(), 1);
    assert_eq!(q(&folder, "map missing.q P11000").code(), 2);
}

/// The status of the example, $30020401, in the sample without the hexadecimal bit: $20020401 [002:253-259].
#[test]
fn get() {
    let folder = desk();
    let (code, held) = report(&folder, "get data.q P1000 P7001 P12153");
    assert_eq!(code, 0);
    let flags = json!({
        "loaded": true, "real_time": false, "sync": false, "inch": false, "fast": false, "interpolator": false,
        "plc": false, "panel": true, "procedure": false, "panel_always": false, "sample": false, "locks": [2],
        "decimals": 0, "hex": false, "stored": true,
    });
    let expected = json!({
        "name": "P1000", "q": 11_000, "value": 7.0, "written": "7", "status": "$20020401", "flags": flags,
    });
    assert_eq!(held[0], expected);
    assert_eq!(
        (&held[1]["value"], &held[1]["written"]),
        (&Value::Null, &json!("--"))
    );
    assert_eq!(
        (&held[2]["name"], &held[2]["q"]),
        (&json!("P12153"), &Value::Null)
    );
    assert_eq!(
        (
            q(&folder, "get data.q P5000").code(),
            q(&folder, "get data.q 7").code()
        ),
        (1, 2)
    );
}

#[test]
fn set() {
    let folder = desk();
    let run = q(
        &folder,
        "set data.q P12020=2.125 2:P7000=-- --status P1000=$30020401 -o new.q",
    );
    assert_eq!(run.code(), 0, "{}", run.err());
    let expected = folder
        .read("data.q")
        .replace("q2020: 1.5", "q2020: 2.125")
        .replace("K2:P7000: 0 $03000001", "K2:P7000: -- $03000000")
        .replace("K1:P1000: 7 $20020401", "K1:P1000: $7 $30020401");
    assert_eq!(folder.read("new.q"), expected);
    for (arguments, code) in [
        ("set data.q q5=far -o other.q", 1),
        ("set data.q q5=99999999999 -o other.q", 1),
        ("set data.q q2=9 q5=1 -o other.q", 1),
        ("set data.q P5000=1 -o other.q", 1),
        ("set data.q q5 -o other.q", 2),
        ("set data.q -o other.q", 2),
        ("set data.q q5=1", 2),
        ("set data.q q5=1 --status q5=$1 -o other.q", 2),
        ("set faulty.q q5=1 -o other.q", 1),
    ] {
        assert_eq!(q(&folder, arguments).code(), code, "{arguments}");
    }
    assert_eq!(folder.names(), ["data.q", "faulty.q", "new.q"]);
    assert_eq!(q(&folder, "set data.q q5=1 -o new.q").code(), 2, "it is there");
    assert_eq!(q(&folder, "set data.q q5=1 -o new.q --force").code(), 0);
    assert!(folder.read("new.q").ends_with("\nq5: 1\n"));
}

#[test]
fn check() {
    let folder = desk();
    let (code, report_of_sample) = report(&folder, "check data.q");
    assert_eq!((code, &report_of_sample["ok"]), (0, &json!(true)));
    assert_eq!(
        report_of_sample["channels"][1]["axes"][0],
        json!({"logical": 1, "name": "Y3", "physical": 4, "key": 66})
    );
    let (code, faulty) = report(&folder, "check faulty.q");
    let places = faulty["errors"].as_array().unwrap().iter();
    let places: Vec<(u64, u64)> = places
        .map(|fault| (fault["line"].as_u64().unwrap(), fault["column"].as_u64().unwrap()))
        .collect();
    // q2 beyond 8, P0 without block, no value.
    assert_eq!((code, places), (1, vec![(1, 5), (2, 1), (3, 5)]));
    let text = q(&folder, "check faulty.q");
    assert!(text.err().contains("faulty.q:3:5"), "{}", text.err());
    assert!(text.err().contains("3 errors"), "{}", text.err());
}

#[test]
fn diff() {
    let folder = desk();
    assert_eq!(
        q(&folder, "set data.q q2=1 P12020=3 P8251=1 -o new.q").code(),
        1,
        "channel 2 is used"
    );
    assert_eq!(
        q(&folder, "set data.q P12020=3 P8251=1 q179=4 -o new.q").code(),
        0
    );
    let (code, found) = report(&folder, "diff data.q new.q");
    assert_eq!(code, 0);
    assert_eq!(
        found,
        json!([
            {"name": "q179", "q": 179, "a": null, "b": 4.0, "needs": "restart"},
            {"name": "P8251", "q": 16_251, "a": null, "b": 1.0, "needs": "mode"},
            {"name": "P12020", "q": 2020, "a": 1.5, "b": 3.0, "needs": "nothing"},
        ])
    );
    assert_eq!(report(&folder, "diff data.q data.q"), (0, json!([])));
    assert_eq!(q(&folder, "diff data.q faulty.q").code(), 1);
}

/// 2 areas * 2 groups * 3 axes * 7 points from P20000 on; 4 records of 20 from P21000 on.
#[test]
fn zero_and_tools() {
    let folder = desk();
    let (code, zero) = report(&folder, "zero data.q");
    assert_eq!(code, 0);
    let counts = ["first", "count", "areas", "groups", "axes", "points"].map(|key| zero[key].as_u64());
    assert_eq!(counts, [20_000, 84, 2, 2, 3, 7].map(Some));
    assert_eq!(
        zero["cells"][21],
        json!({"area": 1, "point": "G53", "group": 1, "axis": 1, "p": 20_021, "q": 18_021, "value": 100.25})
    );
    let (_, tools) = report(&folder, "tools data.q");
    assert_eq!((&tools["count"], &tools["length"]), (&json!(4), &json!(20)));
    assert_eq!(
        tools["records"][0],
        json!({
            "record": 0, "p": 21_000, "q": 19_000, "group": 1.0, "number": null, "place": null, "sub": null,
            "correction": null, "life": null, "radius": 4.975, "length": 112.5, "radius_offset": null,
            "length_offset": null, "quadrant": null,
        })
    );
    let none = report(&folder, "tools data.q --channel 2").1;
    assert_eq!(
        none,
        json!({"first": null, "count": 0, "length": 0, "records": []})
    );
    assert_eq!(q(&folder, "zero data.q --channel 3").code(), 2);
}

#[test]
fn m() {
    let folder = desk();
    let (code, functions) = report(&folder, "m data.q M7 m05 M8");
    assert_eq!(code, 0);
    assert_eq!(
        functions[0],
        json!({
            "m": 7, "parameter": "P11051", "byte": 4, "bits": 16, "acts": "branch", "before": true, "after": false,
            "sync": false, "restart": false,
        })
    );
    assert_eq!(
        (&functions[1]["acts"], &functions[1]["after"]),
        (&json!("stop"), &json!(true))
    );
    assert_eq!(functions[2]["acts"], "none");
    let all = report(&folder, "m data.q --channel 2").1;
    assert_eq!(all.as_array().unwrap().len(), 1);
    assert_eq!(
        (&all[0]["parameter"], &all[0]["acts"]),
        (&json!("2:P8308"), &json!("cycle"))
    );
    assert_eq!(q(&folder, "m data.q M1000").code(), 2);
}

/// In the place of a file stands the folder of a machine.
#[test]
fn of_a_machine() {
    let folder = desk();
    std::fs::create_dir(folder.path("portal")).unwrap();
    folder.write("portal/data.q", folder.read("data.q"));
    let with = |description: &str| {
        folder.write("portal/machine.toml", description);
        q(&folder, "map portal P7000")
    };
    assert_eq!(
        with("control = \"system900\"\nparameters = \"data.q\"\n").out(),
        "P7000  q15000\n"
    );
    for wrong in [
        "model = \"tnc415b\"\nparameters = \"data.q\"\n",
        "control = \"system900\"\n",
        "control = \"system900\"\nparameters = \"../data.q\"\n",
        "control = \"system900\"\nparameters = \"none.q\"\n",
        "control\n",
    ] {
        assert_eq!(with(wrong).code(), 2, "{wrong}");
    }
}

/// The registry of this control is its table.
#[test]
fn conformance() {
    let folder = Folder::new();
    let listed = folder
        .bahn("conformance --model system900 --kind parameter --format json")
        .json();
    assert_eq!(listed["entries"].as_array().unwrap().len(), 1417);
    let totals = &listed["totals"][0];
    let sum: u64 = ["acts", "partly", "stored", "none"]
        .iter()
        .map(|effect| totals[effect].as_u64().unwrap())
        .sum();
    assert_eq!((sum, &totals["model"]), (1417, &json!("system900")));
    let of_others = folder
        .bahn("conformance --model system900 --kind m --format json")
        .json();
    assert_eq!(of_others, json!({"totals": [], "entries": []}));
    let none = folder
        .bahn("conformance --model system900 --effect none --format json")
        .json();
    assert_eq!(none["entries"][0]["name"], "q0");
}
