#!/usr/bin/env bash
# Unpacks the newer Mesa of Debian 12's backports into a folder. The system's Mesa is not changed.
# The newer software Vulkan device supports ray tracing, so that the tests of the tracers "ray_query"
# and "ray_pipeline" run on machines without a GPU:
#   deploy/newer_mesa.sh FOLDER && HELIOGRAPH_NEWER_MESA=FOLDER ctest ...
# Uses only Debian packages, from the mirror that apt is configured with.
set -euo pipefail
if [ $# -ne 1 ]; then
  echo "usage: deploy/newer_mesa.sh FOLDER" >&2
  exit 2
fi

fail() {
  [ -s "${log:-}" ] && tail -n 10 "$log" >&2
  echo "newer_mesa: $1" >&2
  exit 1
}

mkdir -p "$1"
folder=$(cd "$1" && pwd)
if [ -f "$folder/driver.json" ]; then
  echo "==> $folder already contains a newer Mesa"
  exit 0
fi
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
[ "$codename" = bookworm ] ||
  fail "not needed: only Debian 12 has an older Mesa than this, and this is $codename; leave HELIOGRAPH_NEWER_MESA unset"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
log=$work/log
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' \
  'Component: main' | head -n 1)
[ -n "$mirror" ] || fail "apt has no package index of Debian 12; run apt-get update first"

# Separate package indexes and archives, so that apt's own state does not change. Installed packages
# still count: only the packages that the newer driver needs in addition are downloaded.
mkdir -p "$work"/lists/partial "$work"/archives/partial
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
{
  echo "deb [signed-by=$keyring] $mirror bookworm main"
  echo "deb [signed-by=$keyring] $mirror bookworm-backports main"
} >"$work/sources.list"
apt=(apt-get -o "Dir::Etc::sourcelist=$work/sources.list" -o Dir::Etc::sourceparts=/dev/null
  -o "Dir::State::lists=$work/lists" -o "Dir::Cache::archives=$work/archives"
  -o "Dir::Cache::pkgcache=" -o "Dir::Cache::srcpkgcache=" -o APT::Sandbox::User=root
  -o Debug::NoLocking=1 -o Acquire::Languages=none -o Acquire::Retries=2
  -o Acquire::http::Timeout=20 -o Acquire::https::Timeout=20)
echo "==> downloading Mesa of bookworm-backports from $mirror"
"${apt[@]}" update >"$log" 2>&1 || fail "apt-get could not download the package indexes"
"${apt[@]}" install --yes --no-install-recommends --download-only \
  --target-release bookworm-backports mesa-vulkan-drivers >"$log" 2>&1 ||
  fail "apt-get could not download the packages"

ls "$work"/archives/*.deb >"$log" 2>&1 ||
  fail "nothing to download: the newer Mesa is installed already"
for package in "$work"/archives/*.deb; do
  dpkg-deb --extract "$package" "$folder"
done
library=$(find "$folder" -name libvulkan_lvp.so | head -n 1)
[ -n "$library" ] || fail "the packages contain no software Vulkan driver (libvulkan_lvp.so)"
sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"$library\"|" \
  "$folder"/usr/share/vulkan/icd.d/lvp_icd*.json >"$folder/driver.json.new"
ln -sfn "$(dirname "$library")" "$folder/libraries"
mv "$folder/driver.json.new" "$folder/driver.json"
echo "==> $folder contains Mesa $(basename "$(ls "$work"/archives/mesa-vulkan-drivers_*.deb)" | cut -d_ -f2)"
