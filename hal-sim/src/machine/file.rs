//! A machine of one's own: every number of the simulated stage in a TOML file, with its unit in its name.
//!
//! `tripivot machine` prints the reference stage to start from. A file need not have every number: what it leaves out is the
//! reference stage's. What it has must be known, and possible.

use toml::{Table, Value};

use super::devices::StageParameters;

/// Why a machine cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MachineError {
    /// It is no TOML.
    #[error("no machine: {0}")]
    Syntax(String),
    /// There is no such number: its name is misspelt, or the unit at its end is missing.
    #[error("{key}: no such number of a machine; {hint}")]
    Unknown {
        /// Where, from the top, with dots between.
        key: String,
        /// What there is in its place.
        hint: String,
    },
    /// It is a word where a number belongs, or the like.
    #[error("{key}: {value} is not {wanted}")]
    Kind {
        /// Where.
        key: String,
        /// What stands there.
        value: String,
        /// What should.
        wanted: &'static str,
    },
    /// No machine has that.
    #[error("{key} = {value}: must be from {least} to {most}")]
    Absurd {
        /// Where.
        key: String,
        /// What stands there.
        value: f64,
        /// What it may be.
        least: f64,
        /// What it may be.
        most: f64,
    },
    /// Two plugs in one socket.
    #[error("{key}: must have each of 0, 1 and 2 once")]
    Wiring {
        /// Where.
        key: &'static str,
    },
    /// Not `KEY=VALUE`.
    #[error("{0}: must be KEY=VALUE, as in plant.platform_mass_kg=3.5")]
    Setting(String),
}

/// What a number may be, by the last part of its name: generous, but a machine that somebody could build.
const RANGES: &[(&str, f64, f64)] = &[
    ("period_s", 20e-6, 1e-3),
    ("track_radius_m", 0.01, 1.0),
    ("platform_mass_kg", 0.1, 50.0),
    ("platform_inertia_kg_m2", 1e-5, 5.0),
    ("mass_kg", 0.0, 50.0),
    ("inertia_kg_m2", 0.0, 5.0),
    ("eccentricity_m", 0.0, 0.5),
    ("direction_rad", -7.0, 7.0),
    ("gravity_m_s2", -9.9, 9.9),
    ("ring_inertia_kg_m2", 1e-5, 1.0),
    ("motor_inertia_kg_m2", 1e-5, 1.0),
    ("gear_ratio", 1.0, 1000.0),
    ("torque_constant_n_m_a", 1e-3, 10.0),
    ("resistance_ohm", 0.01, 100.0),
    ("inductance_h", 1e-6, 0.1),
    ("supply_v", 5.0, 60.0),
    ("transmission_stiffness_n_m_rad", 1e3, 1e7),
    ("transmission_damping_n_m_s_rad", 0.0, 1e3),
    ("backlash_rad", 0.0, 0.01),
    ("coulomb", 0.0, 50.0),
    ("stiction_ratio", 1.0, 5.0),
    ("stribeck_rate", 1e-6, 10.0),
    ("presliding", 1e-7, 0.01),
    ("bristle_damping", 0.0, 1e4),
    ("viscous", 0.0, 1e4),
    ("ripple_n_m", 0.0, 5.0),
    ("ripple_periods_per_motor_turn", 0.0, 1000.0),
    ("guide_range_m", 1e-3, 2.0),
    ("stop_stiffness_n_m", 1e3, 1e8),
    ("stop_damping_n_s_m", 0.0, 1e5),
    ("guide_stiffness_n_m", 1e6, 1e9),
    ("guide_damping_n_s_m", 0.0, 1e5),
    ("ring_centre_m", -2e-3, 2e-3),
    ("radius_error_m", -2e-3, 2e-3),
    ("guide_error_rad", -0.1, 0.1),
    ("guide_offset_m", -5e-3, 5e-3),
    ("runout_m", -1e-4, 1e-4),
    ("straightness_m", -1e-4, 1e-4),
    ("zero_counts", 0.0, 67_108_863.0),
    ("noise_rad", 0.0, 1e-4),
    ("eccentricity_rad", 0.0, 0.01),
    ("eccentricity_phase_rad", -7.0, 7.0),
    ("latency_s", 0.0, 1e-4),
    ("idle_bits", 1.0, 8.0),
    ("acknowledge_bits", 1.0, 20.0),
    ("pwm_hz", 1e3, 200e3),
    ("dead_time_s", 0.0, 2e-6),
    ("dead_time_knee_a", 1e-4, 5.0),
    ("commutation_ripple", 0.0, 0.2),
    ("cyclic_error_rad", 0.0, 0.01),
    ("cyclic_phase_rad", -7.0, 7.0),
    ("preload_n_m", 0.0, 1e3),
    ("preload_way_rad", 0.0, 0.01),
    ("efficiency", 0.3, 1.0),
    ("tooth_torque_n_m", 1.0, 1e5),
    ("thermal_resistance_k_w", 0.0, 100.0),
    ("time_constant_s", 0.1, 1e5),
    ("resistance_per_k", 0.0, 0.01),
    ("expansion_per_k", 0.0, 1e-4),
    ("start_k", -60.0, 150.0),
    ("floor_acceleration_m_s2", 0.0, 0.1),
    ("cable_stiffness_n_m", 0.0, 1e3),
    ("ball_runout_m", 0.0, 1e-5),
    ("ball_phase_rad", -7.0, 7.0),
    ("harmonics_rad", -0.01, 0.01),
    ("subdivisional_error_rad", 0.0, 1e-4),
    ("scale_periods_per_turn", 1.0, 1e6),
    ("bit_error_rate", 0.0, 0.01),
    ("noise_counts", 0.0, 100.0),
    ("current_offset_counts", -200.0, 200.0),
    ("current_gain", 0.5, 2.0),
    ("supply_gain", 0.5, 2.0),
    ("current_sampled_s", 0.0, 1e-3),
    ("source_ohm", 1e-3, 10.0),
    ("ripple_v", 0.0, 5.0),
    ("ripple_hz", 0.0, 1e4),
    ("diode_v", 0.0, 2.0),
    ("capacitor_f", 1e-4, 1.0),
    ("brake_resistor_ohm", 0.1, 1e3),
    ("trip_a", 1.0, 1e3),
    ("wake_s", 0.0, 0.1),
    ("edge_s", 0.0, 1e-5),
    ("air_c", -40.0, 150.0),
    ("shutdown_c", 50.0, 300.0),
    ("hysteresis_k", 0.0, 100.0),
    ("bridge_of_ring", 0.0, 2.0),
    ("port_of_ring", 0.0, 2.0),
];

/// A machine as a file.
#[must_use]
pub fn to_text(machine: &StageParameters) -> String {
    let head = "# A machine for `tripivot --machine FILE`. Every number has its unit in its name: _m, _kg, _rad, _s, _n_m (N m).\n\
                # Friction of rings is in N m and rad, of guides in N and m. What a file leaves out is the reference stage's.\n\n";
    match toml::to_string(machine) {
        Ok(text) => head.to_owned() + &text,
        // Numbers, words and tables of them, all of which TOML has.
        Err(error) => format!("{head}# {error}\n"),
    }
}

/// The machine of a file, and single numbers set in it afterwards, each as `plant.platform_mass_kg=3.5` or
/// `encoders.1.zero_counts=5000`.
///
/// # Errors
/// [`MachineError`]: names what is wrong and where.
pub fn from_text(text: &str, settings: &[String]) -> Result<StageParameters, MachineError> {
    let reference = Value::try_from(StageParameters::REFERENCE)
        .map_err(|error| MachineError::Syntax(error.to_string()))?;
    let mut machine = reference;
    let given = (text.parse::<Table>()).map_err(|error| MachineError::Syntax(error.to_string()))?;
    merge("", &mut machine, Value::Table(given))?;
    for setting in settings {
        set(&mut machine, setting)?;
    }
    check("", &machine)?;
    let machine: StageParameters =
        (machine.try_into()).map_err(|error| MachineError::Syntax(error.to_string()))?;
    for (key, mut places) in [
        ("wiring.bridge_of_ring", machine.wiring.bridge_of_ring),
        ("wiring.port_of_ring", machine.wiring.port_of_ring),
    ] {
        places.sort_unstable();
        if places != [0, 1, 2] {
            return Err(MachineError::Wiring { key });
        }
    }
    Ok(machine)
}

/// Puts what is given in the place of what is there, all of which is known.
fn merge(key: &str, there: &mut Value, given: Value) -> Result<(), MachineError> {
    match (there, given) {
        (Value::Table(there), Value::Table(given)) => {
            for (name, value) in given {
                let key = join(key, &name);
                let names: Vec<String> = there.keys().cloned().collect();
                let place = there.get_mut(&name).ok_or_else(|| MachineError::Unknown {
                    key: key.clone(),
                    hint: hint(&name, &names),
                })?;
                merge(&key, place, value)?;
            }
            Ok(())
        }
        (Value::Array(there), Value::Array(given)) if there.len() == given.len() => {
            for (index, (place, value)) in there.iter_mut().zip(given).enumerate() {
                merge(&join(key, &index.to_string()), place, value)?;
            }
            Ok(())
        }
        (there @ Value::Float(_), Value::Integer(number)) => {
            *there = Value::Float(number as f64);
            Ok(())
        }
        (there, given) if there.same_type(&given) && !there.is_array() => {
            *there = given;
            Ok(())
        }
        (there, given) => Err(MachineError::Kind {
            key: key.to_owned(),
            value: given.to_string(),
            wanted: wanted(there),
        }),
    }
}

/// One setting, `KEY=VALUE`.
fn set(machine: &mut Value, setting: &str) -> Result<(), MachineError> {
    let malformed = || MachineError::Setting(setting.to_owned());
    let (key, value) = setting.split_once('=').ok_or_else(malformed)?;
    let key = key.trim();
    let parsed = format!("value = {value}").parse::<Table>();
    let value = (parsed.ok())
        .and_then(|mut table| table.remove("value"))
        .ok_or_else(malformed)?;
    let mut place = machine;
    let mut path = String::new();
    for name in key.split('.') {
        path = join(&path, name);
        let names: Vec<String> = match place {
            Value::Table(table) => table.keys().cloned().collect(),
            Value::Array(array) => (0..array.len()).map(|index| index.to_string()).collect(),
            _ => Vec::new(),
        };
        let inner = match place {
            Value::Table(table) => table.get_mut(name),
            Value::Array(array) => {
                (name.parse().ok()).and_then(|index: usize| array.get_mut(index))
            }
            _ => None,
        };
        place = inner.ok_or_else(|| MachineError::Unknown {
            key: path.clone(),
            hint: hint(name, &names),
        })?;
    }
    merge(key, place, value)
}

/// Every number inside its range.
fn check(key: &str, value: &Value) -> Result<(), MachineError> {
    match value {
        Value::Table(table) => {
            (table.iter()).try_for_each(|(name, value)| check(&join(key, name), value))
        }
        Value::Array(array) => (array.iter().enumerate())
            .try_for_each(|(index, value)| check(&join(key, &index.to_string()), value)),
        Value::Float(number) => in_range(key, *number),
        Value::Integer(number) => in_range(key, *number as f64),
        _ => Ok(()),
    }
}

fn in_range(key: &str, value: f64) -> Result<(), MachineError> {
    let Some((least, most)) = range(key) else {
        return Err(MachineError::Unknown {
            key: key.to_owned(),
            hint: "its range is not known".to_owned(),
        });
    };
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(MachineError::Absurd {
        key: key.to_owned(),
        value,
        least,
        most,
    })
}

/// By the last part of the name that is not a place in a list.
fn range(key: &str) -> Option<(f64, f64)> {
    let name = key
        .rsplit('.')
        .find(|part| part.parse::<usize>().is_err())?;
    let (_, least, most) = RANGES.iter().find(|(known, ..)| *known == name)?;
    Some((*least, *most))
}

fn join(key: &str, name: &str) -> String {
    if key.is_empty() {
        name.to_owned()
    } else {
        format!("{key}.{name}")
    }
}

/// The name that was meant, where one begins with what was written: a unit is missing. Else all of them.
fn hint(name: &str, names: &[String]) -> String {
    let meant = names.iter().find(|known| known.starts_with(name));
    match meant {
        Some(known) => format!("did you mean {known}?"),
        None if names.is_empty() => "it is a single number".to_owned(),
        None => format!("there are {}", names.join(", ")),
    }
}

const fn wanted(value: &Value) -> &'static str {
    match value {
        Value::Float(_) => "a number",
        Value::Integer(_) => "a whole number",
        Value::Boolean(_) => "true or false",
        Value::Array(_) => "a list of as many values as it has",
        Value::Table(_) => "a table of numbers",
        Value::String(_) | Value::Datetime(_) => "a word",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_comes_back_from_its_file_to_the_bit() {
        let text = to_text(&StageParameters::REFERENCE);
        assert_eq!(from_text(&text, &[]), Ok(StageParameters::REFERENCE));
        assert_eq!(from_text("", &[]), Ok(StageParameters::REFERENCE));
        let mut other = StageParameters::REFERENCE;
        other.plant.platform_mass_kg = 4.25;
        other.plant.pivots[1].runout_m[2][1] = 1.5e-6;
        other.encoders[2].zero_counts = 99;
        other.plant.imperfections.backlash = false;
        assert_eq!(from_text(&to_text(&other), &[]), Ok(other));
        let settings = [
            "plant.platform_mass_kg=4.25",
            "plant.pivots.1.runout_m.2.1 = 1.5e-6",
            "encoders.2.zero_counts=99",
            "plant.imperfections.backlash=false",
        ];
        assert_eq!(from_text("", &settings.map(str::to_owned)), Ok(other));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |text: &str| from_text(text, &[]).unwrap_err().to_string();
        assert_eq!(
            error("[plant]\nplatform_mass = 3"),
            "plant.platform_mass: no such number of a machine; did you mean platform_mass_kg?"
        );
        assert_eq!(
            error("[plant]\nplatform_mass_kg = -3"),
            "plant.platform_mass_kg = -3: must be from 0.1 to 50"
        );
        assert_eq!(
            error("[plant]\nplatform_mass_kg = \"heavy\""),
            "plant.platform_mass_kg: \"heavy\" is not a number"
        );
        assert_eq!(
            error("[wiring]\nport_of_ring = [0, 0, 1]"),
            "wiring.port_of_ring: must have each of 0, 1 and 2 once"
        );
        assert_eq!(
            error("[plant]\ngravity_m_s2 = [1.0]"),
            "plant.gravity_m_s2: [1.0] is not a list of as many values as it has"
        );
        assert!(error("[plant").starts_with("no machine: "));
        assert!(error("[plant]\nbacklash_rad = nan").contains("must be from"));
        let setting = |text: &str| from_text("", &[text.to_owned()]).unwrap_err().to_string();
        assert_eq!(
            setting("plant.mass"),
            "plant.mass: must be KEY=VALUE, as in plant.platform_mass_kg=3.5"
        );
        assert_eq!(
            setting("encoders.7.noise_rad=0"),
            "encoders.7: no such number of a machine; there are 0, 1, 2"
        );
        assert_eq!(
            setting("period_s.x=0"),
            "period_s.x: no such number of a machine; it is a single number"
        );
    }
}
