#!/usr/bin/env bash
# One process, one process per node, nodes behind agents, one thread or two, once or again, objects propagated by the sensors or by
# the orbit node: the products are the same bytes.
#
#   run_identity.sh DMISE SCENARIO DURATION_S
#
# Runs the scenario, cut to DURATION_S of simulated time, and compares every FITS and EXR file, positions,
# detections.jsonl, truth.jsonl and frames.jsonl with cmp. What is published is also what
# `dmise detect` finds in the FITS file alone.
set -euo pipefail

dmise=$1
work=$(mktemp -d -t dmise-test-XXXXXX)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAIL: $*" >&2; exit 1; }

scenario=$work/scenario.yaml
cp -r "$(dirname "$(readlink -f "$2")")/." "$work/"  # it may name files beside itself
sed -E "s/duration_s: *[0-9.]+/duration_s: $3/" "$2" >"$scenario"

taking=$work/taking-states.yaml  # sensors take published states instead of propagating objects
if grep -q '^network: {' "$scenario"; then
  sed 's/^network: {/network: {sensors_propagate: off, /' "$scenario" >"$taking"
else
  { cat "$scenario"; echo 'network: {sensors_propagate: off}'; } >"$taking"
fi

produce() {  # NAME COMMAND..
  local name=$1 scenario=$scenario
  shift
  [[ $name != *-taking-states ]] || scenario=$taking
  # Processes of a network must hear each other within seconds: at idle priority they may not.
  local at=()
  [[ $1 != launch ]] || at=(chrt --other 0)
  "${at[@]}" "$dmise" "$@" "$scenario" --out "$work/$name" >"$work/$name.log" 2>&1 ||
    fail "$name: $(tail -n 2 "$work/$name.log")"
}

products() { (cd "$1" && find . -name 'frame-*.fits' -o -name '*.exr' -o -name '*.oem' -o -name '*.csv' -o -name '*.jsonl' ! -name cost.jsonl | sort); }

produce run-1-thread run --threads 1
produce run-2-threads run --threads 2
produce launch launch
produce launch-again launch
produce launch-hosts launch --hosts 2
produce run-taking-states run
produce launch-taking-states launch

reference=$work/run-1-thread
frames=$(products "$reference" | grep -cE 'frame-[0-9]+.fits$') || fail "no frame was made"
for other in run-2-threads launch launch-again launch-hosts run-taking-states launch-taking-states; do
  diff <(products "$reference") <(products "$work/$other") || fail "$other: other files than one process made"
  while read -r file; do
    cmp "$reference/$file" "$work/$other/$file" || fail "$other: $file differs"
  done < <(products "$reference")
  echo "ok: $other: $frames frames and all lines are those of one process with one thread"
done

for frame in "$reference"/*/frame-000001.fits; do
  sensor=$(basename "$(dirname "$frame")")
  "$dmise" detect "$frame" >"$work/detected.jsonl"
  grep "\"sensor\":\"$sensor\",\"frame\":1," "$reference/detections.jsonl" >"$work/published.jsonl" || true
  cmp "$work/detected.jsonl" "$work/published.jsonl" || fail "$sensor: dmise detect finds other detections"
  echo "ok: $sensor: dmise detect finds the $(wc -l <"$work/published.jsonl") published detections"
done
