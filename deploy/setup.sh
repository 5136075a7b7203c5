#!/usr/bin/env bash
# Installs the packages listed in deploy/packages. Does nothing if none is missing.
#   deploy/setup.sh [build] [run] [test] [deploy]      default: build run
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
purposes=("${@:-build}")
[ $# -gt 0 ] || purposes=(build run)

if ! command -v apt-get >/dev/null; then
  echo "setup: apt-get not found: only Debian and Ubuntu are supported; deploy/packages lists what to install" >&2
  exit 1
fi

# Whether this release has a package, according to apt's current package indexes.
known() { apt-cache show "$1" >/dev/null 2>&1; }

missing=()
# Packages that not every release has (marked with "?" in the list).
optional=()
while read -r purpose package command; do
  case "$purpose" in ''|'#'*) continue ;; esac
  case " ${purposes[*]} " in *" $purpose "*) ;; *) continue ;; esac
  [ -n "$command" ] && command -v "$command" >/dev/null && continue
  name=${package%\?}
  dpkg-query -W -f='${db:Status-Status}\n' "$name" 2>/dev/null | grep -qx installed && continue
  if [ "$name" = "$package" ]; then
    missing+=("$name")
  else
    optional+=("$name")
  fi
done <"$folder/packages"

choose() {
  wanted=("${missing[@]}")
  for package in "${optional[@]}"; do
    if known "$package"; then wanted+=("$package"); fi
  done
}
choose
if [ ${#wanted[@]} -eq 0 ]; then
  echo "==> every package is installed"
  exit 0
fi
if [ "$(id -u)" -ne 0 ]; then
  echo "setup: ${#wanted[@]} packages are missing; run as root:" >&2
  echo "  apt-get install --no-install-recommends ${wanted[*]}" >&2
  exit 1
fi

log=$(mktemp)
fail() {
  tail -n 15 "$log" >&2
  echo "setup: $1" >&2
  exit 1
}
export DEBIAN_FRONTEND=noninteractive
apt-get update >"$log" 2>&1 || fail "apt-get update failed"
choose
unknown=()
for package in "${missing[@]}"; do
  known "$package" || unknown+=("$package")
done
: >"$log"
[ ${#unknown[@]} -eq 0 ] ||
  fail "apt does not know ${unknown[*]}; on Ubuntu enable the component universe"
echo "==> installing ${#wanted[@]} packages: ${wanted[*]}"
apt-get install -y --no-install-recommends "${wanted[@]}" >"$log" 2>&1 ||
  fail "apt-get failed to install the packages"
rm -f "$log"
echo "==> installed"
