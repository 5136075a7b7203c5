"""Paired tests over seeds: is a difference larger than the noise of random sequences?"""

import dataclasses
import math

import numpy
from scipy import stats


@dataclasses.dataclass(frozen=True)
class Test:
    mean: float
    low: float    # 95 % confidence interval of the mean
    high: float
    p: float      # of the null hypothesis of the test, one-sided
    count: int


def interval(differences, confidence=0.95):
    values = numpy.asarray(differences, float)
    mean = float(values.mean())
    if len(values) < 2:
        return mean, -math.inf, math.inf, math.inf
    error = float(values.std(ddof=1)) / math.sqrt(len(values))
    reach = float(stats.t.ppf(0.5 + confidence / 2.0, len(values) - 1)) * error
    return mean, mean - reach, mean + reach, error


def rises(differences):
    """p of a mean that is not above zero (Student's t, one-sided)."""
    mean, low, high, error = interval(differences)
    return Test(mean, low, high, upper_tail(mean, error, len(differences)), len(differences))


def falls(differences):
    """p of a mean that is not below zero."""
    mean, low, high, error = interval(differences)
    return Test(mean, low, high, upper_tail(-mean, error, len(differences)), len(differences))


def similar(differences, margin):
    """p of a mean outside of +-margin: two one-sided tests (Schuirmann 1987)."""
    mean, low, high, error = interval(differences)
    count = len(differences)
    p = max(upper_tail(margin + mean, error, count), upper_tail(margin - mean, error, count))
    return Test(mean, low, high, p, count)


def different(differences):
    """p of a mean of zero, two-sided."""
    test = rises(differences)
    return dataclasses.replace(test, p=min(1.0, 2.0 * min(test.p, 1.0 - test.p)))


def upper_tail(distance, error, count):
    if not math.isfinite(error):
        return math.nan
    if error == 0.0:
        return 0.0 if distance > 0.0 else 1.0
    return float(stats.t.sf(distance / error, count - 1))


def slope(x, y):
    """Least squares."""
    return float(numpy.polyfit(numpy.asarray(x, float), numpy.asarray(y, float), 1)[0])
