#!/usr/bin/env bash
# The package on a bare Debian made by debootstrap: `apt install` puts it there, `dmise demo` runs without a network, `man dmise`
# has a page, and `apt purge` leaves nothing.
#
#   debian.sh CHECKOUT BUILD     BUILD: a build tree of the checkout with all programs
#
# The bare root is that of bare_root.sh and stack.sh. A proof holds until something that decides what is installed changes. Needs
# root, debootstrap and the mirrors in /etc/apt; runs only with DMISE_BARE_ROOT=1, else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1") build=$(readlink -f "$2")

say() { printf 'package: %s\n' "$*"; }
die() { say "$*" >&2; exit 1; }
source "$checkout/tests/system/setup_proof.sh"
source "$checkout/tests/system/in_root.sh"

# What lies in a root but for what runs and caches leave.
paths() { (cd "$1" && find usr etc opt srv root home -xdev | sort); }

prove() {
  local work=$1 log=$2 began=$SECONDS page
  (cd "$build" && cpack -G DEB) >"$log" 2>&1 || die "cpack: $(tail -n 5 "$log")"
  tar -xz -C "$work" <"$base"
  rm -f "$work/etc/dpkg/dpkg.cfg.d/slim"  # which leaves out manuals
  "$checkout/launch/stack/apt-settings.sh" "$work"
  cp /etc/resolv.conf /etc/hosts "$work/etc/"
  mkdir -p "$work/proc" "$work/dev"
  cp "$build"/package/dmise_*.deb "$work/var/tmp/"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends)
  in_root "$work" sh -c 'apt-get -q update && exec "$@"' _ "${apt[@]}" install man-db >>"$log" 2>&1 ||
    die "apt-get: $(tail -n 5 "$log")"
  paths "$work" >"$work.before"
  in_root "$work" sh -c 'exec "$@" /var/tmp/dmise_*.deb' _ "${apt[@]}" install >>"$log" 2>&1 ||
    die "apt install: $(tail -n 5 "$log")"
  say "ok: apt install, after $((SECONDS - began)) s: $(du -k "$work"/var/tmp/dmise_*.deb | cut -f 1) KB"
  in_root "$work" sh -c '! ldd /usr/bin/dmise* /usr/lib/dmise/*.so | grep "not found"' || die "a library is missing"
  page=$(in_root "$work" sh -c 'man dmise | cat; man dmise-run | cat')
  [[ $page == *SYNOPSIS*'dmise-run'*--threads* ]] || die "man dmise: $page"
  say "ok: man dmise, man dmise-run"
  sed -i 's/duration_s: 120/duration_s: 30/' "$work/usr/share/dmise/launch/scenarios/demo.yaml"  # for time's sake
  in_root_offline "$work" sh -c 'cd /var/tmp && exec dmise demo' >"$log.demo" 2>&1 || die "dmise demo: $(tail -n 5 "$log.demo")"
  check_demonstration "$work/var/tmp/out/demo"
  say "ok: dmise demo without a network, after $((SECONDS - began)) s"
  in_root "$work" "${apt[@]}" purge --autoremove dmise >>"$log" 2>&1 || die "apt purge: $(tail -n 5 "$log")"
  paths "$work" >"$work.after"
  diff "$work.before" "$work.after" | grep '^>' | grep -vE '/__pycache__|^> etc/ld.so.cache|^> root/\.cache' >"$work.left" || true
  [[ ! -s $work.left ]] || die "apt purge left: $(head -n 20 "$work.left")"
  say "ok: apt purge leaves nothing"
}

package_proof() {
  echo "$proofs/package-$(digest_of_files 'launch/(package|stack|models|materials|cameras|sites)/.*|tests/package/.*|core/base/module.cpp|core/config/yaml/search_path.cpp').proof"
}

prove_in_bare_root "two minutes" package_proof
