//! One viewer, over a web socket.
//!
//! The server sends MessagePack: an array of regions that have changed, `[name, value]` each; besides those of the
//! screen there is `crew`, who operates, and `taken`, the number of the last input that was taken. The viewer sends JSON: inputs with
//! a number that grows, `{"n":7,"key":"ENT"}`, which are done once however often they arrive, `{"operate":true}` or
//! `{"hand_over":true}`, and `{"part":true}` to look at the part that is being cut. What a viewer is too slow for is left
//! out: he gets what is newest when he has taken what was sent before.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use bahn_panel::{Input, InputText};
use serde::{Deserialize, Serialize};

use crate::crew::{Crew, Taking};
use crate::part::Looking;
use crate::regions::{message, region};
use crate::shared::Shared;

/// Longest message of a viewer, bytes.
const MESSAGE: usize = 16 << 10;
/// Messages of a viewer in a second.
const RATE: u32 = 400;
/// A viewer that asks for the part again is sent all of it behind this time (inferred).
const AGAIN: Duration = Duration::from_millis(500);
/// Length of a name.
const NAME: usize = 64;

#[derive(Deserialize)]
pub(crate) struct Who {
    #[serde(default)]
    name: String,
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
struct Role<'a> {
    operates: bool,
    operator: Option<&'a str>,
    asks: Option<&'a str>,
}

/// `GET /ws?name=...`.
pub(crate) async fn open(
    State(shared): State<Shared>,
    Query(who): Query<Who>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let Ok(permit) = shared.viewers.clone().try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many viewers").into_response();
    };
    let fits = !who.name.is_empty() && who.name.len() <= NAME;
    if !fits
        || !who
            .name
            .chars()
            .all(|character| character.is_ascii_alphanumeric() || "-_ ".contains(character))
    {
        return (
            StatusCode::BAD_REQUEST,
            "a viewer has a name of letters and digits",
        )
            .into_response();
    }
    upgrade
        .max_message_size(MESSAGE)
        .max_frame_size(MESSAGE)
        .on_upgrade(move |socket| async move {
            let _permit = permit;
            let taken = lock(&shared.crew).come(&who.name);
            let mut viewer = Viewer {
                taken,
                name: who.name,
                shared,
                seen: 0,
                role: Vec::new(),
                looked: Instant::now(),
                looking: None,
                rate: Rate::default(),
            };
            viewer.follow(socket).await;
            lock(&viewer.shared.crew).go(&viewer.name);
        })
}

struct Viewer {
    name: String,
    shared: Shared,
    /// Serial of the last screen that was sent.
    seen: u64,
    /// Number of the last input that was taken.
    taken: u64,
    /// The role that was sent.
    role: Vec<u8>,
    /// When he last asked for the part.
    looked: Instant,
    /// He looks at the part that is being cut.
    looking: Option<Looking>,
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
                () = part_changes(&mut self.looking) => {
                    if let Some(news) = self.news_of_the_part().await
                        && socket.send(news).await.is_err()
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
            return refused("this is no input");
        };
        if let Some(looks) = sent.part {
            // Whoever asks again is sent all of it anew, which takes its time: soon again he has what he gets.
            let again = looks && self.looking.is_some() && self.looked.elapsed() < AGAIN;
            if !again {
                self.looking = looks.then(|| self.shared.part.look());
                self.looked = Instant::now();
            }
            return self.taken_message();
        }
        match (sent.operate, sent.hand_over) {
            (Some(_), _) => lock(&self.shared.crew).ask(&self.name),
            (_, Some(yes)) => lock(&self.shared.crew).answer(&self.name, yes),
            (None, None) => return self.input(sent).await,
        }
        self.taken_message()
    }

    async fn input(&mut self, sent: Sent) -> Message {
        let order = lock(&self.shared.crew).order(&self.name);
        let _turn = order.lock().await;
        let taking = lock(&self.shared.crew).takes(&self.name, sent.n);
        self.taken = self.taken.max(sent.n);
        match taking {
            Taking::Twice => return self.taken_message(),
            Taking::NotOperator => return refused("somebody else operates"),
            Taking::New => {}
        }
        let input = serde_json::from_value::<InputText>(sent.input.into())
            .map_err(|error| bahn_panel::Refusal(error.to_string()))
            .and_then(Input::try_from);
        let link = self.shared.link.clone();
        let done = match input {
            Ok(input) => tokio::task::spawn_blocking(move || link.input(input)).await,
            Err(refusal) => Ok(Err(refusal)),
        };
        match done {
            Ok(Ok(())) => self.taken_message(),
            Ok(Err(refusal)) => refused(&refusal.0),
            Err(_) => refused("the station has ended"),
        }
    }

    fn taken_message(&self) -> Message {
        told("taken", &self.taken)
    }

    async fn news_of_the_part(&mut self) -> Option<Message> {
        let (looking, news) = self.looking.take()?.next().await?;
        self.looking = Some(looking);
        Some(Message::Binary(message(&[&news?]).into()))
    }

    fn news_of_the_crew(&mut self) -> Option<Message> {
        let crew = lock(&self.shared.crew);
        let (operator, asks) = crew.roles();
        let role = Role {
            operates: operator == Some(&self.name),
            operator,
            asks,
        };
        let encoded = alone("crew", &role);
        (encoded != self.role).then(|| {
            self.role.clone_from(&encoded);
            Message::Binary(encoded.into())
        })
    }
}

/// Waits for another part; for ever, when he does not look at it.
async fn part_changes(looking: &mut Option<Looking>) {
    if let Some(looking) = looking
        && looking.news.changed().await.is_ok()
    {
        return;
    }
    std::future::pending().await
}

fn refused(why: &str) -> Message {
    told("refused", &why)
}

fn told<T: Serialize>(name: &str, value: &T) -> Message {
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
