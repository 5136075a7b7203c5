// Every message of heliograph.v1, made by generate.py from `heliograph schema`.

import type { JsonObject, Vector3 } from "./json.ts";

export const subprotocol = "heliograph.v1";

/** Parameters of hello. */
export interface HelloParams {
  /** Name and version of the client, for the log. */
  client?: string;
  /** Frame codecs that the client can decode, preferred first. */
  codecs?: string[];
  /**
   * On reconnect: the `instance` of the server process that `session` was on. If it differs, the
   * server picks a session that other viewers do not use; see `restore_state`.
   */
  instance?: string;
  /** Display name, shown to the other viewers of the session. */
  name?: string;
  /** The session to join; absent: the one in /ws?session=NAME, or main. */
  session?: string;
}

export interface HelloDevice {
  /** Name and version of its driver. */
  driver: string;
  /** Name of the Vulkan device. */
  name: string;
  /** Kind of device. */
  type: "cpu" | "integrated" | "discrete" | "virtual" | "other";
}

export interface HelloLimits {
  /**
   * Frames that the server sends ahead of the newest stream.ack; up to 8 where the round trip is
   * long.
   */
  ack_window: number;
  /** Maximum number of calls of a batch. */
  max_batch: number;
  /** Maximum frame height. [pixels] */
  max_height: number;
  /** Maximum size of a message to the server. [bytes] */
  max_message_bytes: number;
  /**
   * Maximum number of pending captures of a session; also of pending steps, and of pending picks
   * and inspections.
   */
  max_pending: number;
  /** Maximum size of an uploaded scene; 0: uploads are not allowed. [bytes] */
  max_upload_bytes: number;
  /** Maximum frame width. [pixels] */
  max_width: number;
}

/** Result of hello. */
export interface Hello {
  /** Why the client's preferred codec is not used; null if it is. */
  codec_reason: string | null;
  /** Codecs of the frames that follow, preferred first. */
  codecs: string[];
  /** The device that renders. */
  device: HelloDevice;
  /**
   * Identifies this run of the server. If it differs after a reconnect, the session state is lost
   * and the client sends its requests again.
   */
  instance: string;
  /** Limits of the server. */
  limits: HelloLimits;
  /** Name and version of the protocol. */
  protocol: string;
  /**
   * After a reconnect to another run of the server: true: the client restores the session's state;
   * false: another viewer of that session does; null: no session was available, or this is no
   * reconnect.
   */
  restore_state: boolean | null;
  /** Revision of the session's state. */
  rev: number;
  /**
   * What the client's token allows: control or view only; session.info tells which viewers have
   * control.
   */
  role: "view" | "control";
  /** The session that the viewer is in. */
  session: string;
  /** The ray tracer in use. */
  tracer: "embree" | "software" | "ray_query" | "ray_pipeline";
  /** Version of the server. */
  version: string;
  /** This viewer's id: `by` in notifications to other viewers. */
  viewer: string;
}

export interface SceneEntry {
  /** Size of the file. [bytes] */
  bytes: number;
  /** Name for scene.load. */
  name: string;
}

/** Result of scene.list. */
export interface SceneList {
  /** Name of the loaded scene, or null. */
  current: string | null;
  /** The scenes of the server's catalogue. */
  scenes: SceneEntry[];
}

/** Parameters of scene.load. */
export interface SceneLoadParams {
  /** A name from scene.list. */
  name: string;
  /**
   * The scene to load from a file with several: its name, or its index from 0. Absent: the file's
   * default.
   */
  scene?: string;
  /** Material variant of the file to apply. Absent: the default materials. */
  variant?: string;
}

export interface SceneInfoBounds {
  /** Maximum corner, world space. [metres] */
  max: Vector3;
  /** Minimum corner, world space. [metres] */
  min: Vector3;
}

export interface ClipInfo {
  /** Duration; the clip loops. [seconds] */
  duration: number;
  /** Name for animation.play. */
  name: string;
}

export interface SceneInfoMemory {
  /** Tables, textures and acceleration structures on the device. [bytes] */
  device: number;
  /** The files on disk. [bytes] */
  file: number;
  /** Geometry, animations and tables in the server's memory. [bytes] */
  host: number;
}

/** Result of scene.load. */
export interface SceneInfo {
  /** Bounding box of the scene. */
  bounds: SceneInfoBounds;
  /** Names for camera.set. */
  cameras: string[];
  /** Animation clips for animation.play. */
  clips: ClipInfo[];
  /** Meshes with skinning or morph targets. */
  deforming: number;
  /** File of the scene's own environment; null: constant white. */
  environment: string | null;
  /** Unique images that textures use. */
  images: number;
  /** Instances of meshes. */
  instances: number;
  /** Names of the lights. */
  light_names: string[];
  /** Punctual and directional lights. */
  lights: number;
  /** Names of the materials. */
  material_names: string[];
  /** Materials. */
  materials: number;
  /** Memory use of the scene. */
  memory: SceneInfoMemory;
  /** Unique meshes. */
  meshes: number;
  /** Name in the catalogue. */
  name: string;
  /** Nodes of the scene's hierarchy. */
  nodes: number;
  /** Index of the loaded scene in `scenes`. */
  scene: number;
  /** Names of the file's scenes; a name may be empty. */
  scenes: string[];
  /** Texels of the images at full size. */
  texels: number;
  /** Textures. */
  textures: number;
  /** Triangles over all instances. */
  triangles: number;
  /** The applied material variant; null: the default materials. */
  variant: string | null;
  /** Names of the file's material variants. */
  variants: string[];
  /** Vertices of the unique meshes. */
  vertices: number;
  /** What the importer skipped, approximated or repaired. */
  warnings: string[];
}

/** Result of scene.cancel. */
export interface SceneCancelResult {
  /** Whether a load was cancelled; its scene.load returns an error. */
  cancelled: boolean;
}

/** Result of camera.get. */
export interface Camera {
  /** Position of the camera, world space. [metres] */
  eye: Vector3;
  /** Name of the scene camera; null after it was moved. */
  name: string | null;
  /** Revision of the session's state. */
  rev: number;
  /** The point at the centre of the image. [metres] */
  target: Vector3;
  /** The up direction of the image. */
  up: Vector3;
  /** Vertical field of view. [degrees] */
  vertical_fov: number;
}

/** Parameters of camera.set. */
export interface CameraSetParams {
  /** Position of the camera, world space. [metres] */
  eye?: Vector3;
  /** A scene camera to start from; the other members are applied on top. */
  name?: string;
  /** The client's sequence number; frames that show this camera echo it as input_seq_echo. */
  seq?: number;
  /** The point at the centre of the image. [metres] */
  target?: Vector3;
  /** The up direction of the image. */
  up?: Vector3;
  /** Vertical field of view. [degrees] */
  vertical_fov?: number;
}

/** Parameters of camera.orbit. */
export interface CameraOrbitParams {
  /** New distance to the target. [metres] */
  distance?: number;
  /** Factor on the distance: below 1 moves closer. */
  dolly?: number;
  /** Positive raises the camera, negative lowers it; it stops short of the poles. [degrees] */
  pitch?: number;
  /** The client's sequence number; frames that show this camera echo it as input_seq_echo. */
  seq?: number;
  /** Rotation about the up axis, counter-clockwise seen from above. [degrees] */
  yaw?: number;
}

/** Result of settings.get. */
export interface SettingsState {
  /** Revision of the session's state. */
  rev: number;
  /** The whole tree of settings. */
  settings: JsonObject;
}

/** Parameters of settings.patch. */
export interface SettingsPatchParams {
  /** A merge patch of the settings tree (RFC 7386): null resets to the default. */
  patch: JsonObject;
}

/** Result of settings.patch. */
export interface AppliedSettings {
  /** The patch as applied: each null is replaced by the default value. */
  applied: JsonObject;
  /** Revision of the session's state. */
  rev: number;
}

export interface PresetInfo {
  /** Description of the preset. */
  description: string;
  /** Name for settings.preset. */
  name: string;
}

/** Result of settings.presets. */
export interface SettingsPresetsResult {
  /** The presets: the paper's steps in order, then best. */
  presets: PresetInfo[];
}

/** Parameters of settings.preset. */
export interface SettingsPresetParams {
  /** A name from settings.presets. */
  name: string;
}

/** Parameters of session.create. */
export interface SessionCreateParams {
  /** A session from which scene, camera, clip, settings and size are copied. */
  copy_of?: string;
  /** Frame height. [pixels] */
  height?: number;
  /** Letters, digits, dots, hyphens and underscores; absent: the server chooses. */
  name?: string;
  /** A name from scene.list; the call returns when the scene is loaded. */
  scene?: string;
  /**
   * A merge patch of the settings tree (RFC 7386), applied to the server's defaults or the copied
   * settings.
   */
  settings?: JsonObject;
  /** Frame width. [pixels] */
  width?: number;
}

export interface ViewerInfo {
  /** Whether it has control of the session. */
  control: boolean;
  /** Display name of the viewer; null: not given. */
  name: string | null;
  /** The viewer's id. */
  viewer: string;
  /** Whether it is the receiver of this message. */
  you: boolean;
}

/** Result of session.create. */
export interface SessionInfo {
  /** Whether all viewers have control (shared) or one viewer (exclusive). */
  control: "shared" | "exclusive";
  /** Frame height. [pixels] */
  height: number;
  /** Time since the session last had a viewer, a call or a frame to render. [seconds] */
  idle_seconds: number;
  /** Name for session.join. */
  name: string;
  /** Revision of the session's state. */
  rev: number;
  /** The loaded scene; null: none. */
  scene: string | null;
  /** The viewers in it, in order of arrival. */
  viewers: ViewerInfo[];
  /** Frame width. [pixels] */
  width: number;
}

/** Parameters of session.join. */
export interface SessionJoinParams {
  /** A name from session.list. */
  session: string;
}

/** Result of session.join. */
export interface SessionJoinResult {
  /** The session. */
  info: SessionInfo;
  /** Revision of the session's state. */
  rev: number;
  /** The session that the viewer is in now. */
  session: string;
  /** This viewer's id; it does not change. */
  viewer: string;
}

export interface SessionListLimits {
  /** Idle time after which a session other than main is closed; 0: never. [seconds] */
  idle_timeout: number;
  /** Maximum sum of the frame sizes of all sessions. */
  pixels: number;
  /** Current sum of the frame sizes. */
  pixels_used: number;
  /** Maximum number of viewers of a session. */
  session_viewers: number;
  /** Maximum number of sessions. */
  sessions: number;
  /** Maximum number of viewers over all sessions. */
  viewers: number;
}

/** Result of session.list. */
export interface SessionList {
  /** Limits of the server. */
  limits: SessionListLimits;
  /** All sessions, by name. */
  sessions: SessionInfo[];
}

/** Parameters of session.control. */
export interface SessionControlParams {
  /** In exclusive mode: take control while it is free, give it to `viewer`, or release it. */
  action?: "take" | "give" | "release";
  /**
   * shared: all viewers have control; exclusive: one viewer has, the one that `viewer` names or the
   * caller.
   */
  mode?: "shared" | "exclusive";
  /** Id of the viewer that gets control. */
  viewer?: string;
}

/** Parameters of stream.configure. */
export interface StreamConfigureParams {
  /** Codec of moving frames; one of those that hello returned. */
  codec?: "jpeg" | "h264";
  /** Frame height. [pixels] */
  height?: number;
  /** Maximum frame rate. */
  max_fps?: number;
  /** Whether the stream is paused. */
  paused?: boolean;
  /** Quality on the scale of JPEG, for any codec. */
  quality?: number;
  /**
   * Format of the final image of a static view: JPEG without chroma subsampling, or lossless PNG.
   */
  still?: "jpeg" | "png";
  /** Frame width. [pixels] */
  width?: number;
}

/** Result of stream.configure. */
export interface StreamSettings {
  /** Codec of moving frames. */
  codec: "jpeg" | "h264";
  /** Frame height in effect. [pixels] */
  height: number;
  /** Maximum frame rate. */
  max_fps: number;
  /** Whether the stream is paused. */
  paused: boolean;
  /** Requested quality; it is reduced on a slow connection. */
  quality: number;
  /** Format of the final image of a static view. */
  still: "jpeg" | "png";
  /** Frame width in effect. [pixels] */
  width: number;
}

/** Parameters of stream.ack. */
export interface StreamAckParams {
  /** `frame_seq` of the frame's header. */
  frame_seq: number;
  /** Time that the client took to decode it. [microseconds] */
  decode_us?: number;
  /** Time from its arrival to its display. [microseconds] */
  present_us?: number;
}

/** Parameters of stats.subscribe. */
export interface StatsSubscribeParams {
  /** Minimum time between two stats.frame notifications; 0: no notifications. [milliseconds] */
  interval_ms: number;
}

export interface BufferInfo {
  /** Content, channels and unit. */
  description: string;
  /** Name for view.buffer and frame.capture. */
  name: string;
}

/** Result of frame.buffers. */
export interface FrameBuffersResult {
  /** The available buffers; `output` is the first. */
  buffers: BufferInfo[];
}

/** Parameters of frame.capture. */
export interface FrameCaptureParams {
  /** A name from frame.buffers. */
  buffer?: string;
  /** Format of the file: png and jpeg for viewing, npy and exr for values. */
  format?: "png" | "jpeg" | "npy" | "exr";
  /**
   * Samples per pixel to wait for, at most accumulation.max_samples, 1 without accumulation;
   * absent: wait for the converged frame.
   */
  samples?: number;
}

/** Result of frame.capture. */
export interface Capture {
  /** The buffer that was captured. */
  buffer: string;
  /** The file as base64 (RFC 4648). */
  data: string;
  /** Format of the file. */
  format: "png" | "jpeg" | "npy" | "exr";
  /** Frame height. [pixels] */
  height: number;
  /** Samples accumulated per pixel. */
  samples: number;
  /** Frame width. [pixels] */
  width: number;
}

/** Result of animation.list. */
export interface AnimationState {
  /** The clip that poses the scene; null: the default pose. */
  clip: string | null;
  /** The clips of the scene. */
  clips: ClipInfo[];
  /** Whether time advances by frame.step only, also while playing. */
  lockstep: boolean;
  /** Whether the clip is playing. */
  playing: boolean;
  /** Playback speed: clip seconds per second. */
  rate: number;
  /** Revision of the session's state. */
  rev: number;
  /** Time in the clip. [seconds] */
  seconds: number;
}

/** Parameters of animation.play. */
export interface AnimationPlayParams {
  /** The clip to play from its start; absent: continue the current clip, or play the first. */
  clip?: string;
  /** Playback speed: clip seconds per second. */
  rate?: number;
}

/** Parameters of animation.seek. */
export interface AnimationSeekParams {
  /** Time in the clip to seek to. [seconds] */
  seconds: number;
}

/** Parameters of animation.rate. */
export interface AnimationRateParams {
  /** Playback speed: clip seconds per second. */
  rate: number;
}

export interface LightInfo {
  /** Apparent diameter of a directional light. [degrees] */
  angular_diameter?: number;
  /** Members that differ from the scene file. */
  changed: string[];
  /** Linear colour. */
  color: Vector3;
  /** Direction of the light rays, world space; absent for point lights. */
  direction?: Vector3;
  /** Whether the light is on. */
  enabled: boolean;
  /** Height of a rectangle. [metres] */
  height?: number;
  /**
   * Factor on the colour: lux (directional), candela (point, spot) or radiance (rectangle, disk).
   */
  intensity: number;
  /** Unique name for lights.patch. */
  name: string;
  /** Centre, world space; absent for directional lights. [metres] */
  position?: Vector3;
  /** Radius of point, spot and disk lights. [metres] */
  radius?: number;
  /** Range of point and spot lights; 0: unlimited. [metres] */
  range?: number;
  /** Type of the light. */
  type: "directional" | "point" | "spot" | "rectangle" | "disk";
  /** Width of a rectangle. [metres] */
  width?: number;
}

/** Result of lights.list. */
export interface LightsListResult {
  /** The lights of the scene with the session's edits. */
  lights: LightInfo[];
  /** Revision of the session's state. */
  rev: number;
}

export interface LightPatch {
  /** Apparent diameter: larger lights cast softer shadows; the sun's is 0.53. [degrees] */
  angular_diameter?: number | null;
  /** Linear colour. */
  color?: Vector3 | null;
  /** Direction of the light rays, world space; any length except 0. */
  direction?: Vector3 | null;
  /** Whether the light is on. */
  enabled?: boolean | null;
  /** Height of a rectangle. [metres] */
  height?: number | null;
  /** Factor on the colour. */
  intensity?: number | null;
  /** Centre, world space. [metres] */
  position?: Vector3 | null;
  /** Radius: larger lights cast softer shadows. [metres] */
  radius?: number | null;
  /** Range; 0: unlimited. [metres] */
  range?: number | null;
  /** Width of a rectangle. [metres] */
  width?: number | null;
}

/** Parameters of lights.patch. */
export interface LightsPatchParams {
  /** A name from lights.list. */
  light: string;
  /** A merge patch (RFC 7386); null restores the value of the scene file. */
  patch: LightPatch;
}

/** Result of lights.patch. */
export interface LightsPatchResult {
  /** The light after the change. */
  light: LightInfo;
  /** Revision of the session's state. */
  rev: number;
}

export interface MaterialInfo {
  /** Linear factor on the texture, if any. */
  base_color: Vector3;
  /** Members that differ from the scene file. */
  changed: string[];
  /** Linear emitted radiance, factor on the texture, if any. */
  emissive: Vector3;
  /** Metalness, factor on the texture, if any. */
  metallic: number;
  /** Unique name for materials.patch. */
  name: string;
  /** Scale of the normal texture. */
  normal_scale: number;
  /** Strength of the occlusion texture. */
  occlusion_strength: number;
  /** Perceptual roughness, factor on the texture, if any. */
  roughness: number;
  /** Members that have a texture. */
  textures: string[];
}

/** Result of materials.list. */
export interface MaterialsListResult {
  /** The materials of the scene with the session's edits. */
  materials: MaterialInfo[];
  /** Revision of the session's state. */
  rev: number;
}

export interface MaterialPatch {
  /** Linear factor. */
  base_color?: Vector3 | null;
  /** Linear emitted radiance. */
  emissive?: Vector3 | null;
  /** Metalness. */
  metallic?: number | null;
  /** Scale of the normal texture. */
  normal_scale?: number | null;
  /** Strength of the occlusion texture. */
  occlusion_strength?: number | null;
  /** Perceptual roughness. */
  roughness?: number | null;
}

/** Parameters of materials.patch. */
export interface MaterialsPatchParams {
  /** A name from materials.list. */
  material: string;
  /** A merge patch (RFC 7386); null restores the value of the scene file. */
  patch: MaterialPatch;
}

/** Result of materials.patch. */
export interface MaterialsPatchResult {
  /** The material after the change. */
  material: MaterialInfo;
  /** Revision of the session's state. */
  rev: number;
}

export interface EnvironmentInfo {
  /** Size of the file. [bytes] */
  bytes: number;
  /** Name for environment.set. */
  name: string;
}

/** Result of environment.list. */
export interface EnvironmentState {
  /** The chosen environment; null: the scene's own. */
  current: string | null;
  /** The environments of the server's catalogue. */
  environments: EnvironmentInfo[];
  /** The setting environment.intensity. */
  intensity: number;
  /** Revision of the session's state. */
  rev: number;
  /** The setting environment.rotation. [degrees] */
  rotation: number;
}

/** Parameters of environment.set. */
export interface EnvironmentSetParams {
  /** A name from environment.list; null: the scene's own. */
  name?: string | null;
  /** Also sets environment.rotation. [degrees] */
  rotation?: number;
}

/** Parameters of scene.pick. */
export interface ScenePickParams {
  /** Fraction of the image width, from the left. */
  x: number;
  /** Fraction of the image height, from the top. */
  y: number;
}

/** Result of scene.pick. */
export interface Pick {
  /** Distance from the camera. [metres] */
  distance: number | null;
  /** Whether there is a surface; if not, the other members are null. */
  hit: boolean;
  /** Name for materials.patch. */
  material: string | null;
  /** Geometric normal, facing the camera, world space. */
  normal: Vector3 | null;
  /** Name of the node, otherwise of the mesh. */
  object: string | null;
  /** Position on the surface, world space. [metres] */
  position: Vector3 | null;
}

export interface BufferValue {
  /** Name of the buffer. */
  name: string;
  /** Unit of the values; empty: dimensionless. */
  unit: string;
  /** Values of its channels, which frame.buffers describes; null: not finite. */
  value: (number | null)[];
}

/** Result of frame.inspect. */
export interface Inspection {
  /** The value of every buffer at that pixel. */
  buffers: BufferValue[];
  /** Column of the pixel, from the left. */
  column: number;
  /** Height of the image. [pixels] */
  height: number;
  /** Row of the pixel, from the top. */
  row: number;
  /** Width of the image. [pixels] */
  width: number;
}

/** Parameters of frame.step. */
export interface FrameStepParams {
  /** Time step before each frame. [seconds] */
  dt: number;
  /** Number of frames to render; 0 enters lockstep without rendering. */
  frames?: number;
}

/** Result of frame.step. */
export interface LockstepState {
  /** Frames rendered since lockstep was entered. */
  frames: number;
  /** Whether time advances by frame.step only. */
  lockstep: boolean;
  /** Revision of the session's state. */
  rev: number;
  /** Samples per pixel accumulated in the newest frame. */
  samples: number;
  /** Time since lockstep was entered. [seconds] */
  seconds: number;
}

/** Parameters of reference.start. */
export interface ReferenceStartParams {
  /** Samples per pixel to accumulate: sets accumulation.max_samples. */
  samples?: number;
  /** Light paths to trace: sets reference.scope. */
  scope?: "same_paths" | "full";
}

/** Result of reference.start. */
export interface ReferenceState {
  /** Whether the target is reached. */
  finished: boolean;
  /** Revision of the session's state. */
  rev: number;
  /** Samples per pixel accumulated so far. */
  samples: number;
  /** Light paths that are traced. */
  scope: "same_paths" | "full";
  /** Whether the reference image is shown: the setting reference.use is always. */
  shown: boolean;
  /** Samples per pixel of the finished image. */
  target_samples: number;
}

/** Parameters of the notification session.closed. */
export interface SessionClosedNotification {
  /** The reason, as a sentence. */
  reason: string;
  /** The session that was closed. */
  session: string;
}

/** Parameters of the notification device.changed. */
export interface DeviceChangedNotification {
  /** What happened, as a sentence. */
  message: string;
  /** Whether frames can be rendered. */
  ready: boolean;
}

/** Parameters of the notification settings.changed. */
export interface SettingsChangedNotification {
  /** The viewer that changed them; empty: the server. */
  by: string;
  /** The settings that changed. */
  patch: JsonObject;
  /** Revision of the session's state. */
  rev: number;
}

/** Parameters of the notification camera.changed. */
export interface CameraChangedNotification {
  /** The viewer that moved it; empty: the server. */
  by: string;
  /** The camera after the change. */
  camera: Camera;
}

/** Parameters of the notification animation.changed. */
export interface AnimationChangedNotification {
  /** The new state of playback. */
  animation: AnimationState;
  /** The viewer that changed it; empty: the server. */
  by: string;
}

/** Parameters of the notification lockstep.changed. */
export interface LockstepChangedNotification {
  /** The viewer that entered or left lockstep; empty: the server. */
  by: string;
  /** The state that frame.step would return now. */
  state: LockstepState;
}

/** Parameters of the notification scene.progress. */
export interface SceneProgress {
  /** Fraction of the work that is done. */
  fraction: number;
  /** The scene that is being loaded. */
  name: string;
  /** Stage of loading. */
  stage: string;
}

/** Parameters of the notification scene.changed. */
export interface SceneChangedNotification {
  /** The scene that was loaded. */
  scene: SceneInfo;
}

/** Parameters of the notification scene.unloaded. */
export interface SceneUnloadedNotification {
  /** The viewer that unloaded it; empty: the server. */
  by: string;
  /** The scene that was unloaded. */
  name: string;
}

/** Parameters of the notification lights.changed. */
export interface LightsChangedNotification {
  /** The viewer that changed it; empty: the server. */
  by: string;
  /** The light after the change. */
  light: LightInfo;
  /** Revision of the session's state. */
  rev: number;
}

/** Parameters of the notification materials.changed. */
export interface MaterialsChangedNotification {
  /** The viewer that changed it; empty: the server. */
  by: string;
  /** The material after the change. */
  material: MaterialInfo;
  /** Revision of the session's state. */
  rev: number;
}

/** Parameters of the notification environment.changed. */
export interface EnvironmentChangedNotification {
  /** The viewer that chose it; empty: the server. */
  by: string;
  /** The chosen environment; null: the scene's own. */
  current: string | null;
  /** Revision of the session's state. */
  rev: number;
}

export interface PassTiming {
  /** Where it ran: device (a shader) or host (the CPU). */
  kind: "device" | "host";
  /** Duration. [milliseconds] */
  ms: number;
  /** Name of the pass. */
  name: string;
}

/** Parameters of the notification stats.frame. */
export interface FrameStats {
  /** Size of the last frame sent to this viewer. [bytes] */
  bytes: number;
  /** Codec of moving frames chosen for this viewer. */
  codec: "jpeg" | "h264";
  /** Time to encode the frame. [milliseconds] */
  encode_ms: number;
  /** Frames rendered in the last second. */
  fps: number;
  /** Time to render the frame. [milliseconds] */
  frame_ms: number;
  /** Measured throughput to this viewer while frames are in flight. [bytes per second] */
  goodput: number;
  /** Frame height. [pixels] */
  height: number;
  /** The frame's passes in execution order. */
  passes: PassTiming[];
  /** Quality of moving frames chosen for this viewer. */
  quality: number;
  /** The rendered frame that the other members describe. */
  render_id: number;
  /** Time from sending a frame to this viewer to its acknowledgement. [milliseconds] */
  round_trip_ms: number;
  /** Samples accumulated per pixel. */
  samples: number;
  /** Scale of moving frames chosen for this viewer, relative to the full size. */
  scale: number;
  /** interactive: follows changes; refining: refines a static view; idle: finished. */
  state: "interactive" | "refining" | "idle";
  /** The ray tracer in use. */
  tracer: "embree" | "software" | "ray_query" | "ray_pipeline";
  /** Frame width. [pixels] */
  width: number;
}

/** What error.data holds. */
export interface ErrorData {
  /** What would be right. */
  limit?: string;
  /** The parameter or setting at fault. */
  path: string;
  /** What is wrong with it. */
  reason: string;
}

/** An object without members. */
export type Empty = Record<string, never>;

/** Parameters and result of every method, by its name. */
export interface Methods {
  /** Introduces a viewer: says what it can decode and learns who serves it. */
  "hello": { params: HelloParams; result: Hello };
  /** Lists the scenes that can be loaded. */
  "scene.list": { params: Empty; result: SceneList };
  /**
   * Loads a scene and shows it; scene.progress tells how far it is. On failure the scene that was
   * shown stays.
   */
  "scene.load": { params: SceneLoadParams; result: SceneInfo };
  /** Ends the load that the session waits for. What is shown stays. */
  "scene.cancel": { params: Empty; result: SceneCancelResult };
  /** Shows no scene any more. */
  "scene.unload": { params: Empty; result: Empty };
  /** Describes the scene that is shown. */
  "scene.info": { params: Empty; result: SceneInfo };
  /** Tells where the camera is. */
  "camera.get": { params: Empty; result: Camera };
  /** Moves the camera; members that are left out stay as they are. */
  "camera.set": { params: CameraSetParams; result: Camera };
  /** Carries the camera about its target, nearer or farther. */
  "camera.orbit": { params: CameraOrbitParams; result: Camera };
  /** Moves the camera back until the whole scene is in the picture. */
  "camera.fit": { params: Empty; result: Camera };
  /** Gives the whole tree of settings. */
  "settings.get": { params: Empty; result: SettingsState };
  /** Changes settings by a merge patch (RFC 7386): all of it or, on any error, nothing. */
  "settings.patch": { params: SettingsPatchParams; result: AppliedSettings };
  /** Lists the presets of the denoiser. */
  "settings.presets": { params: Empty; result: SettingsPresetsResult };
  /** Applies a preset, as settings.patch would; settings it does not name stay. */
  "settings.preset": { params: SettingsPresetParams; result: AppliedSettings };
  /** Gives the JSON Schema of the settings: types, defaults, limits, units, help. */
  "settings.schema": { params: Empty; result: JsonObject };
  /** Makes a session of its own scene, camera, settings, clock and histories. */
  "session.create": { params: SessionCreateParams; result: SessionInfo };
  /** Brings this viewer, with its stream as it is, into another session. */
  "session.join": { params: SessionJoinParams; result: SessionJoinResult };
  /** Lists the sessions and limits. */
  "session.list": { params: Empty; result: SessionList };
  /** Tells who is in this session and who has control. */
  "session.info": { params: Empty; result: SessionInfo };
  /**
   * Decides who may change the session: everyone, or one viewer who takes, gives or releases
   * control.
   */
  "session.control": { params: SessionControlParams; result: SessionInfo };
  /** Ends a session; its viewers are told and let go. main stays for ever. */
  "session.close": { params: SessionJoinParams; result: Empty };
  /** Sets size, quality and pace of this viewer's pictures; gives what is in effect. */
  "stream.configure": { params: StreamConfigureParams; result: StreamSettings };
  /** Stops this viewer's pictures, for instance while nobody can see them. */
  "stream.pause": { params: Empty; result: StreamSettings };
  /** Lets this viewer's pictures come again, beginning with the newest. */
  "stream.resume": { params: Empty; result: StreamSettings };
  /** Tells that a frame was displayed. The server sends only a window of frames ahead. */
  "stream.ack": { params: StreamAckParams; result: Empty };
  /** Asks for stats.frame notifications; gives the interval in effect. */
  "stats.subscribe": { params: StatsSubscribeParams; result: StatsSubscribeParams };
  /**
   * Lists what can be shown or captured: the buffers of the newest picture, which follow from scene
   * and settings.
   */
  "frame.buffers": { params: Empty; result: FrameBuffersResult };
  /** Renders one buffer and gives it as a file. */
  "frame.capture": { params: FrameCaptureParams; result: Capture };
  /** Gives this document. */
  "rpc.discover": { params: Empty; result: JsonObject };
  /** Lists the scene's clips and tells where the clip stands. */
  "animation.list": { params: Empty; result: AnimationState };
  /**
   * Lets time pass in a clip. A camera that the clip moves follows it until it is taken by hand.
   */
  "animation.play": { params: AnimationPlayParams; result: AnimationState };
  /** Stops time; the pose stays. */
  "animation.pause": { params: Empty; result: AnimationState };
  /** Goes to a moment of the clip. */
  "animation.seek": { params: AnimationSeekParams; result: AnimationState };
  /** Sets how fast time passes. */
  "animation.rate": { params: AnimationRateParams; result: AnimationState };
  /** Lists the lights of the scene as this session has them. */
  "lights.list": { params: Empty; result: LightsListResult };
  /** Changes a light of this session's scene by a merge patch (RFC 7386). */
  "lights.patch": { params: LightsPatchParams; result: LightsPatchResult };
  /** Lists the materials of the scene as this session has them. */
  "materials.list": { params: Empty; result: MaterialsListResult };
  /** Changes a material of this session's scene by a merge patch (RFC 7386). */
  "materials.patch": { params: MaterialsPatchParams; result: MaterialsPatchResult };
  /** Lists the environments that can be put around the scene and tells which one is. */
  "environment.list": { params: Empty; result: EnvironmentState };
  /** Puts another environment around this session's scene, or turns it. */
  "environment.set": { params: EnvironmentSetParams; result: EnvironmentState };
  /** Tells what surface lies under a point of the picture. */
  "scene.pick": { params: ScenePickParams; result: Pick };
  /** Gives the value of every buffer under a point of the picture. */
  "frame.inspect": { params: ScenePickParams; result: Inspection };
  /**
   * Renders exactly so many frames of dt seconds and answers when they are done. Time passes no
   * other way until frame.run; the first call forgets every history.
   */
  "frame.step": { params: FrameStepParams; result: LockstepState };
  /** Lets time pass by itself again after frame.step. */
  "frame.run": { params: Empty; result: LockstepState };
  /** Shows the path traced truth and gathers its samples, whether anybody watches or not. */
  "reference.start": { params: ReferenceStartParams; result: ReferenceState };
  /** Tells how far the path traced truth is. */
  "reference.status": { params: Empty; result: ReferenceState };
  /** Shows the hybrid picture again; what reference.start had set is as it was before. */
  "reference.stop": { params: Empty; result: ReferenceState };
}

/** Parameters of every notification of the server. */
export interface Notifications {
  /**
   * Somebody came, left or was given control of this session, or its pictures have another size.
   */
  "session.changed": SessionInfo;
  /** This session has ended; the connection is closed with code 4003. */
  "session.closed": SessionClosedNotification;
  /** The device was lost, or is back; sessions keep all but histories. */
  "device.changed": DeviceChangedNotification;
  /** Another viewer changed settings. */
  "settings.changed": SettingsChangedNotification;
  /** Another viewer moved the camera. */
  "camera.changed": CameraChangedNotification;
  /**
   * Another viewer let a clip play, stop, jump or go at another rate, or began or ended lockstep.
   * Time that just passes is not told.
   */
  "animation.changed": AnimationChangedNotification;
  /** Another viewer began or ended lockstep; single steps are not told. */
  "lockstep.changed": LockstepChangedNotification;
  /** A scene is being loaded. */
  "scene.progress": SceneProgress;
  /** Another scene is shown now. */
  "scene.changed": SceneChangedNotification;
  /** No scene is shown now. */
  "scene.unloaded": SceneUnloadedNotification;
  /** Another viewer changed a light. */
  "lights.changed": LightsChangedNotification;
  /** Another viewer changed a material. */
  "materials.changed": MaterialsChangedNotification;
  /** Another viewer put another environment around the scene. */
  "environment.changed": EnvironmentChangedNotification;
  /** Timings of a picture, for subscribers. */
  "stats.frame": FrameStats;
}

export const ErrorCode = {
  /** The request contradicts what happened meanwhile. */
  conflict: -32009,
  /** The caller may not do this. */
  forbidden: -32001,
  /** The server has no room for more. */
  full: -32029,
  /** The server failed. */
  internal: -32603,
  /** A parameter is missing or not acceptable. */
  invalidParams: -32602,
  /** The JSON is not a request. */
  invalidRequest: -32600,
  /** What was named does not exist. */
  notFound: -32004,
  /** What the call needs is not there yet. */
  notReady: -32050,
  /** The text is not JSON. */
  parseError: -32700,
  /** Too many calls in too little time. */
  rateLimited: -32002,
  /** The message exceeds a limit. */
  tooLarge: -32013,
  /** The caller has not shown who it is. */
  unauthenticated: -32000,
  /** No method has this name. */
  unknownMethod: -32601,
} as const;
