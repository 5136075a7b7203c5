"""Why a statement of the paper holds in this renderer, or does not."""

HOLDS = {}
HOLDS_NOT = {}
UNDECIDED = "The seeds of this run are too few."


def why(key, verdict):
    return {"reproduced": HOLDS.get(key, ""),
            "not reproduced": HOLDS_NOT.get(key, "")}.get(verdict, UNDECIDED)
