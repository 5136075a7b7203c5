"""The server under deploy/seccomp.json, as a container engine applies it."""

import ctypes
import json
import os
import shlex
import stat
import sys
import tempfile
import unittest

from harness.server import Server

PROFILE = os.path.join(os.path.dirname(__file__), "../../../deploy/seccomp.json")
ALLOW, ERRNO = 0x7FFF0000, 0x00050000
COMPARISONS = {"SCMP_CMP_EQ": 4, "SCMP_CMP_MASKED_EQ": 7}


class Argument(ctypes.Structure):
    _fields_ = [("index", ctypes.c_uint), ("op", ctypes.c_int), ("first", ctypes.c_uint64),
                ("second", ctypes.c_uint64)]


def library():
    try:
        found = ctypes.CDLL("libseccomp.so.2")
    except OSError as missing:
        raise unittest.SkipTest(str(missing)) from missing
    found.seccomp_init.restype = ctypes.c_void_p
    found.seccomp_rule_add_array.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int,
                                             ctypes.c_uint, ctypes.c_void_p]
    found.seccomp_load.argtypes = [ctypes.c_void_p]
    return found


def action_of(entry):
    return ALLOW if entry["action"] == "SCMP_ACT_ALLOW" else ERRNO | entry["errnoRet"]


def apply(profile):
    """Restricts this process, and what it becomes."""
    seccomp = library()
    context = seccomp.seccomp_init(ERRNO | profile["defaultErrnoRet"])
    for entry in profile["syscalls"]:
        arguments = [Argument(one["index"], COMPARISONS[one["op"]], one["value"],
                              one.get("valueTwo", 0)) for one in entry.get("args", [])]
        array = (Argument * max(len(arguments), 1))(*arguments)
        for name in entry["names"]:
            number = seccomp.seccomp_syscall_resolve_name(name.encode())
            # Engines leave out what another processor has.
            if number >= 0 and seccomp.seccomp_rule_add_array(
                    context, action_of(entry), number, len(arguments), array) != 0:
                raise OSError(f"no rule for {name}")
    if seccomp.seccomp_load(context) != 0:
        raise OSError("the profile cannot be loaded")


def read_profile():
    with open(PROFILE, encoding="utf-8") as file:
        return json.load(file)


class Profile(unittest.TestCase):
    def test_it_refuses_what_no_server_needs(self):
        profile = read_profile()
        self.assertEqual(profile["defaultAction"], "SCMP_ACT_ERRNO")
        allowed = {name for entry in profile["syscalls"] if entry["action"] == "SCMP_ACT_ALLOW"
                   for name in entry["names"]}
        for name in ("mount", "unshare", "setns", "ptrace", "bpf", "keyctl", "init_module", "reboot",
                     "perf_event_open", "userfaultfd", "io_uring_setup", "setuid", "process_vm_readv"):
            self.assertNotIn(name, allowed)

    def test_the_server_streams_imports_and_renders_jobs_under_it(self):
        library()
        with tempfile.TemporaryDirectory() as folder:
            wrapper = os.path.join(folder, "restricted")
            with open(wrapper, "w", encoding="utf-8") as file:
                file.write(f'#!/bin/sh\nexport PYTHONPATH={shlex.quote(os.pathsep.join(sys.path))}\n'
                           f'exec {shlex.quote(sys.executable)} {shlex.quote(__file__)} '
                           f'{shlex.quote(os.environ["HELIOGRAPH_BINARY"])} "$@"\n')
            os.chmod(wrapper, stat.S_IRWXU)
            with Server("--uploads", folder + "/uploads", "--jobs", folder + "/jobs",
                        binary=wrapper) as server:
                self.use(server)

    def use(self, server):
        self.assertGreaterEqual(server.call("frame.capture", {"samples": 1})["samples"], 1)
        with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
            self.assertEqual(server.request("PUT", "/api/v1/scenes/up", file.read())[0], 201)
        self.assertNotIn("not restricted", server.log_text())
        entry = {"scene": "up", "width": 16, "height": 16, "samples": 1}
        job = server.call("job.create", {"entries": [entry]})["job"]
        server.wait_for(lambda: server.call("job.status", {"job": job})["state"] == "done",
                        "the end of the job", timeout=60)
        with open(f"/proc/{server.process.pid}/status", encoding="ascii") as file:
            self.assertIn("Seccomp:\t2", file.read())


if __name__ == "__main__":
    apply(read_profile())
    os.execv(sys.argv[1], sys.argv[1:])
