//! Who comes in, and that nobody keeps others out: half-open and slow connections, guesses, those who only look.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use bahn_server::Tokens;
use serde_json::json;
use support::{Panel, Viewer};

/// The head of a request is there within this time, and so long a connection stays open without one (docs/panel-api.md).
const HEAD: Duration = Duration::from_secs(5);
/// What a computer that does other work, too, may add.
const BUSY: Duration = Duration::from_secs(5);

fn connect(panel: &Panel) -> TcpStream {
    let stream = TcpStream::connect(panel.address).unwrap();
    stream.set_read_timeout(Some(HEAD + BUSY)).unwrap();
    stream
}

/// How long it takes until the server closes a connection, to which `drop` is written piece by piece meanwhile.
fn closed_after(mut stream: TcpStream, piece: &[u8]) -> (Duration, String) {
    let begun = Instant::now();
    stream.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    let mut said = Vec::new();
    let mut some = [0; 1024];
    while begun.elapsed() < HEAD + BUSY {
        match stream.read(&mut some) {
            Ok(0) => break,
            Ok(count) => said.extend_from_slice(&some[..count]),
            Err(error)
                if matches!(
                    error.kind(),
                    std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
                ) =>
            {
                let _ = stream.write_all(piece);
            }
            Err(_) => break,
        }
    }
    (begun.elapsed(), String::from_utf8_lossy(&said).into_owned())
}

#[test]
fn half_open_connections_lock_nobody_out() {
    let panel = Panel::start();
    let mut operator = panel.viewer("anna");
    operator.until("crew", |crew| crew["operates"] == true);
    let mut half_open: Vec<_> = (0..300).map(|_| connect(&panel)).collect();
    for stream in half_open.iter_mut().step_by(2) {
        // Who was sent away already cannot write.
        let _ = stream.write_all(b"POST /api/command HTTP/1.1\r\nHost: 127");
    }
    let begun = Instant::now();
    assert_eq!(panel.give(&json!({"key": "EMERGENCY_STOP"})), 200);
    operator.send(&json!({"n": 1, "key": "EMERGENCY_STOP"}));
    operator.answered(1);
    drop(panel.viewer("ben"));
    assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    // Of one address no more than 64 are kept; none of the others waits for its time to end.
    let closed = |stream: &mut TcpStream| {
        stream.set_read_timeout(Some(Duration::from_millis(10))).unwrap();
        match stream.read(&mut [0; 8]) {
            Ok(count) => count == 0,
            Err(error) => error.kind() == std::io::ErrorKind::ConnectionReset,
        }
    };
    let sent_away = half_open
        .iter_mut()
        .take(230)
        .filter_map(|stream| closed(stream).then_some(()));
    assert_eq!(sent_away.count(), 230);
}

#[test]
fn slow_and_idle_connections_end_in_time() {
    let panel = Panel::start();
    let within = |(took, said): (Duration, String)| {
        assert!(
            took >= HEAD - Duration::from_millis(200) && took < HEAD + BUSY,
            "{took:?}: {said}"
        );
        said
    };
    std::thread::scope(|scope| {
        let begin = |text: String| {
            let mut stream = connect(&panel);
            stream.write_all(text.as_bytes()).unwrap();
            stream
        };
        let host = format!("Host: {}\r\n", panel.address);
        let drop_by_drop = begin("GET /api/screen HTTP/1.1\r\nX-Slow: ".to_owned());
        let silent = begin(String::new());
        let idle = begin(format!("GET /api/station HTTP/1.1\r\n{host}\r\n"));
        let body = begin(format!(
            "POST /api/key HTTP/1.1\r\n{host}Content-Length: 1000\r\n\r\n{{"
        ));
        let head = scope.spawn(|| closed_after(drop_by_drop, b"a"));
        let silent = scope.spawn(|| closed_after(silent, b""));
        let idle = scope.spawn(|| closed_after(idle, b""));
        let body = scope.spawn(|| closed_after(body, b" "));
        within(head.join().unwrap());
        within(silent.join().unwrap());
        assert!(within(idle.join().unwrap()).starts_with("HTTP/1.1 200"));
        assert!(within(body.join().unwrap()).starts_with("HTTP/1.1 408"));
    });
    // A head without end.
    let mut stream = connect(&panel);
    let mut written = 0;
    while written < 1 << 20 && stream.write_all(&[b'a'; 1024]).is_ok() {
        written += 1024;
    }
    let (took, said) = closed_after(stream, b"");
    assert!(
        took < HEAD && (said.is_empty() || said.starts_with("HTTP/1.1 4")),
        "{took:?}: {said}"
    );
}

fn tokens() -> Tokens {
    Tokens {
        operate: Some("secret".to_owned()),
        look: Some("classroom".to_owned()),
    }
}

/// Status of a request with a token, from an address of this computer.
fn from(panel: &Panel, own: &str, token: &str) -> u16 {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .unwrap();
    let mut stream = runtime.block_on(async {
        let socket = tokio::net::TcpSocket::new_v4().unwrap();
        socket.bind(SocketAddr::new(own.parse().unwrap(), 0)).unwrap();
        socket.connect(panel.address).await.unwrap().into_std().unwrap()
    });
    stream.set_nonblocking(false).unwrap();
    stream.set_read_timeout(Some(BUSY)).unwrap();
    let host = panel.address;
    write!(
        stream,
        "GET /api/screen?token={token} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer.split(' ').nth(1).unwrap().parse().unwrap()
}

#[test]
fn who_guesses_tokens_is_slowed() {
    let panel = Panel::served("mill", tokens(), |_| {});
    assert_eq!(from(&panel, "127.0.0.1", "secret"), 200);
    let begun = Instant::now();
    let answers: Vec<_> = (0..40)
        .map(|guess| from(&panel, "127.0.0.2", &format!("guess{guess}")))
        .collect();
    // Ten at once, and one in 5 s.
    let looked_at = answers.iter().filter(|status| **status == 403).count();
    let most = 10 + begun.elapsed().as_secs() as usize / 5;
    assert!((10..=most).contains(&looked_at), "{looked_at} of at most {most}");
    assert_eq!(
        answers.iter().filter(|status| **status == 429).count(),
        40 - looked_at
    );
    // Nobody else is.
    assert_eq!(from(&panel, "127.0.0.1", "secret"), 200);
    assert_eq!(from(&panel, "127.0.0.1", "classroom"), 200);
}

#[test]
fn who_may_only_look_sees_everything_and_does_nothing() {
    let panel = Panel::served("mill", tokens(), |_| {});
    let bearer = |token: &str| format!("Bearer {token}");
    let request = |method: &str, path: &str, token: &str, body: &str| {
        panel.request(method, path, &[("Authorization", &bearer(token))], body)
    };
    for path in [
        "/",
        "/api/station",
        "/api/screen",
        "/api/snapshot",
        "/api/drawer",
        "/api/lessons",
        "/api/texts",
    ] {
        assert_eq!(request("GET", path, "classroom", "").0, 200, "{path}");
    }
    for (path, input) in [
        ("/api/key", json!({"key": "EMERGENCY_STOP"})),
        ("/api/command", json!({"pause": true})),
        ("/api/command", json!({"action": "fault drive X dead"})),
    ] {
        let (status, said) = request("POST", path, "classroom", &input.to_string());
        assert_eq!(status, 403, "{said}");
        let said: serde_json::Value = serde_json::from_str(&said).unwrap();
        assert_eq!(
            said,
            json!({"ok": false, "error": "this token is for looking, not for operating"})
        );
        let (status, said) = request("POST", path, "secret", &input.to_string());
        assert_eq!(status, 200, "{input}: {said}");
    }
    // The first to come does not operate when he may not.
    let viewer = |name: &str, token: &str| {
        Viewer::of(&format!(
            "ws://{}/ws?name={name}&key={name}-0123456789abcdef&token={token}",
            panel.address
        ))
    };
    let mut looks = viewer("ben", "classroom");
    let crew = looks.until("crew", |_| true);
    assert_eq!(
        (&crew["operates"], &crew["may_operate"]),
        (&json!(false), &json!(false))
    );
    let shut = "this token is for looking, not for operating";
    for input in [
        json!({"n": 1, "key": "CE"}),
        json!({"operate": true}),
        json!({"hand_over": true}),
    ] {
        looks.send(&input);
        looks.until("refused", |why| why == shut);
    }
    viewer("eve", "classroom").until("header", |header| header[0].is_string());
    let mut operates = viewer("anna", "secret");
    let crew = operates.until("crew", |crew| crew["operates"] == true);
    assert_eq!(&crew["may_operate"], &json!(true));
    operates.send(&json!({"n": 1, "key": "CE"}));
    operates.answered(1);
    // Places are kept for those who operate.
    let mut crowd: Vec<_> = (1..24)
        .map(|number| viewer(&format!("pupil{number}"), "classroom"))
        .collect();
    let one_more = format!("ws://{}/ws?name=more&token=classroom", panel.address);
    assert!(tungstenite::connect(one_more).is_err());
    crowd.push(viewer("carl", "secret"));
}

#[test]
fn a_name_is_no_key() {
    let panel = Panel::start();
    let mut anna = panel.viewer("anna");
    anna.until("crew", |crew| crew["operates"] == true);
    for url in ["name=anna", "name=anna&key=some-other-key-of-somebody"] {
        let mut other = Viewer::of(&format!("ws://{}/ws?{url}", panel.address));
        other.until("crew", |crew| crew["operates"] == false);
        other.send(&json!({"n": 1, "key": "CE"}));
        other.until("refused", |why| why == "somebody else operates");
    }
    for wrong in [
        "name=anna&key=short",
        "name=anna&key=with%20some%20spaces%20in%20it",
        "name=",
    ] {
        assert!(
            tungstenite::connect(format!("ws://{}/ws?{wrong}", panel.address)).is_err(),
            "{wrong}"
        );
    }
}

/// One picture is drawn at a time, 25 a second at most, and 32 wait.
#[test]
fn pictures_have_bounds() {
    let panel = Panel::start();
    for size in [
        "width=3841&height=10",
        "width=3840&height=2161",
        "width=4000000000&height=4000000000",
    ] {
        assert_eq!(
            panel
                .request("GET", &format!("/api/graphics.png?{size}"), &[], "")
                .0,
            400,
            "{size}"
        );
    }
    let begun = Instant::now();
    let answers: Vec<u16> = std::thread::scope(|scope| {
        let ask = || panel.request("GET", "/api/graphics.png", &[], "").0;
        let asked: Vec<_> = (0..60).map(|_| scope.spawn(ask)).collect();
        asked.into_iter().map(|asked| asked.join().unwrap()).collect()
    });
    let took = begun.elapsed();
    let drawn = answers.iter().filter(|status| **status == 204).count();
    let refused = answers.iter().filter(|status| **status == 429).count();
    assert_eq!(drawn + refused, 60, "{answers:?}");
    assert!(drawn >= 32, "{drawn}");
    assert!(
        took >= Duration::from_millis(40) * (drawn as u32 - 1),
        "{drawn} in {took:?}"
    );
}
