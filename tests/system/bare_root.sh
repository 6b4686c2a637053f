#!/usr/bin/env bash
# The set-up works on nothing: `./dmise demo` inside a bare Debian root made by debootstrap.
#
#   bare_root.sh CHECKOUT      proves the committed tree (HEAD) of that checkout
#
# A proof holds until something that the set-up depends on changes; it and the bare root are kept in
# ${XDG_CACHE_HOME:-~/.cache}/dmise. Needs root, debootstrap and the mirrors in /etc/apt. Takes a
# whole build, so it runs only with DMISE_BARE_ROOT=1; else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1")
suite=bookworm
cache=${XDG_CACHE_HOME:-$HOME/.cache}/dmise
inside=/opt/dmise  # where the tree lies in the root

say() { printf 'bare root: %s\n' "$*"; }
die() { say "$*" >&2; exit 1; }

committed() { git -c safe.directory='*' -C "$checkout" "$@"; }

# What the set-up depends on: scripts, lists, CMake, headers included from the system, scenario.
setup_digest() {
  {
    echo "$suite"
    committed ls-tree -r HEAD |
      grep -E $'\t(dmise|launch/(setup|scenarios)/.*|tests/system/bare_root.sh|cmake/.*|CMakePresets.json)$'
    committed ls-tree -r HEAD | grep -E $'\t(.*/)?CMakeLists.txt$' | grep -vE $'\t(tests|bench)/'
    committed grep -hoE '^ *# *include <[^>]+>' HEAD -- '*.h' '*.cpp' | sort -u
  } | sha256sum | cut -c 1-16
}

mirror() {
  apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
    awk -v suite="$suite" '$1 == suite { print $2; exit }'
}

make_base() {  # -> a tarball
  local work
  say "making a bare $suite with debootstrap from $(mirror)"
  work=$(mktemp -d "$cache/base.XXXXXX")
  chmod 755 "$work"
  debootstrap --variant=minbase "$suite" "$work" "$(mirror)" >"$cache/debootstrap.log" 2>&1 ||
    { rm -rf "$work"; die "debootstrap failed: $(tail -n 1 "$cache/debootstrap.log")"; }
  tar -c -C "$work" --exclude=./proc/* --exclude=./sys/* --exclude=./var/cache/apt/archives/*.deb . |
    gzip -1 >"$1.part"
  mv "$1.part" "$1"
  rm -rf "$work"
}

# The mirrors, keys and proxies of this machine, so that the root fetches from where we do.
copy_apt_settings() {
  local file
  rm -f "$1"/etc/apt/sources.list
  for file in sources.list sources.list.d trusted.gpg trusted.gpg.d keyrings auth.conf auth.conf.d; do
    [[ ! -e /etc/apt/$file ]] || cp -a "/etc/apt/$file" "$1/etc/apt/"
  done
  mkdir -p "$1/usr/share/keyrings" "$1/etc/ssl/certs"
  cp -a /usr/share/keyrings/. "$1/usr/share/keyrings/"
  apt-config dump | grep -E '^Acquire::(http|https|ftp)' >"$1/etc/apt/apt.conf.d/80host" || true
  cp /etc/resolv.conf /etc/hosts "$1/etc/"
  [[ ! -e /etc/ssl/certs/ca-certificates.crt ]] ||
    cp -L /etc/ssl/certs/ca-certificates.crt "$1/etc/ssl/certs/"
}

# in_root ROOT COMMAND..: in namespaces of its own, so that no mount or process outlives it.
in_root() {
  unshare --mount --pid --fork --kill-child -- bash -euc '
    root=$1; shift
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    exec chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      HOME=/root LANG=C.UTF-8 http_proxy="${http_proxy-}" https_proxy="${https_proxy-}" "$@"' _ "$@"
}

check_products() {
  local out=$1 sensors=0 report
  grep -q '"status":"complete"' "$out/run.json" || die "run.json does not say that the run is complete"
  for report in detections.jsonl truth.jsonl index.html; do
    [[ -s $out/$report ]] || die "the demonstration left no $report"
  done
  for report in "$out"/*/frame-000001.fits; do
    [[ -s $report && -s ${report%.fits}.png && -s ${report%.fits}-marked.png ]] ||
      die "the demonstration left an incomplete $(dirname "$report")"
    sensors=$((sensors + 1))
  done
  ((sensors == 4)) || die "frames of $sensors sensors, not of 4"
}

prove() {
  local work=$1 log=$2 began=$SECONDS
  tar -xz -C "$work" <"$base"
  copy_apt_settings "$work"
  mkdir -p "$work$inside"
  committed archive HEAD | tar -x -C "$work$inside"

  # A user without sudo is told so in one line, and nothing is installed.
  in_root "$work" setpriv --reuid 65534 --clear-groups "$inside/dmise" demo >"$log" 2>&1 &&
    die "the demonstration ran without its packages"
  [[ $(wc -l <"$log") == 1 && $(cat "$log") == *'need root to install'*'there is no sudo'* ]] ||
    die "without root and sudo it should say so in one line, but said: $(cat "$log")"

  say "running ./dmise demo (log: $log)"
  in_root "$work" "$inside/dmise" demo >"$log" 2>&1 ||
    die "./dmise demo failed: $(tail -n 20 "$log" "$work$inside/build/setup.log")"
  check_products "$work$inside/out/demo"
  say "demonstration done after $((SECONDS - began)) s"

  in_root "$work" "$inside/dmise" demo >"$log.again" 2>&1 || die "again failed: $(tail -n 1 "$log.again")"
  grep -q 'holds this run, complete' "$log.again" || die "a second ./dmise demo did the work again"
}

[[ ${DMISE_BARE_ROOT:-0} == 1 ]] || { say "skipped: set DMISE_BARE_ROOT=1 to spend a build on it"; exit 77; }
((EUID == 0)) || die "needs root"
command -v debootstrap >/dev/null || die "needs debootstrap"
mkdir -p "$cache"

proof=$cache/bare-root-$(setup_digest).proof
if [[ -f $proof ]]; then
  say "proved before: $(cat "$proof")"
  exit 0
fi
base=$cache/$suite-minbase.tar.gz
[[ -f $base ]] || make_base "$base"
work=$(mktemp -d "$cache/root.XXXXXX")
trap 'rm -rf --one-file-system "$work"' EXIT
prove "$work" "${proof%.proof}.log"
echo "$(date -u +%FT%TZ), commit $(committed rev-parse --short HEAD), $SECONDS s" >"$proof"
say "proved: $(cat "$proof")"
