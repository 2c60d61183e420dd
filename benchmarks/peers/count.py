"""Operation counts by one rule for all.

A sum of n terms counts n - 1, a product of n factors n - 1, a product with a sign one, a square 1. Square
roots, sine-cosine pairs, arc tangents, signs and negations are counted separately.
"""

from dataclasses import dataclass


@dataclass
class Count:
    """Operations of one function."""

    additions: int = 0
    multiplications: int = 0
    divisions: int = 0
    square_roots: int = 0
    trigonometric_pairs: int = 0
    arc_tangents: int = 0
    signs: int = 0
    negations: int = 0
    # Operations of legs in SIMD lanes, in place of the straight program's.
    side_by_side: int = 0

    @property
    def operations(self):
        if self.side_by_side:
            return self.side_by_side
        return self.additions + self.multiplications + self.divisions

    def add(self, kind, times=1):
        setattr(self, kind, getattr(self, kind) + times)

    @classmethod
    def from_json(cls, function):
        """Counts of overact's own function, as printed by `overact inspect --json`."""
        keys = ["additions", "multiplications", "divisions", "square_roots", "trigonometric_pairs"]
        counts = {key: function[key] for key in [*keys, "arc_tangents", "signs"]}
        # The default: other numbers of lanes than two require processor flags.
        beside = function.get("side_by_side")
        if beside and beside["lanes"] <= 2:
            counts["side_by_side"] = beside["once"] + beside["legs"] * beside["each"]
        return cls(**counts)
