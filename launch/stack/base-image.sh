#!/usr/bin/env bash
# A base for the Dockerfile where no image registry can be reached: a bare Debian made by debootstrap,
# with this machine's apt settings.
#
#   base-image.sh [IMAGE]      makes IMAGE, dmise-base:bookworm by default
#
# Then: docker build --build-arg BASE=dmise-base:bookworm ... Needs root, debootstrap and a docker that
# answers.
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
image=${1:-dmise-base:bookworm}

tarball=$("$here/base-system.sh" bookworm)
root=$(mktemp -d -t dmise-base-XXXXXX)
trap 'rm -rf --one-file-system "$root"' EXIT
tar -xz -C "$root" <"$tarball"
"$here/apt-settings.sh" "$root" bookworm
tar -c -C "$root" . | docker import --change 'CMD ["bash"]' - "$image" >/dev/null
echo "base image: made $image"
