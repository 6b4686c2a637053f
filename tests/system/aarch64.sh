#!/usr/bin/env bash
# The program for AArch64: Debian's cross compiler compiles it, the unit tests of base, time, frames, orbit and detector pass under
# qemu-user, and its states and a run's products differ from this machine's by no more than docs/install.md states.
#
#   aarch64.sh CHECKOUT DMISE      of the committed tree (HEAD) of that checkout; DMISE: the program of this machine
#
# A proof holds until something changes that decides how another processor computes (`aarch64_proof`). It, a Debian with the libraries
# of AArch64 and what was compiled there are kept in ${XDG_CACHE_HOME:-~/.cache}/dmise. Takes a whole build, so it runs only with
# DMISE_AARCH64=1; else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1") dmise=$(readlink -f "$2")
inside=/opt/dmise  # where the tree lies in the root
unit_tests=(test_rng test_base test_time test_frames test_catalogue test_motion test_sgp4 test_detector)
# 1e5 turns with `long double` of 128 bits in software, and 1e8 draws: too long under an emulator.
left_out=TwoBody.EnergyAndMomentumHoldAfter1e5Turns:Poisson.IsDistributedAsPoissonOnBothSidesOfTheSwitchAndFarFromIt

say() { printf 'aarch64: %s\n' "$*"; }
die() { say "$*" >&2; exit 1; }
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$tests/setup_proof.sh"
source "$tests/in_root.sh"

# Kernels for each instruction set, and what the unit tests here test.
aarch64_proof() {
  local sources='core/(base|time|frames|orbit|detector)/.*|(core|sensors)/.*_kernels?\.(h|cpp)|tests/(base|time|frames|orbit|detector)/.*'
  echo "$proofs/aarch64-$(digest_of_files "$sources|tests/system/aarch64.*").proof"
}

# The libraries for AArch64, the rest for this machine; a package for all processors is this machine's.
packages() {
  grep -v '^#' "$checkout/launch/setup/aarch64-packages.txt"
  grep -e '-dev$' "$checkout/launch/setup/build-packages.txt" | while read -r package; do
    in_root "$root" apt-cache show "$package" </dev/null | grep -x 'Architecture: all' >/dev/null || package+=:arm64
    echo "$package"
  done
}

# A Debian with what a cross build needs, unless the one that is kept was made of the same lists.
make_root() {
  local lists
  lists=$(cat "$checkout"/launch/setup/{aarch64,build}-packages.txt | sha256sum)
  [[ ! -f $root/made-of || $(<"$root/made-of") != "$lists" ]] || return 0
  say "making a Debian with the libraries of AArch64 (log: $log)"
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  tar -xz -C "$root" <"$base"
  "$checkout/launch/stack/apt-settings.sh" "$root"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  mkdir -p "$root"/{proc,dev,sys} "$root$inside"
  in_root "$root" dpkg --add-architecture arm64
  in_root "$root" apt-get -q update >"$log" 2>&1 || die "apt-get update failed: $(tail -n 1 "$log")"
  packages >"$root/packages"
  in_root "$root" sh -c 'DEBIAN_FRONTEND=noninteractive xargs apt-get -q -y install --no-install-recommends <packages' \
    >>"$log" 2>&1 || die "apt-get failed: $(grep '^E:' "$log" | tail -n 1) (log: $log)"
  echo "$lists" >"$root/made-of"
}

here() { in_root "$root" env -C "$inside" "$@"; }
# emulated PROGRAM ARGUMENT..: with /sys, of which a test reads.
emulated() {
  here sh -euc 'mount -t sysfs none /sys; exec timeout 1200 qemu-aarch64 "build/aarch64/bin/$@"' _ "$@"
}

# The committed tree and its reference data, beside what was compiled of an earlier one.
place_tree() {
  find "$root$inside" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  committed archive HEAD | tar -x -C "$root$inside"
  mkdir -p "$root$inside/build/data"
  cp "$checkout"/build/data/{stars,satellites}.dat "$root$inside/build/data/"
  local data=${DMISE_DATA:-$checkout/../shared/data} shared=$root$inside/../shared
  mkdir -p "$shared"
  [[ ! -d $data ]] || cp -rT "$data" "$shared/data"
}

prove_in_kept_root() {
  local program
  root=$proofs/aarch64-root
  exec {lock}>"$proofs/aarch64.lock"
  flock "$lock"
  make_root
  place_tree
  say "compiling (log: $log)"
  { here cmake --preset aarch64 && here timeout 3000 ninja -C build/aarch64 programs "${unit_tests[@]}"; } >"$log" 2>&1 ||
    die "no build: $(grep -m 1 -E 'error|FAILED' "$log" || tail -n 1 "$log") (log: $log)"
  for program in "${unit_tests[@]}"; do
    emulated "$program" --gtest_brief=1 --gtest_filter="-$left_out" >"$log.$program" 2>&1 || die "$program failed: $(grep -m 3 'FAILED' "$log.$program")"
    say "$program: $(tail -n 1 "$log.$program")"
  done
  compare
}

# Runs the programs of both processors on the same input.
compare() {
  local out=$root$inside/out scenario=tests/system/products/scenario.yaml
  rm -rf "$out"
  mkdir -p "$out/here"
  "$dmise" catalogue synth --objects 20000 >"$out/catalogue.txt"
  "$dmise" catalogue states --at 2018-01-21T00:15:00Z "$out/catalogue.txt" >"$out/here/states.csv"
  "$dmise" run "$root$inside/$scenario" --out "$out/here/run" >"$out/here.log" 2>&1 || die "$(tail -n 1 "$out/here.log")"
  emulated dmise check "$scenario" >"$out/check.log" 2>&1 || die "dmise check: $(tail -n 1 "$out/check.log")"
  mkdir "$out/there"
  emulated dmise catalogue states --at 2018-01-21T00:15:00Z out/catalogue.txt >"$out/there/states.csv"
  emulated dmise run "$scenario" --out out/there/run >"$out/there.log" 2>&1 || die "$(tail -n 1 "$out/there.log")"
  /usr/bin/python3 "$tests/aarch64/compare.py" "$out/here" "$out/there"
}

[[ ${DMISE_AARCH64:-0} == 1 ]] || { say "skipped: set DMISE_AARCH64=1 to spend a build on it"; exit 77; }
((EUID == 0)) || die "needs root"
command -v debootstrap >/dev/null || die "needs debootstrap"
mkdir -p "$proofs"
proof=$(aarch64_proof)
if [[ -f $proof ]]; then
  say "proved before: $(<"$proof")"
  exit 0
fi
base=$("$checkout/launch/stack/base-system.sh")
log=${proof%.proof}.log
prove_in_kept_root
write_proof "$proof" "$SECONDS"
