#!/usr/bin/env bash
# Draws the photographs of a manifest with GNU parallel, in parts, on this machine or on several.
#
#   draw.sh MANIFEST 'OUT/{name}.svg' RESULTS.jsonl [options of drypoint batch]
#
#   PARTS=64             parts of the manifest; each should take some minutes, as drypoint starts anew for each
#   MACHINES=nodes.txt   machines, one per line such as `8/user@node` (8 parts at once), that share the files; `:` is this one
#
# One machine needs none of this: `drypoint batch` alone keeps its processors busy. A run that stopped goes on where it was.
# Exit status: 0 all drawn, 3 some photographs could not be drawn, 1 some parts did not end (the log names them).
set -euo pipefail

manifest=$(realpath "$1") output=$(realpath -m "$2") results=$3
shift 3
parts=${PARTS:-64}
machines=()
[ -z "${MACHINES:-}" ] || machines=(--sshloginfile "$MACHINES")

# A part whose status is 3 has ended well: some photographs are none, their lines say so, and another attempt would not help.
# The lines of a part come in one piece when it ends; those of attempts that died are thrown away.
# --quote keeps names and options as they are through the shell of each machine.
status=0
# shellcheck disable=SC2016
seq "$parts" | parallel --quote "${machines[@]}" --jobs "${JOBS:-100%}" --retries 5 --joblog "$results.log" \
  sh -c '"$@"; status=$?; [ $status -eq 0 ] || [ $status -eq 3 ]' part \
  "${DRYPOINT:-drypoint}" batch "$manifest" -o "$output" "$@" --shard "{}/$parts" --jobs 1 --threads 1 --quiet \
  >"$results.part" || status=$?
if [ "$status" -gt 0 ]; then
  echo "$status of $parts parts did not end; $results.log says which. Run it again." >&2
  exit 1
fi
mv "$results.part" "$results"

count() { grep -c "\"status\":\"$1\"" "$results" || true; }
echo "$(count "done") done, $(count skipped) skipped, $(count failed) failed" >&2
[ "$(count failed)" -eq 0 ] || exit 3
