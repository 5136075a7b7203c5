#!/usr/bin/env bash
# Prints the bill of materials of what was built, SPDX 2.3 in JSON: the Debian packages of the files
# and of every library that they link, those whose headers were compiled in, and what made the page.
#   sbom.sh NAME VERSION [--headers BUILD_FOLDER] [--npm LOCK_FILE] [--tool FILE] FILE...
# Times are those of SOURCE_DATE_EPOCH, if it is set.
set -euo pipefail
if [ $# -lt 3 ]; then
  echo "usage: sbom.sh NAME VERSION [--headers BUILD_FOLDER] [--npm LOCK_FILE] [--tool FILE] FILE..." >&2
  exit 2
fi
name=$1
version=$2
shift 2
build=
lock=
tool=
while :; do
  case $1 in
    --headers) build=$2 ;;
    --npm) lock=$2 ;;
    --tool) tool=$2 ;;
    *) break ;;
  esac
  shift 2
done

# Packages of the files whose names are read. dpkg knows some by their names before /usr was merged,
# and dpkg-query fails if it knows one of them by neither.
packages_of() {
  awk '{ print; if (sub("^/usr/", "/")) print }' | sort -u |
    { xargs dpkg-query --search 2>/dev/null || true; } |
    sed -n 's/^\([^ ,]*\).*: \/.*/\1/p' | sort -u
}

linked=$({ printf '%s\n' "$@"; { ldd "$@" 2>/dev/null || true; } |
  awk '$2 == "=>" { print $3 } $1 ~ /^\/lib.*ld-/ { print $1 }'; } | sort -u |
  xargs -d '\n' readlink -f | packages_of)
compiled=
if [ -n "$build" ]; then
  compiled=$(ninja -C "$build" -t deps | awk '$1 ~ "^/usr/include/" { print $1 }' |
    sort -u | packages_of)
fi
tools=
if [ -n "$tool" ]; then tools=$(readlink -f "$tool" | packages_of); fi
# Name, version, licence and SHA-512 of each package that npm has installed.
modules=
if [ -n "$lock" ]; then
  modules=$(node -e '
    const { packages } = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"));
    for (const [path, found] of Object.entries(packages)) {
      if (!path) continue;
      const digest = Buffer.from(found.integrity.replace(/^sha512-/, ""), "base64").toString("hex");
      console.log(path.replace(/^.*node_modules\//, ""), found.version, digest,
                  found.license ?? "NOASSERTION");
    }' "$lock" | LC_ALL=C sort -u)
fi

created=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(date +%s)}" +%Y-%m-%dT%H:%M:%SZ)
# The two packages of a name for two architectures differ in their id.
id_of() { printf 'SPDXRef-%s' "$(printf %s "$1" | tr -c 'A-Za-z0-9.-' -)"; }

distribution=$(. /etc/os-release && echo "$ID")
release=$(. /etc/os-release && echo "$ID-$VERSION_ID")
elements=$(printf '%s\n' "$linked" "$compiled" "$tools" | sort -u | sed '/^$/d' |
  xargs dpkg-query --show --showformat '${Package}:${Architecture} ${Version} ${source:Package}\n' |
  sort -u)
checksum=$(printf '%s\n' "$name" "$version" "$elements" "$modules" | sha256sum | cut -c 1-32)

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

print_module() {
  printf ',\n    {"SPDXID": "%s", "name": "%s", "versionInfo": "%s",\n' "$(id_of "npm-$1")" "$1" "$2"
  printf '     "downloadLocation": "NOASSERTION", "filesAnalyzed": false,\n'
  printf '     "licenseConcluded": "NOASSERTION", "licenseDeclared": "%s",\n' "$4"
  printf '     "copyrightText": "NOASSERTION",\n'
  printf '     "checksums": [{"algorithm": "SHA512", "checksumValue": "%s"}],\n' "$3"
  printf '     "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",\n'
  printf '       "referenceLocator": "pkg:npm/%s@%s"}]}' "${1/#@/%40}" "$2"
}

# A tool comes first in its relation.
print_tool() {
  printf ',\n    {"spdxElementId": "%s", "relationshipType": "BUILD_TOOL_OF",' "$1"
  printf ' "relatedSpdxElement": "SPDXRef-built"}'
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
  while read -r package found source; do print_package "$package" "$found" "$source"; done <<<"$elements"
  while read -r module found digest licence; do
    if [ -n "$module" ]; then print_module "$module" "$found" "$digest" "$licence"; fi
  done <<<"$modules")
  ],
  "relationships": [
    {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-built"}$(
  print_relations DYNAMIC_LINK <<<"$linked"
  print_relations STATIC_LINK <<<"$compiled"
  while read -r package; do
    if [ -n "$package" ]; then
      print_tool "$(id_of "$(dpkg-query --show --showformat '${Package}:${Architecture}' "$package")")"
    fi
  done <<<"$tools"
  while read -r module rest; do
    if [ -n "$module" ]; then print_tool "$(id_of "npm-$module")"; fi
  done <<<"$modules")
  ]
}
END
