"""Plays a history of random clients on a server and compares it with the model of the contract."""

import asyncio
import contextlib
import json
import time

from harness.contract_model import FORBIDDEN, HTTP, NOT_READY, Broken, SessionModel, require
from harness.server import declared_errors
from harness.viewer import Viewer

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"
VIEWERS = {"ada": CONTROL, "bob": CONTROL, "eve": VIEW, "slow": CONTROL}
MOST_UNACKNOWLEDGED = 8  # protocol/README.md: 2, up to 8 on links with high latency
STEP_TIMEOUT = 15  # seconds


class Play:
    """One history, in two sessions of its own."""

    def __init__(self, server, name, methods):
        self.server = server
        self.name = name
        self.methods = methods
        self.sessions = [SessionModel(f"{name}-{i}") for i in range(2)]
        self.viewers = {}  # actor -> Viewer
        self.place = {}  # actor -> its session's number
        self.paused = set()
        self.acknowledged = 0  # by the one that does so rarely

    async def run(self, history):
        try:
            for number in range(2):
                await self.create(number)
            for actor in VIEWERS:
                await self.connect(actor, 0)
            for number, step in enumerate(history):
                try:
                    await asyncio.wait_for(self.take(*step), STEP_TIMEOUT)
                except Broken as broken:
                    raise Broken(f"step {number}, {step}: {broken}") from broken
                except asyncio.TimeoutError as late:
                    raise Broken(f"step {number}, {step}: not finished in {STEP_TIMEOUT} s") from late
                self.check_streams()
            await self.settle()
        finally:
            for viewer in self.viewers.values():
                with contextlib.suppress(Exception):
                    await viewer.__aexit__()
            for session in self.sessions:
                await self.http("session.close", {"session": session.name}, CONTROL, "main")

    # Connections.

    async def create(self, number):
        name = self.sessions[number].name
        info = await self.http("session.create", {
            "name": name, "copy_of": "main", "width": 48, "height": 32}, CONTROL, "main")
        require("result" in info, f"session.create: {info}")
        self.sessions[number] = SessionModel(name)

    async def connect(self, actor, number):
        session = self.sessions[number]
        viewer = Viewer(self.server, session=session.name, token=VIEWERS[actor],
                        acknowledge=actor != "slow")
        self.viewers[actor] = await viewer.__aenter__()
        self.place[actor] = number
        self.paused.discard(actor)
        self.acknowledged = 0 if actor == "slow" else self.acknowledged
        require(viewer.hello["role"] == ("view" if VIEWERS[actor] == VIEW else "control"),
                f"role {viewer.hello['role']}")
        session.take_rev(viewer.hello["rev"], "hello")
        session.members[viewer.hello["viewer"]] = VIEWERS[actor] == VIEW

    def id_of(self, actor):
        return self.viewers[actor].hello["viewer"] if actor in VIEWERS else HTTP

    def session_of(self, actor):
        return self.sessions[self.place.get(actor, 0)]

    def others(self, actor):
        return [viewer for name, viewer in self.viewers.items()
                if name != actor and self.place[name] == self.place.get(actor, 0)]

    async def http(self, method, params, token, session):
        call = {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}
        _, _, answer = await asyncio.to_thread(
            self.server.request, "POST", f"/rpc?session={session}", json.dumps(call),
            {"Authorization": "Bearer " + token, "Content-Type": "application/json"})
        return self.server.seen(method, json.loads(answer))

    async def ask(self, actor, method, params=None):
        params = {name: value for name, value in (params or {}).items() if value is not None}
        if actor in VIEWERS:
            answer = await self.viewers[actor].ask(method, params)
        else:
            token = VIEW if actor == "http_view" else CONTROL
            answer = await self.http(method, params, token, self.session_of(actor).name)
        if "error" in answer:
            code = answer["error"]["code"]
            require((method, code) in declared_errors(), f"{method}: undeclared {answer['error']}")
        return answer

    def expect(self, answer, code, what):
        """The answer has this error; None: it is a result, which is returned."""
        found = answer.get("error", {}).get("code")
        require(found == code, f"{what}: {answer.get('error', 'a result')}, not {code}")
        return answer.get("result")

    def refusal(self, actor):
        """The code with which commands of the actor are refused; None: they are not."""
        if actor == "http_view" or not self.session_of(actor).may_change(self.id_of(actor)):
            return FORBIDDEN
        return None

    # Steps.

    async def take(self, actor, act, argument):
        if actor in VIEWERS or act not in ("join", "acknowledge", "pause", "reconnect", "burst"):
            await getattr(self, "do_" + act)(actor, argument)

    async def do_camera(self, actor, eye):
        session = self.session_of(actor)
        answer = await self.ask(actor, "camera.set", {"eye": eye})
        result = self.expect(answer, self.refusal(actor), "camera.set")
        if result:
            session.take_rev(result["rev"], "camera.set", grows=True)
            session.eye = eye
            await self.notified(actor, "camera.changed", lambda it: it["camera"]["rev"])
        seen = self.expect(await self.ask(actor, "camera.get"), None, "camera.get")
        session.take_rev(seen["rev"], "camera.get")
        if session.eye:
            require(all(abs(a - b) < 1e-3 for a, b in zip(seen["eye"], session.eye)),
                    f"the camera is at {seen['eye']}, not {session.eye}")

    async def do_settings(self, actor, compensation):
        session = self.session_of(actor)
        changes = compensation != session.compensation
        answer = await self.ask(actor, "settings.patch",
                                {"patch": {"exposure": {"compensation": compensation}}})
        result = self.expect(answer, self.refusal(actor), "settings.patch")
        if result:
            session.take_rev(result["rev"], "settings.patch", grows=changes)
            session.compensation = compensation
            if changes:
                await self.notified(actor, "settings.changed", lambda it: it["rev"])
        seen = self.expect(await self.ask(actor, "settings.get"), None, "settings.get")
        session.take_rev(seen["rev"], "settings.get")
        require(abs(seen["settings"]["exposure"]["compensation"] - session.compensation) < 1e-5,
                f"the exposure is {seen['settings']['exposure']}, not {session.compensation}")

    async def notified(self, actor, method, rev_of):
        """Every other participant hears of the newest change and by whom it was; its author does
        not."""
        rev, author = self.session_of(actor).rev, self.id_of(actor)

        def heard(viewer):
            return any(note["method"] == method and rev_of(note["params"]) == rev and
                       note["params"]["by"] == author for note in viewer.notifications)
        deadline = time.monotonic() + STEP_TIMEOUT / 3
        while not all(heard(viewer) for viewer in self.others(actor)):
            require(time.monotonic() < deadline, f"{method} of rev {rev} did not come")
            await asyncio.sleep(0.002)
        if actor in VIEWERS:
            require(not heard(self.viewers[actor]), f"{method} came to its author")

    async def do_control(self, actor, params):
        session = self.session_of(actor)
        viewer = params["viewer"]
        params = {**params, "viewer": self.id_of(viewer) if viewer in VIEWERS else viewer}
        read_only = actor == "http_view" or VIEWERS.get(actor) == VIEW
        code = FORBIDDEN if read_only else session.control(params, self.id_of(actor))
        self.expect(await self.ask(actor, "session.control", params), code, "session.control")
        await self.check_info(session)

    async def check_info(self, session):
        """Departures are noticed a moment later."""
        deadline = time.monotonic() + STEP_TIMEOUT / 3
        while True:
            answer = await self.http("session.info", {}, CONTROL, session.name)
            try:
                return session.check_info(self.expect(answer, None, "session.info"))
            except Broken:
                if time.monotonic() > deadline:
                    raise
            await asyncio.sleep(0.005)

    async def do_join(self, actor, number):
        before, there = self.session_of(actor), self.sessions[number]
        answer = await self.ask(actor, "session.join", {"session": there.name})
        result = self.expect(answer, None, "session.join")
        if there is not before:
            before.leave(self.id_of(actor))
            there.members[self.id_of(actor)] = VIEWERS[actor] == VIEW
            self.place[actor] = number
            # The frames of another session follow.
            self.viewers[actor].joined_at = self.viewers[actor].frames_received
        there.take_rev(result["rev"], "session.join")
        await self.check_info(before)
        await self.check_info(there)

    async def do_step(self, actor, step):
        session = self.session_of(actor)
        frames, dt = step
        answer = await self.ask(actor, "frame.step", {"frames": frames, "dt": dt})
        result = self.expect(answer, self.refusal(actor), "frame.step")
        if result:
            session.step(frames, dt)
            session.check_step(result, "frame.step")
            session.take_rev(result["rev"], "frame.step")

    async def do_run(self, actor, _):
        session = self.session_of(actor)
        result = self.expect(await self.ask(actor, "frame.run"), self.refusal(actor), "frame.run")
        if result:
            session.lockstep = False
            session.check_step(result, "frame.run")
            session.take_rev(result["rev"], "frame.run")

    async def do_burst(self, actor, steps):
        """Steps that are not waited for are finished in their order, changes between them too."""
        session = self.session_of(actor)
        calls = []
        for _ in range(steps):
            calls.append(asyncio.ensure_future(self.ask(actor, "frame.step", {"frames": 1, "dt": 0.0})))
            await asyncio.sleep(0)  # in this order
        code = self.refusal(actor)
        for answer in await asyncio.gather(*calls):
            result = self.expect(answer, code, "frame.step")
            if result:
                session.step(1, 0.0)
                session.check_step(result, "a burst of steps")
                session.take_rev(result["rev"], "frame.step")

    async def do_capture(self, actor, _):
        session = self.session_of(actor)
        answer = await self.ask(actor, "frame.capture", {"samples": 1, "format": "jpeg"})
        code = NOT_READY if session.lockstep and not session.stepped else None
        result = self.expect(answer, code, "frame.capture")
        if result:
            require((result["width"], result["height"]) == (48, 32), f"size of {result['width']}")

    async def do_generic(self, actor, choice):
        """Any other method, with its example."""
        method = self.methods[int(choice * len(self.methods))]
        params = {one["name"]: one["value"] for one in method["examples"][0]["params"]}
        session = self.session_of(actor)
        answer = await self.ask(actor, method["name"], params)
        code = answer.get("error", {}).get("code")
        if method["x-needs-control"]:
            require((code == FORBIDDEN) == (self.refusal(actor) is not None),
                    f"{method['name']}: {answer.get('error', 'a result')}")
        if method["name"].startswith("camera.") and code is None and method["x-needs-control"]:
            session.eye = answer["result"]["eye"]
        if method["name"] in ("stream.pause", "stream.resume") and code is None:
            change = self.paused.add if method["name"] == "stream.pause" else self.paused.discard
            change(actor)
        rev = answer.get("result", {}).get("rev")
        if isinstance(rev, int):
            session.take_rev(rev, method["name"])

    async def do_pause(self, actor, pauses):
        result = await self.ask(actor, "stream.pause" if pauses else "stream.resume")
        require(self.expect(result, None, "stream.pause")["paused"] == pauses, "paused")
        (self.paused.add if pauses else self.paused.discard)(actor)

    async def do_acknowledge(self, actor, _):
        """All frames that have come; those that have been acknowledged may be again."""
        viewer = self.viewers[actor]
        self.acknowledge(actor, viewer)
        newest = viewer.newest_seq if hasattr(viewer, "newest_seq") else 0
        self.expect(await self.ask(actor, "stream.ack", {"frame_seq": newest}), None, "stream.ack")

    def acknowledge(self, actor, viewer):
        if actor == "slow":
            self.acknowledged = viewer.frames_received

    async def do_reconnect(self, actor, _):
        viewer, session, number = (self.viewers.pop(actor), self.session_of(actor),
                                   self.place[actor])
        identity = viewer.hello["viewer"]
        await viewer.__aexit__()
        session.leave(identity)
        await self.check_info(session)
        await self.connect(actor, number)
        await self.check_info(session)

    async def do_close(self, actor, _):
        """The second session ends, if the actor may close it, and another takes its name."""
        session = self.sessions[1]
        inside = self.session_of(actor) is session and actor in VIEWERS
        empty = not session.members
        read_only = actor == "http_view" or VIEWERS.get(actor) == VIEW
        allowed = not read_only and (
            actor == "http" or empty or (inside and session.may_change(self.id_of(actor))))
        members = [name for name, number in self.place.items() if number == 1]
        answer = None
        with contextlib.suppress(asyncio.CancelledError):  # it may close its own connection
            answer = await self.ask(actor, "session.close", {"session": session.name})
        if not allowed:
            return self.expect(answer, FORBIDDEN, "session.close")
        if answer:
            self.expect(answer, None, "session.close")
        for name in members:
            code, _ = await self.viewers[name].closed(STEP_TIMEOUT / 3)
            require(code == 4003, f"the session's viewers are closed with {code}")
            del self.viewers[name]
        await self.create(1)
        for name in members:
            await self.connect(name, 1)

    # Streams.

    def check_streams(self):
        for actor, viewer in self.viewers.items():
            last = getattr(viewer, "checked", {"frame_seq": 0, "state_rev": 0, "render_id": 0})
            while not viewer.frames.empty():
                header = viewer.frames.get_nowait().header
                viewer.looked_at = getattr(viewer, "looked_at", 0) + 1
                require(header["frame_seq"] > last["frame_seq"],
                        f"{actor}: frame {header['frame_seq']} after {last['frame_seq']}")
                if header["flags"] & 8:  # discontinuity: of another session
                    last = {**last, "state_rev": 0, "render_id": 0}
                for member in ("state_rev", "render_id"):
                    require(header[member] >= last[member],
                            f"{actor}: {member} {header[member]} after {last[member]}")
                last = header
            viewer.checked = last
            viewer.newest_seq = last["frame_seq"]
            if actor == "slow":
                ahead = viewer.frames_received - self.acknowledged
                require(ahead <= MOST_UNACKNOWLEDGED, f"{ahead} frames are not acknowledged")

    async def settle(self):
        """Every viewer that wants frames sees the newest state of a session that renders."""
        for actor, viewer in self.viewers.items():
            session = self.session_of(actor)
            if session.lockstep or actor in self.paused:
                continue
            deadline = time.monotonic() + STEP_TIMEOUT
            while (seen := getattr(viewer, "checked", {}).get("state_rev", 0)) < session.rev:
                require(time.monotonic() < deadline,
                        f"{actor} sees rev {seen}, not {session.rev}")
                if actor == "slow":
                    self.acknowledge(actor, viewer)
                    await viewer.notify("stream.ack", {"frame_seq": viewer.newest_seq})
                await asyncio.sleep(0.005)
                self.check_streams()
