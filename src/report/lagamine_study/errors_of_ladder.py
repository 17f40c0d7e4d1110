"""Errors of the runs of a ladder: against what is exact, what Richardson's extrapolation says, or the finest run; orders and costs."""
import math
from dataclasses import dataclass
from typing import List, Optional, Sequence

FEWEST, MOST = 0.3, 8.0      # orders between three runs that may be extrapolated
SLOWEST = 0.98               # errors that fall by less do not converge
ROUND_OFF = 1e-10            # of errors: no order, no cost


@dataclass
class Verdict:
    """Truth and where it comes from; errors of the runs over it (as they are where it is 0), orders between neighbours, cost of half the error;
    not a number: unknown."""

    truth: float
    source: str
    errors: List[float]
    orders: List[float]
    half_costs: float

    @property
    def percent(self) -> float:
        """What errors are shown times: those over the truth in percent, others as they are."""
        return 100.0 if self.truth else 1.0


def judge(values: Sequence[float], ratios: Sequence[Optional[float]], seconds: Sequence[float], exact: Optional[float]) -> Verdict:
    """Of runs from the coarsest to the finest."""
    truth, source = _truth(values, ratios, exact)
    scale = abs(truth) if truth else 1.0
    errors = [abs(value - truth) / scale for value in values]
    if source == "the finest run":
        # the finest that reached its end is its own measure
        for k in [k for k, value in enumerate(values) if math.isfinite(value)][-1:]:
            errors[k] = float("nan")
    orders = [_order(a, b, ratio) for a, b, ratio in zip(errors, errors[1:], ratios)]
    return Verdict(truth, source, errors, orders, _half_costs(errors, seconds))


def _truth(values: Sequence[float], ratios: Sequence[Optional[float]], exact: Optional[float]):
    if exact is not None:
        return exact, "given"
    known = [value for value in values if math.isfinite(value)]
    if len(known) == len(values) >= 3 and ratios[-1] and ratios[-2] and abs(ratios[-1] / ratios[-2] - 1) < 0.01:
        a, b, c = values[-3:]
        if (a - b) * (b - c) > 0 and abs(b - c) > ROUND_OFF * abs(c):
            order = math.log((a - b) / (b - c)) / math.log(ratios[-1])
            if FEWEST <= order <= MOST:
                return c + (c - b) / (ratios[-1]**order - 1), f"Richardson's extrapolation, order {order:.2f}"
    return (known[-1] if known else float("nan")), "the finest run"


def _order(coarse: float, fine: float, ratio: Optional[float]) -> float:
    if not ratio or not (coarse > ROUND_OFF and fine > ROUND_OFF):
        return float("nan")
    return math.log(coarse / fine) / math.log(ratio)


def _half_costs(errors: Sequence[float], seconds: Sequence[float]) -> float:
    """By how much the time grows while the error is halved, over the last two runs whose errors fall."""
    known = [(error, time) for error, time in zip(errors, seconds) if error > ROUND_OFF and time > 0]
    for (coarse, before), (fine, after) in zip(known[-2::-1], known[:0:-1]):
        if fine < SLOWEST * coarse and after > before:
            return 2**(math.log(after / before) / math.log(coarse / fine))
    return float("nan")
