//! Commissioning and tuning that run in the server.

use desk::web::Page;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

use super::bench::{Stage, Viewer, connect_to, token};

/// A page's second connection.
fn operator(page: &Page) -> Viewer {
    let origin = format!("http://{}", page.address());
    Viewer {
        socket: connect_to(page, "operator", Some(&origin)).unwrap(),
        token: token(page),
        next: 1,
    }
}

fn order(operator: &mut Viewer, order: &Value) {
    let order = json!({"token": operator.token, "order": {"commissioning": order}, "who": "Ada"});
    operator.send(&order.to_string());
}

/// The next that is told of it for which this holds.
fn told(operator: &mut Viewer, wanted: impl Fn(&Value) -> bool) -> Value {
    operator.wait(|message| message["kind"] == "commissioning" && wanted(message))
}

/// Over TCP, where it has a connection of its own, and over a line that all share.
#[test]
fn it_has_the_stage_for_itself_and_ends_with_the_page_that_began_it() {
    let stage = Stage::start("127.0.0.1:0");
    for page in [stage.page(), stage.page_on_line()] {
        let mut viewer = Viewer::ready(&page);
        let (mut one, mut other) = (operator(&page), operator(&page));
        order(&mut one, &json!("measure"));
        let begun = told(&mut other, |status| status["runs"] == true);
        assert_eq!(begun["what"], "measuring the loops");
        assert_eq!(begun["steps"][0]["state"], "runs");
        // Others look, and command nothing; a second order is none.
        let owner = loop {
            let owner = viewer.reply("OWN?").unwrap();
            if !owner.contains("nobody") && owner.contains("commissioning") {
                break owner;
            }
        };
        assert!(owner.contains("MINE=0"), "{owner}");
        assert_ne!(viewer.ask("MOV X 1")["error"], 0);
        order(&mut other, &json!("keep"));
        drop(one);
        let ended = told(&mut other, |status| status["runs"] == false);
        assert_eq!(ended["what"], "measuring the loops");
        assert_eq!(ended["good"], false);
        let said = ended["said"].as_str().unwrap();
        assert!(
            said.contains("its page, which is gone") && said.contains("the motors are off"),
            "{said}"
        );
        assert_eq!(viewer.reply("SVO? X").as_deref(), Some("X=0"));
        // And the stage is everybody's again.
        viewer.reply("FRF");
        viewer.reply("SVO X 0");
    }
}

#[test]
fn a_stop_of_any_page_ends_it_and_a_task_waits_for_its_person() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    let mut operator = operator(&page);
    // A step that needs what another one finds is refused by its name, the first time that anything is asked for.
    order(&mut operator, &json!({"only": {"step": "hand"}}));
    let refused = told(&mut operator, |status| {
        status["runs"] == false && status["said"] != ""
    });
    assert_eq!(refused["what"], "one step of commissioning");
    let said = refused["said"].as_str().unwrap();
    assert!(said.contains("begin with `wiring`"), "{said}");
    // Whoever serves this page has no simulated person.
    order(&mut operator, &json!({"only": {"step": "zeros"}}));
    let asked = told(&mut operator, |status| !status["asks"].is_null());
    assert_eq!(asked["asks"]["task"], "jig");
    assert_eq!(asked["asks"]["waits"], true);
    // Stopped again and again it is brought to rest all the same, and is commissioned as before.
    let stopped = Instant::now();
    while stopped.elapsed() < Duration::from_secs(1) {
        viewer.ask("STP");
    }
    let ended = told(&mut operator, |status| status["runs"] == false);
    let said = ended["said"].as_str().unwrap();
    assert!(said.contains("ended by STOP by"), "{said}");
    assert!(viewer.reply("CMS?").unwrap().starts_with('1'));
    assert!(ended["asks"].is_null());
    // Said to be done, it goes on: the platform stands somewhere, which is where its zeros are now.
    order(&mut operator, &json!({"only": {"step": "zeros"}}));
    told(&mut operator, |status| !status["asks"].is_null());
    order(&mut operator, &json!("done"));
    let done = told(&mut operator, |status| status["runs"] == false);
    assert_eq!(done["good"], true, "{done}");
    assert_eq!(done["steps"][0]["state"], "done");
    // The step has nudged a ring to see that the jig is out: whoever looked on in silence meanwhile is gone.
    let mut viewer = Viewer::ready(&page);
    let zero = |viewer: &mut Viewer| viewer.reply("SPA? 1 0x54500600").unwrap();
    let found = zero(&mut viewer);
    // What was before is given back.
    order(&mut operator, &json!("undo"));
    let is_over = |status: &Value, what: &str| status["what"] == what && status["runs"] == false;
    let undone = told(&mut operator, |status| {
        is_over(status, "giving back what was before")
    });
    assert_eq!(undone["good"], true, "{undone}");
    assert_ne!(zero(&mut viewer), found);
    // What nothing is known of is told so.
    let gains = [[1.0; 11]; 3];
    order(&mut operator, &json!({"predict": {"gains": gains}}));
    let refused = told(&mut operator, |status| {
        is_over(status, "gains on the loops as measured")
    });
    assert_eq!(refused["said"], "measure the loops first");
}
