"""The same work as overact's, done with other tools: models, operation counts, times.

The derivation in this package shares nothing with the Rust crates but the TOML descriptions, so that the
comparison of results is a check of both sides.
"""
