# Named checks of the packages' tests, counted; to be sourced. Needs $scratch, a folder for what a check says.
# shellcheck shell=bash
passed=0
failed=0

# NAME COMMAND...: in the background, so that a step ends at its first failing command.
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
