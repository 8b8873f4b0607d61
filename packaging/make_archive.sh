#!/usr/bin/env bash
# make_archive.sh EXECUTABLE DIRECTORY: DIRECTORY/trichrome-VERSION-linux-x86_64.tar.gz with the executable, the
# libraries that it needs except the C library, and their licences; then tries it in an empty root.
set -euo pipefail
executable=$1
directory=$2
here=$(cd "$(dirname "$0")" && pwd)

# The C library: of the machine that it will run on, like the driver.
C_LIBRARY='^(linux-vdso|ld-linux-x86-64|libc|libm|libdl|libpthread|librt|libresolv)\.so'

# What the executable contains of headers and static libraries.
INSIDE="glslang-dev spirv-tools libcli11-dev libkainjow-mustache-dev nlohmann-json3-dev libtinygltf-dev libstb-dev libglm-dev
    libboost-math-dev"

add_license() { cp -L "/usr/share/doc/$1/copyright" "$root/licenses/$1.txt"; }

name=trichrome-$("$executable" --version)-linux-$(uname -m)
root=$directory/$name
rm -rf "$directory"
mkdir -p "$root/lib" "$root/licenses"

cp "$executable" "$root/trichrome"
strip "$root/trichrome"
cp "$here/../LICENSE" "$root/licenses/trichrome.txt"
ldd "$executable" | awk '$2 == "=>" {print $1, $3}' | while read -r library path; do
    [[ $library =~ $C_LIBRARY ]] && continue
    cp -L "$path" "$root/lib/$library"
    package=$(dpkg-query -S "*linux-gnu/$(basename "$(readlink -f "$path")")" | head -1 | cut -d: -f1)
    add_license "$package"
done
for package in $INSIDE; do add_license "$package"; done
cat >"$root/README.txt" <<TEXT
Trichrome renders glTF scenes on any Vulkan device. Needs Linux x86-64, glibc $(
    objdump -T "$root/trichrome" "$root"/lib/* | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1 | cut -d_ -f2
) or newer, and a Vulkan driver.

    ./trichrome info
    ./trichrome render hall -o hall.png
    ./trichrome --help

The licences of everything in here are in licenses/.
TEXT
tar -C "$directory" -czf "$directory/$name.tar.gz" "$name"
echo "The archive: $directory/$name.tar.gz ($(du -h "$directory/$name.tar.gz" | cut -f1))"
"$here/try_archive.sh" "$directory/$name.tar.gz"
