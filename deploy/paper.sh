#!/usr/bin/env bash
# The paper on one page: installs missing packages, builds, measures what the paper measured and
# writes build/paper/index.html and build/paper/paper.pdf. It can be interrupted and goes on where it
# stopped.
#   deploy/paper.sh                        under half an hour on two idle processors
#   deploy/paper.sh --full                 the form that can be published: many hours
#   deploy/paper.sh --device NVIDIA        on another Vulkan device
#   deploy/paper.sh --preset my.json --against best    a page of two presets, with a paired test
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
build=${HELIOGRAPH_BUILD:-build}
"$folder/setup.sh" build run test
HELIOGRAPH_TARGETS=heliograph-experiments "$folder/build.sh" -DHELIOGRAPH_TESTS=ON
cd "$folder/.."
echo "==> measuring, and writing $build/paper"
# Debian's Python has the packages, another one that comes first in PATH has not.
exec /usr/bin/python3 tests/paper/page/make_page.py --binary "$build/bin/heliograph-experiments" \
  --output "$build/paper" "$@"
