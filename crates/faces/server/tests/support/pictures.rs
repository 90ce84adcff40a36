//! Pictures of the page for docs/panel, taken when `BAHN_WRITE_DOCS` is set.

use std::path::Path;

use bahn_browser::Page;

/// Takes one of what is in the window now, in light and dark colours.
pub fn take(page: &mut Page, name: &str) {
    if std::env::var_os("BAHN_WRITE_DOCS").is_none() {
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/panel");
    std::fs::create_dir_all(&folder).unwrap();
    let at = page.number("scrollY").unwrap();
    page.evaluate("scrollTo(0, 0)").unwrap();
    for (dark, ending) in [(true, "-dark"), (false, "")] {
        page.dark(dark).unwrap();
        let picture = page.screenshot().unwrap();
        std::fs::write(folder.join(format!("{name}{ending}.png")), picture).unwrap();
    }
    // Fingers meet what was drawn last: the page is back where it was, and drawn there, before the next of them comes.
    page.evaluate(&format!(
        "scrollTo(0, {at}); new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(() => drawn(true))))"
    ))
    .unwrap();
}
