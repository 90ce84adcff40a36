//! One viewer, over a web socket.
//!
//! The server sends MessagePack: an array of regions that have changed, `[name, value]` each; besides those of the
//! screen there is `crew`, who operates, and `taken`, the number of the last input that was taken. The viewer sends JSON: inputs with
//! a number that grows, `{"n":7,"key":"ENT"}`, which are done once however often they arrive, `{"operate":true}` or
//! `{"hand_over":true}`, and `{"part":true}` to look at the part that is being cut. What a viewer is too slow for is left
//! out: he gets what is newest when he has taken what was sent before.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Extension, Query, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use bahn_service::{Input, InputText, Refusal, Role, ServiceError};
use serde::{Deserialize, Serialize};

use crate::crew::{Crew, Id, Taking};
use crate::part::Look;
use crate::regions::{message, region};
use crate::shared::Shared;

/// Longest message of a viewer, bytes.
const MESSAGE: usize = 16 << 10;
/// Messages of a viewer in a second.
const RATE: u32 = 400;
/// A viewer that asks for the part again is sent all of it after this time (inferred).
const AGAIN: Duration = Duration::from_millis(500);
/// Length of a name, and of a key.
const NAME: usize = 64;
/// Length of a key at least.
const KEY: usize = 16;

#[derive(Deserialize)]
pub(crate) struct Who {
    #[serde(default)]
    name: String,
    /// Who knows it is whoever came with it before.
    key: Option<String>,
}

impl Who {
    /// What is wrong with it.
    fn fault(&self) -> Option<&'static str> {
        let fits = |text: &str, others: &str| {
            text.len() <= NAME
                && text
                    .chars()
                    .all(|character| character.is_ascii_alphanumeric() || others.contains(character))
        };
        let is_key = |key: &String| key.len() >= KEY && fits(key, "-_");
        if self.name.is_empty() || !fits(&self.name, "-_ ") {
            return Some("a viewer has a name of letters and digits");
        }
        let wrong = self.key.as_ref().is_some_and(|key| !is_key(key));
        wrong.then_some("a key has 16 to 64 letters and digits")
    }
}

/// What a viewer sends.
#[derive(Deserialize)]
struct Sent {
    /// Number of the input.
    #[serde(default)]
    n: u64,
    operate: Option<bool>,
    hand_over: Option<bool>,
    part: Option<bool>,
    #[serde(flatten)]
    input: serde_json::Map<String, serde_json::Value>,
}

/// Who operates, as one viewer sees it.
#[derive(Serialize)]
struct CrewView<'a> {
    may_operate: bool,
    operates: bool,
    operator: Option<&'a str>,
    asks: Option<&'a str>,
}

/// `GET /ws?name=...&key=...`: the connection over which a viewer sees and operates the machine.
pub(crate) async fn open(
    State(shared): State<Shared>,
    Extension(role): Extension<Role>,
    Query(who): Query<Who>,
    upgrade: WebSocketUpgrade,
) -> Response {
    if let Some(fault) = who.fault() {
        return (StatusCode::BAD_REQUEST, fault).into_response();
    }
    let looks = match role {
        Role::Look => shared.lookers.clone().try_acquire_owned().map(Some),
        Role::Operate => Ok(None),
    };
    let (Ok(viewer), Ok(looks)) = (shared.viewers.clone().try_acquire_owned(), looks) else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many viewers").into_response();
    };
    upgrade
        .max_message_size(MESSAGE)
        .max_frame_size(MESSAGE)
        .on_upgrade(move |socket| async move {
            let _places = (viewer, looks);
            attend(shared, role, who, socket).await;
        })
}

/// Attends to a viewer until he goes.
async fn attend(shared: Shared, role: Role, who: Who, socket: WebSocket) {
    static ALONE: AtomicU64 = AtomicU64::new(0);
    // Without a key he is somebody else each time; no key has such a sign.
    let comes_again = who.key.is_some();
    let id = who
        .key
        .unwrap_or_else(|| format!("#{}", ALONE.fetch_add(1, Ordering::Relaxed)));
    let taken = lock(&shared.crew).come(&id, &who.name, role);
    let mut viewer = Viewer {
        taken,
        id,
        role,
        shared,
        seen: 0,
        sent_crew: Vec::new(),
        looked: Instant::now(),
        look: Look::default(),
        rate: Rate::default(),
    };
    viewer.follow(socket).await;
    let mut crew = lock(&viewer.shared.crew);
    crew.go(&viewer.id);
    if !comes_again {
        crew.forget(&viewer.id);
    }
}

struct Viewer {
    id: Id,
    role: Role,
    shared: Shared,
    /// Serial of the last screen that was sent.
    seen: u64,
    /// Number of the last input that was taken.
    taken: u64,
    /// What was sent of the crew.
    sent_crew: Vec<u8>,
    /// When he last asked for the part.
    looked: Instant,
    /// He looks at the part that is being cut.
    look: Look,
    rate: Rate,
}

impl Viewer {
    async fn follow(&mut self, mut socket: WebSocket) {
        let mut regions = self.shared.regions.clone();
        regions.mark_changed();
        // Roles and lost connections are noticed without a screen, too.
        let mut pulse = tokio::time::interval(Duration::from_millis(500));
        if socket.send(self.taken_message()).await.is_err() {
            return;
        }
        loop {
            tokio::select! {
                changed = regions.changed() => {
                    let latest = regions.borrow_and_update().clone();
                    let message = latest.since(self.seen);
                    self.seen = latest.serial();
                    if changed.is_err() || socket.send(Message::Binary(message.into())).await.is_err() {
                        return;
                    }
                }
                received = socket.recv() => match received {
                    Some(Ok(Message::Text(text))) => {
                        if !self.rate.allows() {
                            return;
                        }
                        let answer = self.take(text.as_str()).await;
                        if socket.send(answer).await.is_err() {
                            return;
                        }
                    }
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                    _ => return,
                },
                news = self.look.news() => {
                    if let Some(news) = news
                        && socket.send(Message::Binary(message(&[&news]).into())).await.is_err()
                    {
                        return;
                    }
                }
                _ = pulse.tick() => {}
            }
            if let Some(role) = self.news_of_the_crew()
                && socket.send(role).await.is_err()
            {
                return;
            }
        }
    }

    /// Does what a viewer sends; the answer is the number of his last input, with what was wrong with it.
    async fn take(&mut self, text: &str) -> Message {
        let Ok(sent) = serde_json::from_str::<Sent>(text) else {
            return refused(&"this is no input");
        };
        if let Some(looks) = sent.part {
            // Each request sends all of it anew, which is expensive: one that follows soon after another is ignored.
            let again = looks && self.look.is_on() && self.looked.elapsed() < AGAIN;
            if !again {
                self.look = match looks {
                    true => Look::on(&self.shared.part),
                    false => Look::Away,
                };
                self.looked = Instant::now();
            }
            return self.taken_message();
        }
        if self.role < Role::Operate && (sent.operate.is_some() || sent.hand_over.is_some()) {
            return refused(&ServiceError::OnlyLooks);
        }
        match (sent.operate, sent.hand_over) {
            (Some(_), _) => lock(&self.shared.crew).ask(&self.id),
            (_, Some(yes)) => lock(&self.shared.crew).answer(&self.id, yes),
            (None, None) => return self.input(sent).await,
        }
        self.taken_message()
    }

    async fn input(&mut self, sent: Sent) -> Message {
        let order = lock(&self.shared.crew).order(&self.id);
        let _turn = order.lock().await;
        let taking = lock(&self.shared.crew).takes(&self.id, sent.n);
        self.taken = self.taken.max(sent.n);
        match taking {
            Taking::Twice => return self.taken_message(),
            Taking::NotOperator => return refused(&"somebody else operates"),
            Taking::Looks => return refused(&ServiceError::OnlyLooks),
            Taking::New => {}
        }
        let input = serde_json::from_value::<InputText>(sent.input.into())
            .map_err(|error| Refusal(error.to_string()))
            .and_then(Input::try_from);
        let machine = self.shared.machine.for_role(self.role);
        let done = match input {
            Ok(input) => tokio::task::spawn_blocking(move || machine.input(input)).await,
            Err(refusal) => Ok(Err(refusal.into())),
        };
        match done {
            Ok(Ok(())) => self.taken_message(),
            Ok(Err(error)) => refused(&error),
            Err(_) => refused(&"the station has ended"),
        }
    }

    fn taken_message(&self) -> Message {
        region_message("taken", &self.taken)
    }

    fn news_of_the_crew(&mut self) -> Option<Message> {
        let crew = lock(&self.shared.crew);
        let (operator, asks) = crew.names();
        let view = CrewView {
            may_operate: self.role >= Role::Operate,
            operates: crew.is_operator(&self.id),
            operator,
            asks,
        };
        let encoded = alone("crew", &view);
        (encoded != self.sent_crew).then(|| {
            self.sent_crew.clone_from(&encoded);
            Message::Binary(encoded.into())
        })
    }
}

fn refused(why: &dyn fmt::Display) -> Message {
    region_message("refused", &why.to_string())
}

fn region_message<T: Serialize>(name: &str, value: &T) -> Message {
    Message::Binary(alone(name, value).into())
}

/// A message of one region.
fn alone<T: Serialize>(name: &str, value: &T) -> Vec<u8> {
    message(&[&region(name, value)])
}

fn lock(crew: &Mutex<Crew>) -> MutexGuard<'_, Crew> {
    crew.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Messages in the second that is on.
struct Rate {
    since: Instant,
    count: u32,
}

impl Default for Rate {
    fn default() -> Rate {
        Rate {
            since: Instant::now(),
            count: 0,
        }
    }
}

impl Rate {
    fn allows(&mut self) -> bool {
        if self.since.elapsed() >= Duration::from_secs(1) {
            *self = Rate::default();
        }
        self.count += 1;
        self.count <= RATE
    }
}
