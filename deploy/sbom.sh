#!/usr/bin/env bash
# Prints the bill of materials of what was built, SPDX 2.3 in JSON: the Debian packages of the files
# and of every library that they link, and those whose headers were compiled in.
#   sbom.sh NAME VERSION [--headers BUILD_FOLDER] FILE...
# Times are those of SOURCE_DATE_EPOCH, if it is set.
set -euo pipefail
if [ $# -lt 3 ]; then
  echo "usage: sbom.sh NAME VERSION [--headers BUILD_FOLDER] FILE..." >&2
  exit 2
fi
name=$1
version=$2
shift 2
build=
if [ "$1" = --headers ]; then
  build=$2
  shift 2
fi

# Packages of the files whose names are read. dpkg knows some by their names before /usr was merged,
# and dpkg-query fails if it knows one of them by neither.
packages_of() {
  awk '{ print; if (sub("^/usr/", "/")) print }' | sort -u |
    { xargs dpkg-query --search 2>/dev/null || true; } |
    sed -n 's/^\([^ ,]*\).*: \/.*/\1/p' | sort -u
}

linked=$({ printf '%s\n' "$@"; ldd "$@" 2>/dev/null |
  awk '$2 == "=>" { print $3 } $1 ~ /^\/lib.*ld-/ { print $1 }'; } | sort -u |
  xargs -d '\n' readlink -f | packages_of)
compiled=
if [ -n "$build" ]; then
  compiled=$(ninja -C "$build" -t deps | awk '$1 ~ "^/usr/include/" { print $1 }' |
    sort -u | packages_of)
fi

created=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(date +%s)}" +%Y-%m-%dT%H:%M:%SZ)
# The two packages of a name for two architectures differ in their id.
id_of() { printf 'SPDXRef-%s' "$(printf %s "$1" | tr -c 'A-Za-z0-9.-' -)"; }

distribution=$(. /etc/os-release && echo "$ID")
release=$(. /etc/os-release && echo "$ID-$VERSION_ID")
elements=$(printf '%s\n' "$linked" "$compiled" | sort -u | sed '/^$/d' |
  xargs dpkg-query --show --showformat '${Package}:${Architecture} ${Version} ${source:Package}\n' |
  sort -u)
checksum=$(printf '%s\n' "$name" "$version" "$elements" | sha256sum | cut -c 1-32)

print_package() {
  local package=${1%:*} architecture=${1##*:}
  printf ',\n    {"SPDXID": "%s", "name": "%s", "versionInfo": "%s",\n' "$(id_of "$1")" "$package" "$2"
  printf '     "downloadLocation": "NOASSERTION", "filesAnalyzed": false,\n'
  printf '     "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION",\n'
  printf '     "copyrightText": "NOASSERTION", "sourceInfo": "built from the source package %s",\n' "$3"
  printf '     "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",\n'
  printf '       "referenceLocator": "pkg:deb/%s/%s@%s?arch=%s&distro=%s"}]}' \
    "$distribution" "$package" "${2//:/%3A}" "$architecture" "$release"
}

print_relations() {
  local kind=$1 package
  while read -r package; do
    if [ -z "$package" ]; then continue; fi
    package=$(dpkg-query --show --showformat '${Package}:${Architecture}' "$package")
    printf ',\n    {"spdxElementId": "SPDXRef-built", "relationshipType": "%s",' "$kind"
    printf ' "relatedSpdxElement": "%s"}' "$(id_of "$package")"
  done
}

cat <<END
{
  "spdxVersion": "SPDX-2.3",
  "dataLicense": "CC0-1.0",
  "SPDXID": "SPDXRef-DOCUMENT",
  "name": "$name-$version",
  "documentNamespace": "https://spdx.org/spdxdocs/$name-$version-$checksum",
  "creationInfo": {"created": "$created", "creators": ["Tool: heliograph-sbom-$version"]},
  "packages": [
    {"SPDXID": "SPDXRef-built", "name": "$name", "versionInfo": "$version",
     "downloadLocation": "NOASSERTION", "filesAnalyzed": false, "licenseConcluded": "MIT",
     "licenseDeclared": "MIT", "copyrightText": "NOASSERTION"}$(
  while read -r package found source; do print_package "$package" "$found" "$source"; done <<<"$elements")
  ],
  "relationships": [
    {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-built"}$(
  print_relations DYNAMIC_LINK <<<"$linked"
  print_relations STATIC_LINK <<<"$compiled")
  ]
}
END
