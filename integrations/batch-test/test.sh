#!/usr/bin/env bash
# Checks `drypoint batch` itself, without an engine: bad files, memory, shards, and being killed. Its pictures and its run are those
# with which the engines' tests compare. DRYPOINT_PICTURES=1000 is the full test.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
exec "$here/run.sh" "$here/test.py" pillow
