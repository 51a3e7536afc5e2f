#!/usr/bin/env bash
# Draws pages in headless Inkscape and compares them with drypoint's own files. Installs Inkscape on Debian if it is missing.
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"

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

find_drypoint
install_missing || refuse "Inkscape and what its test needs cannot be installed"
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$folder/tests/run.py"
