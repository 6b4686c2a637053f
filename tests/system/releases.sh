#!/usr/bin/env bash
# The set-up calls packages as each release does, and on a system that it does not know says in one line what is missing.
#
#   releases.sh CHECKOUT
set -euo pipefail
unset DMISE_NO_SETUP

checkout=$(readlink -f "$1") lists=$(readlink -f "$1")/launch/setup
work=$(mktemp -d -t dmise-releases-XXXXXX)
trap 'rm -rf "$work"' EXIT
say() { printf '%s\n' "$*"; }
die() { say "FAIL: $*" >&2; exit 1; }
source "$lists/install.sh"
os_release=$work/os-release

# check WHAT GOT WANTED
check() { [[ $2 == $3 ]] || die "$1: $2"; say "ok: $1"; }

is() { printf 'ID=%s\n%s\n' "$1" "${2:+VERSION_ID=\"$2\"}" >"$os_release"; }

# The lists have the names of Debian 12.
is debian 12
check "Debian 12 has the names of the lists" "$(packages_in "$lists"/{build,test,stack}-packages.txt)" "$(names_in "$lists"/{build,test,stack}-packages.txt)"
for release in 'debian 13 19' 'ubuntu 24.04 18'; do
  read -r id version clang <<<"$release"
  is "$id" "$version"
  check "$id $version has clang $clang" "$(packages_in "$lists/test-packages.txt" | grep libclang-rt)" "libclang-rt-$clang-dev"
done

# Another system, which has all commands but ninja, and all headers but one.
is arch
mkdir "$work/bin"
for command in awk sed grep cmake c++ pkg-config protoc; do ln -s "$(command -v "$command")" "$work/bin/"; done
{ cat "$lists/build-packages.txt"; echo "libnothing-dev nothing/here.h"; } >"$work/list"
refused=$(PATH=$work/bin; install_packages "$work/list" 2>&1) && die "an unknown system is taken for a known one"
check "an unknown system gets one line: $refused" "$(wc -l <<<"$refused")" 1
check "which names the releases and what is missing" "$refused" \
  '*arch-rolling: the set-up knows debian-12, debian-13, ubuntu-24.04; missing here, as Debian calls it: ninja-build libnothing-dev (*DMISE_NO_SETUP=1*'
DMISE_NO_SETUP=1 install_packages "$work/list"
say "ok: DMISE_NO_SETUP=1 goes on"
