"""Mass fractions and shares of the strain: positive numbers with a given sum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp
from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lwa.algebra.rational import factored, to_flint
from lwa.base.frozen import Value


@dataclass(frozen=True)
class Partition(Value):
    """Positive weights w_i that enter by their fractions f_i = total · w_i / Σ_j w_j only.

    The masses of a cell are such weights (total 1), and so are the compliances of its contacts
    (total P). Rational fractions are numbers; else each distinct fraction but the last is a
    generator of a python-flint ring.
    """

    weights: tuple[sp.Expr, ...]
    total: int
    letter: str

    @cached_property
    def distinct(self) -> tuple[sp.Expr, ...]:
        """The distinct weights, in the order of their first appearance."""
        return tuple(dict.fromkeys(self.weights))

    @cached_property
    def sum(self) -> sp.Expr:
        """The sum Σ w_i of the weights."""
        return sp.Add(*self.weights)

    @cached_property
    def values(self) -> tuple[sp.Expr, ...] | None:
        """The fraction f_i of each distinct weight if all are rational, else None."""
        first = self.distinct[0]
        ratios = [w / first if w.is_number else factored(w / first) for w in self.weights]
        if not all(ratio.is_Rational for ratio in ratios):
            return None
        return tuple(self.total * w / first / sp.Add(*ratios) for w in self.distinct)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ring generators: one per distinct weight but the last."""
        count = 0 if self.values else len(self.distinct) - 1
        return tuple(f"{self.letter}{i}" for i in range(count))

    def elements(self, context: fmpq_mpoly_ctx) -> list[fmpq_mpoly]:
        """The fractions f_0, f_1, … in a ring that has `names` among its generators."""
        if self.values:
            fractions = [context.constant(to_flint(f)) for f in self.values]
        else:
            fractions = [context.gen(context.variable_to_index(name)) for name in self.names]
            rest = context.constant(self.total)
            for weight, f in zip(self.distinct, fractions, strict=False):
                rest = rest - self.weights.count(weight) * f
            fractions.append(rest / self.weights.count(self.distinct[-1]))
        by_weight = dict(zip(self.distinct, fractions, strict=True))
        return [by_weight[w] for w in self.weights]
