#!/usr/bin/env bash
# Draws pages in headless Inkscape and compares them with drypoint's own files. Installs Inkscape on Debian if it is missing.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)

# Sets DRYPOINT to the command's full path.
find_drypoint() {
    local named=${DRYPOINT:-$(command -v drypoint || echo "$folder/../../target/release/drypoint")}
    if ! DRYPOINT=$(realpath -e "$named"); then
        echo "drypoint was not found; set DRYPOINT or run cargo build --release" >&2
        return 1
    fi
    export DRYPOINT
}

install_missing() {
    local packages=() pair
    for pair in inkscape:inkscape xvfb-run:xvfb xauth:xauth rsvg-convert:librsvg2-bin; do
        command -v "${pair%%:*}" >/dev/null || packages+=("${pair##*:}")
    done
    for pair in cssselect:python3-cssselect lxml:python3-lxml numpy:python3-numpy PIL:python3-pil; do
        /usr/bin/python3 -c "import ${pair%%:*}" 2>/dev/null || packages+=("${pair##*:}")
    done
    if ((${#packages[@]})); then
        apt-get -o DPkg::Lock::Timeout=600 update -qq >&2
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends "${packages[@]}" >&2
    fi
}

if ! find_drypoint || ! install_missing; then
    echo "0 passed, 1 failed"
    exit 1
fi
PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 "$folder/tests/run.py"
