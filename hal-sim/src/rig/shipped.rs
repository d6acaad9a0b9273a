//! What the reference stage comes with: the settings that `tripivot commission` left it with, as they were exported
//! (`reference_stage.txt`; how they are made again stands in `told`'s [`Told::Reference`](super::Told::Reference)).

use firmware::gcs::PARAMETERS;
use firmware::parameters::Parameters;

const SETTINGS: &str = include_str!("reference_stage.txt");

/// The same parameters with all that commissioning has set: what it has left as every controller has it stays as it is here.
pub(super) fn with_reference_settings(parameters: &Parameters) -> Parameters {
    let mut told = parameters.clone();
    for (id, value) in settings() {
        let parameter = (PARAMETERS.iter()).find(|parameter| parameter.id == id);
        let parameter = parameter.expect("the file has parameters of this controller");
        if parameter.number(&Parameters::REFERENCE) != Some(value) {
            (parameter.set(value, &mut told)).expect("the file has values that it has taken");
        }
    }
    told
}

/// Numbers of parameters, and their values.
fn settings() -> impl Iterator<Item = (u32, f64)> {
    let settings = (SETTINGS.lines()).filter_map(|line| line.split('#').next()?.split_once('='));
    settings.map(|(id, value)| {
        let id = id.trim().strip_prefix("0x");
        let id = id.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let value = value.trim().parse().ok();
        id.zip(value).expect("the file has a number and its value")
    })
}
