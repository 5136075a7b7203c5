// Every message of heliograph.v1, made by generate.py from `heliograph schema`.

import type { JsonObject, Vector3 } from "./json.ts";

export const subprotocol = "heliograph.v1";

/** Parameters of hello. */
export interface HelloParams {
  /** Name and version of the client, for the log. */
  client?: string;
  /** Picture codecs the client can decode, best first. */
  codecs?: string[];
  /**
   * Of who comes back: the run of the server that `session` was on. Where it is another one, a
   * place that disturbs nobody is found; `bring` tells of it.
   */
  instance?: string;
  /** What the person is called, for the others in the session. */
  name?: string;
  /** The session to watch; left out: the one that /ws?session=NAME named, or main. */
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
   * Frames the server sends ahead of the newest stream.ack; on a long way more, but no more than 8.
   */
  ack_window: number;
  /** Most calls of a batch. */
  max_batch: number;
  /** Highest picture. [pixels] */
  max_height: number;
  /** Longest message the server reads. [bytes] */
  max_message_bytes: number;
  /** Largest scene that the client may send; 0: it may send none. [bytes] */
  max_upload_bytes: number;
  /**
   * Most captures of a session that wait for their picture; as many steps may wait beside them, and
   * as many questions about the picture.
   */
  max_waiting: number;
  /** Widest picture. [pixels] */
  max_width: number;
}

/** Result of hello. */
export interface Hello {
  /**
   * To who comes back from another run: true, to bring the session's state into this one; false,
   * that somebody who was there too does; null, that no place was found.
   */
  bring: boolean | null;
  /** Why the client's best codec is not used; null if it is. */
  codec_reason: string | null;
  /** Codecs of the frames that will come, best first. */
  codecs: string[];
  /** Where pictures are rendered. */
  device: HelloDevice;
  /**
   * Differs with every run of a server: where it is another, the session starts anew and a client
   * that comes back says again what it wants.
   */
  instance: string;
  /** What the server refuses to exceed. */
  limits: HelloLimits;
  /** Protocol and its version. */
  protocol: string;
  /** Revision of the session's state. */
  rev: number;
  /**
   * Whether this client's token lets it steer or only watch; session.info tells who has control.
   */
  role: "view" | "control";
  /** The session that is watched. */
  session: string;
  /** What traces the rays. */
  tracer: "embree" | "software" | "ray_query" | "ray_pipeline";
  /** Version of the server. */
  version: string;
  /** This viewer's id: the `by` of notifications to the others. */
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
  /** Name of the loaded scene. */
  current: string | null;
  /** The scenes of the server's catalogue. */
  scenes: SceneEntry[];
}

/** Parameters of scene.load. */
export interface SceneLoadParams {
  /** A name that scene.list gave. */
  name: string;
  /**
   * Which scene of a file that holds several: its name, or its number from 0. Left out: the file's
   * default.
   */
  scene?: string;
  /** Which of the file's material variants. Left out: the materials outside of them. */
  variant?: string;
}

export interface SceneInfoBounds {
  /** Greatest corner, world space. [metres] */
  max: Vector3;
  /** Least corner, world space. [metres] */
  min: Vector3;
}

export interface ClipInfo {
  /** Length; the clip loops. [seconds] */
  duration: number;
  /** Name for animation.play. */
  name: string;
}

export interface SceneInfoMemory {
  /** Tables, textures and acceleration structure on the device. [bytes] */
  device: number;
  /** The files that were read. [bytes] */
  file: number;
  /** Geometry, animation and tables of the server. [bytes] */
  host: number;
}

/** Result of scene.load. */
export interface SceneInfo {
  /** Box around everything. */
  bounds: SceneInfoBounds;
  /** Names for camera.set. */
  cameras: string[];
  /** What animation.play can play. */
  clips: ClipInfo[];
  /** Meshes that joints or morph targets move. */
  deforming: number;
  /** File of the environment that came with the scene; null: even white. */
  environment: string | null;
  /** Different images that textures use. */
  images: number;
  /** Meshes as placed in the scene. */
  instances: number;
  /** Names of the lights. */
  light_names: string[];
  /** Punctual and directional lights. */
  lights: number;
  /** Names of the materials. */
  material_names: string[];
  /** Materials. */
  materials: number;
  /** What the scene takes. */
  memory: SceneInfoMemory;
  /** Different meshes. */
  meshes: number;
  /** Name in the catalogue. */
  name: string;
  /** Nodes of the scene's hierarchy. */
  nodes: number;
  /** Number of the one that is shown. */
  scene: number;
  /** Names of the file's scenes, which may be empty. */
  scenes: string[];
  /** Texels of these, at full size. */
  texels: number;
  /** Textures. */
  textures: number;
  /** Triangles over all instances. */
  triangles: number;
  /** The one that is shown; null: the file's default. */
  variant: string | null;
  /** Names of the file's material variants. */
  variants: string[];
  /** Vertices of the different meshes. */
  vertices: number;
  /** What the importer left out, approximated or repaired. */
  warnings: string[];
}

/** Result of scene.cancel. */
export interface SceneCancelResult {
  /** Whether a scene was being loaded; its scene.load is answered by an error. */
  cancelled: boolean;
}

/** Result of camera.get. */
export interface Camera {
  /** Where the camera is, world space. [metres] */
  eye: Vector3;
  /** The scene camera this is, null once it was moved. */
  name: string | null;
  /** Revision of the session's state. */
  rev: number;
  /** The point in the middle of the picture. [metres] */
  target: Vector3;
  /** The direction that points up in the picture. */
  up: Vector3;
  /** Field of view, top to bottom. [degrees] */
  vertical_fov: number;
}

/** Parameters of camera.set. */
export interface CameraSetParams {
  /** Where the camera is, world space. [metres] */
  eye?: Vector3;
  /** A scene camera to begin from; the other members are applied on top. */
  name?: string;
  /** The client's own count; frames that show this camera echo it as input_seq_echo. */
  seq?: number;
  /** The point in the middle of the picture. [metres] */
  target?: Vector3;
  /** The direction that points up in the picture. */
  up?: Vector3;
  /** Field of view, top to bottom. [degrees] */
  vertical_fov?: number;
}

/** Parameters of camera.orbit. */
export interface CameraOrbitParams {
  /** How far from the target to be. [metres] */
  distance?: number;
  /** Factor on the distance: below 1 comes closer. */
  dolly?: number;
  /** Raises the camera, lowers it below 0; it stops short of straight above and below. [degrees] */
  pitch?: number;
  /** The client's own count; frames that show this camera echo it as input_seq_echo. */
  seq?: number;
  /** Turns about the up axis, counter-clockwise seen from above. [degrees] */
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
  /** Part of the settings tree (RFC 7386): null resets to the default. */
  patch: JsonObject;
}

/** Result of settings.patch. */
export interface AppliedSettings {
  /** The patch as applied: each null replaced by the value it led to. */
  applied: JsonObject;
  /** Revision of the session's state. */
  rev: number;
}

export interface PresetInfo {
  /** What it chooses, in a sentence. */
  description: string;
  /** Name for settings.preset. */
  name: string;
}

/** Result of settings.presets. */
export interface SettingsPresetsResult {
  /** The presets, each on top of the last, then best. */
  presets: PresetInfo[];
}

/** Parameters of settings.preset. */
export interface SettingsPresetParams {
  /** A name that settings.presets gave. */
  name: string;
}

/** Parameters of session.create. */
export interface SessionCreateParams {
  /** A session whose scene, camera, clip, settings and size it starts with. */
  copy_of?: string;
  /** Picture height. [pixels] */
  height?: number;
  /** Letters, digits, dots, hyphens and underscores; left out: the server chooses. */
  name?: string;
  /** A name that scene.list gave; it is loaded before the answer comes. */
  scene?: string;
  /** Part of the settings tree (RFC 7386), on top of the server's own or the copied. */
  settings?: JsonObject;
  /** Picture width. [pixels] */
  width?: number;
}

export interface ViewerInfo {
  /** Whether it may change what all see. */
  control: boolean;
  /** What the person is called; null: nobody said. */
  name: string | null;
  /** The viewer's id. */
  viewer: string;
  /** Whether it is the one that is told this. */
  you: boolean;
}

/** Result of session.create. */
export interface SessionInfo {
  /** Whether all viewers may change it or only one. */
  control: "everyone" | "one";
  /** Picture height. [pixels] */
  height: number;
  /** Time since it last had a viewer, a call or a picture to make. [seconds] */
  idle_seconds: number;
  /** Name for session.join. */
  name: string;
  /** Revision of the session's state. */
  rev: number;
  /** The scene that is shown, null before the first. */
  scene: string | null;
  /** Who is in it, in order of arrival. */
  viewers: ViewerInfo[];
  /** Picture width. [pixels] */
  width: number;
}

/** Parameters of session.join. */
export interface SessionJoinParams {
  /** A name that session.list gave. */
  session: string;
}

/** Result of session.join. */
export interface SessionJoinResult {
  /** The session. */
  info: SessionInfo;
  /** Revision of the session's state. */
  rev: number;
  /** The session that is watched now. */
  session: string;
  /** This viewer's id, the same as before. */
  viewer: string;
}

export interface SessionListLimits {
  /** Idle time after which a session other than main is closed; 0: never. [seconds] */
  idle_timeout: number;
  /** Most pixels of the pictures of all sessions together. */
  pixels: number;
  /** How many of them are taken. */
  pixels_used: number;
  /** Most viewers of a session. */
  session_viewers: number;
  /** Most sessions. */
  sessions: number;
  /** Most viewers of all sessions together. */
  viewers: number;
}

/** Result of session.list. */
export interface SessionList {
  /** What the server refuses to exceed. */
  limits: SessionListLimits;
  /** All sessions, by name. */
  sessions: SessionInfo[];
}

/** Parameters of session.control. */
export interface SessionControlParams {
  /**
   * Where one has control: take it while nobody has it, give it to `viewer`, or release it for
   * anybody to take.
   */
  action?: "take" | "give" | "release";
  /** Whether everyone has control or one viewer: the one that `viewer` names, else the caller. */
  mode?: "everyone" | "one";
  /** The id of who is to have control. */
  viewer?: string;
}

/** Parameters of stream.configure. */
export interface StreamConfigureParams {
  /** Codec while something moves; one that hello agreed on. */
  codec?: "jpeg" | "h264";
  /** Picture height. [pixels] */
  height?: number;
  /** Most pictures in a second. */
  max_fps?: number;
  /** Whether no pictures are sent. */
  paused?: boolean;
  /** Quality on the scale of JPEG, for any codec. */
  quality?: number;
  /** Format of the final picture: JPEG with all its colour, or PNG without any loss. */
  still?: "jpeg" | "png";
  /** Picture width. [pixels] */
  width?: number;
}

/** Result of stream.configure. */
export interface StreamSettings {
  /** Codec while something moves. */
  codec: "jpeg" | "h264";
  /** Picture height in effect. [pixels] */
  height: number;
  /** Most pictures in a second. */
  max_fps: number;
  /** Whether no pictures are sent. */
  paused: boolean;
  /** Quality asked for; a slow way gets less. */
  quality: number;
  /** Format of the final picture. */
  still: "jpeg" | "png";
  /** Picture width in effect. [pixels] */
  width: number;
}

/** Parameters of stream.ack. */
export interface StreamAckParams {
  /** The frame's number from its header. */
  frame_seq: number;
  /** Time the client took to decode it. [microseconds] */
  decode_us?: number;
  /** Time from its arrival to its display. [microseconds] */
  present_us?: number;
}

/** Parameters of stats.subscribe. */
export interface StatsSubscribeParams {
  /** Least time between two stats.frame notifications; 0: none. [milliseconds] */
  interval_ms: number;
}

export interface BufferInfo {
  /** What it shows. */
  description: string;
  /** Name for view.buffer and frame.capture. */
  name: string;
}

/** Result of frame.buffers. */
export interface FrameBuffersResult {
  /** What can be shown; `output` comes first. */
  buffers: BufferInfo[];
}

/** Parameters of frame.capture. */
export interface FrameCaptureParams {
  /** A name that frame.buffers gave. */
  buffer?: string;
  /** Format of the file: png and jpeg for people, npy and exr for values. */
  format?: "png" | "jpeg" | "npy" | "exr";
  /**
   * Samples per pixel to wait for, at most accumulation.max_samples, one without accumulation;
   * absent: all of them. The answer tells how many there are.
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
  /** Picture height. [pixels] */
  height: number;
  /** Samples accumulated in each pixel. */
  samples: number;
  /** Picture width. [pixels] */
  width: number;
}

/** Result of animation.list. */
export interface AnimationState {
  /** The clip that poses the scene, null at rest. */
  clip: string | null;
  /** The clips of the scene. */
  clips: ClipInfo[];
  /** Whether time passes by frame.step alone, also while playing. */
  lockstep: boolean;
  /** Whether time passes. */
  playing: boolean;
  /** Seconds of the clip that pass in a second. */
  rate: number;
  /** Revision of the session's state. */
  rev: number;
  /** Where the clip stands. [seconds] */
  seconds: number;
}

/** Parameters of animation.play. */
export interface AnimationPlayParams {
  /**
   * The clip to play from its start; left out: go on with the one that is there, or play the first.
   */
  clip?: string;
  /** Seconds of the clip that pass in a second. */
  rate?: number;
}

/** Parameters of animation.seek. */
export interface AnimationSeekParams {
  /** Where the clip shall stand. [seconds] */
  seconds: number;
}

/** Parameters of animation.rate. */
export interface AnimationRateParams {
  /** Seconds of the clip that pass in a second. */
  rate: number;
}

export interface LightInfo {
  /** Apparent size of a directional light. [degrees] */
  angular_diameter?: number;
  /** Members that differ from the scene's file. */
  changed: string[];
  /** Linear colour. */
  color: Vector3;
  /** The way its light travels, world space; not of point lights. */
  direction?: Vector3;
  /** Whether it shines. */
  enabled: boolean;
  /** Of a rectangle. [metres] */
  height?: number;
  /**
   * Factor on the colour: lux (directional), candela (point, spot) or radiance (rectangle, disk).
   */
  intensity: number;
  /** Name for lights.patch, different for every light. */
  name: string;
  /** Its middle, world space; not of directional. [metres] */
  position?: Vector3;
  /** Of point, spot and disk lights. [metres] */
  radius?: number;
  /** How far a point or spot light reaches; 0: without limit. [metres] */
  range?: number;
  /** What kind of light it is. */
  type: "directional" | "point" | "spot" | "rectangle" | "disk";
  /** Of a rectangle. [metres] */
  width?: number;
}

/** Result of lights.list. */
export interface LightsListResult {
  /** The lights of the scene as they are now. */
  lights: LightInfo[];
  /** Revision of the session's state. */
  rev: number;
}

export interface LightPatch {
  /** Larger lights cast softer shadows; the sun's is 0.53. [degrees] */
  angular_diameter?: number | null;
  /** Linear colour. */
  color?: Vector3 | null;
  /** The way its light travels, world space; any length but 0. */
  direction?: Vector3 | null;
  /** Whether it shines. */
  enabled?: boolean | null;
  /** Of a rectangle. [metres] */
  height?: number | null;
  /** Factor on the colour. */
  intensity?: number | null;
  /** Its middle, world space. [metres] */
  position?: Vector3 | null;
  /** Larger lights cast softer shadows. [metres] */
  radius?: number | null;
  /** How far it reaches; 0: without limit. [metres] */
  range?: number | null;
  /** Of a rectangle. [metres] */
  width?: number | null;
}

/** Parameters of lights.patch. */
export interface LightsPatchParams {
  /** A name that lights.list gave. */
  light: string;
  /** What shall change (RFC 7386): null brings back what the scene's file says. */
  patch: LightPatch;
}

/** Result of lights.patch. */
export interface LightsPatchResult {
  /** The light as it is now. */
  light: LightInfo;
  /** Revision of the session's state. */
  rev: number;
}

export interface MaterialInfo {
  /** Linear factor on the texture, if any. */
  base_color: Vector3;
  /** Members that differ from the scene's file. */
  changed: string[];
  /** Linear radiance given off, factor on the texture, if any. */
  emissive: Vector3;
  /** Metalness, factor on the texture, if any. */
  metallic: number;
  /** Name for materials.patch, different for every one. */
  name: string;
  /** How deep the normal texture goes. */
  normal_scale: number;
  /** How dark the occlusion texture gets. */
  occlusion_strength: number;
  /** Perceptual roughness, factor on the texture, if any. */
  roughness: number;
  /** Which values have a texture. */
  textures: string[];
}

/** Result of materials.list. */
export interface MaterialsListResult {
  /** The materials of the scene as they are now. */
  materials: MaterialInfo[];
  /** Revision of the session's state. */
  rev: number;
}

export interface MaterialPatch {
  /** Linear factor. */
  base_color?: Vector3 | null;
  /** Linear radiance given off. */
  emissive?: Vector3 | null;
  /** Metalness. */
  metallic?: number | null;
  /** How deep the normal texture goes. */
  normal_scale?: number | null;
  /** How dark the occlusion texture gets. */
  occlusion_strength?: number | null;
  /** Perceptual roughness. */
  roughness?: number | null;
}

/** Parameters of materials.patch. */
export interface MaterialsPatchParams {
  /** A name that materials.list gave. */
  material: string;
  /** What shall change (RFC 7386): null brings back what the scene's file says. */
  patch: MaterialPatch;
}

/** Result of materials.patch. */
export interface MaterialsPatchResult {
  /** The material as it is now. */
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
  /** The one that was chosen; null: the one that goes with the scene. */
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
  /** A name that environment.list gave; null: the one that goes with the scene. */
  name?: string | null;
  /** Sets environment.rotation, too. [degrees] */
  rotation?: number;
}

/** Parameters of scene.pick. */
export interface ScenePickParams {
  /** Share of the picture's width, from the left. */
  x: number;
  /** Share of the picture's height, from the top. */
  y: number;
}

/** Result of scene.pick. */
export interface Pick {
  /** From the camera. [metres] */
  distance: number | null;
  /** Whether there is a surface; the rest is null if not. */
  hit: boolean;
  /** Name for materials.patch. */
  material: string | null;
  /** Of its triangle, toward the camera, world space. */
  normal: Vector3 | null;
  /** Name of its node, else of its mesh. */
  object: string | null;
  /** The point on it, world space. [metres] */
  position: Vector3 | null;
}

export interface BufferValue {
  /** The buffer. */
  name: string;
  /** Of the values; empty: plain numbers. */
  unit: string;
  /** Its channels there, which frame.buffers explains; null is no finite number. */
  value: (number | null)[];
}

/** Result of frame.inspect. */
export interface Inspection {
  /** Every buffer's value at that pixel. */
  buffers: BufferValue[];
  /** The pixel that was read, from the left. */
  column: number;
  /** Of the picture it was read from. [pixels] */
  height: number;
  /** And from the top. */
  row: number;
  /** Of the picture it was read from. [pixels] */
  width: number;
}

/** Parameters of frame.step. */
export interface FrameStepParams {
  /** How much time passes before each of them. [seconds] */
  dt: number;
  /** How many frames to render; 0 enters lockstep and renders none. */
  frames?: number;
}

/** Result of frame.step. */
export interface LockstepState {
  /** Frames rendered since lockstep was entered. */
  frames: number;
  /** Whether time passes by frame.step alone. */
  lockstep: boolean;
  /** Revision of the session's state. */
  rev: number;
  /** Samples accumulated in the newest of them. */
  samples: number;
  /** Time that passed since lockstep was entered. [seconds] */
  seconds: number;
}

/** Parameters of reference.start. */
export interface ReferenceStartParams {
  /** Samples per pixel to gather: the setting accumulation.max_samples. */
  samples?: number;
  /** Which light paths: the setting reference.scope. */
  scope?: "same_paths" | "full";
}

/** Result of reference.start. */
export interface ReferenceState {
  /** Whether it has them. */
  finished: boolean;
  /** Revision of the session's state. */
  rev: number;
  /** Samples gathered in each pixel so far. */
  samples: number;
  /** Which light paths it follows. */
  scope: "same_paths" | "full";
  /** Whether the path traced truth is shown: the setting reference.use is always. */
  shown: boolean;
  /** Samples that it will have at the end. */
  wanted: number;
}

/** Parameters of the notification session.closed. */
export interface SessionClosedNotification {
  /** Why, in a sentence. */
  reason: string;
  /** The session that has ended. */
  session: string;
}

/** Parameters of the notification device.changed. */
export interface DeviceChangedNotification {
  /** What happened, in a sentence. */
  message: string;
  /** Whether pictures are made. */
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
  /** The camera now. */
  camera: Camera;
}

/** Parameters of the notification animation.changed. */
export interface AnimationChangedNotification {
  /** Where the clip stands now, and how. */
  animation: AnimationState;
  /** The viewer that changed it; empty: the server. */
  by: string;
}

/** Parameters of the notification lockstep.changed. */
export interface LockstepChangedNotification {
  /** The viewer that began or ended lockstep; empty: the server. */
  by: string;
  /** What frame.step would answer now. */
  state: LockstepState;
}

/** Parameters of the notification scene.progress. */
export interface SceneProgress {
  /** How much is done. */
  fraction: number;
  /** The scene that is being loaded. */
  name: string;
  /** What is being done. */
  stage: string;
}

/** Parameters of the notification scene.changed. */
export interface SceneChangedNotification {
  /** The scene that is shown now. */
  scene: SceneInfo;
}

/** Parameters of the notification scene.unloaded. */
export interface SceneUnloadedNotification {
  /** The viewer that unloaded it; empty: the server. */
  by: string;
  /** The scene that was shown. */
  name: string;
}

/** Parameters of the notification lights.changed. */
export interface LightsChangedNotification {
  /** The viewer that changed it; empty: the server. */
  by: string;
  /** The light as it is now. */
  light: LightInfo;
  /** Revision of the session's state. */
  rev: number;
}

/** Parameters of the notification materials.changed. */
export interface MaterialsChangedNotification {
  /** The viewer that changed it; empty: the server. */
  by: string;
  /** The material as it is now. */
  material: MaterialInfo;
  /** Revision of the session's state. */
  rev: number;
}

/** Parameters of the notification environment.changed. */
export interface EnvironmentChangedNotification {
  /** The viewer that chose it; empty: the server. */
  by: string;
  /** The one that was chosen; null: the one that goes with the scene. */
  current: string | null;
  /** Revision of the session's state. */
  rev: number;
}

export interface PassTiming {
  /** Where it ran: a shader or the processor. */
  kind: "device" | "host";
  /** How long it took. [milliseconds] */
  ms: number;
  /** Name of the pass. */
  name: string;
}

/** Parameters of the notification stats.frame. */
export interface FrameStats {
  /** Size of the picture this viewer was sent last. [bytes] */
  bytes: number;
  /** Codec chosen for this viewer while something moves. */
  codec: "jpeg" | "h264";
  /** Time to encode it. [milliseconds] */
  encode_ms: number;
  /** Pictures rendered in the last second. */
  fps: number;
  /** Time to render it. [milliseconds] */
  frame_ms: number;
  /** What reaches this viewer when it is busy. [bytes per second] */
  goodput: number;
  /** Picture height. [pixels] */
  height: number;
  /** The frame's passes in their order. */
  passes: PassTiming[];
  /** Quality chosen for this viewer while something moves. */
  quality: number;
  /** The picture these figures are of. */
  render_id: number;
  /** From sending a picture to this viewer to its acknowledgement. [milliseconds] */
  round_trip_ms: number;
  /** Samples accumulated in each pixel. */
  samples: number;
  /** Size chosen for this viewer while something moves, as a part of the whole size. */
  scale: number;
  /** Whether the stream follows changes, refines a resting picture, or is done. */
  state: "interactive" | "refining" | "still";
  /** What traced the rays. */
  tracer: "embree" | "software" | "ray_query" | "ray_pipeline";
  /** Picture width. [pixels] */
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

/** Parameters of every notification that the server sends. */
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
