//! Who may look and who may drive.

use crate::bench::{PATIENCE, Stage, Viewer, connect, connect_to, get, token};
use desk::line::Endpoint;
use desk::web::{Page, PageOptions};
use serde_json::json;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::thread;
use std::time::Duration;
use tungstenite::Message;

#[test]
fn the_page_is_served_to_its_own_name_and_may_load_nothing_from_elsewhere() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let place = page.address().to_string();
    let index = get(page.address(), "/", &place);
    assert!(index.starts_with("HTTP/1.1 200"), "{index}");
    assert!(index.contains("default-src 'none'"), "{index}");
    let mut files = 0;
    for part in index
        .split(['"', '\''])
        .filter(|part| part.starts_with('/'))
    {
        let answer = get(page.address(), part, &place);
        assert!(answer.starts_with("HTTP/1.1 200"), "{part}: {answer}");
        files += 1;
    }
    assert!(files >= 5, "{files}");
    let lesson = get(page.address(), "/lesson.json", "localhost");
    assert!(
        lesson.contains("\"frames\":[{\"pose\":[0.0,0.0,"),
        "{lesson}"
    );
    let elsewhere = get(page.address(), "/nothing", &place);
    assert!(elsewhere.starts_with("HTTP/1.1 404"), "{elsewhere}");
    for path in ["/", "/token", "/live"] {
        let stolen = get(page.address(), path, "evil.example");
        assert!(stolen.starts_with("HTTP/1.1 421"), "{stolen}");
        assert!(!stolen.contains(&token(&page)));
    }
}

#[test]
fn a_page_of_somebody_else_cannot_connect() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut other = page.address();
    other.set_port(1);
    let strangers = [
        None,
        Some("http://evil.example".to_owned()),
        Some(format!("http://{other}")),
    ];
    for origin in strangers {
        for path in ["live", "operator"] {
            let result = connect_to(&page, path, origin.as_deref());
            assert_eq!(result.err(), Some(403), "{path}: {origin:?}");
        }
    }
}

#[test]
fn what_is_not_a_request_gets_its_reason_and_changes_nothing() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    viewer.reply("FRF");
    let before = viewer.reply("MOV? X Y W");
    for (message, reason) in [
        ("MOV X 10".to_owned(), "not a request: expected value"),
        (
            json!({"id": 1, "line": "MOV X 10"}).to_string(),
            "not a request: missing field `token`",
        ),
        (
            json!({"id": 1, "token": "0", "line": "MOV X 10"}).to_string(),
            "the token is wrong",
        ),
        (
            json!({"id": 1, "token": viewer.token, "line": "MOV X 10\nMOV Y 10"}).to_string(),
            "a character",
        ),
    ] {
        viewer.send(&message);
        let answer = viewer.wait(|answer| answer["kind"] == "refused");
        let said = answer["reason"].as_str().unwrap();
        assert!(said.starts_with(reason), "{message}: {said}");
    }
    viewer.socket.send(Message::binary(vec![24])).unwrap();
    viewer.wait(|answer| answer["kind"] == "refused");
    assert_eq!(viewer.reply("MOV? X Y W"), before);
}

/// The cookie that a password brings, or what the page says in place of one.
fn enter(page: SocketAddr, origin: &str, password: &str) -> Result<String, String> {
    let mut stream = TcpStream::connect(page).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let form = format!("password={password}");
    write!(
        stream,
        "POST /login HTTP/1.1\r\nHost: {page}\r\nOrigin: {origin}\r\nConnection: close\r\nContent-Type: application/x-www-form-urlencoded\r\nContent-Length: {}\r\n\r\n{form}",
        form.len()
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    let cookie = answer
        .lines()
        .find_map(|line| line.strip_prefix("set-cookie: "));
    cookie
        .and_then(|cookie| cookie.split(';').next())
        .map(str::to_owned)
        .ok_or(answer)
}

#[test]
fn a_page_that_others_reach_wants_its_password() {
    let stage = Stage::start("127.0.0.1:0");
    let options = PageOptions {
        password: Some("correct horse".to_owned()),
        public_url: Some("https://stage.example.org".to_owned()),
        ..PageOptions::local("127.0.0.1:0")
    };
    let page = Page::start(&options, Endpoint::Tcp(stage.address.to_string())).unwrap();
    let (address, place) = (page.address(), page.address().to_string());
    for (path, status) in [
        ("/", "303"),
        ("/token", "401"),
        ("/live", "401"),
        ("/js/main.js", "401"),
        ("/login", "200"),
    ] {
        let answer = get(address, path, &place);
        assert!(
            answer.starts_with(&format!("HTTP/1.1 {status}")),
            "{path}: {answer}"
        );
    }
    assert_eq!(
        connect(&page, Some(&format!("http://{place}"))).err(),
        Some(401)
    );
    let own = format!("http://{place}");
    // Nobody else's page tries for its user.
    assert!(
        enter(address, "http://evil.example", "correct+horse")
            .unwrap_err()
            .starts_with("HTTP/1.1 403")
    );
    let wrong = enter(address, &own, "wrong").unwrap_err();
    assert!(wrong.contains("not the password"), "{wrong}");
    let soon = enter(address, &own, "correct+horse").unwrap_err();
    assert!(soon.contains("too soon"), "{soon}");
    thread::sleep(Duration::from_millis(1_100));
    // Through the proxy as well.
    let cookie = enter(address, "https://stage.example.org", "correct+horse").unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let host = "stage.example.org";
    write!(
        stream,
        "GET /token HTTP/1.1\r\nHost: {host}\r\nCookie: {cookie}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
}
