"""A system with systemd as its first process, in namespaces and a control group of its own."""

import os
import signal
import subprocess
import time

from .commands import Skip, program, run, succeeds

OUTSIDE, INSIDE = "10.213.8.254", "10.213.8.1"
NAME = "heliograph-boot"
LINK = "hgboot"

# The mounts that a container manager prepares for systemd: /proc/sys and /sys are read-only, so that
# the machine's kernel settings cannot change.
_BOOT = r"""
set -e
cd "$0"
mount --bind . .
cd "$0"
mount -t proc proc proc
mount --bind proc/sys proc/sys
mount -o remount,bind,ro proc/sys
mount -t sysfs -o ro,nosuid,nodev,noexec sysfs sys
mount -t cgroup2 -o nosuid,nodev,noexec cgroup2 sys/fs/cgroup
mount -t tmpfs -o mode=755,nosuid,nodev tmpfs run
mount -t tmpfs -o mode=755,nosuid tmpfs dev
for device in null zero full random urandom tty; do
  touch "dev/$device"
  mount --bind "/dev/$device" "dev/$device"
done
mkdir dev/pts dev/shm
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts dev/pts
mount -t tmpfs -o mode=1777,nosuid,nodev tmpfs dev/shm
ln -s pts/ptmx dev/ptmx
ln -s /proc/self/fd dev/fd
mkdir -p mnt
pivot_root . mnt
exec chroot . /bin/sh -c 'umount -l /mnt && exec env -i container=heliograph-test \
  PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd --unit=multi-user.target'
"""


def _control_groups():
    """The mount point of control groups v2."""
    with open("/proc/mounts", encoding="utf-8") as file:
        for line in file:
            _, folder, kind, *_ = line.split()
            if kind == "cgroup2":
                return folder
    raise Skip("systemd needs control groups of the second version, which are mounted nowhere here")


class Booted:
    """A context manager. From this machine its address is INSIDE."""

    def __init__(self, system):
        self.system = system
        self._group = os.path.join(_control_groups(), NAME)
        self._process = None
        self._first = None

    def __enter__(self):
        for name in ("unshare", "nsenter", "ip", "pivot_root"):
            program(name)
        if os.path.exists(self._group):
            raise RuntimeError(f"{self._group} exists: another run of these tests is under way")
        os.mkdir(self._group)
        try:
            self._boot()
            self._connect()
            self._wait()
        except BaseException:
            self.__exit__()
            raise
        return self

    def _boot(self):
        def join():
            with open(os.path.join(self._group, "cgroup.procs"), "w", encoding="ascii") as file:
                file.write("0")

        log = os.path.join(self.system.folder, "../boot.log")
        with open(log, "w", encoding="utf-8") as file:
            self._process = subprocess.Popen(
                ["unshare", "--mount", "--uts", "--ipc", "--net", "--pid", "--cgroup", "--fork",
                 "--kill-child", "sh", "-c", _BOOT, self.system.folder], stdin=subprocess.DEVNULL,
                stdout=file, stderr=file, preexec_fn=join)
        deadline = time.monotonic() + 120
        while not self._is_systemd():
            if self._process.poll() is not None or time.monotonic() > deadline:
                with open(log, encoding="utf-8") as file:
                    raise Skip(f"systemd does not start here: {file.read()[-400:].strip()}")
            time.sleep(0.05)

    def _is_systemd(self):
        children = f"/proc/{self._process.pid}/task/{self._process.pid}/children"
        try:
            with open(children, encoding="ascii") as file:
                self._first = int(file.read().split()[0])
            with open(f"/proc/{self._first}/comm", encoding="ascii") as file:
                return file.read().strip() == "systemd"
        except (OSError, IndexError):
            return False

    def _connect(self):
        run("ip", "link", "add", LINK, "type", "veth", "peer", "name", "eth0", "netns", self._first)
        run("ip", "addr", "add", f"{OUTSIDE}/24", "dev", LINK)
        run("ip", "link", "set", LINK, "up")
        for words in ("link set lo up", f"addr add {INSIDE}/24 dev eth0", "link set eth0 up"):
            run("nsenter", f"--net=/proc/{self._first}/ns/net", "ip", *words.split())

    def _wait(self):
        """Waits until the system is up. Units that cannot work here may fail."""
        deadline = time.monotonic() + 300
        while True:
            state = self.run("systemctl", "is-system-running", check=False)
            if state in ("running", "degraded"):
                return
            if time.monotonic() > deadline:
                raise AssertionError(f"systemd is {state or 'not to be asked'} after 300 s")
            time.sleep(0.1)

    def run(self, *words, **options):
        """Runs a program inside."""
        return run("nsenter", "--target", self._first, "--mount", "--uts", "--ipc", "--net",
                   "--pid", "--cgroup", "env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
                   "DEBIAN_FRONTEND=noninteractive", *words, **options)

    def properties(self, unit, *names):
        """The properties of a unit."""
        lines = self.run("systemctl", "show", unit, "--property", ",".join(names)).splitlines()
        return dict(line.split("=", 1) for line in lines)

    def status_of(self, process):
        """/proc/PID/status of a process inside, by its inner PID: names to values."""
        lines = self.run("cat", f"/proc/{process}/status").splitlines()
        return dict(line.split(":", 1) for line in lines if ":" in line)

    def run_as(self, process, script):
        """Runs a shell script with the namespaces and the user of a process inside, without its
        system call filters."""
        user = self.status_of(process)["Uid"].split()[0]
        return self.run("nsenter", "--target", process, "--mount", "setpriv", f"--reuid={user}",
                        f"--regid={user}", "--clear-groups", "--no-new-privs",
                        "--bounding-set=-all", "sh", "-c", script)

    def __exit__(self, *_):
        if self._first and self._process.poll() is None:
            os.kill(self._first, signal.SIGRTMIN + 3)  # systemd's "halt"
            try:
                self._process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                pass
        if self._process and self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        run("ip", "link", "del", LINK, check=False)
        self._remove_groups()

    def _remove_groups(self):
        """Control groups become empty when their last process has exited."""
        deadline = time.monotonic() + 10
        while os.path.exists(self._group) and time.monotonic() < deadline:
            for folder, _, _ in os.walk(self._group, topdown=False):
                succeeds("rmdir", folder)
            time.sleep(0.05)
