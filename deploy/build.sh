#!/usr/bin/env bash
# Configures and builds in build/ (or $HELIOGRAPH_BUILD) and generates the demo scene. Arguments are
# passed to cmake.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${HELIOGRAPH_BUILD:-build}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "==> configuring $build"
if ! cmake -S . -B "$build" -G Ninja "$@" >"$log" 2>&1; then
  tail -n 25 "$log" >&2
  echo "build: cmake failed to configure; the end of its output is above" >&2
  exit 1
fi
echo "==> building (a few minutes the first time)"
ninja -C "$build" || { echo "build: compilation failed" >&2; exit 1; }
if [ ! -f "$build/scenes/.complete" ] || [ "$build/bin/heliograph-scenes" -nt "$build/scenes/.complete" ]; then
  echo "==> generating the demo scene"
  "$build/bin/heliograph-scenes" "$build/scenes" ||
    { echo "build: heliograph-scenes failed to generate the demo scene" >&2; exit 1; }
  touch "$build/scenes/.complete"
fi
