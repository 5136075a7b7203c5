#include "protocol/methods.hpp"

#include <vector>

#include "protocol/json/codec.hpp"

namespace heliograph::protocol {
namespace {

template <class T>
Result<void> check(const RawJson& json) {
  const Result<T> message = decode<T>(json);
  if (!message) return message.error();
  return {};
}

struct Example {
  std::string_view params;
  std::string_view result;
};

/// A query changes nothing; a command changes the session, for all who are in it, and needs control
/// of it; a personal command changes something for its caller only; one about sessions is for who
/// may steer, whoever has control.
enum class Call { query, command, personal, sessions };

/// `errors`: besides what every call may answer, and what follows from who may call it.
template <class Params, class ResultType>
MethodDescriptor method(std::string_view name, Call call, std::string_view summary, Example example,
                        std::vector<ErrorCode> errors = {}) {
  if (call == Call::command || call == Call::sessions) {
    errors.insert(errors.begin(), ErrorCode::forbidden);
  }
  return {.name = name,
          .summary = summary,
          .params = typeid(Params),
          .result = typeid(ResultType),
          .may_be_notification = call != Call::query,
          .needs_control = call == Call::command,
          .read_only = call == Call::query || call == Call::personal,
          .errors = std::move(errors),
          .example_params = example.params,
          .example_result = example.result,
          .params_schema = schema_of<Params>,
          .result_schema = schema_of<ResultType>,
          .check_params = check<Params>,
          .check_result = check<ResultType>};
}

template <class Params>
NotificationDescriptor notification(std::string_view name, std::string_view summary) {
  return {.name = name,
          .summary = summary,
          .params = typeid(Params),
          .params_schema = schema_of<Params>};
}

constexpr std::string_view no_params = "{}";

constexpr std::string_view greeting = R"({
  "protocol": "heliograph.v1", "version": "0.1.0",
  "device": {"name": "llvmpipe", "driver": "llvmpipe 22.3.6",
             "type": "cpu"},
  "tracer": "embree", "session": "main", "viewer": "v1", "role": "control", "codecs": ["jpeg"],
  "codec_reason": null,
  "limits": {"max_width": 3840, "max_height": 2160, "max_message_bytes": 65536,
             "ack_window": 2, "max_batch": 32, "max_pending": 32,
             "max_upload_bytes": 0},
  "rev": 1, "instance": "5f0c1d7a93b2e648", "restore_state": null})";

constexpr std::string_view scene = R"({
  "name": "atrium", "triangles": 344000, "instances": 210, "meshes": 34, "materials": 18,
  "textures": 41, "lights": 1, "vertices": 51230, "nodes": 230, "images": 40, "texels": 9437184,
  "deforming": 0, "material_names": ["marble"], "light_names": ["sun"], "environment": "atrium.hdr",
  "cameras": ["entrance", "gallery"],
  "clips": [{"name": "moving_camera", "duration": 10.0}],
  "scenes": ["atrium"], "scene": 0, "variants": [], "variant": null,
  "bounds": {"min": [-12.0, 0.0, -6.5], "max": [12.0, 11.5, 6.5]},
  "memory": {"file": 18874368, "host": 9437184, "device": 104857600}, "warnings": []})";

constexpr std::string_view camera = R"({
  "eye": [8.0, 1.7, 0.0], "target": [0.0, 2.5, 0.0], "up": [0.0, 1.0, 0.0],
  "vertical_fov": 50.0, "name": null, "rev": 7})";

constexpr std::string_view animation = R"({
  "clips": [{"name": "moving_camera", "duration": 10.0}], "clip": "moving_camera",
  "playing": true, "seconds": 2.5, "rate": 1.0, "lockstep": false, "rev": 9})";

std::vector<MethodDescriptor> animation_methods() {
  return {
      method<Empty, AnimationState>("animation.list", Call::query,
                                    "Lists the scene's clips and tells where the clip stands.",
                                    {no_params, animation}),
      method<AnimationPlay, AnimationState>(
          "animation.play", Call::command,
          "Lets time pass in a clip. A camera that the clip moves follows it until it is taken by "
          "hand.",
          {R"({"clip": "moving_camera", "rate": 1.0})", animation}),
      method<Empty, AnimationState>("animation.pause", Call::command, "Stops time; the pose stays.",
                                    {no_params, animation}),
      method<AnimationSeek, AnimationState>("animation.seek", Call::command,
                                            "Goes to a moment of the clip.",
                                            {R"({"seconds": 2.5})", animation}),
      method<AnimationRate, AnimationState>("animation.rate", Call::command,
                                            "Sets how fast time passes.",
                                            {R"({"rate": 0.5})", animation}),
  };
}

constexpr std::string_view session = R"({
  "name": "review", "scene": "atrium", "width": 1280, "height": 720,
  "viewers": [{"viewer": "v1", "name": "Ada", "control": true, "you": true},
              {"viewer": "v4", "name": null, "control": false, "you": false}],
  "control": "exclusive", "rev": 7, "idle_seconds": 0.0})";

constexpr std::string_view joined = R"({
  "session": "review", "viewer": "v1", "rev": 7, "info": {
    "name": "review", "scene": null, "width": 1280, "height": 720,
    "viewers": [{"viewer": "v1", "name": "Ada", "control": true, "you": true}],
    "control": "shared", "rev": 7, "idle_seconds": 0.0}})";

constexpr std::string_view sessions = R"({
  "sessions": [{"name": "main", "scene": "atrium", "width": 640, "height": 360, "viewers": [],
                "control": "shared", "rev": 3, "idle_seconds": 12.5}],
  "limits": {"sessions": 64, "viewers": 256, "session_viewers": 32, "pixels": 66355200,
             "pixels_used": 230400, "idle_timeout": 600}})";

std::vector<MethodDescriptor> membership_methods() {
  return {
      method<SessionCreate, SessionInfo>(
          "session.create", Call::sessions,
          "Makes a session of its own scene, camera, settings, clock and histories.",
          {R"({"name": "review", "scene": "atrium", "width": 320, "height": 180})", session},
          {ErrorCode::conflict, ErrorCode::full}),
      method<SessionChoice, SessionJoined>(
          "session.join", Call::personal,
          "Brings this viewer, with its stream as it is, into another session.",
          {R"({"session": "review"})", joined}, {ErrorCode::full}),
      method<Empty, SessionList>("session.list", Call::query, "Lists the sessions and limits.",
                                 {no_params, sessions}),
      method<Empty, SessionInfo>("session.info", Call::query,
                                 "Tells who is in this session and who has control.",
                                 {no_params, session}),
      method<SessionControl, SessionInfo>(
          "session.control", Call::sessions,
          "Decides who may change the session: everyone, or one viewer who takes, gives or "
          "releases control.",
          {R"({"mode": "exclusive"})", session}, {ErrorCode::conflict}),
      method<SessionChoice, Empty>(
          "session.close", Call::sessions,
          "Ends a session; its viewers are told and let go. main stays for ever.",
          {R"({"session": "review"})", "{}"}, {ErrorCode::conflict}),
  };
}

std::vector<MethodDescriptor> session_methods() {
  return {
      method<Hello, HelloResult>(
          "hello", Call::query,
          "Introduces a viewer: says what it can decode and learns who serves it.",
          {R"({"client": "example 1.0", "codecs": ["jpeg"]})", greeting}, {ErrorCode::full}),
      method<Empty, SceneListResult>(
          "scene.list", Call::query, "Lists the scenes that can be loaded.",
          {no_params,
           R"({"scenes": [{"name": "atrium", "bytes": 18874368}], "current": "atrium"})"}),
      method<SceneLoad, SceneInfo>(
          "scene.load", Call::command,
          "Loads a scene and shows it; scene.progress tells how far it is. On failure the scene "
          "that was shown stays.",
          {R"({"name": "atrium"})", scene}, {ErrorCode::conflict}),
      method<Empty, SceneCancelled>(
          "scene.cancel", Call::command,
          "Ends the load that the session waits for. What is shown stays.",
          {no_params, R"({"cancelled": true})"}),
      method<Empty, Empty>("scene.unload", Call::command, "Shows no scene any more.",
                           {no_params, "{}"}),
      method<Empty, SceneInfo>("scene.info", Call::query, "Describes the scene that is shown.",
                               {no_params, scene}),
      method<Empty, Camera>("camera.get", Call::query, "Tells where the camera is.",
                            {no_params, camera}),
      method<CameraSet, Camera>(
          "camera.set", Call::command,
          "Moves the camera; members that are left out stay as they are.",
          {R"({"eye": [8.0, 1.7, 0.0], "target": [0.0, 2.5, 0.0], "seq": 12})", camera}),
      method<CameraOrbit, Camera>(
          "camera.orbit", Call::command, "Carries the camera about its target, nearer or farther.",
          {R"({"yaw": 15.0, "pitch": -5.0, "dolly": 0.9, "seq": 13})", camera}),
      method<Empty, Camera>("camera.fit", Call::command,
                            "Moves the camera back until the whole scene is in the picture.",
                            {no_params, camera}),
      method<Empty, SettingsState>(
          "settings.get", Call::query, "Gives the whole tree of settings.",
          {no_params, R"({"rev": 7, "settings": {"tone_map": {"curve": "neutral"}}})"}),
      method<SettingsPatch, SettingsApplied>(
          "settings.patch", Call::command,
          "Changes settings by a merge patch (RFC 7386): all of it or, on any error, nothing.",
          {R"({"patch": {"tone_map": {"curve": "agx"}, "exposure": {"compensation": null}}})",
           R"({"rev": 8, "applied": {"tone_map": {"curve": "agx"},
                                     "exposure": {"compensation": 0.0}}})"}),
      method<Empty, PresetList>(
          "settings.presets", Call::query, "Lists the presets of the denoiser.",
          {no_params,
           R"({"presets": [{"name": "svgf", "description": "The paper's baseline."}]})"}),
      method<PresetChoice, SettingsApplied>(
          "settings.preset", Call::command,
          "Applies a preset, as settings.patch would; settings it does not name stay.",
          {R"({"name": "best"})",
           R"({"rev": 9, "applied": {"specular_blur": {"kernel": "separable"}}})"}),
      method<Empty, RawJson>(
          "settings.schema", Call::query,
          "Gives the JSON Schema of the settings: types, defaults, limits, units, help.",
          {no_params, R"({"type": "object", "properties": {}})"}),
  };
}

std::vector<MethodDescriptor> stream_methods() {
  return {
      method<StreamConfigure, StreamState>(
          "stream.configure", Call::personal,
          "Sets size, quality and pace of this viewer's pictures; gives what is in effect.",
          {R"({"width": 1280, "height": 720, "quality": 80})",
           R"({"width": 1280, "height": 720, "quality": 80, "max_fps": 60.0,
               "paused": false, "codec": "jpeg", "still": "jpeg"})"},
          {ErrorCode::forbidden, ErrorCode::full}),
      method<Empty, StreamState>(
          "stream.pause", Call::personal,
          "Stops this viewer's pictures, for instance while nobody can see them.",
          {no_params, R"({"width": 1280, "height": 720, "quality": 80, "max_fps": 60.0,
               "paused": true, "codec": "jpeg", "still": "jpeg"})"}),
      method<Empty, StreamState>(
          "stream.resume", Call::personal,
          "Lets this viewer's pictures come again, beginning with the newest.",
          {no_params, R"({"width": 1280, "height": 720, "quality": 80, "max_fps": 60.0,
               "paused": false, "codec": "jpeg", "still": "jpeg"})"}),
      method<StreamAck, Empty>(
          "stream.ack", Call::personal,
          "Tells that a frame was displayed. The server sends only a window of frames ahead.",
          {R"({"frame_seq": 42, "decode_us": 3100, "present_us": 9800})", "{}"}),
      method<StatsSubscription, StatsSubscription>(
          "stats.subscribe", Call::personal,
          "Asks for stats.frame notifications; gives the interval in effect.",
          {R"({"interval_ms": 250})", R"({"interval_ms": 250})"}),
      method<Empty, FrameBuffers>(
          "frame.buffers", Call::query,
          "Lists what can be shown or captured: the buffers of the newest picture, which follow "
          "from "
          "scene and settings.",
          {no_params,
           R"({"buffers": [{"name": "output", "description": "The finished picture."}]})"}),
      method<FrameCapture, CapturedFrame>(
          "frame.capture", Call::query, "Renders one buffer and gives it as a file.",
          {R"({"buffer": "output", "samples": 16})",
           R"({"buffer": "output", "format": "png", "width": 1280, "height": 720, "samples": 16,
               "data": "iVBORw0KGgo="})"},
          {ErrorCode::full}),
      method<Empty, RawJson>("rpc.discover", Call::query, "Gives this document.",
                             {no_params, R"({"openrpc": "1.3.2"})"}),
  };
}

constexpr std::string_view light = R"({
  "light": {"name": "sun", "type": "directional", "enabled": true, "color": [1.0, 0.9, 0.8],
            "intensity": 6.0, "direction": [-0.6, -0.77, -0.2], "angular_diameter": 0.53,
            "changed": ["intensity"]},
  "rev": 12})";

constexpr std::string_view material = R"({
  "material": {"name": "floor", "base_color": [0.8, 0.8, 0.8], "roughness": 0.2,
               "metallic": 0.0, "emissive": [0.0, 0.0, 0.0], "normal_scale": 1.0,
               "occlusion_strength": 1.0, "textures": [], "changed": ["roughness"]},
  "rev": 13})";

constexpr std::string_view environment = R"({
  "environments": [{"name": "sky", "bytes": 524288}], "current": "sky", "rotation": 30.0,
  "intensity": 1.0, "rev": 14})";

std::vector<MethodDescriptor> edit_methods() {
  return {
      method<Empty, LightList>(
          "lights.list", Call::query, "Lists the lights of the scene as this session has them.",
          {no_params, R"({"lights": [{"name": "sun", "type": "directional", "enabled": true,
              "color": [1.0, 0.9, 0.8], "intensity": 6.0, "direction": [-0.6, -0.77, -0.2],
              "angular_diameter": 0.53, "changed": []}], "rev": 12})"}),
      method<LightsPatch, LightState>(
          "lights.patch", Call::command,
          "Changes a light of this session's scene by a merge patch (RFC 7386).",
          {R"({"light": "sun", "patch": {"intensity": 6.0, "angular_diameter": null}})", light}),
      method<Empty, MaterialList>(
          "materials.list", Call::query,
          "Lists the materials of the scene as this session has them.",
          {no_params, R"({"materials": [{"name": "floor", "base_color": [0.8, 0.8, 0.8],
              "roughness": 0.2, "metallic": 0.0, "emissive": [0.0, 0.0, 0.0], "normal_scale": 1.0,
              "occlusion_strength": 1.0, "textures": [], "changed": []}], "rev": 13})"}),
      method<MaterialsPatch, MaterialState>(
          "materials.patch", Call::command,
          "Changes a material of this session's scene by a merge patch (RFC 7386).",
          {R"({"material": "floor", "patch": {"roughness": 0.2}})", material}),
      method<Empty, EnvironmentState>(
          "environment.list", Call::query,
          "Lists the environments that can be put around the scene and tells which one is.",
          {no_params, environment}),
      method<EnvironmentSet, EnvironmentState>(
          "environment.set", Call::command,
          "Puts another environment around this session's scene, or turns it.",
          {R"({"name": "sky", "rotation": 30.0})", environment}, {ErrorCode::full}),
  };
}

constexpr std::string_view reference = R"({
  "shown": true, "scope": "same_paths", "samples": 12, "target_samples": 256, "finished": false,
  "rev": 15})";

std::vector<MethodDescriptor> frame_methods() {
  return {
      method<FrameStep, StepState>(
          "frame.step", Call::command,
          "Renders exactly so many frames of dt seconds and answers when they are done. Time "
          "passes no other way until frame.run; the first call forgets every history.",
          {R"({"frames": 4, "dt": 0.04})",
           R"({"lockstep": true, "seconds": 0.16, "frames": 4, "samples": 4, "rev": 16})"},
          {ErrorCode::conflict, ErrorCode::full}),
      method<Empty, StepState>(
          "frame.run", Call::command, "Lets time pass by itself again after frame.step.",
          {no_params,
           R"({"lockstep": false, "seconds": 0.0, "frames": 4, "samples": 4, "rev": 17})"}),
      method<ReferenceStart, ReferenceState>(
          "reference.start", Call::command,
          "Shows the path traced truth and gathers its samples, whether anybody watches or not.",
          {R"({"scope": "same_paths", "samples": 256})", reference}),
      method<Empty, ReferenceState>("reference.status", Call::query,
                                    "Tells how far the path traced truth is.",
                                    {no_params, reference}),
      method<Empty, ReferenceState>(
          "reference.stop", Call::command,
          "Shows the hybrid picture again; what reference.start had set is as it was before.",
          {no_params, R"({"shown": false, "scope": "same_paths", "samples": 0, "target_samples": 64,
                          "finished": false, "rev": 18})"}),
  };
}

std::vector<MethodDescriptor> probe_methods() {
  return {
      method<ImagePoint, PickResult>(
          "scene.pick", Call::query, "Tells what surface lies under a point of the picture.",
          {R"({"x": 0.5, "y": 0.5})",
           R"({"hit": true, "position": [0.0, 0.5, 1.0], "normal": [0.0, 0.0, 1.0],
               "distance": 4.2, "object": "sphere", "material": "chrome"})"},
          {ErrorCode::conflict, ErrorCode::full}),
      method<ImagePoint, Inspection>(
          "frame.inspect", Call::query,
          "Gives the value of every buffer under a point of the picture.",
          {R"({"x": 0.5, "y": 0.5})",
           R"({"column": 640, "row": 360, "width": 1280, "height": 720,
               "buffers": [{"name": "gbuffer.motion.view_z", "value": [4.2],
                            "unit": "metres"}]})"},
          {ErrorCode::full}),
  };
}

}  // namespace

std::span<const MethodDescriptor> methods() {
  static const std::vector<MethodDescriptor> all = [] {
    std::vector<MethodDescriptor> list = session_methods();
    for (const auto& more : {membership_methods(), stream_methods(), animation_methods(),
                             edit_methods(), probe_methods(), frame_methods()}) {
      list.insert(list.end(), more.begin(), more.end());
    }
    return list;
  }();
  return all;
}

std::span<const NotificationDescriptor> notifications() {
  static const std::vector<NotificationDescriptor> all{
      notification<SessionInfo>("session.changed",
                                "Somebody came, left or was given control of this session, or its "
                                "pictures have another size."),
      notification<SessionClosed>(
          "session.closed", "This session has ended; the connection is closed with code 4003."),
      notification<DeviceChanged>(
          "device.changed", "The device was lost, or is back; sessions keep all but histories."),
      notification<SettingsChanged>("settings.changed", "Another viewer changed settings."),
      notification<CameraChanged>("camera.changed", "Another viewer moved the camera."),
      notification<AnimationChanged>(
          "animation.changed",
          "Another viewer let a clip play, stop, jump or go at another rate, or began or ended "
          "lockstep. Time that just passes is not told."),
      notification<LockstepChanged>(
          "lockstep.changed", "Another viewer began or ended lockstep; single steps are not told."),
      notification<SceneProgress>("scene.progress", "A scene is being loaded."),
      notification<SceneChanged>("scene.changed", "Another scene is shown now."),
      notification<SceneUnloaded>("scene.unloaded", "No scene is shown now."),
      notification<LightsChanged>("lights.changed", "Another viewer changed a light."),
      notification<MaterialsChanged>("materials.changed", "Another viewer changed a material."),
      notification<EnvironmentChanged>("environment.changed",
                                       "Another viewer put another environment around the scene."),
      notification<StatsFrame>("stats.frame", "Timings of a picture, for subscribers."),
  };
  return all;
}

}  // namespace heliograph::protocol
