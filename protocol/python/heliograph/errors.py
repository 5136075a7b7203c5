"""What a call that is refused raises."""


class HeliographError(Exception):
    """An error that the server answered: `code` as protocol/README.md lists them, `path` the
    parameter at fault, `reason` what is wrong with it, `limit` what would be right."""

    def __init__(self, error):
        data = error.get("data") or {}
        self.code = error["code"]
        self.path = data.get("path", "")
        self.reason = data.get("reason", "")
        self.limit = data.get("limit", "")
        super().__init__(f"{error['message']} ({self.code})")
