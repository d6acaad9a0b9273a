//! One browser: status and answers go out, requests come in.

use std::sync::Arc;

use axum::extract::ws::{Message, WebSocket};
use serde::Serialize;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::{Semaphore, mpsc};

use super::bridge::{Bridge, Way, json};
use super::guard::Guard;
use super::life::{Life, send};
use super::operator::Operator;
use super::request::{self, Refusal, Request, Wanted};
use crate::error_words::refused_with;
use crate::line::Answer;

/// Requests of a viewer that may be under way at once.
const AT_ONCE: usize = 16;

/// What a request came to.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Reply {
    /// It went to the controller.
    Answer {
        id: u64,
        reply: Option<String>,
        /// What `ERR?` said; 0 is no error.
        error: u16,
    },
    /// It did not.
    Refused { id: Option<u64>, reason: String },
    /// What the viewer is called where others ask who commands, and what its orders to the sequence say so that they are known for
    /// its own.
    You { name: String, key: String },
    /// So many status messages were lost, because they were not read in time.
    Lost { messages: u64 },
}

impl Reply {
    /// For the log.
    fn in_words(&self, is_stop: bool) -> String {
        match self {
            Self::Answer { error: 0, .. } if is_stop => "sent".to_owned(),
            Self::Answer { error: 0, .. } => "taken".to_owned(),
            Self::Answer { error, .. } => refused_with(*error),
            Self::Refused { reason, .. } => reason.clone(),
            Self::You { name, .. } => name.clone(),
            Self::Lost { messages } => format!("{messages} messages lost"),
        }
    }
}

/// Serves a viewer until it is gone.
pub(super) async fn serve(
    mut socket: WebSocket,
    bridge: Bridge,
    guard: Arc<Guard>,
    operator: Operator,
) {
    // Without a thread there is no way to the controller.
    let Ok(way) = bridge.way() else {
        return;
    };
    let mut status = bridge.status();
    let mut hello = bridge.hello();
    hello.mark_changed();
    let (answers, mut answered) = mpsc::channel::<Arc<str>>(AT_ONCE);
    let slots = Arc::new(Semaphore::new(AT_ONCE));
    let you = json(&Reply::You {
        name: way.0.name(),
        key: way.0.key().to_owned(),
    });
    // There is room.
    let _ = answers.try_send(you);
    let mut life = Life::new();
    loop {
        let text = tokio::select! {
            // Requests first: a stop must not wait for the status.
            biased;
            message = socket.recv() => {
                let Some(Ok(message)) = message else { return };
                life.heard();
                match take(message, &bridge, &way.0, &guard, &operator, &slots, &answers) {
                    Some(reply) => json(&reply),
                    None => continue,
                }
            }
            ping = life.ping() => {
                let Some(ping) = ping else { return };
                if !send(&mut socket, ping).await {
                    return;
                }
                continue;
            }
            Some(answer) = answered.recv() => answer,
            Ok(()) = hello.changed() => Arc::clone(&hello.borrow_and_update()),
            message = status.recv() => match message {
                Ok(message) => message,
                Err(RecvError::Lagged(messages)) => json(&Reply::Lost { messages }),
                Err(RecvError::Closed) => return,
            },
        };
        if !send(&mut socket, Message::Text(text.as_ref().into())).await {
            return;
        }
    }
}

/// Takes a message; the reply, where one can be given at once.
fn take(
    message: Message,
    bridge: &Bridge,
    way: &Arc<Way>,
    guard: &Guard,
    operator: &Operator,
    slots: &Arc<Semaphore>,
    answers: &mpsc::Sender<Arc<str>>,
) -> Option<Reply> {
    let text = match message {
        Message::Text(text) => text,
        Message::Ping(_) | Message::Pong(_) | Message::Close(_) => return None,
        Message::Binary(_) => {
            return Some(refused(None, &Refusal::Malformed("binary".to_owned())));
        }
    };
    let Request {
        id,
        token,
        line,
        who,
    } = match request::read(&text) {
        Ok(request) => request,
        Err(refusal) => return Some(refused(None, &refusal)),
    };
    if !guard.knows(&token) {
        return Some(refused(Some(id), &Refusal::Token));
    }
    let wanted = match request::check(&line, way.is_shared()) {
        Ok(wanted) => wanted,
        Err(refusal) => return Some(refused(Some(id), &refusal)),
    };
    let Ok(slot) = Arc::clone(slots).try_acquire_owned() else {
        return Some(refused(Some(id), &Refusal::TooMany));
    };
    let line_out = match wanted {
        Wanted::Stop => {
            // Before the stop is sent: no line of a sequence may follow it.
            operator.stopped(&who);
            let reply = reply(id, bridge.stop());
            operator.journal.note(&who, &line, &reply.in_words(true));
            return Some(reply);
        }
        Wanted::Line(line) => line,
    };
    let (way, answers) = (Arc::clone(way), answers.clone());
    let journal = operator.journal.clone();
    tokio::spawn(async move {
        let reply = reply(id, way.ask(line_out).await);
        journal.note(&who, &line, &reply.in_words(false));
        // A viewer that is gone needs no answer.
        let _ = answers.send(json(&reply)).await;
        drop(slot);
    });
    None
}

fn reply(id: u64, result: Result<Answer, Refusal>) -> Reply {
    match result {
        Ok(Answer { reply, error }) => Reply::Answer { id, reply, error },
        Err(refusal) => refused(Some(id), &refusal),
    }
}

fn refused(id: Option<u64>, refusal: &Refusal) -> Reply {
    Reply::Refused {
        id,
        reason: refusal.to_string(),
    }
}
