#!/usr/bin/env bash
# Builds the book and checks it: links, anchors and pictures, the names that it gives, and every command in a block fenced as `sh`.
# Needs Rust for mdBook, unless that is on the PATH; takes the command from DRYPOINT, the PATH or target/release.
set -euo pipefail

mdbook_version=0.5.4

docs=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$docs")
scratch=$(mktemp -d "${TMPDIR:-/tmp}/drypoint-docs-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0

# WHY: something failed, which is said and counted.
fail() {
  echo "FAILED: $*" >&2
  failed=$((failed + 1))
}

finish() {
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
  exit
}

# PYTHON-SCRIPT ARGUMENTS...: adds its two counts, which are its standard output.
count() {
  local counts
  counts=$(PYTHONDONTWRITEBYTECODE=1 python3 "$docs/check/$1.py" "${@:2}") || true
  if [[ $counts =~ ^([0-9]+)\ ([0-9]+)$ ]]; then
    passed=$((passed + BASH_REMATCH[1]))
    failed=$((failed + BASH_REMATCH[2]))
  else
    fail "$1 ended without a result"
  fi
}

if ! command -v python3 >/dev/null; then
  apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends python3 >/dev/null || true
fi
command -v python3 >/dev/null || { fail "python3 is not there and cannot be installed" && finish; }

# The command under the name that the pages use.
command=${DRYPOINT:-$(command -v drypoint || echo "$root/target/release/drypoint")}
mkdir "$scratch/bin"
ln -s "$(realpath -m "$command")" "$scratch/bin/drypoint"
export PATH="$scratch/bin:$PATH"
# Presets of the user who runs this are not those of the pages.
export XDG_CONFIG_HOME="$scratch/config"
drypoint --version >/dev/null || { fail "$command cannot be run; build it, or name it in DRYPOINT" && finish; }

mdbook=$(command -v mdbook || true)
if [ -z "$mdbook" ] || [ "$("$mdbook" --version)" != "mdbook v$mdbook_version" ]; then
  # Without optimisation and without its web server, which would double the time.
  CARGO_TARGET_DIR="$scratch/target" cargo install mdbook --version "$mdbook_version" --locked --debug --quiet \
    --no-default-features --features search --root "$scratch/mdbook" >&2 || true
  mdbook=$scratch/mdbook/bin/mdbook
fi

# A copy, without a book that was built there before.
mkdir "$scratch/copy"
cp -R "$docs" "$root/samples" "$root/examples" "$scratch/copy"
rm -rf "$scratch/copy/docs/book"
if "$mdbook" build "$scratch/copy/docs" -d "$scratch/book" >"$scratch/log" 2>&1 && ! grep -E ' (WARN|ERROR) ' "$scratch/log" >&2; then
  passed=$((passed + 1))
  count links "$scratch/book"
else
  cat "$scratch/log" >&2 || true
  fail "the book cannot be built"
fi

count names
count commands "$root/samples"
finish
