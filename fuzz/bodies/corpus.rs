//! Replays a target's corpus: what `cargo test` does with the inputs that fuzzing found.

use std::path::Path;

/// Gives every file of a target's corpus to its body, in the order of names.
pub(crate) fn replay(manifest_dir: &str, up: &str, target: &str, check: fn(&[u8])) {
    let folder = Path::new(manifest_dir).join(up).join("fuzz/corpus").join(target);
    let mut paths: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(paths.len() > 2, "{}: only {} inputs", folder.display(), paths.len());
    for path in paths {
        let input = std::fs::read(&path).unwrap();
        // Shown only when the input fails.
        println!("{}", path.display());
        check(&input);
    }
}
