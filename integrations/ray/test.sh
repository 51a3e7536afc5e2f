#!/usr/bin/env bash
# Draws portraits on a Ray cluster of four workers on this machine, also while workers and the head are killed.
# DRYPOINT_PICTURES=1000 is the full test.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
exec "$here/../batch-test/run.sh" "$here/test.py" pillow 'ray>=2.40' pyarrow
