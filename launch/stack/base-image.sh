#!/usr/bin/env bash
# A base for the Dockerfile where no image registry can be reached: Debian's minimal system, made by
# debootstrap from the mirror in /etc/apt, without its manuals.
#
#   base-image.sh [IMAGE]      makes IMAGE, dmise-base:bookworm by default, unless it is there
#
# Then: docker build --build-arg BASE=dmise-base:bookworm ... Needs root, debootstrap and a docker that
# answers. The tarball is kept in ${XDG_CACHE_HOME:-~/.cache}/dmise.
set -euo pipefail

image=${1:-dmise-base:bookworm}
suite=bookworm
cache=${XDG_CACHE_HOME:-$HOME/.cache}/dmise
tarball=$cache/$suite-slim.tar.gz

say() { printf 'base image: %s\n' "$*"; }
die() { say "$*" >&2; exit 1; }

mirror() {
  apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
    awk -v suite="$suite" '$1 == suite { print $2; exit }'
}

bootstrap() {
  ((EUID == 0)) || die "debootstrap needs root"
  local system
  mkdir -p "$cache"
  work=$(mktemp -d "$cache/slim.XXXXXX")
  trap 'rm -rf --one-file-system "$work"' EXIT
  system=$work/system
  say "making a bare $suite with debootstrap from $(mirror)"
  debootstrap --variant=minbase "$suite" "$system" "$(mirror)" >"$work/log" 2>&1 ||
    die "debootstrap failed: $(tail -n 1 "$work/log")"
  # What an image needs not, now and when packages come: manuals and translations; licences stay.
  printf 'path-exclude /usr/share/%s\n' 'man/*' 'info/*' 'locale/*' 'doc/*' \
    >"$system/etc/dpkg/dpkg.cfg.d/slim"
  echo 'path-include /usr/share/doc/*/copyright' >>"$system/etc/dpkg/dpkg.cfg.d/slim"
  rm -rf "$system"/usr/share/{man,info,locale}/* "$system"/var/lib/apt/lists/*
  find "$system/usr/share/doc" -type f ! -name copyright -delete
  echo 'APT::Keep-Downloaded-Packages "false";' >"$system/etc/apt/apt.conf.d/80keep-nothing"
  tar -c -C "$system" --exclude=./proc/* --exclude=./sys/* --exclude=./dev/* \
    --exclude=./var/cache/apt/*.bin --exclude=./var/cache/apt/archives/*.deb . |
    gzip -1 >"$work/tarball"
  mv "$work/tarball" "$tarball"
}

! docker image inspect "$image" >/dev/null 2>&1 || { say "$image is there"; exit 0; }
[[ -f $tarball ]] || bootstrap
docker import --change 'CMD ["bash"]' "$tarball" "$image" >/dev/null
say "made $image"
