#!/usr/bin/env bash
# Fills the manifest and checks the files against what winget's schema asks.
# shellcheck disable=SC2317  # check calls the steps by name.
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"
sum=$(printf '0123456789abcdef%.0s' 1 2 3 4)
url=https://example.org/someone/drypoint/releases/download/v1.2.3/drypoint-windows.zip

install_yaml() {
    if ! /usr/bin/python3 -c "import yaml"; then
        apt-get -o DPkg::Lock::Timeout=600 update -qq
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends python3-yaml
    fi
}

fill() {
    local place
    place=$("$folder/fill.sh" "$1" "$url" "$sum" "$scratch/out")
    /usr/bin/python3 -B "$folder/manifest_test.py" "$place" "$1"
    grep -qx "  InstallerUrl: $url" "$place/Drypoint.Drypoint.installer.yaml"
    grep -qx "  InstallerSha256: ${sum^^}" "$place/Drypoint.Drypoint.installer.yaml"
    grep -qx "PackageUrl: https://example.org/someone/drypoint" "$place/Drypoint.Drypoint.locale.en-US.yaml"
}

# The check itself must see what is missing.
find_damage() {
    local place damage
    for damage in 's/^PackageVersion.*/PackageVersion: 1.2/' '/^ManifestType/d' '/Sha256/d' 's/^Moniker/Monicker/' 's/x64/x65/' \
        's/^License:.*/License: no/' 's/1\.10\.0$/1.0.0/'; do
        rm -rf "$scratch/damaged"
        place=$("$folder/fill.sh" 1.2.3 "$url" "$sum" "$scratch/damaged")
        sed -i "$damage" "$place"/*.yaml
        if /usr/bin/python3 -B "$folder/manifest_test.py" "$place" 1.2.3; then
            echo "not seen: $damage"
            return 1
        fi
    done
}

refuse_what_is_wrong() {
    local arguments
    for arguments in "" "1.2.3 $url $sum" "1.2 $url $sum $scratch/no" "1.2.3 http://a.org/b.zip $sum $scratch/no" \
        "1.2.3 https://a.org/b.exe $sum $scratch/no" "1.2.3 $url abc $scratch/no"; do
        # shellcheck disable=SC2086  # Several arguments.
        if "$folder/fill.sh" $arguments; then
            echo "taken: $arguments"
            return 1
        fi
    done
    [ ! -e "$scratch/no" ]
}

check "YAML can be read" install_yaml
check "the manifest is filled and valid" fill 1.2.3
check "the manifest of a version that looks like a number is valid" fill 1.10.0
check "damage is found" find_damage
check "wrong values are refused" refuse_what_is_wrong
finish
