#!/usr/bin/env bash
# Builds the package, installs it in an empty Debian, draws a portrait there, and removes it again. Must run as root, for chroot.
# shellcheck disable=SC2317  # check calls the steps by name.
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"
root=$scratch/root

install_tools() {
    local packages=() pair
    for pair in mmdebstrap:mmdebstrap lintian:lintian dpkg-shlibdeps:dpkg-dev strip:binutils man:man-db zsh:zsh fish:fish git:git \
        python3:python3; do
        command -v "${pair%%:*}" >/dev/null || packages+=("${pair##*:}")
    done
    if ((${#packages[@]})); then
        apt-get -o DPkg::Lock::Timeout=600 update -qq
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends "${packages[@]}"
    fi
}

# Not kept: it belongs to no package. Without optimisation it takes two minutes less.
install_cargo_deb() {
    if ! command -v cargo-deb; then
        nice -n 19 cargo install cargo-deb --locked --debug --root "$scratch/cargo" --target-dir "$scratch/cargo-build"
    fi
}

build() {
    MAINTAINER="Test <test@drypoint.invalid>" "$folder/build.sh" "$DRYPOINT" "$scratch/$1"
}

same_bytes_twice() {
    build again && cmp "$scratch"/package/*.deb "$scratch"/again/*.deb
}

lintian_finds_no_error() {
    lintian --allow-root --fail-on error "$package"
}

# All that is needed is what every Debian has.
depends_only_on_libc() {
    dpkg-deb -f "$package" Depends Section Architecture
    [[ $(dpkg-deb -f "$package" Depends) =~ ^libc6\ \(\>=\ [0-9.]+\)$ ]] && [ "$(dpkg-deb -f "$package" Section)" = graphics ]
}

make_root() {
    mmdebstrap --variant=minbase --quiet bookworm "$root"
}

inside() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"
}

files_of_root() {
    (cd "$root" && find . -path ./proc -prune -o -path ./sys -prune -o -path ./tmp -prune -o -path ./var/log -prune -o \
        -path ./var/lib/dpkg -prune -o -path ./var/lib/apt -prune -o -path ./var/cache -prune -o -print | sort)
}

# From the package at hand to the portrait, as a user does it.
install_and_draw() {
    cp "$package" "$root/tmp/drypoint.deb"
    cp "$repository/samples/grace-hopper.jpg" "$root/tmp/"
    local TIMEFORMAT='%R seconds (%U of the processor)'
    {
        echo -n "to install: "
        time inside apt-get install -y --no-install-recommends /tmp/drypoint.deb >"$scratch/installed" 2>&1
        echo -n "to draw: "
        time inside drypoint draw /tmp/grace-hopper.jpg -o /tmp/portrait.svg --json >"$scratch/report.json" 2>"$scratch/drawn"
    } >"$scratch/seconds" 2>&1
}

the_portrait_is_whole() {
    # The same bytes as outside, and what a portrait needs: a face that was found, dots and hair.
    "$DRYPOINT" draw "$repository/samples/grace-hopper.jpg" -o "$scratch/portrait.svg" --quiet
    cmp "$scratch/portrait.svg" "$root/tmp/portrait.svg"
    python3 - "$scratch/report.json" <<'PYTHON'
import json, sys
layers = {layer["name"]: layer for layer in json.load(open(sys.argv[1]))["layers"]}
assert layers["dots"]["dots"] > 1000 and layers["clothing"]["strokes"] > 100, layers
PYTHON
}

version_is_the_packages() {
    [ "drypoint $(dpkg-deb -f "$package" Version)" = "$(inside drypoint --version)-1" ]
}

every_subcommand_has_a_page() {
    local name pages=$root/usr/share/man/man1
    for name in "" $(subcommands); do
        gzip -cd "$pages/drypoint$name.1.gz" >"$scratch/page.1"
        # Warnings are those of the typesetter.
        MANWIDTH=80 man --warnings -l "$scratch/page.1" >"$scratch/page.txt" 2>"$scratch/warnings"
        cat "$scratch/warnings"
        [ ! -s "$scratch/warnings" ]
        grep -q "^ *drypoint$name  *-  *[A-Z]" "$scratch/page.txt"
        [ "$(grep -c '^\.TH .*"drypoint [0-9]' "$scratch/page.1")" = 1 ]
        [ "$(grep -c '^\.TH ' "$scratch/page.1")" = 1 ]
    done
    gzip -cd "$pages/drypoint-draw.1.gz" | man -l - | grep -q -e --pitch
}

# Each with a dash before it.
subcommands() {
    inside drypoint --help | awk '/^Commands:/ { on = 1; next } /^Options:/ { on = 0 } on && /^  [a-z]/ && $1 != "help" { print "-" $1 }'
}

bash_completes() {
    # shellcheck disable=SC2016  # For the shell inside.
    inside bash -euc '
        source /usr/share/bash-completion/completions/drypoint
        complete -p drypoint
        COMP_WORDS=(drypoint dra) COMP_CWORD=1 COMPREPLY=()
        _drypoint drypoint dra drypoint
        [ "${COMPREPLY[*]}" = draw ]
        COMP_WORDS=(drypoint draw --pit) COMP_CWORD=2 COMPREPLY=()
        _drypoint drypoint --pit draw
        [ "${COMPREPLY[*]}" = --pitch ]'
}

zsh_completes() {
    # shellcheck disable=SC2016  # For zsh.
    zsh -fc '
        fpath=('"$root"'/usr/share/zsh/vendor-completions $fpath)
        autoload -Uz compinit && compinit -u -d '"$scratch"'/zcompdump
        [ "$_comps[drypoint]" = _drypoint ] && autoload +X _drypoint && (( $+functions[_drypoint] ))' &&
        zsh -n "$root/usr/share/zsh/vendor-completions/_drypoint"
}

fish_completes() {
    HOME=$scratch fish -Nc "
        source '$root/usr/share/fish/vendor_completions.d/drypoint.fish'
        complete -C 'drypoint dra'" | grep -q '^draw'
}

the_extension_of_inkscape_is_there() {
    diff -r -x __pycache__ "$folder/../inkscape/drypoint" "$root/usr/share/inkscape/extensions/drypoint"
}

licences_are_there() {
    local documents=$root/usr/share/doc/drypoint
    grep -q "Permission is hereby granted" "$documents/copyright" && grep -q "^License: Apache-2.0" "$documents/copyright" &&
        [ -s "$root/usr/share/common-licenses/Apache-2.0" ] && grep -q MediaPipe "$documents/NOTICE" &&
        gzip -cd "$documents/changelog.Debian.gz" | grep -q "^drypoint ("
}

removed_without_leftovers() {
    inside apt-get purge -y drypoint
    files_of_root >"$scratch/after"
    diff "$scratch/before" "$scratch/after"
    # shellcheck disable=SC2016  # A field of dpkg.
    [ -z "$(inside dpkg-query -f '${db:Status-Status}' -W drypoint)" ]
}

check "the tools are there" install_tools
find_drypoint
check "cargo-deb is there" install_cargo_deb
PATH=$PATH:$scratch/cargo/bin
check "the package is built" build package
if ((failed)); then
    finish
fi
package=$(echo "$scratch"/package/*.deb)
check "the same sources give the same bytes" same_bytes_twice
check "lintian finds no error" lintian_finds_no_error
check "the package depends on libc only and is in section graphics" depends_only_on_libc
check "an empty Debian is made" make_root
if ((failed)); then
    finish
fi
files_of_root >"$scratch/before"
check "installed, and a portrait drawn" install_and_draw
cat "$scratch/seconds" >&2
check "the portrait is whole" the_portrait_is_whole
check "the version is the package's" version_is_the_packages
check "every subcommand has a page" every_subcommand_has_a_page
check "bash completes" bash_completes
check "zsh completes" zsh_completes
check "fish completes" fish_completes
check "the extension of Inkscape is there" the_extension_of_inkscape_is_there
check "the licences are there" licences_are_there
check "removed without leftovers" removed_without_leftovers
finish
