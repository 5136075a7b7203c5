#!/usr/bin/env bash
# From a fresh clone to tested code: installs missing packages, builds and runs every test. Arguments
# are passed to ctest.
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
# Tests that measure time or use the whole machine run alone (RUN_SERIAL), the others in pairs.
exec ctest --test-dir "$build" --output-on-failure --parallel 2 "$@"
