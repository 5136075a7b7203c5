"""The table of faults that the library heliograph_faults (tests/faults) shares with a server that it
is loaded into: which calls fail, how, and how often it happened."""

import contextlib
import errno
import mmap
import os
import struct
import tempfile
import unittest

from harness.server import Server

# struct Row of tests/faults/fault_table.hpp
ROW = struct.Struct("<32s32sQQIiQQq16x")
FILTER, CALLS, ARMED = 32, 64, 80

OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, DEVICE_LOST = -1, -2, -4  # VkResult
ALL_CALLS = 1 << 60


def fault_library():
    """The path of the library; skips the test where there is none, as in builds with sanitizers."""
    library = os.environ.get("HELIOGRAPH_FAULT_LIBRARY")
    if not library:
        raise unittest.SkipTest("HELIOGRAPH_FAULT_LIBRARY is not set")
    return library


class FaultTable:
    def __init__(self):
        self._file = tempfile.NamedTemporaryFile(prefix="faults")
        self._file.truncate(1 << 16)
        self._memory = mmap.mmap(self._file.fileno(), 1 << 16)
        self._rows = {}

    @property
    def environment(self):
        return {"LD_PRELOAD": fault_library(), "HELIOGRAPH_TEST_FAULT_TABLE": self._file.name}

    def close(self):
        self._memory.close()
        self._file.close()

    def _row(self, function):
        if function not in self._rows:
            for at in range(0, len(self._memory) - ROW.size, ROW.size):
                name = self._memory[at:at + FILTER].split(b"\0")[0].decode()
                if name:
                    self._rows[name] = at
        return self._rows[function]

    @property
    def functions(self):
        self._row("open")
        return list(self._rows)

    def arm(self, function, first=1, error=0, *, times=1, amount=0, only=""):
        """Lets the calls from `first` on fail with `error`, or do only `amount`; 0: counts them.
        `only`: those on files with such a path, or from libraries of such a name."""
        at = self._row(function)
        self.disarm(function)
        name = self._memory[at:at + FILTER]
        self._memory[at:at + ROW.size] = ROW.pack(
            name, only.encode(), 0, 0, 0, error, first, times, amount)
        self._memory[at + ARMED] = 1

    def disarm(self, function):
        """Gives the calls that were counted and those that failed."""
        at = self._row(function)
        self._memory[at + ARMED] = 0
        return struct.unpack_from("<QQ", self._memory, at + CALLS)

    @contextlib.contextmanager
    def fault(self, function, first=1, error=0, **rule):
        """Within the block calls fail; gives a list that holds the counts after it."""
        counts = []
        self.arm(function, first, error, **rule)
        try:
            yield counts
        finally:
            counts.extend(self.disarm(function))


class FaultyServer(Server):
    """A server whose calls a table can let fail."""

    def __init__(self, *arguments, faults="", **more):
        self.faults = FaultTable()
        environment = {**self.faults.environment, **more.pop("environment", {}),
                       "HELIOGRAPH_TEST_FAULTS": faults}
        super().__init__(*arguments, environment=environment, **more)

    def __exit__(self, *exception):
        super().__exit__(*exception)
        self.faults.close()

    def open_files(self):
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def threads(self):
        return len(os.listdir(f"/proc/{self.process.pid}/task"))


def rule(function, first, error, only=""):
    """A rule for the environment variable, which holds from the start of the program."""
    return f"{function}{'@' + only if only else ''}:{first}:{error}"


__all__ = ["DEVICE_LOST", "ALL_CALLS", "FaultTable", "FaultyServer", "OUT_OF_DEVICE_MEMORY",
           "OUT_OF_HOST_MEMORY", "errno", "fault_library", "rule"]
