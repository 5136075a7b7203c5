"""Why a statement of the paper holds in this renderer, or does not: what we know of the cause."""

HOLDS = {}
HOLDS_NOT = {}


def why(key, verdict):
    """@return the empty text where we know no cause"""
    return (HOLDS if verdict == "reproduced" else HOLDS_NOT).get(key, "")
