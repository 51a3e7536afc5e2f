#!/usr/bin/env bash
# Builds the wheel, installs it in a clean environment and tests it there.
#
#   DRYPOINT_WHEEL=FILE     tests this wheel, without building
#   DRYPOINT_TARGET=FOLDER  where cargo builds [default: the repository's target]
#   PYTHON=COMMAND          the Python to test with [default: python3]
#
# The build needs Rust 1.94 or later and a C compiler, the tests Python 3.10 or later.
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

# The wheel's own command is tested, with nothing written beside the sources.
unset DRYPOINT PYTHONPATH
export PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1

environment() {
    if ! "$python" -m venv "$1" >"$work/log" 2>&1; then
        # Debian keeps venv in a package of its own.
        rm -rf "$1"
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq python3 python3-venv >"$work/log" 2>&1 ||
            refuse "python3-venv cannot be installed: $(tail -n 3 "$work/log")"
        "$python" -m venv "$1" || refuse "$python -m venv does not work"
    fi
}

build() {
    command -v cargo >/dev/null || refuse "there is no cargo to build the wheel with; install Rust 1.94, or set DRYPOINT_WHEEL"
    environment "$work/builder"
    "$work/builder/bin/pip" install --quiet 'maturin>=1.7,<2' || refuse "maturin cannot be installed"
    CARGO_TARGET_DIR=${DRYPOINT_TARGET:-$here/../../target} "$work/builder/bin/maturin" build --release --locked \
        --out "$work/wheel" >&2 || refuse "maturin cannot build the wheel"
    echo "$work"/wheel/*.whl
}

if [ -n "${DRYPOINT_WHEEL:-}" ]; then
    wheel=$(realpath "$DRYPOINT_WHEEL")
else
    cd "$here"
    wheel=$(build) || { echo "$wheel" && exit 1; }
fi
case $(basename "$wheel") in
*-py3-none-*.whl) ;;
*) refuse "$(basename "$wheel") is not a wheel for every Python 3" ;;
esac

environment "$work/clean"
"$work/clean/bin/pip" install --quiet "$wheel" || refuse "the wheel cannot be installed"
"$work/clean/bin/pip" install --quiet pillow || refuse "pillow, for the tests, cannot be installed"
"$work/clean/bin/drypoint" --version >&2 || refuse "the wheel's command does not run"

cp -r "$here/tests" "$work/tests"
export DRYPOINT_SAMPLES="$here/../../samples"
cd "$work"
"$work/clean/bin/python" tests
