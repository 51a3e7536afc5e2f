#!/usr/bin/env bash
# Draws portraits with GNU parallel, also while its jobs and parallel itself are killed.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
install() {
  apt-get update -qq
  apt-get -o DPkg::Lock::Timeout=600 install -y -qq parallel >/dev/null
}
if ! command -v parallel >/dev/null && ! install; then
  echo "FAILED: GNU parallel cannot be installed"
  echo "0 passed, 1 failed"
  exit 1
fi
exec "$here/../batch-test/run.sh" "$here/test.py" pillow
