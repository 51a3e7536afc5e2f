#!/usr/bin/env bash
# Tests the plug-in with the real vpype, in an environment of its own.
#
#   DRYPOINT=COMMAND  the command [default: drypoint on PATH, else the one built in this repository]
#   PYTHON=COMMAND    the Python to test with, 3.11 or later [default: python3]
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${PYTHON:-python3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

refuse() {
    echo "$1" >&2
    echo "0 passed, 1 failed"
    exit 1
}

DRYPOINT=${DRYPOINT:-$(command -v drypoint || echo "$here/../../target/release/drypoint")}
DRYPOINT=$(command -v "$DRYPOINT") || refuse "there is no drypoint; build it with cargo build --release, or set DRYPOINT"
DRYPOINT=$(realpath "$DRYPOINT")
export DRYPOINT
unset PYTHONPATH
export PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1

if ! "$python" -m venv "$work/venv" >"$work/log" 2>&1; then
    # Debian keeps venv in a package of its own.
    rm -rf "$work/venv"
    apt-get -o DPkg::Lock::Timeout=600 install -y -qq python3 python3-venv >"$work/log" 2>&1 ||
        refuse "python3-venv cannot be installed: $(tail -n 3 "$work/log")"
    "$python" -m venv "$work/venv" || refuse "$python -m venv does not work"
fi

# setuptools builds beside the sources.
cp -rL "$here" "$work/source"
"$work/venv/bin/pip" install --quiet "$work/source" || refuse "vpype and the plug-in cannot be installed"
echo "vpype $("$work/venv/bin/vpype" --version), $("$DRYPOINT" --version)" >&2

cp -r "$here/tests" "$work/tests"
export DRYPOINT_SAMPLES="$here/../../samples" PATH="$work/venv/bin:$PATH"
cd "$work"
"$work/venv/bin/python" tests
