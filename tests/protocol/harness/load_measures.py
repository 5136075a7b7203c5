"""Latencies that are counted from when an input was due, whether the sender or the server was late."""

import bisect
import math
from dataclasses import dataclass

SHARES = (0.5, 0.9, 0.99, 0.999)


@dataclass
class Input:
    due: float  # time.monotonic()
    rev: int = None  # of the session, by the answer


@dataclass
class Latency:
    due: float
    seconds: float
    shown: bool = True  # False: it was not, and this is how long it was waited for


def latencies_of(inputs, frames, end):
    """From each input to the first frame of its revision or a newer one, of one viewer. Frames that
    are left out show their inputs with the next one; inputs without a frame count until the end."""
    revisions = [frame.state_rev for frame in frames]
    found = []
    for one in inputs:
        first = bisect.bisect_left(revisions, one.rev) if one.rev is not None else len(frames)
        shown = first < len(frames)
        found.append(Latency(one.due, (frames[first].at if shown else end) - one.due, shown))
    return found


def percentile(values, share):
    """The least value that so many are not above."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def histogram(values, bars=(0.025, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2)):
    """Counts up to each bar, the rest last."""
    counts = [0] * (len(bars) + 1)
    for value in values:
        counts[bisect.bisect_left(bars, value)] += 1
    return [*zip([f"{bar * 1000:.0f}" for bar in bars], counts), ("more", counts[-1])]


def describe(values):
    values = list(values)
    if not values:
        return "none"
    shares = ", ".join(f"p{100 * share:g} {1000 * percentile(values, share):.0f}" for share in SHARES)
    return f"{shares}, most {1000 * max(values):.0f} ms of {len(values)}"


def recovered_after(latencies, end, normal, row):
    """Seconds from `end` until so many inputs in a row, due after it, had normal latencies; infinite
    if there were none."""
    later = [one for one in latencies if one.due >= end]
    for first in range(len(later) - row + 1):
        if all(one.seconds <= normal for one in later[first:first + row]):
            return later[first].due + later[first].seconds - end
    return math.inf
