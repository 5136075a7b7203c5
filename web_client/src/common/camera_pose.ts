import type { Camera } from "heliograph/messages.ts";

/** A camera as the server sends it, or one made by this page, which has no revision yet. */
export type CameraPose = Omit<Camera, "rev"> & Partial<Pick<Camera, "rev">>;
