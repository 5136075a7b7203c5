#!/usr/bin/env bash
# Builds the Debian package of the last commit twice and compares the bytes:
#   tests/deploy/two_builds.sh [--cached] [FOLDER]      default: /var/tmp/heliograph-two-builds
# The builds differ in the name and length of their folders, in time, time zone and locale, and the second one does
# not use the compiler cache. --cached: it does, which checks everything but the compiler, in a few minutes.
# Where they differ it names the files, ends with 1 and keeps both.
set -euo pipefail
repository=$(cd "$(dirname "$0")/../.." && pwd)
cached=
if [ "${1:-}" = --cached ]; then
  cached=1
  shift
fi
folder=${1:-/var/tmp/heliograph-two-builds}
one=$folder/one
two=$folder/the_second_of_two

SOURCE_DATE_EPOCH=$(git -C "$repository" log -1 --format=%ct)
export SOURCE_DATE_EPOCH
umask 022

# build PLACE [VARIABLE=VALUE]...
build() {
  local place=$1
  shift
  rm -rf "$place"
  mkdir -p "$place/source"
  git -C "$repository" archive HEAD | tar --extract --directory "$place/source"
  env "$@" HELIOGRAPH_BUILD=build HELIOGRAPH_TARGETS="heliograph heliograph-scenes" \
    "$place/source/deploy/build.sh" -DHELIOGRAPH_TESTS=OFF
  env "$@" cpack --config "$place/source/build/CPackConfig.cmake" -B "$place/package"
}

package_of() { printf '%s\n' "$1"/package/heliograph_*.deb; }

# Checksums of what is in a package, and of its parts: their compression and order may differ, too.
contents_of() {
  local package
  package=$(package_of "$1")
  dpkg-deb --raw-extract "$package" "$1/unpacked"
  (cd "$1/unpacked" && find . -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum)
  dpkg-deb --fsys-tarfile "$package" | tar --list --verbose --full-time
  dpkg-deb --ctrl-tarfile "$package" | tar --list --verbose --full-time
}

build "$one"
if [ -n "$cached" ]; then
  build "$two" TZ=Asia/Tokyo LC_ALL=C
else
  build "$two" TZ=Asia/Tokyo LC_ALL=C CCACHE_DISABLE=1
fi

if cmp "$(package_of "$one")" "$(package_of "$two")"; then
  sha256sum "$(package_of "$one")"
  rm -rf "$one" "$two"
  exit 0
fi
contents_of "$one" >"$one/contents"
contents_of "$two" >"$two/contents"
diff "$one/contents" "$two/contents" >&2 || true
echo "two builds: the packages differ; both are kept in $folder" >&2
exit 1
