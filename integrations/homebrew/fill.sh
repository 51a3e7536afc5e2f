#!/usr/bin/env bash
# Prints the formula of a release:  fill.sh VERSION URL SHA256 [HOMEPAGE]
# URL and SHA256 are those of the archive of the sources. Without HOMEPAGE the first two parts of URL's path are it.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)

fail() {
    echo "$1" >&2
    exit 2
}

if (($# < 3 || $# > 4)); then
    fail "usage: fill.sh VERSION URL SHA256 [HOMEPAGE]"
fi
version=$1 url=$2 sha256=${3,,}
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+([-+.][0-9A-Za-z.+-]+)?$ ]] || fail "$version is no version; it looks like 1.2.3"
[[ $url =~ ^https://[^[:space:]\"@#\|\\]+$ ]] || fail "$url is no address; it begins with https://"
[[ $sha256 =~ ^[0-9a-f]{64}$ ]] || fail "$3 is no SHA-256; it has 64 digits from 0 to 9 and a to f (sha256sum FILE prints it)"
homepage=${4:-$(sed -E 's#^(https://[^/]+/[^/]+/[^/]+).*#\1#' <<<"$url")}

sed -e "s|@VERSION@|$version|" -e "s|@URL@|$url|" -e "s|@SHA256@|$sha256|" -e "s|@HOMEPAGE@|$homepage|" "$folder/drypoint.rb.in" |
    # Homebrew reads the version from the address where it stands there, and does not want it twice.
    if [[ $url == *"$version"* ]]; then sed '/^  version "/d'; else cat; fi
