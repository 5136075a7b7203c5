#!/bin/sh
# Builds the server and the tests of its threads with the thread sanitizer, and runs them:
#   threads.sh [FOLDER] [JOBS]
# Any report of a race fails the test in which it appeared. FOLDER: build-thread-sanitize in the project.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=${1:-$root/build-thread-sanitize}
jobs=${2:-$(nproc)}
cd "$root"
cmake --preset thread-sanitize -B "$folder"
ninja -C "$folder" -j "$jobs" heliograph heliograph-scenes unit_session unit_stream unit_net unit_jobs
# Shared memory is where the sanitizer expects it only if the kernel places it as usual.
exec setarch -R ctest --test-dir "$folder" --output-on-failure \
  -R '^(unit_(session|stream|net|jobs)|protocol_(scenes|sessions|jobs|security))$'
