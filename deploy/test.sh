#!/usr/bin/env bash
# From a fresh clone to passed tests: installs, builds and runs every test. Arguments go to ctest.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
"$folder/setup.sh" build run test
"$folder/build.sh" -DHELIOGRAPH_TESTS=ON
cd "$folder/.."
build=${HELIOGRAPH_BUILD:-build}
if [ -z "${HELIOGRAPH_NEWER_MESA:-}" ] && deploy/newer_mesa.sh "$build/newer_mesa"; then
  HELIOGRAPH_NEWER_MESA=$(cd "$build/newer_mesa" && pwd)
  export HELIOGRAPH_NEWER_MESA
fi
echo "==> running the tests"
# What measures time or fills the machine by itself runs alone; the rest in pairs.
exec ctest --test-dir "$build" --output-on-failure --parallel 2 "$@"
