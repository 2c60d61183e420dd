"""The same tasks as overact's with other tools: models, operation counts, times.

The derivation in this package shares only the TOML descriptions with the Rust crates. Comparing results
therefore checks both.
"""
