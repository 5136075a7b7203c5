"""A small model of what the protocol promises about sessions: who may change one, what its camera,
exposure and lockstep are, and that revisions only grow."""

import math

FORBIDDEN, NOT_FOUND, CONFLICT, INVALID, NOT_READY = -32001, -32004, -32009, -32602, -32050
HTTP = ""  # the viewer id of callers without a stream


class Broken(AssertionError):
    """The server has done what the contract does not allow."""


def require(condition, why):
    if not condition:
        raise Broken(why)


class SessionModel:
    def __init__(self, name):
        self.name = name
        self.rev = 0
        self.eye = None
        self.compensation = 0.0
        self.members = {}  # id -> whether the viewer is read-only
        self.exclusive = False
        self.holder = ""
        self.lockstep = False
        self.stepped = False  # since lockstep was entered
        self.frames = 0
        self.seconds = 0.0

    def take_rev(self, rev, what, grows=False):
        require(rev >= self.rev, f"{what}: rev {rev} after {self.rev}")
        require(not grows or rev > self.rev, f"{what}: a change left rev at {rev}")
        self.rev = rev

    # Control.

    def may_change(self, viewer):
        if self.members.get(viewer):
            return False
        return not self.exclusive or self.holder == viewer

    def control(self, params, by):
        """The error code of session.control; None: it changes control."""
        before = (self.exclusive, self.holder)
        code = self._control(params, by)
        if code is not None:
            self.exclusive, self.holder = before
        return code

    def _control(self, params, by):
        mode, action, viewer = (params.get(name) for name in ("mode", "action", "viewer"))
        if mode is None and action is None:
            return INVALID
        if mode is not None:
            code = self._set_mode(mode == "exclusive", viewer, by)
            if code is not None:
                return code
        return self._act(action, viewer, by) if action else None

    def _set_mode(self, exclusive, viewer, by):
        if by != HTTP and not self.may_change(by) and self.holder:
            return FORBIDDEN
        if exclusive == self.exclusive and not viewer and (not exclusive or self.holder == by):
            return None
        self.exclusive, self.holder = exclusive, ""
        holder = viewer or by
        return self._hand_to(holder) if exclusive and holder else None

    def _act(self, action, viewer, by):
        if not self.exclusive:
            return CONFLICT
        may_assign = by == HTTP or self.holder == by
        if action == "take":
            if by == HTTP:
                return NOT_READY
            return FORBIDDEN if self.holder not in ("", by) else self._hand_to(by)
        if action == "give" and not viewer:
            return INVALID
        if not may_assign:
            return FORBIDDEN
        if action == "give":
            return self._hand_to(viewer)
        self.holder = ""
        return None

    def _hand_to(self, viewer):
        if self.members.get(viewer) is not False:
            return NOT_FOUND
        self.holder = viewer
        return None

    def leave(self, viewer):
        del self.members[viewer]
        if self.holder == viewer:
            self.holder = ""

    def check_info(self, info):
        """session.info against the model."""
        require(info["control"] == ("exclusive" if self.exclusive else "shared"),
                f"control is {info['control']}")
        expected = {viewer: self.may_change(viewer) for viewer in self.members}
        found = {one["viewer"]: one["control"] for one in info["viewers"]}
        require(found == expected, f"participants are {found}, not {expected}")

    # Lockstep.

    def step(self, frames, dt):
        if not self.lockstep:
            self.lockstep, self.stepped = True, False
            self.frames, self.seconds = 0, 0.0
        self.frames += frames
        self.seconds += frames * dt
        self.stepped |= frames > 0

    def check_step(self, state, what):
        require(state["lockstep"] == self.lockstep, f"{what}: lockstep is {state['lockstep']}")
        require(state["frames"] == self.frames, f"{what}: {state['frames']} frames, not {self.frames}")
        if self.lockstep:
            require(math.isclose(state["seconds"], self.seconds, abs_tol=1e-6),
                    f"{what}: at {state['seconds']} s, not {self.seconds}")
