//! The machine as a page reaches it: in real time, with roles.

use std::time::Duration;

use bahn_live::{Input, Live};
use bahn_panel900::Service900;
use bahn_service::{Operated as _, Role, ServiceError};

use crate::support::Panel;

#[test]
fn a_service_shows_and_operates_the_machine() {
    let live = Live::start(Panel::of_the_portal().0);
    let service = Service900::of(&live).unwrap();
    let surface = service.surface();
    assert_eq!(
        (surface.name.as_str(), surface.model.as_str()),
        ("Portal with two heads", "System 900")
    );
    assert_eq!(surface.axes, "XYZC");
    assert!(surface.machine_keys.contains(&"C+".to_owned()) && !surface.has_past);
    assert!(
        surface.keys.iter().any(|key| key.name == "CH2") && !surface.keys.iter().any(|key| key.name == "CH3")
    );
    let tapped = |name: &str| Input::Machine(name.to_owned(), bahn_host::KeyAction::Tap);
    let serial = service.screen().serial;
    service.input(tapped("CH2")).unwrap();
    let screen = service.next_screen(serial, Duration::from_secs(5));
    assert!(screen.serial > serial);
    let looks = service.for_role(Role::Look);
    assert_eq!(looks.input(tapped("START")), Err(ServiceError::OnlyLooks));
    assert!(looks.steps(1).is_err());
    let state: serde_json::Value = serde_json::from_str(&service.state_json().unwrap()).unwrap();
    assert_eq!(state["channels"][1]["axes"][3]["name"], "C");
    assert_eq!(service.drawer().unwrap().len(), 0);
    // Time stands, and ten cycles pass.
    service.input(Input::Pause(true.into())).unwrap();
    assert_eq!(service.steps(10).unwrap().cycles, 10);
    live.end().unwrap();
}
