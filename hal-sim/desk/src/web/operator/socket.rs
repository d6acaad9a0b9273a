//! A page's second connection: the sequence, the commissioning, the calibration and the log out, orders in.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use axum::extract::ws::{Message, WebSocket};
use serde::Deserialize;
use tokio::sync::broadcast::error::RecvError;

use super::Operator;
use super::runs::Ordered;
use super::sequence_status::{Order, Orderer};
use super::{calibration, commissioning};
use crate::web::guard::Guard;
use crate::web::life::{Life, send};

/// Longest message: a script.
pub(in crate::web) const MESSAGE_BYTES: usize = 256 << 10;

/// A message of a page.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    token: String,
    order: Wanted,
    /// Whoever uses the page.
    #[serde(default)]
    who: String,
    /// Of the page's way to the controller.
    #[serde(default)]
    key: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Wanted {
    Run { name: String, text: String },
    First { name: String, text: String },
    Step,
    Pause,
    Continue,
    Stop,
    Commissioning(Box<commissioning::Order>),
    Calibration(calibration::Order),
}

/// What a page wants, and of whom.
#[derive(Debug, PartialEq)]
enum Taken {
    Sequence(Order),
    Commissioning(Box<Ordered<commissioning::Order>>),
    Calibration(Ordered<calibration::Order>),
}

/// Serves a page until it is gone.
pub(in crate::web) async fn serve(mut socket: WebSocket, operator: Operator, guard: Arc<Guard>) {
    static PAGES: AtomicU64 = AtomicU64::new(1);
    let page = PAGES.fetch_add(1, Ordering::Relaxed);
    talk(&mut socket, &operator, &guard, page).await;
    operator.gone(page);
}

async fn talk(socket: &mut WebSocket, operator: &Operator, guard: &Guard, page: u64) {
    let mut told = operator.sequence.told();
    told.mark_changed();
    let mut commissioning = operator.commissioning.told();
    commissioning.mark_changed();
    let mut calibration = operator.calibration.told();
    calibration.mark_changed();
    let (kept, mut news) = operator.journal.read();
    for entry in kept {
        if !send(socket, Message::Text(entry.as_ref().into())).await {
            return;
        }
    }
    let mut life = Life::new();
    loop {
        let message = tokio::select! {
            message = socket.recv() => {
                let Some(Ok(message)) = message else { return };
                life.heard();
                if let Message::Text(text) = message
                    && let Some(order) = order(&text, guard, page)
                {
                    match order {
                        Taken::Sequence(order) => operator.sequence.order(order),
                        Taken::Commissioning(ordered) => operator.commissioning.order(*ordered),
                        Taken::Calibration(ordered) => operator.calibration.order(ordered),
                    }
                }
                continue;
            }
            Ok(()) = told.changed() => Message::Text(told.borrow_and_update().as_ref().into()),
            Ok(()) = commissioning.changed() => {
                Message::Text(commissioning.borrow_and_update().as_ref().into())
            }
            Ok(()) = calibration.changed() => {
                Message::Text(calibration.borrow_and_update().as_ref().into())
            }
            entry = news.recv() => match entry {
                Ok(entry) => Message::Text(entry.as_ref().into()),
                Err(RecvError::Lagged(_)) => continue,
                Err(RecvError::Closed) => return,
            },
            ping = life.ping() => match ping {
                Some(ping) => ping,
                None => return,
            },
        };
        if !send(socket, message).await {
            return;
        }
    }
}

/// The order in a message of somebody who may give one.
fn order(text: &str, guard: &Guard, page: u64) -> Option<Taken> {
    let Request {
        token,
        order,
        who,
        key,
    } = serde_json::from_str(text).ok()?;
    if !guard.knows(&token) {
        return None;
    }
    let by = Orderer { page, key };
    let run = |name, text, steps, by| Order::Run {
        name,
        text,
        steps,
        by,
    };
    Some(Taken::Sequence(match order {
        Wanted::Commissioning(order) => {
            return Some(Taken::Commissioning(Box::new(ordered(*order, who, by))));
        }
        Wanted::Calibration(order) => return Some(Taken::Calibration(ordered(order, who, by))),
        Wanted::Run { name, text } => run(name, text, false, by),
        Wanted::First { name, text } => run(name, text, true, by),
        Wanted::Step => Order::Step { by },
        Wanted::Pause => Order::Pause,
        Wanted::Continue => Order::Continue { by },
        Wanted::Stop => Order::Stop,
    }))
}

fn ordered<O>(order: O, who: String, by: Orderer) -> Ordered<O> {
    let Orderer { page, key } = by;
    Ordered {
        order,
        who,
        page,
        key,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_need_the_token() {
        let guard = Guard::new("127.0.0.1:8080", None).unwrap();
        let token = guard.token();
        let step = format!(r#"{{"token":"{token}","order":"step","key":"a"}}"#);
        let by = Orderer {
            page: 3,
            key: "a".to_owned(),
        };
        assert_eq!(
            order(&step, &guard, 3),
            Some(Taken::Sequence(Order::Step { by }))
        );
        let run = format!(r#"{{"token":"{token}","order":{{"run":{{"name":"a","text":"FRF"}}}}}}"#);
        assert!(matches!(
            order(&run, &guard, 3),
            Some(Taken::Sequence(Order::Run {
                steps: false,
                by: Orderer { page: 3, .. },
                ..
            }))
        ));
        let only = format!(
            r#"{{"token":"{token}","order":{{"commissioning":{{"only":{{"step":"friction"}}}}}},"who":"Ada"}}"#
        );
        let Some(Taken::Commissioning(only)) = order(&only, &guard, 3) else {
            panic!("no order");
        };
        let step = "friction".to_owned();
        let scale_periods = None;
        let wanted = commissioning::Order::Only {
            step,
            scale_periods,
        };
        assert_eq!(only.order, wanted);
        assert_eq!((only.who.as_str(), only.page), ("Ada", 3));
        for bad in [
            r#"{"token":"x","order":"step"}"#,
            r#"{"order":"step"}"#,
            "step",
            "",
        ] {
            assert_eq!(order(bad, &guard, 3), None, "{bad}");
        }
    }
}
