#!/usr/bin/env bash
# Runs a test written in Python, with the packages that it needs, and leaves nothing behind.
#
#   run.sh TEST.py PACKAGE...
set -euo pipefail

test=$1
shift
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d "${TMPDIR:-/tmp}/drypoint-test-XXXXXX")
trap 'rm -rf "$folder"' EXIT

# Debian leaves venv out of its python3.
bare() { ! python3 -c 'import ensurepip, venv' 2>/dev/null; }
if bare; then
  apt-get update -qq || true
  apt-get -o DPkg::Lock::Timeout=600 install -y -qq python3-venv >/dev/null || true
fi
if ! python3 -m venv "$folder/python" || ! "$folder/python/bin/pip" install --quiet --disable-pip-version-check "$@"; then
  echo "FAILED: the packages of the test cannot be installed: $*"
  echo "0 passed, 1 failed"
  exit 1
fi

# The mark by which the test knows its processes. What they leave when they are killed goes with the folder.
export DRYPOINT_TEST_RUN="$folder" TMPDIR="$folder/temporary"
mkdir "$TMPDIR"
PYTHONPATH="$here:$(dirname "$test")" PYTHONDONTWRITEBYTECODE=1 "$folder/python/bin/python" "$test" &
running=$!
trap 'kill "$running"' INT TERM HUP
status=0
wait "$running" || status=$?
# A signal ends the wait; the test still cleans up.
wait "$running" 2>/dev/null || true
exit "$status"
