#!/usr/bin/env bash
# Runs a command on the software device of the Mesa that HELIOGRAPH_NEWER_MESA names, a folder made
# by deploy/newer_mesa.sh: it supports every tracer, so none of their tests may be skipped.
set -euo pipefail
if [ -z "${HELIOGRAPH_NEWER_MESA:-}" ]; then
  echo "HELIOGRAPH_NEWER_MESA names no folder made by deploy/newer_mesa.sh: not run"
  exit 77
fi
folder=$(cd "$HELIOGRAPH_NEWER_MESA" && pwd)
[ -f "$folder/driver.json" ] || { echo "there is no driver.json in $folder" >&2; exit 1; }
export VK_DRIVER_FILES=$folder/driver.json
export VK_ICD_FILENAMES=$folder/driver.json
export LD_LIBRARY_PATH=$folder/libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export HELIOGRAPH_TEST_ALL_TRACERS=1
exec "$@"
