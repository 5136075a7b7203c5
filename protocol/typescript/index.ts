// What programs in Node import from "heliograph-client". Pages import "heliograph-client/client".

export { HeliographClient } from "./client.ts";
export { findProgram, render, RenderError, serve } from "./local.ts";
export type { LocalServer, RenderEntry } from "./local.ts";
