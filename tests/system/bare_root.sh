#!/usr/bin/env bash
# The set-up works on nothing: `./dmise demo` inside a bare Debian root made by debootstrap.
#
#   bare_root.sh CHECKOUT      proves the committed tree (HEAD) of that checkout
#
# stack.sh proves the same on its way to an image; this is for machines where no container can run. A
# proof holds until something that the set-up depends on changes; it and the bare root are kept in
# ${XDG_CACHE_HOME:-~/.cache}/dmise. Needs root, debootstrap and the mirrors in /etc/apt. Takes a
# whole build, so it runs only with DMISE_BARE_ROOT=1; else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1")
inside=/opt/dmise  # where the tree lies in the root

say() { printf 'bare root: %s\n' "$*"; }
die() { say "$*" >&2; exit 1; }
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$tests/setup_proof.sh"
source "$tests/in_root.sh"

prove() {
  local work=$1 log=$2 began=$SECONDS
  tar -xz -C "$work" <"$base"
  "$checkout/launch/stack/apt-settings.sh" "$work"
  cp /etc/resolv.conf /etc/hosts "$work/etc/"
  mkdir -p "$work$inside" "$work/proc" "$work/dev"
  committed archive HEAD | tar -x -C "$work$inside"

  in_root "$work" setpriv --reuid 65534 --clear-groups "$inside/dmise" demo >"$log" 2>&1 &&
    die "the demonstration ran without its packages"
  check_refusal "$log"

  say "running ./dmise demo (log: $log)"
  in_root "$work" "$inside/dmise" demo >"$log" 2>&1 ||
    die "./dmise demo failed: $(tail -n 20 "$log" "$work$inside/build/setup.log")"
  check_demonstration "$work$inside/out/demo"
  say "demonstration done after $((SECONDS - began)) s"

  in_root "$work" "$inside/dmise" demo >"$log.again" 2>&1 || die "again failed: $(tail -n 1 "$log.again")"
  grep -q 'contains this run, complete' "$log.again" || die "a second ./dmise demo did the work again"
}

prove_in_bare_root "a build" setup_proof
