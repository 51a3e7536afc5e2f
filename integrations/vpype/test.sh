#!/usr/bin/env bash
# Tests the plug-in with the real vpype, in an environment of its own.
#
#   DRYPOINT=COMMAND  the command [default: drypoint on PATH, else the one built in this repository]
#   PYTHON=COMMAND    the Python to test with, 3.11 or later [default: python3]
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"
find_drypoint
unset PYTHONPATH
export PYTHONDONTWRITEBYTECODE=1 PIP_DISABLE_PIP_VERSION_CHECK=1

environment "$scratch/venv"
# setuptools builds beside the sources.
cp -rL "$folder" "$scratch/source"
"$scratch/venv/bin/pip" install --quiet "$scratch/source" || refuse "vpype and the plug-in cannot be installed"
echo "vpype $("$scratch/venv/bin/vpype" --version), $("$DRYPOINT" --version)" >&2
export PATH="$scratch/venv/bin:$PATH"
run_python_tests "$scratch/venv/bin/python"
