"""The paper's statements about quality, each tested on our data: pairs with the same seed."""

import dataclasses
import math

import paired
import paper
import reasons

SIGNIFICANT = 0.05
REPRODUCED, NOT_REPRODUCED, OPEN = "reproduced", "not reproduced", "not decided"


@dataclasses.dataclass(frozen=True)
class Outcome:
    key: str
    figure: int
    statement: str
    test: str        # what was tested, in words
    change: str      # the mean and its 95 % confidence interval
    p: float
    verdict: str
    why: str


def figure_of(finding):
    return next(figure for figure in paper.QUALITY if figure.number == finding.figure)


def differences_by_seed(results, finding, movement):
    """{value: {seed: after - before}} of what the finding is about."""
    figure = figure_of(finding)
    before = results.quality("sweep", figure.scene, movement, figure.before, finding.measure)
    after = results.quality("sweep", figure.scene, movement, figure.after, finding.measure)
    chosen = [value for value in after if value in before
              and (not finding.values or value in finding.values)]
    return {value: {seed: after[value][seed] - before[value][seed]
                    for seed in after[value] if seed in before[value]} for value in chosen}


def mean_by_seed(tables):
    """{seed: mean} over the values of {value: {seed: number}} tables: one number per seed."""
    sums = {}
    for table in tables:
        for of_seeds in table.values():
            for seed, number in of_seeds.items():
                sums.setdefault(seed, []).append(number)
    return {seed: sum(numbers) / len(numbers) for seed, numbers in sums.items()}


def change_of(results, finding):
    return mean_by_seed([differences_by_seed(results, finding, movement)
                         for movement in finding.movements])


def minus(first, second):
    return [first[seed] - second[seed] for seed in first if seed in second]


def against_static(results, finding):
    """Per seed: the change with the movement less the change in a static view."""
    still = dataclasses.replace(finding, movements=("static",))
    return minus(change_of(results, finding), change_of(results, still))


def level_against_static(results, finding):
    """Per seed: what the technique reaches with the movement less what it does in a static view."""
    figure = figure_of(finding)

    def level(movement):
        return mean_by_seed([results.quality("sweep", figure.scene, movement, figure.after,
                                             finding.measure)])
    return minus(level(finding.movements[0]), level("static"))


def slopes(results, finding):
    """Per seed: the slope of the change along the swept value."""
    table = differences_by_seed(results, finding, finding.movements[0])
    seeds = {seed for of_seeds in table.values() for seed in of_seeds}
    return [paired.slope(list(table), [table[value][seed] for value in table])
            for seed in sorted(seeds) if len(table) > 1]


TESTS = {
    "rises": (lambda r, f: list(change_of(r, f).values()), "the change is above 0"),
    "falls": (lambda r, f: list(change_of(r, f).values()), "the change is below 0"),
    "similar": (lambda r, f: list(change_of(r, f).values()),
                "each change lies within ±{margin:g}; the one that is least so"),
    "more_in_motion": (against_static, "the change is larger than in a static view"),
    "lower_in_motion": (level_against_static, "the level is below that of a static view"),
    "falls_along": (slopes, "the change falls along the swept value, per unit"),
}
DOWNWARD = ("falls", "lower_in_motion", "falls_along")


def least_similar(results, finding):
    """Similar means: at each value with each movement. The test of the one that is least so."""
    tests = [paired.similar(list(of_seeds.values()), finding.margin)
             for movement in finding.movements
             for of_seeds in differences_by_seed(results, finding, movement).values()]
    return max(tests, key=lambda test: (test.p >= SIGNIFICANT, abs(test.mean)), default=None)


def run_test(finding, differences):
    if finding.kind in DOWNWARD:
        return paired.falls(differences)
    return paired.rises(differences)


def words(finding):
    values = ", ".join(f"{value:g}" for value in finding.values) or "all values"
    movements = " and ".join(paper.MOVEMENT_TITLES[m] for m in finding.movements)
    if finding.movements == tuple(paper.MOVEMENT_TITLES):
        movements = "all movements"
    text = TESTS[finding.kind][1].format(margin=finding.margin)
    return f"{finding.measure}, {movements}, {values}: {text}"


def verdict_of(test):
    if math.isnan(test.p):
        return OPEN
    return REPRODUCED if test.p < SIGNIFICANT else NOT_REPRODUCED


def observed(kind, test, margin=0.0):
    """What the data say where a statement is not reproduced."""
    if kind == "similar":
        return (f"The change is larger than ±{margin:g}." if abs(test.mean) > margin
                else "The seeds scatter too much to tell.")
    opposite = test.low > 0.0 if kind in DOWNWARD else test.high < 0.0
    return ("The change goes the other way." if opposite
            else "There is no change beyond the noise of the seeds.")


def explanation(key, verdict, kind, test, margin=0.0):
    if verdict == OPEN:
        return "The seeds of this run are too few."
    said = observed(kind, test, margin) if verdict == NOT_REPRODUCED else ""
    return f"{said} {reasons.why(key, verdict)}".strip()


def evaluate(results):
    outcomes = []
    for finding in paper.FINDINGS:
        differences = TESTS[finding.kind][0](results, finding)
        if not differences:
            outcomes.append(Outcome(finding.key, finding.figure, finding.statement, words(finding),
                                    "not measured", math.nan, OPEN, "These values were not part "
                                    "of this run."))
            continue
        test = (least_similar(results, finding) if finding.kind == "similar"
                else run_test(finding, differences))
        verdict = verdict_of(test)
        change = f"{test.mean:+.4f}"
        if test.count > 1:
            change += f" ({test.low:+.4f} to {test.high:+.4f}, {test.count} seeds)"
        outcomes.append(Outcome(finding.key, finding.figure, finding.statement, words(finding),
                                change, test.p, verdict,
                                explanation(finding.key, verdict, finding.kind, test,
                                            finding.margin)))
    return outcomes
