#!/usr/bin/env bash
# Draws portraits on a Slurm cluster of four nodes on this machine, also while workers and the controller are killed.
# DRYPOINT_PICTURES=1000 is the full test.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
export PATH="$PATH:/usr/sbin"
install() {
  # Their daemons are started by the test, in a folder of its own, and not by the installation.
  apt-get update -qq
  RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends "$@" >/dev/null
}
if ! { command -v slurmctld && command -v slurmd && command -v sbatch && command -v munged; } >/dev/null &&
  ! install slurmctld slurmd slurm-client munge; then
  echo "FAILED: Slurm cannot be installed"
  echo "0 passed, 1 failed"
  exit 1
fi
exec "$here/../batch-test/run.sh" "$here/test.py" pillow
