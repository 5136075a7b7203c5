"""Every method of heliograph.v1, made by generate.py from `heliograph schema`."""

from typing import Any, Dict, List, Literal, Optional, Union

_UNSET: Any = type("Unset", (), {"__repr__": lambda self: "..."})()


def _given(params):
    return {name: value for name, value in params.items() if value is not _UNSET}


class _Group:
    def __init__(self, call):
        self._call = call


class Animation(_Group):
    def list(self) -> Dict[str, Any]:
        """Lists the scene's clips and tells where the clip stands.

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.list", {})

    def play(self, *, clip: str = _UNSET, rate: float = _UNSET) -> Dict[str, Any]:
        """Lets time pass in a clip. A camera that the clip moves follows it until it is taken
        by hand.

        clip: The clip to play from its start; left out: go on with the one that is there, or
            play the first.
        rate: Seconds of the clip that pass in a second.

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.play", _given({"clip": clip, "rate": rate}))

    def pause(self) -> Dict[str, Any]:
        """Stops time; the pose stays.

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.pause", {})

    def seek(self, *, seconds: float) -> Dict[str, Any]:
        """Goes to a moment of the clip.

        seconds: Where the clip shall stand. [seconds]

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.seek", _given({"seconds": seconds}))

    def rate(self, *, rate: float) -> Dict[str, Any]:
        """Sets how fast time passes.

        rate: Seconds of the clip that pass in a second.

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.rate", _given({"rate": rate}))


class Camera(_Group):
    def get(self) -> Dict[str, Any]:
        """Tells where the camera is.

        Gives: eye, name, rev, target, up, vertical_fov.
        """
        return self._call("camera.get", {})

    def set(
            self,
            *,
            eye: List[float] = _UNSET,
            name: str = _UNSET,
            seq: int = _UNSET,
            target: List[float] = _UNSET,
            up: List[float] = _UNSET,
            vertical_fov: float = _UNSET) -> Dict[str, Any]:
        """Moves the camera; members that are left out stay as they are.

        eye: Where the camera is, world space. [metres]
        name: A scene camera to begin from; the other members are applied on top.
        seq: The client's own count; frames that show this camera echo it as input_seq_echo.
        target: The point in the middle of the picture. [metres]
        up: The direction that points up in the picture.
        vertical_fov: Field of view, top to bottom. [degrees]

        Gives: eye, name, rev, target, up, vertical_fov.
        """
        return self._call("camera.set", _given({
            "eye": eye, "name": name, "seq": seq, "target": target, "up": up,
            "vertical_fov": vertical_fov}))

    def orbit(
            self,
            *,
            distance: float = _UNSET,
            dolly: float = _UNSET,
            pitch: float = _UNSET,
            seq: int = _UNSET,
            yaw: float = _UNSET) -> Dict[str, Any]:
        """Carries the camera about its target, nearer or farther.

        distance: How far from the target to be. [metres]
        dolly: Factor on the distance: below 1 comes closer.
        pitch: Raises the camera, lowers it below 0; it stops short of straight above and below.
            [degrees]
        seq: The client's own count; frames that show this camera echo it as input_seq_echo.
        yaw: Turns about the up axis, counter-clockwise seen from above. [degrees]

        Gives: eye, name, rev, target, up, vertical_fov.
        """
        return self._call("camera.orbit", _given({
            "distance": distance, "dolly": dolly, "pitch": pitch, "seq": seq, "yaw":
            yaw}))

    def fit(self) -> Dict[str, Any]:
        """Moves the camera back until the whole scene is in the picture.

        Gives: eye, name, rev, target, up, vertical_fov.
        """
        return self._call("camera.fit", {})


class Environment(_Group):
    def list(self) -> Dict[str, Any]:
        """Lists the environments that can be put around the scene and tells which one is.

        Gives: current, environments, intensity, rev, rotation.
        """
        return self._call("environment.list", {})

    def set(self, *, name: Optional[str] = _UNSET, rotation: float = _UNSET) -> Dict[str, Any]:
        """Puts another environment around this session's scene, or turns it.

        name: A name that environment.list gave; null: the one that goes with the scene.
        rotation: Sets environment.rotation, too. [degrees]

        Gives: current, environments, intensity, rev, rotation.
        """
        return self._call("environment.set", _given({"name": name, "rotation": rotation}))


class Frame(_Group):
    def buffers(self) -> Dict[str, Any]:
        """Lists what can be shown or captured: the buffers of the newest picture, which follow
        from scene and settings.

        Gives: buffers.
        """
        return self._call("frame.buffers", {})

    def capture(
            self,
            *,
            buffer: str = _UNSET,
            format: Literal["png", "jpeg", "npy", "exr"] = _UNSET,
            samples: int = _UNSET) -> Dict[str, Any]:
        """Renders one buffer and gives it as a file.

        buffer: A name that frame.buffers gave.
        format: Format of the file: png and jpeg for people, npy and exr for values.
        samples: Samples per pixel to wait for, at most accumulation.max_samples, one without
            accumulation; absent: all of them. The answer tells how many there are.

        Gives: buffer, data, format, height, samples, width.
        """
        return self._call("frame.capture", _given({
            "buffer": buffer, "format": format, "samples": samples}))

    def inspect(self, *, x: float, y: float) -> Dict[str, Any]:
        """Gives the value of every buffer under a point of the picture.

        x: Share of the picture's width, from the left.
        y: Share of the picture's height, from the top.

        Gives: buffers, column, height, row, width.
        """
        return self._call("frame.inspect", _given({"x": x, "y": y}))

    def step(self, *, dt: float, frames: int = _UNSET) -> Dict[str, Any]:
        """Renders exactly so many frames of dt seconds and answers when they are done. Time
        passes no other way until frame.run; the first call forgets every history.

        dt: How much time passes before each of them. [seconds]
        frames: How many frames to render; 0 enters lockstep and renders none.

        Gives: frames, lockstep, rev, samples, seconds.
        """
        return self._call("frame.step", _given({"dt": dt, "frames": frames}))

    def run(self) -> Dict[str, Any]:
        """Lets time pass by itself again after frame.step.

        Gives: frames, lockstep, rev, samples, seconds.
        """
        return self._call("frame.run", {})


class Lights(_Group):
    def list(self) -> Dict[str, Any]:
        """Lists the lights of the scene as this session has them.

        Gives: lights, rev.
        """
        return self._call("lights.list", {})

    def patch(self, *, light: str, patch: Dict[str, Any]) -> Dict[str, Any]:
        """Changes a light of this session's scene by a merge patch (RFC 7386).

        light: A name that lights.list gave.
        patch: What shall change (RFC 7386): null brings back what the scene's file says.

        Gives: light, rev.
        """
        return self._call("lights.patch", _given({"light": light, "patch": patch}))


class Materials(_Group):
    def list(self) -> Dict[str, Any]:
        """Lists the materials of the scene as this session has them.

        Gives: materials, rev.
        """
        return self._call("materials.list", {})

    def patch(self, *, material: str, patch: Dict[str, Any]) -> Dict[str, Any]:
        """Changes a material of this session's scene by a merge patch (RFC 7386).

        material: A name that materials.list gave.
        patch: What shall change (RFC 7386): null brings back what the scene's file says.

        Gives: material, rev.
        """
        return self._call("materials.patch", _given({"material": material, "patch": patch}))


class Reference(_Group):
    def start(
            self,
            *,
            samples: int = _UNSET,
            scope: Literal["same_paths", "full"] = _UNSET) -> Dict[str, Any]:
        """Shows the path traced truth and gathers its samples, whether anybody watches or not.

        samples: Samples per pixel to gather: the setting accumulation.max_samples.
        scope: Which light paths: the setting reference.scope.

        Gives: finished, rev, samples, scope, shown, wanted.
        """
        return self._call("reference.start", _given({"samples": samples, "scope": scope}))

    def status(self) -> Dict[str, Any]:
        """Tells how far the path traced truth is.

        Gives: finished, rev, samples, scope, shown, wanted.
        """
        return self._call("reference.status", {})

    def stop(self) -> Dict[str, Any]:
        """Shows the hybrid picture again; what reference.start had set is as it was before.

        Gives: finished, rev, samples, scope, shown, wanted.
        """
        return self._call("reference.stop", {})


class Rpc(_Group):
    def discover(self) -> Dict[str, Any]:
        """Gives this document."""
        return self._call("rpc.discover", {})


class Scene(_Group):
    def list(self) -> Dict[str, Any]:
        """Lists the scenes that can be loaded.

        Gives: current, scenes.
        """
        return self._call("scene.list", {})

    def load(self, *, name: str, scene: str = _UNSET, variant: str = _UNSET) -> Dict[str, Any]:
        """Loads a scene and shows it; scene.progress tells how far it is. On failure the scene
        that was shown stays.

        name: A name that scene.list gave.
        scene: Which scene of a file that holds several: its name, or its number from 0. Left
            out: the file's default.
        variant: Which of the file's material variants. Left out: the materials outside of them.

        Gives: bounds, cameras, clips, deforming, environment, images, instances, light_names,
            lights, material_names, materials, memory, meshes, name, nodes, scene, scenes,
            texels, textures, triangles, variant, variants, vertices, warnings.
        """
        return self._call("scene.load", _given({"name": name, "scene": scene, "variant": variant}))

    def cancel(self) -> Dict[str, Any]:
        """Ends the load that the session waits for. What is shown stays.

        Gives: cancelled.
        """
        return self._call("scene.cancel", {})

    def unload(self) -> Dict[str, Any]:
        """Shows no scene any more."""
        return self._call("scene.unload", {})

    def info(self) -> Dict[str, Any]:
        """Describes the scene that is shown.

        Gives: bounds, cameras, clips, deforming, environment, images, instances, light_names,
            lights, material_names, materials, memory, meshes, name, nodes, scene, scenes,
            texels, textures, triangles, variant, variants, vertices, warnings.
        """
        return self._call("scene.info", {})

    def pick(self, *, x: float, y: float) -> Dict[str, Any]:
        """Tells what surface lies under a point of the picture.

        x: Share of the picture's width, from the left.
        y: Share of the picture's height, from the top.

        Gives: distance, hit, material, normal, object, position.
        """
        return self._call("scene.pick", _given({"x": x, "y": y}))


class Session(_Group):
    def create(
            self,
            *,
            copy_of: str = _UNSET,
            height: int = _UNSET,
            name: str = _UNSET,
            scene: str = _UNSET,
            settings: Dict[str, Any] = _UNSET,
            width: int = _UNSET) -> Dict[str, Any]:
        """Makes a session of its own scene, camera, settings, clock and histories.

        copy_of: A session whose scene, camera, clip, settings and size it starts with.
        height: Picture height. [pixels]
        name: Letters, digits, dots, hyphens and underscores; left out: the server chooses.
        scene: A name that scene.list gave; it is loaded before the answer comes.
        settings: Part of the settings tree (RFC 7386), on top of the server's own or the
            copied.
        width: Picture width. [pixels]

        Gives: control, height, idle_seconds, name, rev, scene, viewers, width.
        """
        return self._call("session.create", _given({
            "copy_of": copy_of, "height": height, "name": name, "scene": scene,
            "settings": settings, "width": width}))

    def join(self, *, session: str) -> Dict[str, Any]:
        """Brings this viewer, with its stream as it is, into another session.

        session: A name that session.list gave.

        Gives: info, rev, session, viewer.
        """
        return self._call("session.join", _given({"session": session}))

    def list(self) -> Dict[str, Any]:
        """Lists the sessions and limits.

        Gives: limits, sessions.
        """
        return self._call("session.list", {})

    def info(self) -> Dict[str, Any]:
        """Tells who is in this session and who has control.

        Gives: control, height, idle_seconds, name, rev, scene, viewers, width.
        """
        return self._call("session.info", {})

    def control(
            self,
            *,
            action: Literal["take", "give", "release"] = _UNSET,
            mode: Literal["everyone", "one"] = _UNSET,
            viewer: str = _UNSET) -> Dict[str, Any]:
        """Decides who may change the session: everyone, or one viewer who takes, gives or
        releases control.

        action: Where one has control: take it while nobody has it, give it to `viewer`, or
            release it for anybody to take.
        mode: Whether everyone has control or one viewer: the one that `viewer` names, else the
            caller.
        viewer: The id of who is to have control.

        Gives: control, height, idle_seconds, name, rev, scene, viewers, width.
        """
        return self._call("session.control", _given({
            "action": action, "mode": mode, "viewer": viewer}))

    def close(self, *, session: str) -> Dict[str, Any]:
        """Ends a session; its viewers are told and let go. main stays for ever.

        session: A name that session.list gave.
        """
        return self._call("session.close", _given({"session": session}))


class Settings(_Group):
    def get(self) -> Dict[str, Any]:
        """Gives the whole tree of settings.

        Gives: rev, settings.
        """
        return self._call("settings.get", {})

    def patch(self, *, patch: Dict[str, Any]) -> Dict[str, Any]:
        """Changes settings by a merge patch (RFC 7386): all of it or, on any error, nothing.

        patch: Part of the settings tree (RFC 7386): null resets to the default.

        Gives: applied, rev.
        """
        return self._call("settings.patch", _given({"patch": patch}))

    def presets(self) -> Dict[str, Any]:
        """Lists the presets of the denoiser.

        Gives: presets.
        """
        return self._call("settings.presets", {})

    def preset(self, *, name: str) -> Dict[str, Any]:
        """Applies a preset, as settings.patch would; settings it does not name stay.

        name: A name that settings.presets gave.

        Gives: applied, rev.
        """
        return self._call("settings.preset", _given({"name": name}))

    def schema(self) -> Dict[str, Any]:
        """Gives the JSON Schema of the settings: types, defaults, limits, units, help."""
        return self._call("settings.schema", {})


class Stats(_Group):
    def subscribe(self, *, interval_ms: int) -> Dict[str, Any]:
        """Asks for stats.frame notifications; gives the interval in effect.

        interval_ms: Least time between two stats.frame notifications; 0: none. [milliseconds]

        Gives: interval_ms.
        """
        return self._call("stats.subscribe", _given({"interval_ms": interval_ms}))


class Stream(_Group):
    def configure(
            self,
            *,
            codec: Literal["jpeg", "h264"] = _UNSET,
            height: int = _UNSET,
            max_fps: float = _UNSET,
            paused: bool = _UNSET,
            quality: int = _UNSET,
            still: Literal["jpeg", "png"] = _UNSET,
            width: int = _UNSET) -> Dict[str, Any]:
        """Sets size, quality and pace of this viewer's pictures; gives what is in effect.

        codec: Codec while something moves; one that hello agreed on.
        height: Picture height. [pixels]
        max_fps: Most pictures in a second.
        paused: Whether no pictures are sent.
        quality: Quality on the scale of JPEG, for any codec.
        still: Format of the final picture: JPEG with all its colour, or PNG without any loss.
        width: Picture width. [pixels]

        Gives: codec, height, max_fps, paused, quality, still, width.
        """
        return self._call("stream.configure", _given({
            "codec": codec, "height": height, "max_fps": max_fps, "paused": paused,
            "quality": quality, "still": still, "width": width}))

    def pause(self) -> Dict[str, Any]:
        """Stops this viewer's pictures, for instance while nobody can see them.

        Gives: codec, height, max_fps, paused, quality, still, width.
        """
        return self._call("stream.pause", {})

    def resume(self) -> Dict[str, Any]:
        """Lets this viewer's pictures come again, beginning with the newest.

        Gives: codec, height, max_fps, paused, quality, still, width.
        """
        return self._call("stream.resume", {})

    def ack(
            self,
            *,
            frame_seq: int,
            decode_us: int = _UNSET,
            present_us: int = _UNSET) -> Dict[str, Any]:
        """Tells that a frame was displayed. The server sends only a window of frames ahead.

        frame_seq: The frame's number from its header.
        decode_us: Time the client took to decode it. [microseconds]
        present_us: Time from its arrival to its display. [microseconds]
        """
        return self._call("stream.ack", _given({
            "frame_seq": frame_seq, "decode_us": decode_us, "present_us": present_us}))


class Methods:
    """The methods in their groups; `call(method, params)` carries them out."""

    def __init__(self, call):
        self._call = call
        self.animation = Animation(call)
        self.camera = Camera(call)
        self.environment = Environment(call)
        self.frame = Frame(call)
        self.lights = Lights(call)
        self.materials = Materials(call)
        self.reference = Reference(call)
        self.rpc = Rpc(call)
        self.scene = Scene(call)
        self.session = Session(call)
        self.settings = Settings(call)
        self.stats = Stats(call)
        self.stream = Stream(call)

    def hello(
            self,
            *,
            client: str = _UNSET,
            codecs: List[str] = _UNSET,
            instance: str = _UNSET,
            name: str = _UNSET,
            session: str = _UNSET) -> Dict[str, Any]:
        """Introduces a viewer: says what it can decode and learns who serves it.

        client: Name and version of the client, for the log.
        codecs: Picture codecs the client can decode, best first.
        instance: Of who comes back: the run of the server that `session` was on. Where it is
            another one, a place that disturbs nobody is found; `bring` tells of it.
        name: What the person is called, for the others in the session.
        session: The session to watch; left out: the one that /ws?session=NAME named, or main.

        Gives: bring, codec_reason, codecs, device, instance, limits, protocol, rev, role,
            session, tracer, version, viewer.
        """
        return self._call("hello", _given({
            "client": client, "codecs": codecs, "instance": instance, "name": name,
            "session": session}))
