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

        clip: The clip to play from its start; absent: continue the current clip, or play the
            first.
        rate: Playback speed: clip seconds per second.

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

        seconds: Time in the clip to seek to. [seconds]

        Gives: clip, clips, lockstep, playing, rate, rev, seconds.
        """
        return self._call("animation.seek", _given({"seconds": seconds}))

    def rate(self, *, rate: float) -> Dict[str, Any]:
        """Sets how fast time passes.

        rate: Playback speed: clip seconds per second.

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

        eye: Position of the camera, world space. [metres]
        name: A scene camera to start from; the other members are applied on top.
        seq: The client's sequence number; frames that show this camera echo it as
            input_seq_echo.
        target: The point at the centre of the image. [metres]
        up: The up direction of the image.
        vertical_fov: Vertical field of view. [degrees]

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

        distance: New distance to the target. [metres]
        dolly: Factor on the distance: below 1 moves closer.
        pitch: Positive raises the camera, negative lowers it; it stops short of the poles.
            [degrees]
        seq: The client's sequence number; frames that show this camera echo it as
            input_seq_echo.
        yaw: Rotation about the up axis, counter-clockwise seen from above. [degrees]

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

        name: A name from environment.list; null: the scene's own.
        rotation: Also sets environment.rotation. [degrees]

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

        buffer: A name from frame.buffers.
        format: Format of the file: png and jpeg for viewing, npy and exr for values.
        samples: Samples per pixel to wait for, at most accumulation.max_samples, 1 without
            accumulation; absent: wait for the converged frame.

        Gives: buffer, data, format, height, samples, width.
        """
        return self._call("frame.capture", _given({
            "buffer": buffer, "format": format, "samples": samples}))

    def inspect(self, *, x: float, y: float) -> Dict[str, Any]:
        """Gives the value of every buffer under a point of the picture.

        x: Fraction of the image width, from the left.
        y: Fraction of the image height, from the top.

        Gives: buffers, column, height, row, width.
        """
        return self._call("frame.inspect", _given({"x": x, "y": y}))

    def step(self, *, dt: float, frames: int = _UNSET) -> Dict[str, Any]:
        """Renders exactly so many frames of dt seconds and answers when they are done. Time
        passes no other way until frame.run; the first call forgets every history.

        dt: Time step before each frame. [seconds]
        frames: Number of frames to render; 0 enters lockstep without rendering.

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

        light: A name from lights.list.
        patch: A merge patch (RFC 7386); null restores the value of the scene file.

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

        material: A name from materials.list.
        patch: A merge patch (RFC 7386); null restores the value of the scene file.

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

        samples: Samples per pixel to accumulate: sets accumulation.max_samples.
        scope: Light paths to trace: sets reference.scope.

        Gives: finished, rev, samples, scope, shown, target_samples.
        """
        return self._call("reference.start", _given({"samples": samples, "scope": scope}))

    def status(self) -> Dict[str, Any]:
        """Tells how far the path traced truth is.

        Gives: finished, rev, samples, scope, shown, target_samples.
        """
        return self._call("reference.status", {})

    def stop(self) -> Dict[str, Any]:
        """Shows the hybrid picture again; what reference.start had set is as it was before.

        Gives: finished, rev, samples, scope, shown, target_samples.
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

        name: A name from scene.list.
        scene: The scene to load from a file with several: its name, or its index from 0.
            Absent: the file's default.
        variant: Material variant of the file to apply. Absent: the default materials.

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

        x: Fraction of the image width, from the left.
        y: Fraction of the image height, from the top.

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

        copy_of: A session from which scene, camera, clip, settings and size are copied.
        height: Frame height. [pixels]
        name: Letters, digits, dots, hyphens and underscores; absent: the server chooses.
        scene: A name from scene.list; the call returns when the scene is loaded.
        settings: A merge patch of the settings tree (RFC 7386), applied to the server's
            defaults or the copied settings.
        width: Frame width. [pixels]

        Gives: control, height, idle_seconds, name, rev, scene, viewers, width.
        """
        return self._call("session.create", _given({
            "copy_of": copy_of, "height": height, "name": name, "scene": scene,
            "settings": settings, "width": width}))

    def join(self, *, session: str) -> Dict[str, Any]:
        """Brings this viewer, with its stream as it is, into another session.

        session: A name from session.list.

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
            mode: Literal["shared", "exclusive"] = _UNSET,
            viewer: str = _UNSET) -> Dict[str, Any]:
        """Decides who may change the session: everyone, or one viewer who takes, gives or
        releases control.

        action: In exclusive mode: take control while it is free, give it to `viewer`, or
            release it.
        mode: shared: all viewers have control; exclusive: one viewer has, the one that `viewer`
            names or the caller.
        viewer: Id of the viewer that gets control.

        Gives: control, height, idle_seconds, name, rev, scene, viewers, width.
        """
        return self._call("session.control", _given({
            "action": action, "mode": mode, "viewer": viewer}))

    def close(self, *, session: str) -> Dict[str, Any]:
        """Ends a session; its viewers are told and let go. main stays for ever.

        session: A name from session.list.
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

        patch: A merge patch of the settings tree (RFC 7386): null resets to the default.

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

        name: A name from settings.presets.

        Gives: applied, rev.
        """
        return self._call("settings.preset", _given({"name": name}))

    def schema(self) -> Dict[str, Any]:
        """Gives the JSON Schema of the settings: types, defaults, limits, units, help."""
        return self._call("settings.schema", {})


class Stats(_Group):
    def subscribe(self, *, interval_ms: int) -> Dict[str, Any]:
        """Asks for stats.frame notifications; gives the interval in effect.

        interval_ms: Minimum time between two stats.frame notifications; 0: no notifications.
            [milliseconds]

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

        codec: Codec of moving frames; one of those that hello returned.
        height: Frame height. [pixels]
        max_fps: Maximum frame rate.
        paused: Whether the stream is paused.
        quality: Quality on the scale of JPEG, for any codec.
        still: Format of the final image of a static view: JPEG without chroma subsampling, or
            lossless PNG.
        width: Frame width. [pixels]

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

        frame_seq: `frame_seq` of the frame's header.
        decode_us: Time that the client took to decode it. [microseconds]
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
        codecs: Frame codecs that the client can decode, preferred first.
        instance: On reconnect: the `instance` of the server process that `session` was on. If
            it differs, the server picks a session that other viewers do not use; see
            `restore_state`.
        name: Display name, shown to the other viewers of the session.
        session: The session to join; absent: the one in /ws?session=NAME, or main.

        Gives: codec_reason, codecs, device, instance, limits, protocol, restore_state, rev,
            role, session, tracer, version, viewer.
        """
        return self._call("hello", _given({
            "client": client, "codecs": codecs, "instance": instance, "name": name,
            "session": session}))
