#!/usr/bin/env bash
# How long it takes from a clean Debian with a package manager and nothing else to a portrait, for each way to install:
#
#   integrations/from-nothing.sh wheel FILE.whl    Python and pip; numpy is fetched
#   integrations/from-nothing.sh deb FILE.deb      apt
#   integrations/from-nothing.sh cargo FILE.crate  cargo and a C compiler; every crate is fetched and built (cargo package writes FILE)
#
# Counted is what a user waits for: installing, and drawing. Making the clean system is not. Must run as root, for chroot and mount. Ends
# with status 1 if there is no portrait after three minutes.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
if (($# != 2)); then
    sed -n 's/^#   //p' "$0" >&2
    exit 2
fi
kind=$1 file=$(realpath -e "$2")
root=$(mktemp -d)
undo() {
    for place in opt/rust proc; do
        if mountpoint -q "$root/$place"; then umount "$root/$place"; fi
    done
    rm -rf --one-file-system "$root"
}
trap undo EXIT

inside() {
    env -i PATH=/root/.cargo/bin:/opt/rust/bin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        chroot "$root" "$@"
}

# SUITE PACKAGES: a clean system with what the package manager consists of.
clean_system() {
    mmdebstrap --variant=minbase --quiet --include="$2" "$1" "$root"
    # The certificates and the name servers of this machine.
    mkdir -p "$root/etc/ssl/certs"
    cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
    cp /etc/resolv.conf /etc/hosts "$root/etc/"
    mkdir -p "$root/root"
    cp "$file" "$root/root/"
    cp "$here/../samples/grace-hopper.jpg" "$root/root/portrait.jpg"
}

case $kind in
wheel)
    clean_system bookworm python3,python3-pip,ca-certificates
    install() { inside pip install --quiet --break-system-packages --root-user-action=ignore "/root/$(basename "$file")"; }
    ;;
deb)
    clean_system bookworm ca-certificates
    install() { inside apt-get install -y -qq --no-install-recommends "/root/$(basename "$file")"; }
    ;;
cargo)
    clean_system bookworm gcc,libc6-dev,ca-certificates
    mkdir -p "$root/opt/rust"
    mount -t proc proc "$root/proc"
    mount --bind -o ro "$(rustc --print sysroot)" "$root/opt/rust"
    install() {
        inside tar -xzf "/root/$(basename "$file")" -C /root
        # Without the studio and the sender, which a portrait does not need.
        inside cargo install --quiet --locked --path "/root/$(basename "$file" .crate)" --profile quick --no-default-features --features cli,see
    }
    ;;
*)
    echo "neither wheel, deb nor cargo: $kind" >&2
    exit 2
    ;;
esac

seconds() { date +%s.%N; }
begun=$(seconds)
install >&2
installed=$(seconds)
inside drypoint draw /root/portrait.jpg -o /root/portrait.svg --quiet
drawn=$(seconds)
test -s "$root/root/portrait.svg"
python3 - "$kind" "$begun" "$installed" "$drawn" <<'PYTHON'
import sys
kind, begun, installed, drawn = sys.argv[1], *map(float, sys.argv[2:])
print(f"{kind}: installed in {installed - begun:.1f} s, drawn in {drawn - installed:.1f} s, {drawn - begun:.1f} s in all")
sys.exit(drawn - begun > 180)
PYTHON
