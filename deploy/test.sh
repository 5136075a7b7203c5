#!/usr/bin/env bash
# From a fresh clone to passed tests: installs, builds and runs every test. Arguments go to ctest.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
"$folder/setup.sh" build run test
"$folder/build.sh" -DHELIOGRAPH_TESTS=ON
cd "$folder/.."
echo "==> running the tests"
exec ctest --test-dir "${HELIOGRAPH_BUILD:-build}" --output-on-failure "$@"
