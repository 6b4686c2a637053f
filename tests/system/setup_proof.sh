# Sourced by the tests that prove the set-up on a bare Debian. Uses `checkout`, `die`.

proofs=${XDG_CACHE_HOME:-$HOME/.cache}/dmise

committed() { git -c safe.directory='*' -C "$checkout" "$@"; }

# digest_of_files PATTERN: what is committed under these paths, and what decides a set-up: scripts,
# lists, CMake, headers included from the system, scenarios.
digest_of_files() {
  {
    committed ls-tree -r HEAD | grep -E $'\t('"$1"')$' || true
    committed ls-tree -r HEAD |
      grep -E $'\t(dmise|launch/(setup|scenarios)/.*|launch/stack/(base-system|apt-settings).sh|tests/system/(bare_root|in_root|setup_proof).sh|cmake/.*|CMakePresets.json)$'
    committed ls-tree -r HEAD | grep -E $'\t(.*/)?CMakeLists.txt$' | grep -vE $'\t(tests|bench)/'
    committed grep -hoE '^ *# *include <[^>]+>' HEAD -- '*.h' '*.cpp' | sort -u
  } | sha256sum | cut -c 1-16
}

setup_proof() { echo "$proofs/${suite-bookworm}-$(digest_of_files nothing).proof"; }

# write_proof FILE SECONDS
write_proof() {
  echo "$(date -u +%FT%TZ), commit $(committed rev-parse --short HEAD), $2 s" >"$1"
  say "proved: $(cat "$1")"
}

# check_refusal LOG: what ./dmise says to a user who can't install its packages.
check_refusal() {
  [[ $(wc -l <"$1") == 1 && $(cat "$1") == *'need root to install'*'there is no sudo'* ]] ||
    die "without root and sudo it should say so in one line, but said: $(cat "$1")"
}

# check_demonstration OUT: its products are whole.
check_demonstration() {
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
