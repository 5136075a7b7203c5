#!/usr/bin/env bash
# Deletes from an image what a running server never reads: other drivers than the software device
# and those that a runtime adds, lists and caches of apt, documentation. Takes from all programs the right to become another user.
set -euo pipefail
if [ "${1:-}" != image ]; then
  echo "usage: slim.sh image      inside an image only: deletes parts of the system it runs in" >&2
  exit 2
fi

libraries=$(dirname "$(find /usr/lib -name libvulkan_lvp.so)")
find "$libraries" -name 'libvulkan_*.so' ! -name libvulkan_lvp.so -delete
find /usr/share/vulkan/icd.d -type f ! -name 'lvp_icd*' -delete
rm -rf /usr/share/vulkan/explicit_layer.d /usr/share/vulkan/implicit_layer.d \
  "$libraries"/libVkLayer_*.so /usr/share/drirc.d

apt-get clean
rm -rf /var/lib/apt/lists/* /var/cache/debconf/* /var/cache/ldconfig/* /var/log/*
find /usr/share/doc -type f ! -name copyright -delete
find /usr/share/doc -type d -empty -delete
rm -rf /usr/share/man/* /usr/share/info/* /usr/share/locale/* /usr/share/lintian \
  /lib/systemd/system/heliograph.service

find / -xdev -type f -perm /6000 -exec chmod a-s {} +
