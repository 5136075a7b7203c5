// Adds the annotations of a file to the scene, and tells what has become of them.

import { describeControl } from "../session/control_state.ts";
import { describeImport, readAnnotations } from "../session/marks/annotation_file.ts";
import type { Viewer } from "../session/viewer.ts";

/** Whether this page may not annotate at the moment, as a sentence; null: it may. */
function refusal({ hello, scene, membership, capabilities }: Viewer): string | null {
  if (!hello) return "There is no connection to the server";
  if (!capabilities.has("annotations.add")) return "This server has no annotations";
  if (!scene.value) return "There is no scene to annotate";
  return membership.mayAnnotate ? null : describeControl(membership.controlState.value);
}

export async function importAnnotations(viewer: Viewer, file: File): Promise<void> {
  try {
    const { scene: from, entries } = await readAnnotations(file);
    const why = refusal(viewer);
    if (why) throw new Error(why);
    const shown = viewer.scene.value?.name ?? "";
    const result = await viewer.marks.annotations.import(entries);
    const sentence = describeImport(file.name, result, { from, shown });
    if (result.refused.length > 0) viewer.onError(sentence);
    else viewer.onInfo(sentence, "annotations");
  } catch (error) {
    viewer.report(error);
  }
}
