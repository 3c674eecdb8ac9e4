//! The rig reader: any text is a rig or a refusal.

use zygote_deployment::Rig;

/// Bytes as a `rig.toml`.
pub(crate) fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Rig::read("fuzz.toml", text) {
        Ok(rig) => assert!(!rig.id.is_empty(), "a rig has a name"),
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "a refusal names its file: {error}"),
    }
}
