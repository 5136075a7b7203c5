"""The paper's statements about time, tested on our pass times: pairs with the same swept value."""

import math

import paired
import paper
import reasons
from findings import NOT_REPRODUCED, OPEN, REPRODUCED, Outcome, explanation, verdict_of
from time_charts import CHANNELS, nearest, stage_curve

SHADOWS, REFLECTIONS = "breakfast_room", "cubes_distance"


def changes(results, scene, before, after, stages):
    """ms with the technique less ms without it, for each swept value."""
    without = dict(zip(*stage_curve(results, scene, before, stages)))
    having = dict(zip(*stage_curve(results, scene, after, stages)))
    return [(having[value] - without[value], without[value]) for value in having
            if value in without]


def relative(pairs):
    return [difference / before for difference, before in pairs if before > 0.0]


def outcome(key, figure, statement, words, test, kind, margin=0.0):
    """test: of relative changes"""
    if test is None:
        return Outcome(key, figure, statement, words, "not measured", math.nan, OPEN,
                       "These times were not part of this run.")
    verdict = verdict_of(test)
    change = (f"{100.0 * test.mean:+.1f} % ({100.0 * test.low:+.1f} to "
              f"{100.0 * test.high:+.1f}, {test.count} pairs)")
    return Outcome(key, figure, statement, words, change, test.p, verdict,
                   explanation(key, verdict, kind, test, margin))


def tested(differences, test, *options):
    return test(differences, *options) if len(differences) > 1 else None


def step(results, scene, before, after, part):
    stages = CHANNELS[scene] if part is None else [CHANNELS[scene][part]]
    return relative(changes(results, scene, before, after, stages))


def blur_iterations(results):
    passes = nearest(results.pass_times(REFLECTIONS, "svgf"), paper.BLUR_ROUGHNESS)
    times = [passes.get(f"specular.atrous.{level}") for level in range(4)]
    statement = "All blur iterations take a similar time (1.93, 1.87, 1.86, 1.86 ms)"
    if not all(times):
        return outcome("12-iterations", 12, statement, "", None, "similar")
    mean = sum(times) / 4.0
    spread = (max(times) - min(times)) / mean
    verdict = REPRODUCED if spread < 0.15 else NOT_REPRODUCED
    numbers = ", ".join(f"{ms:.2f}" for ms in times)
    return Outcome("12-iterations", 12, statement,
                   "slowest less fastest iteration, of their mean: below 15 % (no test)",
                   f"{numbers} ms: {100.0 * spread:.0f} %", math.nan, verdict,
                   reasons.why("12-iterations", verdict))


def trace_over_roughness(results):
    """Slope over roughness of the time of reflection rays, for each step of the ladder."""
    slopes = []
    for preset in ("svgf", "rectification", "adapted", "separable", "reinhard"):
        x, y = stage_curve(results, REFLECTIONS, preset, ["reflection rays"])
        if len(x) > 1 and sum(y) > 0.0:
            slopes.append(paired.slope(x, y) / (sum(y) / len(y)))
    return slopes


def evaluate(results):
    found = []
    for scene, figure, light in ((REFLECTIONS, 12, "reflections"), (SHADOWS, 13, "shadows")):
        found.append(outcome(
            f"{figure}-slower", figure, f"History rectification slightly increases the time of "
            f"{light}", "time of the channel: the change is above 0",
            tested(step(results, scene, "svgf", "rectification", None), paired.rises), "rises"))
    found.append(blur_iterations(results))
    found.append(outcome(
        "12-divergence", 12, "Ray tracing takes longer as roughness rises",
        "slope of the time of reflection rays, of its mean per unit of roughness: above 0",
        tested(trace_over_roughness(results), paired.rises), "rises"))
    found.append(outcome(
        "14-slower", 14, "Adapted blur: slightly slower reflections",
        "time of reflection blur: the change is above 0",
        tested(step(results, REFLECTIONS, "rectification", "adapted", 2), paired.rises), "rises"))
    found.append(outcome(
        "15-similar", 15, "Adapted blur: shadows stay similar",
        "time of shadow blur: the change lies within ±10 %",
        tested(step(results, SHADOWS, "rectification", "adapted", 2), paired.similar, 0.1),
        "similar", 0.1))
    for scene, figure, light in ((REFLECTIONS, 16, "reflections"), (SHADOWS, 17, "shadows")):
        found.append(outcome(
            f"{figure}-faster", figure, f"Separable blur greatly improves the time of {light}",
            "time of the blur: the change is below 0",
            tested(step(results, scene, "adapted", "separable", 2), paired.falls), "falls"))
    rates = {scene: results.rates(scene, "reinhard") for scene in paper.RATES}
    rates = {scene: rate for scene, rate in rates.items() if rate}
    if rates:
        slow = [paper.SCENE_TITLES[scene] for scene, rate in rates.items() if rate[1] <= 30.0]
        verdict = NOT_REPRODUCED if slow else REPRODUCED
        found.append(Outcome(
            "tables-30", 1, "Tables 1 and 2: every scene is faster than 30 frames per second",
            "mean of both movements, on this machine at this size (no test)",
            ", ".join(f"{paper.SCENE_TITLES[s]} {r[1]:.0f}" for s, r in rates.items()), math.nan,
            verdict, reasons.why("tables-30", verdict)))
    return found
