#!/bin/sh
# Fuzzes what reads the bytes of others: run.sh TARGET SECONDS [FOLDER], where TARGET is one of
#   gltf images environments textures    files of scenes
#   messages requests acknowledgements   what clients send
#   manifests configuration              what operators write
# Builds with clang in FOLDER (default: build-fuzz in the project), starts with seeds of the
# project and keeps the corpus in FOLDER/corpus-*. Failures are kept in FOLDER as crash-*,
# timeout-* or oom-*; run the fuzzer with that file as argument to reproduce one.
set -eu
target=$1
seconds=$2
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=${3:-$root/build-fuzz}

compiler=
for candidate in clang++ clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14; do
  if command -v "$candidate" >/dev/null; then
    compiler=$candidate
    break
  fi
done
if [ -z "$compiler" ]; then
  echo "skipped: there is no clang++"
  exit 77
fi
probe=$(mktemp -d)
trap 'rm -rf "$probe"' EXIT
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' \
  >"$probe/probe.cpp"
if ! "$compiler" -fsanitize=fuzzer,address,undefined "$probe/probe.cpp" -o "$probe/probe" \
  2>/dev/null; then
  echo "skipped: $compiler has no libFuzzer (Debian: libclang-rt-dev)"
  exit 77
fi

cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DHELIOGRAPH_MODULES=protocol;server/scene" \
  -DHELIOGRAPH_SANITIZE=fuzzer-no-link,address,undefined >"$probe/configure.log" ||
  { cat "$probe/configure.log" && exit 1; }
# Seeds lie beside the fuzzers, or are made of the project's test files.
seeds=$root/tests/fuzz/seeds/$target
needed="heliograph-fuzz-$target"
case $target in
  gltf | images | environments | textures) needed="$needed heliograph-fuzz-seeds" ;;
esac
# shellcheck disable=SC2086  # two words
ninja -C "$folder" $needed >"$probe/build.log" || { cat "$probe/build.log" && exit 1; }

cd "$folder"
mkdir -p "corpus-$target" "seeds-$target"
if [ -d "$seeds" ]; then
  cp "$seeds"/* "seeds-$target"
elif [ "$needed" != "heliograph-fuzz-$target" ]; then
  bin/heliograph-fuzz-seeds "$target" "seeds-$target"
fi
# Made by clang 14, the description of the protocol leaves strings behind; made by gcc, the server's memory stays
# the same over hundreds of them.
leaks=1
[ "$target" != messages ] || leaks=0
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
exec "bin/heliograph-fuzz-$target" "corpus-$target" "seeds-$target" -max_total_time="$seconds" -detect_leaks="$leaks" \
  -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=512 -max_len=65536 -verbosity=0 -print_funcs=0 \
  -print_final_stats=1
