#!/usr/bin/env bash
# Runs a command on Chromium's software device, treated as a GPU: another driver than Mesa's, with
# a less precise rasterizer, and the code paths of devices with their own memory.
set -euo pipefail
driver=/usr/lib/chromium/vk_swiftshader_icd.json
if [ ! -f "$driver" ]; then
  echo "there is no $driver: not run"
  exit 77
fi
export VK_DRIVER_FILES=$driver
export VK_ICD_FILENAMES=$driver
export HELIOGRAPH_TEST_AS_GPU=1
exec "$@"
