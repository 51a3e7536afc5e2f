# What the tests of packages share; to be sourced by a folder's test.sh. Gives $folder, that of the test, $repository, and $scratch, a
# folder that is gone at the end.
# shellcheck shell=bash
folder=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$folder/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0
failed=0

# NAME COMMAND...: a named check, counted; in the background, so that a step ends at its first failing command.
check() {
    local name=$1
    shift
    (set -e; "$@") >"$scratch/said" 2>&1 &
    if wait $!; then
        passed=$((passed + 1))
        echo "passed: $name" >&2
    else
        failed=$((failed + 1))
        echo "FAILED: $name" >&2
        head -n 20 "$scratch/said" >&2
    fi
}

# Ends the test with the line that integrations/test.sh adds up.
finish() {
    echo "$passed passed, $failed failed"
    exit $((failed > 0))
}

# WHY: ends a test that cannot go on, as failed.
refuse() {
    echo "$1" >&2
    failed=$((failed + 1))
    finish
}

# Sets DRYPOINT to the command's full path: $DRYPOINT, else drypoint on the PATH, else the one built in this repository.
find_drypoint() {
    local named=${DRYPOINT:-$(command -v drypoint || echo "$repository/target/release/drypoint")}
    DRYPOINT=$(realpath -e "$(command -v "$named")" 2>"$scratch/said") ||
        refuse "there is no drypoint; build it with cargo build --release, or set DRYPOINT"
    export DRYPOINT
}

# FOLDER: an environment for packages of Python, made by $PYTHON [default: python3].
environment() {
    local python=${PYTHON:-python3}
    if ! "$python" -m venv "$1" >"$scratch/said" 2>&1; then
        # Debian keeps venv in a package of its own.
        rm -rf "$1"
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq python3 python3-venv >"$scratch/said" 2>&1 ||
            refuse "python3-venv cannot be installed: $(tail -n 3 "$scratch/said")"
        "$python" -m venv "$1" || refuse "$python -m venv does not work"
    fi
}

# PYTHON: runs the Python tests of this folder, with nothing written beside the sources. The last command of a test.
run_python_tests() {
    cp -r "$folder/tests" "$scratch/tests"
    cd "$scratch"
    DRYPOINT_SAMPLES="$repository/samples" "$1" "$repository/integrations/unit_tests.py" tests
}
