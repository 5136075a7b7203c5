// Shapes of the JSON messages this client sends and understands (protocol heliograph.v1).

export const subprotocol = "heliograph.v1";

export type Vector3 = [number, number, number];
export type JsonValue = null | boolean | number | string | JsonValue[] | JsonObject;
export interface JsonObject {
  [name: string]: JsonValue;
}

export interface Hello {
  protocol: string;
  version: string;
  device: { name: string; driver: string; type: string };
  tracer: string;
  session: string;
  viewer: string | number;
  /** With "view" the server refuses whatever would change the session; servers that do not tell let it steer. */
  role?: "view" | "control";
  codecs: string[];
  limits: {
    max_width: number;
    max_height: number;
    max_message_bytes: number;
    ack_window: number;
    /** How many calls a batch may have, and how many captures may wait; older servers leave them out. */
    max_batch?: number;
    max_waiting?: number;
    /** 0: the server takes no scenes from viewers; servers that do not tell leave it out. */
    max_upload_bytes?: number;
  };
  rev: number;
  /** Differs with every run of a server: another one has not kept the session. */
  instance: string;
  /** To who comes back from another run: whether to bring the state; null: no place was found. */
  bring?: boolean | null;
}

export interface SceneList {
  scenes: { name: string; bytes: number }[];
  current: string | null;
}

export interface SceneInfo {
  name: string;
  triangles: number;
  instances: number;
  meshes: number;
  materials: number;
  textures: number;
  lights: number;
  vertices: number;
  nodes: number;
  images: number;
  texels: number;
  deforming: number;
  material_names: string[];
  light_names: string[];
  /** Name of the environment's file; null: none came with the scene. */
  environment: string | null;
  cameras: string[];
  clips: ClipInfo[];
  /** Scenes of the file, and the number of the one that is shown. */
  scenes?: string[];
  scene?: number;
  variants: string[];
  /** The variant that is shown; servers without that choice leave it out. */
  variant?: string | null;
  bounds: { min: Vector3; max: Vector3 };
  /** Bytes. */
  memory: { file: number; host: number; device: number };
  warnings: string[];
}

export interface SceneProgress {
  name: string;
  stage: string;
  fraction: number;
}

/** Positions in metres, world space; vertical_fov in degrees. */
export interface Camera {
  eye: Vector3;
  target: Vector3;
  up: Vector3;
  vertical_fov: number;
  name: string | null;
  /** Revision of the session's state, where a server tells it. */
  rev?: number;
}

/** `duration` in seconds. */
export interface ClipInfo {
  name: string;
  duration: number;
}

export interface AnimationState {
  clips: ClipInfo[];
  clip: string | null;
  playing: boolean;
  seconds: number;
  rate: number;
  /** Whether time passes by frame.step alone, also while playing. */
  lockstep?: boolean;
  rev: number;
}

export interface StreamSettings {
  width: number;
  height: number;
  quality: number;
  max_fps: number;
  paused: boolean;
  /** While something moves; servers with one codec leave it out. */
  codec?: string;
}

export interface PassTiming {
  name: string;
  kind: "device" | "host";
  ms: number;
}

export interface FrameStats {
  render_id: number;
  fps: number;
  frame_ms: number;
  encode_ms: number;
  bytes: number;
  width: number;
  height: number;
  samples: number;
  tracer: string;
  passes: PassTiming[];
}

export interface BufferInfo {
  name: string;
  description: string;
}

/** What a ray through a point of the picture met; metres, world space. Null without a hit. */
export interface Pick {
  hit: boolean;
  position: Vector3 | null;
  normal: Vector3 | null;
  distance: number | null;
  object: string | null;
  material: string | null;
}

export interface PresetInfo {
  name: string;
  description: string;
}

export interface Capture {
  buffer: string;
  format: string;
  width: number;
  height: number;
  samples: number;
  data: string;
}

export const ErrorCode = {
  methodNotFound: -32601,
  unauthenticated: -32000,
  forbidden: -32001,
  tooManyCalls: -32002,
  notFound: -32004,
  full: -32029,
  notReady: -32050,
  /** Never sent: no answer came in time. */
  timedOut: 0,
} as const;

/** Members that a kind of light lacks are left out. Lengths in metres, angles in degrees. */
export interface LightInfo {
  name: string;
  type: string;
  enabled: boolean;
  color: Vector3;
  intensity: number;
  position?: Vector3;
  /** The way its light travels. */
  direction?: Vector3;
  radius?: number;
  angular_diameter?: number;
  /** Members that differ from the scene's file. */
  changed?: string[];
}

export interface MaterialInfo {
  name: string;
  base_color: Vector3;
  roughness: number;
  metallic: number;
  emissive: Vector3;
  textures: string[];
  /** Members that differ from the scene's file. */
  changed?: string[];
}

export interface EnvironmentState {
  environments: { name: string; bytes: number }[];
  /** null: the one that goes with the scene. */
  current: string | null;
}

export interface BufferValue {
  name: string;
  /** null is no finite number. */
  value: (number | null)[];
  unit: string;
}

/** Every buffer at one pixel; column and row count from the top left. */
export interface Inspection {
  column: number;
  row: number;
  width: number;
  height: number;
  buffers: BufferValue[];
}

export interface ViewerInfo {
  viewer: string;
  name: string | null;
  control: boolean;
  you: boolean;
}

export interface SessionInfo {
  name: string;
  scene: string | null;
  /** Of its pictures, pixels. */
  width?: number;
  height?: number;
  viewers: ViewerInfo[];
  /** Whether all viewers may change things or only one. */
  control: "everyone" | "one";
  rev: number;
  idle_seconds: number;
}
