#!/usr/bin/env bash
# Reads draw.yaml as Kubernetes would and runs its container's command for every part, without a cluster.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
exec "$here/../batch-test/run.sh" "$here/test.py" pillow pyyaml 'kubernetes>=33'
