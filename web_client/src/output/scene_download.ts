// The session's scene with its edits as a .glb file, which the server writes.

interface DownloadedScene {
  file: Blob;
  /** What the file lacks, one sentence each. */
  warnings: string[];
}

/**
 * Reports the bytes so far and those of the whole file, of which there are none until it is written.
 * @throws Error with the server's reason; AbortError
 */
export async function downloadScene(
  url: URL,
  signal: AbortSignal,
  progress: (received: number, total: number) => void,
): Promise<DownloadedScene> {
  const response = await fetch(url, { signal });
  if (!response.ok || !response.body) throw new Error((await response.text()).trim());
  const total = Number(response.headers.get("content-length") ?? 0);
  const chunks: Uint8Array<ArrayBuffer>[] = [];
  let received = 0;
  const reader = response.body.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    chunks.push(part.value);
    received += part.value.length;
    progress(received, total);
  }
  return {
    file: new Blob(chunks, { type: "model/gltf-binary" }),
    warnings: warningsOf(response.headers.get("x-heliograph-warnings")),
  };
}

function warningsOf(header: string | null): string[] {
  if (!header) return [];
  try {
    return (JSON.parse(header) as unknown[]).map(String);
  } catch {
    return [header];
  }
}
