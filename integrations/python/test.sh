#!/usr/bin/env bash
# Builds the wheel, installs it in a clean environment and tests it there.
#
#   DRYPOINT_WHEEL=FILE     tests this wheel, without building
#   DRYPOINT_TARGET=FOLDER  where cargo builds [default: the repository's target]
#   PYTHON=COMMAND          the Python to test with [default: python3]
#
# The build needs Rust 1.94 or later and a C compiler, the tests Python 3.10 or later.
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"

# The wheel's own command is tested, with nothing written beside the sources.
unset DRYPOINT PYTHONPATH
export PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1

build() {
    command -v cargo >/dev/null || refuse "there is no cargo to build the wheel with; install Rust 1.94, or set DRYPOINT_WHEEL"
    environment "$scratch/builder"
    "$scratch/builder/bin/pip" install --quiet 'maturin>=1.7,<2' || refuse "maturin cannot be installed"
    CARGO_TARGET_DIR=${DRYPOINT_TARGET:-$repository/target} "$scratch/builder/bin/maturin" build --release --locked \
        --out "$scratch/wheel" >&2 || refuse "maturin cannot build the wheel"
    echo "$scratch"/wheel/*.whl
}

if [ -n "${DRYPOINT_WHEEL:-}" ]; then
    wheel=$(realpath "$DRYPOINT_WHEEL")
else
    cd "$folder"
    wheel=$(build) || { echo "$wheel" && exit 1; }
fi
case $(basename "$wheel") in
*-py3-none-*.whl) ;;
*) refuse "$(basename "$wheel") is not a wheel for every Python 3" ;;
esac

environment "$scratch/clean"
"$scratch/clean/bin/pip" install --quiet "$wheel" || refuse "the wheel cannot be installed"
"$scratch/clean/bin/pip" install --quiet pillow || refuse "pillow, for the tests, cannot be installed"
"$scratch/clean/bin/drypoint" --version >&2 || refuse "the wheel's command does not run"
run_python_tests "$scratch/clean/bin/python"
