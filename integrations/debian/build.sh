#!/usr/bin/env bash
# Writes a Debian package of a drypoint that is built already:  build.sh DRYPOINT FOLDER
# Needs dpkg-dev, binutils and cargo-deb (cargo install cargo-deb --locked). Prints the package's file name.
# MAINTAINER='Name <address>' names who answers for the package.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$folder/../.." && pwd)

if (($# != 2)); then
    echo "usage: build.sh DRYPOINT FOLDER    (the binary, and the folder that the package goes to)" >&2
    exit 2
fi
if ! command -v cargo-deb >/dev/null; then
    echo "cargo-deb is missing; install it with: cargo install cargo-deb --locked" >&2
    exit 1
fi
drypoint=$(realpath -e "$1")
output=$(realpath -m "$2")
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT

# cargo-deb reads a project's folder. This one has the sources by links, and the binary and all that is made with it as files.
lay_out_project() {
    local name
    for name in "$repository"/*; do
        case ${name##*/} in
            Cargo.toml | target | packaged) ;;
            *) ln -s "$name" "$stage/" ;;
        esac
    done
    # Debian wants a description of a few words that does not begin with the program's verb.
    sed "s/^description = .*/description = \"vector stroke art from photographs, for print and pen plotters\"/" \
        "$repository/Cargo.toml" >"$stage/Cargo.toml"
    { echo; cat "$folder/metadata.toml"; } >>"$stage/Cargo.toml"
    if [ -n "${MAINTAINER:-}" ]; then
        sed -i "s/^maintainer = .*/maintainer = \"$MAINTAINER\"/" "$stage/Cargo.toml"
    fi
    install -D -m 755 "$drypoint" "$stage/target/release/drypoint"
    mkdir -p "$stage/packaged/man" "$stage/packaged/completions"
}

# Pages and completions come from the binary itself, so they fit it.
describe_program() {
    "$drypoint" man -o "$stage/packaged/man"
    "$drypoint" completions bash >"$stage/packaged/completions/drypoint"
    "$drypoint" completions zsh >"$stage/packaged/completions/_drypoint"
    "$drypoint" completions fish >"$stage/packaged/completions/drypoint.fish"
}

write_licences() {
    local terms
    # The terms begin after the title and the copyright line.
    terms=$(sed 1,4d "$repository/LICENSE-MIT" | fold -s -w 78 | sed -e 's/ *$//' -e 's/^$/./' -e 's/^/ /')
    awk -v terms="$terms" '$0 == "@MIT@" { print "License: MIT\n" terms "\n"; next } { print }' "$folder/copyright" \
        >"$stage/packaged/copyright"
}

# The date is that of the sources, so that the same sources give the same package.
write_changelog() {
    local version maintainer
    version=$("$drypoint" --version | cut -d ' ' -f 2)
    maintainer=$(sed -n 's/^maintainer = "\(.*\)"/\1/p' "$stage/Cargo.toml")
    printf 'drypoint (%s-1) unstable; urgency=medium\n\n  * Release %s.\n\n -- %s  %s\n' "$version" "$version" "$maintainer" \
        "$(LC_ALL=C date -u -R -d "@$SOURCE_DATE_EPOCH")" >"$stage/packaged/changelog"
}

if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
    SOURCE_DATE_EPOCH=$(git -C "$repository" log -1 --format=%ct 2>/dev/null || stat -c %Y "$repository/Cargo.toml")
fi
export SOURCE_DATE_EPOCH
lay_out_project
describe_program
write_licences
write_changelog
mkdir -p "$output"
CARGO_TARGET_DIR=$stage/target cargo deb --no-build --manifest-path "$stage/Cargo.toml" --output "$output" --quiet --strip \
    --no-dbgsym
