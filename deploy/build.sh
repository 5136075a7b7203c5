#!/usr/bin/env bash
# Configures and builds in build/ (or $HELIOGRAPH_BUILD) and generates the demo scene, or builds
# $HELIOGRAPH_TARGETS alone. Arguments are passed to cmake.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${HELIOGRAPH_BUILD:-build}

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "==> configuring $build"
# A folder that is configured already stays as it is.
first=()
if [ ! -f "$build/CMakeCache.txt" ]; then
  first=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON)
fi
if ! cmake -S . -B "$build" -G Ninja "${first[@]}" "$@" >"$log" 2>&1; then
  tail -n 25 "$log" >&2
  echo "build: cmake failed to configure; the end of its output is above" >&2
  exit 1
fi
read -ra targets <<<"${HELIOGRAPH_TARGETS:-all demo_scene}"
echo "==> building ${targets[*]} (a few minutes the first time)"
# Clones in different folders share what the compiler cache holds.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
ninja -C "$build" "${targets[@]}" || { echo "build: compilation failed" >&2; exit 1; }
