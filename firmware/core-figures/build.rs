//! Names the linker script.

fn main() {
    println!("cargo::rustc-link-arg=-T{}/link.x", env!("CARGO_MANIFEST_DIR"));
    println!("cargo::rerun-if-changed=link.x");
}
