# SPDX-License-Identifier: Apache-2.0
"""Fits and interpolations of the report. Plain Python: testable without numpy."""
import math


def median(values):
    ordered = sorted(values)
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else 0.5 * (ordered[half - 1] + ordered[half])


def power_fit(xs, ys):
    """(factor, exponent) of y = factor x^exponent, least squares in the logarithms; needs two different positive x."""
    if len(xs) != len(ys) or len(set(xs)) < 2:
        raise ValueError("a power law needs at least two different x")
    u, v = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mean_u, mean_v = sum(u) / len(u), sum(v) / len(v)
    exponent = sum((a - mean_u) * (b - mean_v) for a, b in zip(u, v)) / sum((a - mean_u) ** 2 for a in u)
    return math.exp(mean_v - exponent * mean_u), exponent


def sampling_time_at(error, points):
    """Seconds that plain sampling needs for an error: error falls as N^-1/2 and time grows as N, so time x error^2 is one
    number, its geometric mean over the points [(error, seconds)]. Overheads that do not grow with N make the small runs
    look worse than the law, so only the points within a factor of 4 of the smallest error count."""
    good = [(e, t) for e, t in points if e > 0 and t > 0]
    if not good or error <= 0:
        return None
    smallest = min(e for e, _ in good)
    near = [(e, t) for e, t in good if e <= 4 * smallest]
    return math.exp(sum(math.log(t * e * e) for e, t in near) / len(near)) / error ** 2


def curve_at(x, points):
    """y of a curve [(x, y)] at x, linear in the logarithms between neighbours; None outside of it."""
    ordered = sorted((a, b) for a, b in points if a > 0 and b > 0)
    for (x0, y0), (x1, y1) in zip(ordered, ordered[1:]):
        if x0 <= x <= x1:
            if x0 == x1:
                return min(y0, y1)
            t = math.log(x / x0) / math.log(x1 / x0)
            return math.exp((1 - t) * math.log(y0) + t * math.log(y1))
    return ordered[0][1] if ordered and x == ordered[0][0] else None


def paid_after(bake_seconds, seconds_each, peer_seconds_each, peer_once=0.0):
    """The first number of sun positions at which bake + n x ours is no more than the peer's once + n x its own; None:
    never. Where the peer is faster a sun, it may be so for the first many positions only."""
    gain = peer_seconds_each - seconds_each
    ahead = bake_seconds - peer_once
    if ahead <= 0:
        return 0
    return math.ceil(ahead / gain) if gain > 0 else None
