#!/usr/bin/env bash
# Puts KStars' Tycho-2, deepstars.dat, into a directory. What fails is said in one line.
#
#   fetch-tycho2.sh DIRECTORY [SOURCE]
#
# SOURCE is a URL or path of the file, or of an archive that holds it: Debian's kstars-data-extra-tycho2 (.deb, non-free) or
# fchart3's source (.tar.gz). Without one fchart3's source is taken from PyPI.
set -euo pipefail

lists=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
into=${1:?DIRECTORY is missing}
source=${2-}
name=deepstars.dat
die() { printf '%s\n' "$*" >&2; exit 1; }

work=$(mktemp -d "$into/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT

if [[ -z $source ]]; then
  source=$("${DMISE_PYTHON:-python3}" "$lists/fetch_source.py" "$lists/tycho2.txt" "$work" 2>"$work/log") ||
    die "cannot fetch fchart3 from PyPI: $(tail -n 1 "$work/log"); --from names a file or URL instead"
elif [[ $source == *://* ]]; then
  curl -fsSL --retry 2 --connect-timeout 30 -o "$work/${source##*/}" "$source" 2>"$work/log" ||
    die "cannot fetch $source: $(head -n 1 "$work/log")"
  source=$work/${source##*/}
fi
[[ -f $source ]] || die "$source: there is no such file"

case $source in
  *.deb) unpack=(dpkg-deb --fsys-tarfile "$source") ;;
  *.tar.gz | *.tgz) unpack=(gzip -dc "$source") ;;
  *) unpack=() ;;
esac
if ((${#unpack[@]})); then
  { "${unpack[@]}" | tar -xO --wildcards "*/$name" >"$work/$name"; } 2>"$work/log" || die "$source does not hold $name"
else
  cp "$source" "$work/$name"
fi
mv "$work/$name" "$into/$name"
