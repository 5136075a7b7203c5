#!/usr/bin/env bash
# Creates the root folder of the image: the server, the software Vulkan device, the libraries that
# these two link, fonts, and busybox as a shell. Nothing else of the system is copied.
#   closure.sh FOLDER
set -euo pipefail
if [ $# -ne 1 ]; then
  echo "usage: closure.sh FOLDER" >&2
  exit 2
fi
root=$1

mkdir -p "$root"/usr/{bin,sbin,lib,lib64} "$root"/{dev,etc,proc,sys,run,tmp,var/cache}
chmod 1777 "$root/tmp"
for folder in bin sbin lib lib64; do
  ln -s "usr/$folder" "$root/$folder"
done

driver=$(find /usr/lib -name libvulkan_lvp.so)
loader=$(ldconfig -p | awk '/libvulkan\.so\.1 / { print $NF; exit }')
programs=(/usr/bin/heliograph "$driver" "$loader")
# A GPU's driver is mounted from the host when a container starts. It links parts of the C library
# that no file here links; they have been empty since glibc 2.34.
for name in libdl.so.2 libpthread.so.0 librt.so.1; do
  library=$(ldconfig -p | awk -v name="$name" '$1 == name { print $NF; exit }')
  install -D -m 755 "$(readlink -f "$library")" "$root$library"
done
# Every library under the name that the programs link it by, and the dynamic loader itself.
ldd "${programs[@]}" | awk '$2 == "=>" { print $3 } $1 ~ /^\/lib.*ld-/ { print $1 }' | sort -u |
  while read -r library; do
    install -D -m 755 "$(readlink -f "$library")" "$root$library"
  done
for program in "${programs[@]}"; do
  install -D -m 755 "$(readlink -f "$program")" "$root$program"
done

mkdir -p "$root/usr/share/vulkan/icd.d"
cp /usr/share/vulkan/icd.d/lvp_icd*.json "$root/usr/share/vulkan/icd.d/"
cp -r --parents /usr/share/heliograph /usr/share/doc/heliograph "$root"
# Fonts of the texts in captures, and where they are found.
font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
cp -r --parents /etc/fonts /usr/share/fontconfig "$root"
cp --parents "$font" "${font%.ttf}-Bold.ttf" "$root"
grep -E '^(root|nobody|heliograph):' /etc/passwd >"$root/etc/passwd"
grep -E '^(root|nogroup|heliograph):' /etc/group >"$root/etc/group"
# The licences of the copied files. dpkg-query fails if it knows one of the files by another name,
# but still prints the others.
{ ldd "${programs[@]}" | awk '$2 == "=>" { print $3 }' | xargs readlink -f | sort -u |
  xargs dpkg-query --search "$driver" "$font" 2>/dev/null || true; } | cut -d: -f1 | sort -u |
  while read -r package; do
    file=/usr/share/doc/$package/copyright
    if [ -f "$file" ]; then install -D -m 644 "$file" "$root$file"; fi
  done

install -m 755 "$(command -v busybox)" "$root/usr/bin/busybox"
"$(dirname "$0")/sbom.sh" heliograph-image \
  "$(dpkg-query --show --showformat '${Version}' heliograph)" \
  "${programs[@]}" "$font" "$(command -v busybox)" >"$root/usr/share/doc/heliograph/image.spdx.json"
# The commands that probes, hooks and operators call. Others are available as "busybox NAME".
for name in cat cp find grep id ls nc rm sh sleep timeout; do
  ln -s busybox "$root/usr/bin/$name"
done
