"""The functions of robots, for editors and type checkers; see `_functions.pyi`."""


class Functions:
    """Functions are found by `Robot` when they are asked for."""
