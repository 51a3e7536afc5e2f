#!/usr/bin/env bash
# Compiles the library for WebAssembly, draws a sample in Node.js, and compares with what this machine's own code draws.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export CARGO_TARGET_DIR=${DRYPOINT_WASM_TARGET:-$folder/target}
passed=0 failed=0
check() {
  if "${@:2}"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "failed: $1"; fi
}

command -v node >/dev/null || { apt-get update -qq && apt-get install -y -qq --no-install-recommends nodejs >/dev/null; }
rustup target add wasm32-unknown-unknown >/dev/null 2>&1 || { echo "the target wasm32-unknown-unknown cannot be had here"; echo "0 passed, 1 failed"; exit 1; }
cd "$here"
# The versions that drypoint itself is built of.
cp "$here/../../Cargo.lock" "$here/Cargo.lock"
cargo build --release --quiet --target wasm32-unknown-unknown
cargo build --release --quiet --example native
# The tool must be as old as the crate.
version=$(cargo metadata --format-version 1 | grep -o '"name":"wasm-bindgen","version":"[^"]*"' | head -1 | cut -d'"' -f8)
tools=${DRYPOINT_WASM_TOOLS:-$folder/tools}
"$tools/bin/wasm-bindgen" --version 2>/dev/null | grep -q "$version" ||
  cargo install --quiet --debug --root "$tools" --version "$version" wasm-bindgen-cli
"$tools/bin/wasm-bindgen" --target nodejs --out-dir "$folder/node" "$CARGO_TARGET_DIR/wasm32-unknown-unknown/release/drypoint_wasm.wasm"
echo "$(stat -c %s "$folder/node/drypoint_wasm_bg.wasm") bytes of WebAssembly"

for style in hedcut grid engrave charcoal glass; do
  for sample in grace-hopper.jpg chelsea.png; do
    native=$folder/native.svg drawn=$folder/wasm.svg
    "$CARGO_TARGET_DIR/release/examples/native" "$here/../../samples/$sample" $style 60 "$native"
    check "$sample as $style in Node.js" node "$here/draw.mjs" "$folder/node/drypoint_wasm.js" "$here/../../samples/$sample" $style 60 "$drawn"
    check "$sample as $style has the same bytes" cmp "$native" "$drawn"
  done
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
