//! Embeds the viewer's page where `cargo xtask viewer` has built it, so that nobody needs Node to build the rest.

use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../viewer/page");
    let page = folder.join("index.html");
    // The folder is always there; a file that isn't would have cargo build this crate again every time.
    println!("cargo::rerun-if-changed={}", folder.display());
    let source = if page.is_file() {
        println!("cargo::rerun-if-changed={}", page.display());
        let page = page.canonicalize()?.display().to_string();
        format!("Some(include_bytes!({page:?}))")
    } else {
        "None".to_owned()
    };
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo didn't set OUT_DIR"))?;
    fs::write(Path::new(&out).join("page.rs"), source)
}
