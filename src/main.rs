//! The program: hands the words of the command line to `cli` and its exit code to the system.

use std::panic;

/// Counts what a stage asks to be measured, and is the system's otherwise.
#[global_allocator]
static ALLOCATOR: gearstudy::cli::Allocator = gearstudy::cli::Allocator;

fn main() {
    // A panic is a bug of this program, never the user's: it gets its own exit code and asks to be reported.
    let code = panic::catch_unwind(|| gearstudy::cli::main(std::env::args_os())).unwrap_or_else(|_| {
        eprintln!("gearstudy: this is a bug; please report it with the study and the lines above");
        gearstudy::cli::BUG
    });
    std::process::exit(code);
}
