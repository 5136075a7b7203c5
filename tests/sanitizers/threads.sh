#!/bin/sh
# Builds the server and the tests of its threads with the thread sanitizer, and runs them:
#   threads.sh [--short] [FOLDER] [JOBS]
# --short: the unit tests of streams, jobs and messages alone, in a minute or two: no other layer is built.
# Any report of a race fails the test in which it appeared. FOLDER: build-thread-sanitize in the project.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
layers=
targets="heliograph heliograph-scenes unit_session unit_stream unit_net unit_jobs unit_scene"
tests='unit_(session|stream|net|jobs|scene)|protocol_(scenes|sessions|jobs|security|stream|framing|contract)'
default_folder=$root/build-thread-sanitize
if [ "${1:-}" = --short ]; then
  shift
  layers="-DHELIOGRAPH_MODULES=protocol;server/jobs;server/stream"
  targets="unit_stream unit_jobs unit_protocol"
  tests='unit_(stream|jobs|protocol)'
  default_folder=$default_folder-short
fi
folder=${1:-$default_folder}
jobs=${2:-$(nproc)}
cd "$root"
cmake --preset thread-sanitize -B "$folder" ${layers:+"$layers"}
# Clones in different folders share what the compiler cache holds.
export CCACHE_BASEDIR="${CCACHE_BASEDIR:-$root}" CCACHE_NOHASHDIR="${CCACHE_NOHASHDIR:-1}"
# shellcheck disable=SC2086 # a list
ninja -C "$folder" -j "$jobs" $targets
# On one processor oneTBB makes no threads: the sanitizer cannot see how they hand over tasks, and would tell
# hundreds of races that are none. It finds races of the server's own threads by what orders them, not by
# what ran at the same time, so that one processor suffices.
processor=$(taskset -cp $$ | sed 's/.*[^0-9]//')
export HELIOGRAPH_TEST_TIME_FACTOR=10
# Shared memory is where the sanitizer expects it only if the kernel places it as usual. Containers may not ask for
# that, and need not where addresses are random by few bits.
placed="setarch -R"
$placed true 2>/dev/null || placed=
if ! $placed "$folder/bin/unit_jobs" --gtest_list_tests >"$folder/probe.log" 2>&1; then
  cat "$folder/probe.log"
  grep -q "unexpected memory mapping" "$folder/probe.log" || exit 1
  echo "skipped: the sanitizer needs fewer random bits in addresses (vm.mmap_rnd_bits), or setarch -R"
  exit 77
fi
# shellcheck disable=SC2086 # words
exec taskset -c "$processor" $placed ctest --test-dir "$folder" --output-on-failure -R "^($tests)\$"
