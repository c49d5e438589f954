"""Mass fractions and shares of the strain: positive numbers with a given sum.

Rational fractions are numbers; each other distinct value becomes one generator of a python-flint
ring, less one, since the fractions sum to the whole.
"""

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
    (total P).
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
            of = {
                w: context.constant(to_flint(f))
                for w, f in zip(self.distinct, self.values, strict=True)
            }
        else:
            free = [context.gen(context.variable_to_index(name)) for name in self.names]
            of = dict(zip(self.distinct, free, strict=False))
            rest = context.constant(self.total)
            for weight, f in of.items():
                rest = rest - self.weights.count(weight) * f
            last = self.distinct[-1]
            of[last] = rest / self.weights.count(last)
        return [of[w] for w in self.weights]
