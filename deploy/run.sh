#!/usr/bin/env bash
# From a fresh clone to a running server: installs missing packages, builds, generates the demo scene,
# starts the server and prints its URL. Arguments are passed to `heliograph serve`.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
"$folder/setup.sh" build run
"$folder/build.sh" -DHELIOGRAPH_TESTS=OFF
cd "$folder/.."
echo "==> starting the server (Ctrl-C stops it)"
exec "${HELIOGRAPH_BUILD:-build}/bin/heliograph" serve "$@"
