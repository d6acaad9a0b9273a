//! Scripts that run in the server of the page.

use crate::bench::{Stage, Viewer, connect_to, token};
use serde_json::json;
use tungstenite::Message;

#[test]
fn a_sequence_needs_the_token_runs_without_pages_and_is_told_to_those_that_come() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    let origin = format!("http://{}", page.address());
    let open = || Viewer {
        socket: connect_to(&page, "operator", Some(&origin)).unwrap(),
        token: token(&page),
        next: 1,
    };
    let text = "FRF\nWAC ONT? W = 1\nMOV X 5\nWAC ONT? X = 1\nDEL 20\nPOS? X\n";
    let order = |token: &str| {
        json!({"token": token, "order": {"run": {"name": "tour", "text": text}}}).to_string()
    };
    let mut stranger = open();
    stranger.send(&order("0123"));
    stranger.wait(|message| message["kind"] == "sequence");
    let mut operator = open();
    let token = operator.token.clone();
    operator.send(&order(&token));
    let end = operator.wait(|message| message["kind"] == "sequence" && message["state"] == "ended");
    assert_eq!(
        (&end["good"], &end["done"], &end["name"]),
        (&json!(true), &json!(6), &json!("tour")),
        "{end}"
    );
    assert!(
        end["answers"][0]["reply"]
            .as_str()
            .unwrap()
            .starts_with("X="),
        "{end}"
    );
    viewer.until("POS? X", 5.0);
    // Who comes later is told what was done, by whom, and nothing of the stranger's.
    viewer.reply("MOV X 0");
    let mut late = open();
    let mut lines = Vec::new();
    late.socket.send(Message::Ping(Default::default())).unwrap();
    while lines.last().is_none_or(|line| line != "MOV X 0") {
        let entry = late.wait(|message| message["kind"] == "log");
        lines.push(entry["line"].as_str().unwrap().to_owned());
    }
    assert_eq!(lines, ["FRF", "MOV X 5", "MOV X 0"]);
}

/// The sequence of the page that owns the stage is that page's; another page's is refused.
#[test]
fn who_owns_the_stage_runs_sequences() {
    let stage = Stage::start("127.0.0.1:0");
    for page in [stage.page(), stage.page_on_line()] {
        let mut other = Viewer::ready(&page);
        let mut owner = Viewer::new(&page);
        let key = owner.wait(|message| message["kind"] == "you")["key"].clone();
        other.reply("FRF");
        assert_eq!(owner.ask("OWN 1")["error"], 0);
        let origin = format!("http://{}", page.address());
        let mut operator = Viewer {
            socket: connect_to(&page, "operator", Some(&origin)).unwrap(),
            token: token(&page),
            next: 1,
        };
        let text = "MOV X 1\nWAC ONT? X = 1\nMOV X 0\nWAC ONT? X = 1\n";
        for (key, good) in [(key, true), (json!(""), false)] {
            let run = json!({"run": {"name": "one", "text": text}});
            let order = json!({"token": operator.token, "order": run, "key": key});
            operator.send(&order.to_string());
            // That it runs may not be told, if it ends at once.
            let end =
                operator.wait(|message| message["state"] == "ended" && message["good"] == good);
            let said = end["said"].as_str().unwrap();
            assert_eq!(
                said.contains("another connection owns the stage"),
                !good,
                "{said}"
            );
            owner.reply("OWN?");
        }
        assert_eq!(owner.ask("OWN 0")["error"], 0);
    }
}
