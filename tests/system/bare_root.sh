#!/usr/bin/env bash
# The set-up works on nothing: `./dmise demo` inside a bare Debian root made by debootstrap.
#
#   bare_root.sh CHECKOUT SUITE      proves the committed tree (HEAD) of that checkout on that release: bookworm, trixie
#
# stack.sh proves the same of bookworm on its way to an image. A proof holds until something that the set-up depends on
# changes; it, the bare root and what a compiler cache keeps are in ${XDG_CACHE_HOME:-~/.cache}/dmise. Needs root, debootstrap
# and the mirrors in /etc/apt. Takes a build, so it runs only with DMISE_BARE_ROOT=1; else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1") suite=$2
inside=/opt/dmise  # where the tree lies in the root

say() { printf '%s: %s\n' "$suite" "$*"; }
die() { say "$*" >&2; exit 1; }
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$tests/setup_proof.sh"
source "$tests/in_root.sh"

# Lets the root compile with the kept cache: set-up, CMake and the linker do all their work, but nothing is compiled twice.
keep_compiled_in() {
  kept=$proofs/ccache-$suite
  mkdir -p "$kept" "$1/var/cache/ccache"
  in_root "$1" sh -c 'apt-get -q update && apt-get -q -y install --no-install-recommends ccache' >"$1.ccache" 2>&1 ||
    die "apt-get: $(tail -n 5 "$1.ccache")"
}

prove() {
  local work=$1 log=$2 began=$SECONDS
  tar -xz -C "$work" <"$base"
  "$checkout/launch/stack/apt-settings.sh" "$work" "$suite"
  cp /etc/resolv.conf /etc/hosts "$work/etc/"
  mkdir -p "$work$inside" "$work/proc" "$work/dev"
  committed archive HEAD | tar -x -C "$work$inside"

  in_root "$work" setpriv --reuid 65534 --clear-groups "$inside/dmise" demo >"$log" 2>&1 &&
    die "the demonstration ran without its packages"
  check_refusal "$log"

  keep_compiled_in "$work"
  say "running ./dmise demo (log: $log)"
  in_root "$work" "$inside/dmise" demo >"$log" 2>&1 ||
    die "./dmise demo failed: $(tail -n 20 "$log" "$work$inside/build/setup.log")"
  check_demonstration "$work$inside/out/demo"
  say "demonstration done after $((SECONDS - began)) s"

  in_root "$work" "$inside/dmise" demo >"$log.again" 2>&1 || die "again failed: $(tail -n 1 "$log.again")"
  grep -q 'contains this run, complete' "$log.again" || die "a second ./dmise demo did the work again"
}

prove_in_bare_root "a build" setup_proof
