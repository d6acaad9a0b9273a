//! Tells the linker of the images where `memory.x` lies and what stands in RAM, and cargo to link again when that changes.

fn main() {
    let here = env!("CARGO_MANIFEST_DIR");
    println!("cargo:rerun-if-changed={here}/../memory.x");
    println!("cargo:rerun-if-changed={here}/control-loop.x");
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-link-search={here}/..");
    if std::env::var_os("CARGO_FEATURE_STAGE").is_some() {
        for board in ["stage", "stage-nucleo"] {
            println!("cargo:rustc-link-arg-bin={board}=-T{here}/control-loop.x");
        }
    }
}
