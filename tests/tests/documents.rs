//! What a document shows for another program is what that program reads.

use serde::Deserialize;

const GCS: &str = include_str!("../../firmware/GCS.md");

/// What BLISS demands of a controller of its class `PI_HEXA`.
#[derive(Deserialize)]
struct Controller {
    plugin: String,
    class: String,
    model: u32,
    tcp: Tcp,
    axes: Vec<BlissAxis>,
}

#[derive(Deserialize)]
struct Tcp {
    url: String,
}

#[derive(Deserialize)]
struct BlissAxis {
    name: String,
    channel: String,
    steps_per_unit: f64,
}

/// The first block of a language under a heading.
fn block(heading: &str, language: &str) -> &'static str {
    let (_, section) = GCS
        .split_once(&format!("\n### {heading}\n"))
        .expect("the heading");
    let (_, block) = section
        .split_once(&format!("```{language}\n"))
        .expect("the block");
    block.split_once("```").expect("its end").0
}

#[test]
fn bliss_reads_its_block() {
    let controller: Controller =
        serde_saphyr::from_str(block("BLISS", "yaml")).expect("what BLISS demands");
    assert_eq!(
        (&*controller.plugin, &*controller.class, controller.model),
        ("emotion", "PI_HEXA", 887)
    );
    assert_eq!(controller.tcp.url, "127.0.0.1:50000");
    let channels: Vec<_> = controller.axes.iter().map(|axis| &*axis.channel).collect();
    assert_eq!(channels, ["X", "Y", "W"]);
    for axis in controller.axes {
        assert_eq!(axis.steps_per_unit, 1.0, "{}", axis.name);
    }
}
