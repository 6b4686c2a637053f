#!/usr/bin/env bash
# The wheel works on nothing: pip install, a frame in Python and a shipped scenario in a bare Debian that has only python3-venv.
#
#   wheel_root.sh CHECKOUT SUITE TREE      on that release (bookworm, trixie); TREE: the built tree (build/release)
#
# A proof holds until something that the wheel depends on changes. Needs root, debootstrap, the mirrors in /etc/apt and PyPI.
# Runs only with DMISE_BARE_ROOT=1; else it exits 77 (skipped).
set -euo pipefail

checkout=$(readlink -f "$1") suite=$2 tree=$(readlink -f "$3")
most_mb=60

say() { printf '%s: %s\n' "$suite" "$*"; }
die() { say "$*" >&2; exit 1; }
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$tests/setup_proof.sh"
source "$tests/in_root.sh"

wheel_proof() {
  echo "$proofs/wheel-$suite-$(digest_of_files 'launch/package/.*|clients/(engine|python)/.*|tests/system/wheel_root.(sh|py)').proof"
}

# bare ROOT PACKAGE..: a bare Debian with these packages.
bare() {
  local root=$1
  shift
  mkdir -p "$root"
  tar -xz -C "$root" <"$base"
  "$checkout/launch/stack/apt-settings.sh" "$root" "$suite"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  mkdir -p "$root/proc" "$root/dev"
  in_root "$root" sh -c 'apt-get -q update && apt-get -q -y install --no-install-recommends "$@"' _ "$@" >"$root.apt" 2>&1 ||
    die "apt-get: $(tail -n 5 "$root.apt")"
  # ca-certificates, which came with them, knows the public ones alone.
  [[ ! -e /etc/ssl/certs/ca-certificates.crt ]] || cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
}

# The wheel of the system's Python, or, of a release with another, one that Python's stable ABI makes good for it.
make_wheel() {  # ROOT OUT
  if [[ $(. /etc/os-release && echo "$VERSION_CODENAME") == "$suite" ]]; then
    "$checkout/build/engine-venv/bin/python" "$checkout/launch/package/wheel.py" "$tree" "$2"
  else
    make_with_another_python "$@"
  fi
}

# The tree is changed only for this process: what is written lies above it.
make_with_another_python() {  # ROOT OUT
  local builder=$1.builder python=$1.builder/bin/python-of-root
  bare "$builder" python3-dev
  # Debian's interpreter with its own libraries, for CMake asks it where its headers are.
  printf '#!/bin/sh\nPYTHONHOME=%s exec %s --library-path %s %s "$@"\n' "$builder/usr" "$builder/usr/lib64/ld-linux-x86-64.so.2" \
    "$builder/usr/lib/x86_64-linux-gnu" "$(readlink -f "$builder/usr/bin/python3")" >"$python"
  chmod +x "$python"
  ln -s ../x86_64-linux-gnu "$(echo "$builder"/usr/include/python3.*[0-9])/x86_64-linux-gnu"  # where Debian's compiler looks by itself
  mkdir -p "$1".{above,work}/{release,python}
  unshare --mount bash -euc '
    checkout=$1 root=$2 python=$3 out=$4
    for part in release python; do
      mount -t overlay overlay -o "lowerdir=$checkout/build/$part,upperdir=$root.above/$part,workdir=$root.work/$part" \
        "$checkout/build/$part"
    done
    cd "$checkout"
    cmake --preset release -DDMISE_ENGINE_PYTHON="$python"
    ninja -C build/release dmise_engine
    build/engine-venv/bin/python launch/package/wheel.py build/release "$out"' _ "$checkout" "$1" "$python" "$2"
}

prove() {
  local work=$1 log=$2
  mkdir "$work.out"
  bare "$work" python3-venv
  say "making the wheel (log: $log)"
  make_wheel "$work" "$work.out" >"$log" 2>&1 || die "wheel: $(tail -n 5 "$log")"
  mkdir "$work/opt/wheel"
  cp "$work.out"/*.whl "$tests/wheel_root.py" "$work/opt/wheel/"
  in_root "$work" sh -c '! command -v cc && ! command -v gcc' >/dev/null || die "the root has a compiler"
  in_root "$work" env PIP_CERT=/etc/ssl/certs/ca-certificates.crt python3 /opt/wheel/wheel_root.py "$most_mb" >"$log" 2>&1 || die "$(tail -n 5 "$log")"
  sed "s/^/$suite: /" "$log"
}

[[ -f $checkout/build/engine-venv/packages.sha256 ]] || { say "skipped: auditwheel is not installed (./dmise setup --tests)"; exit 77; }
prove_in_bare_root "minutes" wheel_proof
