#!/usr/bin/env bash
# try_archive.sh ARCHIVE: unpacks it into an otherwise empty root that holds only a C library and one Vulkan driver
# (Mesa's lavapipe, with the libraries that it needs), changes into that root, and renders a picture there.
set -euo pipefail
archive=$1
driver_manifest=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT

add() { # a file, with the libraries that it is linked with
    local file
    for file in "$1" $(ldd "$1" | grep -o '/[^ ]*'); do
        mkdir -p "$root$(dirname "$file")"
        cp -L "$file" "$root$file"
    done
}

mkdir -p "$root/dev" "$root/proc" "$root/tmp" "$root/app"
tar -C "$root/app" --strip-components=1 -xzf "$archive"

# The C library alone, found through a program that needs nothing else; `env` also sets the driver for chroot.
add /usr/bin/env
mkdir -p "$root/lib64" "$root/usr/share/vulkan/icd.d"
for library in libm.so.6 libdl.so.2 libpthread.so.0 librt.so.1; do
    cp -L "/lib/x86_64-linux-gnu/$library" "$root/lib/x86_64-linux-gnu/"
done

# The driver lives in a folder of its own, so that the program cannot borrow its libraries.
driver=$(grep -o '"library_path": *"[^"]*"' "$driver_manifest" | cut -d'"' -f4)
mkdir -p "$root/driver"
cp -L "$driver" "$root/driver/"
ldd "$driver" | awk '$2 == "=>" {print $3}' | while read -r library; do cp -L "$library" "$root/driver/"; done
sed "s|$driver|/driver/$(basename "$driver")|" "$driver_manifest" >"$root/usr/share/vulkan/icd.d/lvp_icd.json"

# A namespace of its own for /proc, which the dynamic linker asks where the program lies.
namespaces=(--mount --pid --fork)
[ "$(id -u)" = 0 ] || namespaces+=(--user --map-root-user)
unshare "${namespaces[@]}" true 2>/dev/null ||
    { echo "try_archive: NOT TRIED in an empty root: this machine allows no namespaces (unshare)." >&2; exit 0; }
inside() {
    unshare "${namespaces[@]}" sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" "$@"
}

missing=$(inside /lib64/ld-linux-x86-64.so.2 --list /app/trichrome | grep 'not found' || true)
[ -z "$missing" ] || { echo "try_archive: libraries are missing from the archive: $missing" >&2; exit 1; }
borrowed=$(inside /lib64/ld-linux-x86-64.so.2 --list /app/trichrome | awk '$2 == "=>" {print $3}' |
    grep -v -e '^/app/lib/' -e '^/lib/x86_64-linux-gnu/' || true)
[ -z "$borrowed" ] || { echo "try_archive: libraries come from elsewhere: $borrowed" >&2; exit 1; }
inside /usr/bin/env -i LD_LIBRARY_PATH=/driver HOME=/tmp /app/trichrome \
    render cornell -o /tmp/cornell.exr --size 64x36 --frames 4 --device llvmpipe --quiet
[ -s "$root/tmp/cornell.exr" ]
echo "Tried in an empty root with the C library and lavapipe alone: it renders."
