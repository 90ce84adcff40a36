//! A picture of a page, a file or an address: `picture PAGE OUT.png WIDTHxHEIGHT [dark] [phone] [js:SCRIPT ...]`; of the pages of `bahn test --html` a fine one.
//!
//! Scripts are executed one after the other before the picture is taken.

use std::path::Path;
use std::time::Duration;

use bahn_browser::Browser;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [page, out, size, further @ ..] = arguments.as_slice() else {
        return Err("picture PAGE OUT.png WIDTHxHEIGHT [dark] [phone] [js:SCRIPT ...]".into());
    };
    let (width, height) = size.split_once('x').ok_or("the size is WIDTHxHEIGHT")?;
    let is = |word: &str| further.iter().any(|other| other == word);
    let browser = Browser::start()?;
    let mut tab = browser.page()?;
    tab.viewport(width.parse()?, height.parse()?, is("phone"))?;
    tab.dark(is("dark"))?;
    match page.starts_with("http") {
        true => tab.open(page)?,
        false => tab.open_file(Path::new(page))?,
    }
    let settled = "!document.querySelector('#data') || globalThis.bahn.view.settled";
    tab.wait_until(settled, Duration::from_secs(60))?;
    // However long that takes without a graphics card.
    tab.evaluate("globalThis.bahn && (bahn.view.floor = 2, bahn.view.changed())")?;
    tab.wait_until(settled, Duration::from_secs(300))?;
    for script in further.iter().filter_map(|word| word.strip_prefix("js:")) {
        println!("{}", tab.evaluate(script)?);
        std::thread::sleep(Duration::from_millis(300));
        tab.wait_until(settled, Duration::from_secs(300))?;
    }
    std::fs::write(out, tab.screenshot()?)?;
    for complaint in tab.complaints() {
        eprintln!("{complaint}");
    }
    Ok(())
}
