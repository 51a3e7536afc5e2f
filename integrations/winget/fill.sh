#!/usr/bin/env bash
# Writes the manifest of a release:  fill.sh VERSION URL SHA256 FOLDER [HOMEPAGE]
# URL and SHA256 are those of the .zip for Windows, with drypoint.exe at its top. Without HOMEPAGE the first two parts of URL's path
# are it. Prints the folder of the three files.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)

fail() {
    echo "$1" >&2
    exit 2
}

if (($# < 4 || $# > 5)); then
    fail "usage: fill.sh VERSION URL SHA256 FOLDER [HOMEPAGE]"
fi
version=$1 url=$2 sha256=${3^^} output=$4
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+([-+.][0-9A-Za-z.+-]+)?$ ]] || fail "$version is no version; it looks like 1.2.3"
[[ $url =~ ^https://[^[:space:]\"@#\|\\]+\.zip$ ]] || fail "$url is no address of a .zip; it begins with https://"
[[ $sha256 =~ ^[0-9A-F]{64}$ ]] || fail "$3 is no SHA-256; it has 64 digits from 0 to 9 and a to f (sha256sum FILE prints it)"
homepage=${5:-$(sed -E 's#^(https://[^/]+/[^/]+/[^/]+).*#\1#' <<<"$url")}

# The place that the repository of winget's manifests asks for.
place=$output/manifests/d/Drypoint/Drypoint/$version
mkdir -p "$place"
for part in version installer locale.en-US; do
    name=Drypoint.Drypoint
    if [ "$part" != version ]; then
        name=$name.$part
    fi
    sed -e "s|@VERSION@|$version|" -e "s|@URL@|$url|" -e "s|@SHA256@|$sha256|" -e "s|@HOMEPAGE@|$homepage|" \
        "$folder/templates/$part.yaml" >"$place/$name.yaml"
done
echo "$place"
