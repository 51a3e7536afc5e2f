#!/usr/bin/env bash
# Fills the formula and runs its install and test steps with a drypoint that is built already.
# shellcheck disable=SC2317  # check calls the steps by name.
set -euo pipefail
# shellcheck source=../checks.sh
source "$(dirname "$0")/../checks.sh"
sum=$(printf '0123456789abcdef%.0s' 1 2 3 4)

install_ruby() {
    if ! command -v ruby; then
        apt-get -o DPkg::Lock::Timeout=600 update -qq
        apt-get -o DPkg::Lock::Timeout=600 install -y -qq --no-install-recommends ruby
    fi
}

fill() {
    "$folder/fill.sh" "$(version)" "https://example.org/someone/drypoint/archive/v$(version).tar.gz" "${sum^^}" >"$scratch/drypoint.rb"
    ruby -wc "$scratch/drypoint.rb"
    [ "$(grep -c '@' "$scratch/drypoint.rb")" = 0 ]
    grep -qx "  sha256 \"$sum\"" "$scratch/drypoint.rb"
    grep -qx '  homepage "https://example.org/someone/drypoint"' "$scratch/drypoint.rb"
    [ "$(grep -c '^  version ' "$scratch/drypoint.rb")" = 0 ]
}

fill_with_a_version() {
    "$folder/fill.sh" 1.2.3-rc.1 https://example.org/d.tar.gz "$sum" https://example.org/d >"$scratch/other.rb"
    ruby -wc "$scratch/other.rb"
    grep -qx '  version "1.2.3-rc.1"' "$scratch/other.rb"
}

refuse_what_is_wrong() {
    local arguments said
    for arguments in "" "1.2.3 https://a.org/b" "1.2 https://a.org/b $sum" "1.2.3 http://a.org/b $sum" "1.2.3 https://a.org/b abc"; do
        # shellcheck disable=SC2086  # Several arguments.
        if said=$("$folder/fill.sh" $arguments 2>"$scratch/words"); then
            echo "taken: $arguments"
            return 1
        fi
        [ -z "$said" ] && [ -s "$scratch/words" ]
    done
}

run_formula() {
    cd "$repository"
    ruby "$folder/formula_test.rb" "$scratch/drypoint.rb" "$DRYPOINT" "$scratch/prefix"
}

version() {
    "$DRYPOINT" --version | cut -d ' ' -f 2
}

find_drypoint
check "ruby is there" install_ruby
check "the formula is filled and parses" fill
check "a version that is not in the address is written" fill_with_a_version
check "wrong values are refused" refuse_what_is_wrong
check "install and test run" run_formula
finish
