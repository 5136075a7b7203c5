"""The exception of refused calls."""


class HeliographError(Exception):
    """An error answered by the server: `code` as listed in protocol/README.md, `path` the invalid
    parameter, `reason` what is wrong with it, `limit` what would be valid."""

    def __init__(self, error):
        data = error.get("data") or {}
        self.code = error["code"]
        self.path = data.get("path", "")
        self.reason = data.get("reason", "")
        self.limit = data.get("limit", "")
        super().__init__(f"{error['message']} ({self.code})")
