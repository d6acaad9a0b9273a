//! What a document shows for another program is what that program reads.

use saphyr::{LoadableYamlNode, Yaml};

const GCS: &str = include_str!("../../firmware/GCS.md");

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
    // What it demands of a controller of its class `PI_HEXA`.
    let documents = Yaml::load_from_str(block("BLISS", "yaml")).expect("a document");
    let [controller] = &documents[..] else {
        panic!("{documents:?}");
    };
    let text = |node: &Yaml<'_>, key: &str| node[key].as_str().expect(key).to_owned();
    assert_eq!(text(controller, "plugin"), "emotion");
    assert_eq!(text(controller, "class"), "PI_HEXA");
    assert_eq!(controller["model"].as_integer(), Some(887));
    assert_eq!(text(&controller["tcp"], "url"), "127.0.0.1:50000");
    let axes = controller["axes"].as_vec().expect("axes");
    let channels: Vec<_> = axes.iter().map(|axis| text(axis, "channel")).collect();
    assert_eq!(channels, ["X", "Y", "W"]);
    for axis in axes {
        let name = text(axis, "name");
        let steps = &axis["steps_per_unit"];
        let steps = steps
            .as_floating_point()
            .or(steps.as_integer().map(|steps| steps as f64));
        assert_eq!(steps, Some(1.0), "{name}");
    }
}
