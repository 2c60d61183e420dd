"""The functions of robots, for editors and type checkers; see `_functions.pyi`."""


class Functions:
    """`Robot` creates functions on first access."""
