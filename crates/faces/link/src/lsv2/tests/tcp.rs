//! The server on TCP: clients, limits, and what half-open connections leave.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::*;

fn serve(desk: &Desk, passwords: Passwords) -> Server {
    let device = Arc::clone(&desk.device) as Arc<dyn Device>;
    let options = ServerOptions {
        listen: "127.0.0.1:0".parse().unwrap(),
        passwords: passwords.clone(),
    };
    Server::start(Site::new(device, passwords), &options).unwrap()
}

fn client(server: &Server) -> Client<TcpTransport> {
    Client::open(TcpTransport::connect(server.address()).unwrap(), None).unwrap()
}

fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < Duration::from_secs(10), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_client_does_with_files_what_it_wants() {
    let desk = Desk::new("client");
    let server = serve(&desk, Passwords::default());
    let mut client = client(&server);
    assert_eq!(client.versions()[..2], ["BAHN TNC 415", "123456 07"]);
    client.log_in(Level::File, None).unwrap();
    let bytes: Vec<u8> = (0..100_000_u32)
        .flat_map(|number| (number * 7919).to_le_bytes())
        .collect();
    let mut source = bytes.as_slice();
    assert_eq!(client.put(&mut source, "TNC:\\BIG.BIN").unwrap(), 400_000);
    let mut read = Vec::new();
    client.get("big.bin", &mut read).unwrap();
    assert!(read == bytes);
    let listed = client.list(Some("TNC:\\")).unwrap();
    let names: Vec<_> = listed
        .iter()
        .map(|entry| (entry.name.as_str(), entry.size, entry.is_folder))
        .collect();
    assert_eq!(names, [("BIG.BIN", 400_000, false)]);
    assert_eq!(client.screen().unwrap(), b"BM the screen");
    client.delete("BIG.BIN").unwrap();
    let again = client.delete("BIG.BIN").unwrap_err();
    assert_eq!(again.number(), Some(ErrorNumber::NO_FILE));
    assert!(again.to_string().contains("there is no such file"), "{again}");
    assert!(desk.on_medium().is_empty());
}

#[test]
fn a_file_that_is_being_sent_is_nowhere_until_it_is_complete() {
    let desk = Desk::new("cut");
    std::fs::write(desk.file("1.H"), "before").unwrap();
    let server = serve(&desk, Passwords::default());
    let mut stream = TcpStream::connect(server.address()).unwrap();
    for telegram in [
        Telegram::new(Command(*b"A_LG")).string("FILE"),
        Telegram::new(Command(*b"C_FL")).string("1.H").byte(1),
        Telegram::with(Command(*b"S_FL"), vec![b'x'; 4000]),
    ] {
        stream.write_all(&encode(&telegram)).unwrap();
        let mut answer = [0; 8];
        stream.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"\0\0\0\0T_OK");
    }
    assert_eq!(desk.on_medium().len(), 2);
    // In the middle of a telegram the cable is pulled.
    stream.write_all(b"\0\0\x0f").unwrap();
    drop(stream);
    until("the connection ends", || server.connections() == 0);
    assert_eq!(desk.on_medium(), ["1.H"]);
    assert_eq!(std::fs::read(desk.file("1.H")).unwrap(), b"before");
}

#[test]
fn half_a_telegram_does_not_hold_a_connection() {
    let desk = Desk::new("half");
    let server = serve(&desk, Passwords::default());
    let mut stream = TcpStream::connect(server.address()).unwrap();
    stream
        .write_all(&encode(&Telegram::new(Command(*b"A_LG")).string("INSPECT")))
        .unwrap();
    let begin = Instant::now();
    // One byte now and then is no telegram either.
    stream.write_all(b"\0\0\x0f\xff").unwrap();
    until("the connection ends", || {
        std::thread::sleep(Duration::from_millis(200));
        let _ = stream.write_all(b"A");
        server.connections() == 0 || begin.elapsed() > Duration::from_secs(9)
    });
    assert!(begin.elapsed() >= Duration::from_secs(1) && begin.elapsed() < Duration::from_secs(8));
}

#[test]
fn there_are_limits() {
    let desk = Desk::new("limits");
    let server = serve(&desk, Passwords::default());
    let streams: Vec<_> = (0..16)
        .map(|_| TcpStream::connect(server.address()).unwrap())
        .collect();
    until("all are there", || server.connections() == 16);
    let mut one_more = TcpStream::connect(server.address()).unwrap();
    let mut answer = Vec::new();
    one_more.read_to_end(&mut answer).unwrap();
    assert_eq!(answer, b"\0\0\0\x02T_ER\x01\x50");
    drop(streams);
    until("there is room again", || server.connections() == 0);
    // A telegram that is longer than any is refused, and the connection ends.
    let mut stream = TcpStream::connect(server.address()).unwrap();
    stream.write_all(b"\x7f\xff\xff\xffA_LG").unwrap();
    answer.clear();
    stream.read_to_end(&mut answer).unwrap();
    assert_eq!(answer, b"\0\0\0\x02T_ER\x01\x14");
}

#[test]
fn others_need_passwords() {
    let mut passwords = Passwords::default();
    let options = |listen: &str, passwords: &Passwords| ServerOptions {
        listen: listen.parse().unwrap(),
        passwords: passwords.clone(),
    };
    for alone in ["127.0.0.1:1", "[::1]:1", "[::ffff:127.0.0.1]:1"] {
        assert!(options(alone, &passwords).check().is_ok(), "{alone}");
    }
    let missing = options("0.0.0.0:1", &passwords).check().unwrap_err();
    assert!(
        missing.contains("INSPECT") && missing.contains("FILEPLC"),
        "{missing}"
    );
    for level in Level::all() {
        assert!(options("192.168.1.5:1", &passwords).check().is_err(), "{level}");
        passwords.set(&format!("{level}=steel")).unwrap();
    }
    assert!(options("0.0.0.0:1", &passwords).check().is_ok());
    for wrong in ["FILE", "FILE=", "KITCHEN=x", "FILE=a b", "FILE=12345678901234567"] {
        assert!(passwords.set(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn messages_of_the_plc_come_by_themselves() {
    let desk = Desk::new("pushed");
    let server = serve(&desk, Passwords::default());
    let mut transport = TcpTransport::connect(server.address()).unwrap();
    transport
        .send(&Telegram::new(Command(*b"A_LG")).string("DNC"))
        .unwrap();
    assert_eq!(transport.receive().unwrap().command, Command::T_OK);
    desk.device.say(PlcMessage::Text(b"TOOL 5".to_vec()));
    let message = transport.receive().unwrap();
    assert_eq!(
        (message.command, message.data),
        (Command::M_PC, b"TOOL 5\0".to_vec())
    );
}

#[test]
fn it_ends_when_it_is_dropped() {
    let desk = Desk::new("end");
    let server = serve(&desk, Passwords::default());
    let mut client = client(&server);
    let address = server.address();
    drop(server);
    assert!(client.log_in(Level::File, None).is_err());
    assert!(TcpStream::connect(address).is_err());
}
