//! Programs in DIN/ISO on the command line: what reports call their blocks.

use crate::support::{Folder, copy, machines};

#[test]
fn reports_of_din_iso_have_the_number_of_the_block_and_the_line_of_the_file() {
    let folder = Folder::new();
    // N200 stands in line 5: `%5` and the comment have no number.
    folder.write(
        "5.I",
        "%5 G71 *\nN100 G00 G40 G90 X+5 *\n; call\nN150 M8 *\nN200 L9,0 *\nN999 %5 G71 *\n",
    );
    let run = folder.bahn("test 5.I --format json");
    let error = &run.json()["error"];
    assert_eq!(run.code(), 1);
    assert_eq!(
        (&error["message"], &error["block"], &error["line"]),
        (&"LABEL NUMBER NOT ALLOCATED".into(), &200.into(), &5.into())
    );
    let err = folder.bahn("test 5.I").err();
    assert!(
        err.contains("5.I:5:1") && err.contains("5 | N200 L9,0 *"),
        "{err}"
    );
    assert!(err.contains("block 200: there is no LBL 9"), "{err}");
}

/// So have those of a run on a machine: of the error, of the largest lag, and of what stands.
#[test]
fn reports_of_a_run_have_the_number_of_the_block() {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("m"));
    folder.write(
        "6.I",
        "%6 G71 *\nN100 G00 G40 G90 X+40 *\nN200 X+20 *\nN300 L9,0 *\nN999 %6 G71 *\n",
    );
    let run = folder.bahn("run 6.I --machine m --fresh --no-graphics --format json");
    let report = run.json();
    assert_eq!(run.code(), 1);
    let error = &report["error"];
    assert_eq!(
        (&error["message"], &error["block"], &error["line"]),
        (&"LABEL NUMBER NOT ALLOCATED".into(), &300.into(), &4.into()),
        "{report}"
    );
    let lag = report["axes"]["X"]["lag_block"].as_u64();
    assert!(lag == Some(200), "{report}");
    assert!(
        run.err().contains("block 300: there is no LBL 9"),
        "{}",
        run.err()
    );
}
