#!/usr/bin/env bash
# Runs the test of every folder here, or of those that are named, and adds up what they say.
#
#   integrations/test.sh [FOLDER...]
#   DRYPOINT_PICTURES=1000 integrations/test.sh batch-test ray slurm parallel kubernetes    the full test of the engines
#
# The command is $DRYPOINT, else drypoint on the PATH, else target/release/drypoint.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
folders=("$@")
if [ ${#folders[@]} -eq 0 ]; then
  for test in "$here"/*/test.sh; do
    folders+=("$(basename "$(dirname "$test")")")
  done
fi

# Tests of engines share their pictures and the plain run with which they compare.
shared=$(mktemp -d "${TMPDIR:-/tmp}/drypoint-tests-XXXXXX")
trap 'rm -rf "$shared"' EXIT
export DRYPOINT_BATCH_FOLDER="${DRYPOINT_BATCH_FOLDER:-$shared}"

passed=0 failed=0
for folder in "${folders[@]}"; do
  echo "== $folder"
  "$here/$folder/test.sh" 2>&1 | tee "$shared/said" && status=0 || status=$?
  # Not the last line alone: what a test leaves running may speak after it.
  closing=$(grep -E '^[0-9]+ passed, [0-9]+ failed$' "$shared/said" | tail -n 1 || true)
  if [[ $closing =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    passed=$((passed + BASH_REMATCH[1]))
    failed=$((failed + BASH_REMATCH[2]))
  fi
  if [ "$status" -ne 0 ] && [[ $closing != *" failed" || $closing == *" 0 failed" ]]; then
    echo "FAILED: $folder ended with status $status"
    failed=$((failed + 1))
  elif [ "$status" -eq 0 ] && [ -z "$closing" ]; then
    echo "FAILED: $folder did not say how many checks passed"
    failed=$((failed + 1))
  fi
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
