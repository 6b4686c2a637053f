#!/usr/bin/env bash
# Looks at every state of a model of the lock-step protocol with spin; then plants faults, each of
# which the checks must find.
#
#   check_model.sh lockstep.pml FAULT..
set -euo pipefail

model=$(readlink -f "$1")
shift
command -v spin >/dev/null || { echo "spin is not installed"; [[ -n ${DMISE_DATA-} ]] && exit 1 || exit 77; }
work=$(mktemp -d -t dmise-test-XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAIL: $*" >&2; exit 1; }

verifier() {  # NAME SPIN_FLAGS C_FLAGS..
  spin -a $2 "$model" >spin.log 2>&1 || { cat spin.log; fail "spin does not take the model"; }
  cc -O1 -w "${@:3}" -o "$1" pan.c
}

states() { sed -nE 's/ *([0-9.e+]+) states, stored.*/\1/p' "$1"; }

verifier safety "" -DSAFETY -DNOCLAIM
./safety -m100000 >safety.log
grep -q 'errors: 0' safety.log || { cat safety.log; fail "a state that must not be"; }
echo "ok: $(states safety.log) states: no deadlock, no tick lost, none done twice"

verifier liveness "" -DNFAIR=4
./liveness -a -f -m100000 >liveness.log
grep -q 'errors: 0' liveness.log || { cat liveness.log; fail "a run that does not end"; }
echo "ok: every run ends"

for fault in "$@"; do
  verifier "$fault" "-DFAULT=$fault" -DSAFETY -DNOCLAIM
  "./$fault" -m100000 >fault.log
  ! grep -q 'errors: 0' fault.log || fail "the planted fault '$fault' is not found"
  echo "ok: '$fault' is found: $(grep -m 1 -oE 'assertion violated|invalid end state' fault.log)"
done
