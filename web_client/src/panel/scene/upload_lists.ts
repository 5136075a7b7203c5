// Lists of uploads in the panel.

import type { UploadLists } from "../../common/uploads.ts";
import { watchShown } from "../../widgets/shown.ts";

/** Keeps the list of the uploads of this kind up to date while the node is shown. */
export function keepUploads(
  { uploads }: { uploads: UploadLists },
  kind: Parameters<UploadLists["read"]>[0],
  node: HTMLElement,
): void {
  let isShown = false;
  uploads.keep(kind, () => isShown);
  watchShown(node, (shown) => {
    isShown = shown;
    if (shown) void uploads.refresh(kind);
  });
}
