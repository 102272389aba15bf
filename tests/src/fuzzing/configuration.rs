//! Configurations.

use meniscus::configuration::Configuration;
use meniscus::memory;

/// The bytes of a file, or `preset ` and the name of one, then, each after a zero byte, overrides. A refusal is one line;
/// what is accepted holds valid parameters and a finite end, can be told and estimated, and reads back equal when written,
/// also when an override repeats what is written.
pub fn configuration(data: &[u8]) {
    let mut parts = data.split(|&byte| byte == 0);
    let file = parts.next().unwrap_or_default();
    let overrides: Vec<String> = parts.map(|part| String::from_utf8_lossy(part).into_owned()).collect();
    let read = match file.strip_prefix(b"preset ") {
        Some(name) => Configuration::from_preset(&String::from_utf8_lossy(name), &overrides),
        None => Configuration::from_bytes("any.toml", file, &overrides),
    };
    let configuration = match read {
        Ok(configuration) => configuration,
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains(char::is_control), "{message:?}");
            return;
        }
    };
    assert_eq!(configuration.parameters().validate(), Ok(()));
    assert!(configuration.end_time().is_finite() && configuration.end_time() >= 0.0);
    let told = [configuration.scheme_line(), configuration.mesh_refresh_line().unwrap_or_default()];
    assert!(told.iter().all(|line| !line.contains(char::is_control)), "{told:?}");
    let (particles, grid) = (configuration.system.particles as u64, configuration.mesh.grid as u64);
    assert!(memory::estimate(&configuration) >= 4 * grid * grid + 56 * particles);
    let text = configuration.to_toml();
    let seed = format!("seed={}", configuration.seed);
    assert_eq!(Configuration::from_text("written.toml", &text, &[seed]).as_ref(), Ok(&configuration));
    let again = Configuration::from_text("written.toml", &text, &[]);
    assert_eq!(again.as_ref(), Ok(&configuration), "{text}");
    assert_eq!(again.map(|again| again.to_toml()), Ok(text));
}
