// Writes a C++ source that holds the files of a folder: node embed_assets.mjs FOLDER OUT.cpp

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { extname, join } from "node:path";

const contentTypes = {
  ".css": "text/css; charset=utf-8",
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript; charset=utf-8",
  ".svg": "image/svg+xml",
};

const [folder, output] = process.argv.slice(2);
if (!folder || !output) throw new Error("usage: node embed_assets.mjs FOLDER OUT.cpp");

function embed(name, index) {
  const bytes = readFileSync(join(folder, name));
  const contentType = contentTypes[extname(name)];
  if (!contentType) throw new Error(`${name}: no content type is known for this ending`);
  const hash = createHash("sha256").update(bytes).digest("hex").slice(0, 32);
  const lines = [];
  for (let start = 0; start < bytes.length; start += 32) {
    lines.push(`    ${[...bytes.subarray(start, start + 32)].join(",")},`);
  }
  return {
    array: `constexpr unsigned char bytes_${index}[] = {\n${lines.join("\n")}\n};\n`,
    entry: `    {"${name}", "${contentType}", "\\"${hash}\\"", bytes_${index}},`,
  };
}

const parts = readdirSync(folder).sort().map(embed);
writeFileSync(
  output,
  `#include "web_client/asset_table.hpp"

namespace heliograph::web {
namespace {

${parts.map(({ array }) => array).join("\n")}
constexpr Asset assets[] = {
${parts.map(({ entry }) => entry).join("\n")}
};

}  // namespace

std::span<const Asset> asset_table() { return assets; }

}  // namespace heliograph::web
`,
);
