//! Programs in DIN/ISO on the command line: what reports call their blocks.

mod support;

use support::Folder;

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
