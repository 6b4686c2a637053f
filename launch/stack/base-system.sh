#!/usr/bin/env bash
# base-system.sh [SUITE]: a bare Debian, by default of this machine's release, as a tarball: what debootstrap calls minimal,
# from the mirror in /etc/apt, without manuals. Prints its path; it is kept in ${XDG_CACHE_HOME:-~/.cache}/dmise. Needs root
# and debootstrap.
set -euo pipefail

here=$(. /etc/os-release && echo "$VERSION_CODENAME") suite=${1:-}
suite=${suite:-$here}
cache=${XDG_CACHE_HOME:-$HOME/.cache}/dmise
tarball=$cache/$suite-system.tar.gz

die() { printf 'base system: %s\n' "$*" >&2; exit 1; }

mirror() {
  apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
    awk -v suite="$here" '$1 == suite { print $2; exit }'
}

# What a bare system needs not, now and when packages come: manuals and translations; licences stay.
leave_out_manuals() {
  printf 'path-exclude /usr/share/%s\n' 'man/*' 'info/*' 'locale/*' 'doc/*' \
    >"$1/etc/dpkg/dpkg.cfg.d/slim"
  echo 'path-include /usr/share/doc/*/copyright' >>"$1/etc/dpkg/dpkg.cfg.d/slim"
  echo 'APT::Keep-Downloaded-Packages "false";' >"$1/etc/apt/apt.conf.d/80keep-nothing"
  rm -rf "$1"/usr/share/{man,info,locale}/* "$1"/var/lib/apt/lists/*
  find "$1/usr/share/doc" -type f ! -name copyright -delete
}

[[ ! -f $tarball ]] || { echo "$tarball"; exit 0; }
((EUID == 0)) || die "debootstrap needs root"
command -v debootstrap >/dev/null || die "needs debootstrap"
mkdir -p "$cache"
work=$(mktemp -d "$cache/system.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT
debootstrap --variant=minbase "$suite" "$work/root" "$(mirror)" >"$cache/debootstrap.log" 2>&1 ||
  die "debootstrap failed: $(tail -n 1 "$cache/debootstrap.log") (log: $cache/debootstrap.log)"
leave_out_manuals "$work/root"
tar -c -C "$work/root" --exclude=./proc/* --exclude=./sys/* --exclude=./dev/* \
  --exclude=./var/cache/apt/*.bin --exclude=./var/cache/apt/archives/*.deb . |
  gzip -1 >"$work/tarball"
mv "$work/tarball" "$tarball"
echo "$tarball"
