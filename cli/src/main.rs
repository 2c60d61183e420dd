//! The command `overact`; everything is in the library.

fn main() -> std::process::ExitCode {
    overact_cli::run()
}
