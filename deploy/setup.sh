#!/usr/bin/env bash
# Installs what Heliograph needs, from deploy/packages. Does nothing where nothing is missing.
#   deploy/setup.sh [build] [run] [test]      default: build run
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
purposes=("${@:-build}")
[ $# -gt 0 ] || purposes=(build run)

if ! command -v apt-get >/dev/null; then
  echo "setup: this script knows Debian and Ubuntu only (no apt-get here); deploy/packages lists what is needed" >&2
  exit 1
fi

missing=()
while read -r purpose package command; do
  case "$purpose" in ''|'#'*) continue ;; esac
  case " ${purposes[*]} " in *" $purpose "*) ;; *) continue ;; esac
  [ -n "$command" ] && command -v "$command" >/dev/null && continue
  dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed && continue
  missing+=("$package")
done <"$folder/packages"

if [ ${#missing[@]} -eq 0 ]; then
  echo "==> every package is installed"
  exit 0
fi
if [ "$(id -u)" -ne 0 ]; then
  echo "setup: ${#missing[@]} packages are missing; as root run:" >&2
  echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

log=$(mktemp)
fail() {
  tail -n 15 "$log" >&2
  echo "setup: $1" >&2
  exit 1
}
export DEBIAN_FRONTEND=noninteractive
echo "==> installing ${#missing[@]} packages: ${missing[*]}"
apt-get update >"$log" 2>&1 || fail "apt-get update failed"
unknown=()
for package in "${missing[@]}"; do
  apt-cache show "$package" >/dev/null 2>&1 || unknown+=("$package")
done
: >"$log"
[ ${#unknown[@]} -eq 0 ] ||
  fail "apt does not know ${unknown[*]}; on Ubuntu, universe must be enabled"
apt-get install -y --no-install-recommends "${missing[@]}" >"$log" 2>&1 ||
  fail "apt-get could not install the packages"
rm -f "$log"
echo "==> installed"
