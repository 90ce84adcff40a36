//! How fast files travel by LSV/2 over local TCP, and what a status poll costs.
#![allow(clippy::expect_used, reason = "without a server nothing would be measured")]

use std::path::PathBuf;
use std::sync::Arc;

use bahn_link::lsv2::{
    Client, Command, Device, Level, Passwords, Server, ServerOptions, Site, StillDevice, TcpTransport,
    Telegram,
};
use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};

fn main() {
    divan::main();
}

/// A file as large as a long program for a mould.
const BYTES: usize = 16 << 20;

struct Desk {
    folder: PathBuf,
    client: Client<TcpTransport>,
    _server: Server,
}

impl Desk {
    fn new() -> Desk {
        let folder = std::env::temp_dir().join(format!("bahn-lsv2-bench-{}", std::process::id()));
        let device = StillDevice::new(&folder).expect("a folder");
        let options = ServerOptions {
            listen: ([127, 0, 0, 1], 0).into(),
            passwords: Passwords::default(),
        };
        let site = Site::new(Arc::new(device) as Arc<dyn Device>, Passwords::default());
        let server = Server::start(site, &options).expect("a port");
        let transport = TcpTransport::connect(server.address()).expect("a server");
        let mut client = Client::open(transport, None).expect("a login");
        for level in [Level::File, Level::Dnc] {
            client.log_in(level, None).expect("a login");
        }
        Desk {
            folder,
            client,
            _server: server,
        }
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        // It lies in the folder for temporary files.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

#[divan::bench(sample_count = 10)]
fn upload(bencher: Bencher) {
    let mut desk = Desk::new();
    let content = vec![b'L'; BYTES];
    bencher.counter(BytesCount::new(BYTES)).bench_local(|| {
        desk.client
            .put(&mut content.as_slice(), "TNC:\\BIG.BIN")
            .expect("it is taken");
    });
}

#[divan::bench(sample_count = 10)]
fn download(bencher: Bencher) {
    let mut desk = Desk::new();
    let content = vec![b'L'; BYTES];
    desk.client
        .put(&mut content.as_slice(), "TNC:\\BIG.BIN")
        .expect("it is taken");
    bencher.counter(BytesCount::new(BYTES)).bench_local(|| {
        desk.client
            .get("TNC:\\BIG.BIN", &mut std::io::sink())
            .expect("it is given");
    });
}

/// Program state, block and positions, as often as a hundred polls a second ask in one.
#[divan::bench(sample_count = 50)]
fn hundred_polls(bencher: Bencher) {
    let mut desk = Desk::new();
    bencher.counter(ItemsCount::new(100_usize)).bench_local(|| {
        for which in [26, 24, 22, 23].into_iter().cycle().take(100) {
            desk.client
                .ask(&Telegram::new(Command(*b"R_RI")).word(which))
                .expect("it is told");
        }
    });
}
