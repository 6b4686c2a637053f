# Sourced by the tests that run commands in the root of a bare Debian.

# in_root ROOT COMMAND..: in namespaces of its own, so that no mount or process outlives it.
in_root() { in_namespaces '' "$@"; }
# The same without a network but loopback.
in_root_offline() { in_namespaces --net "$@"; }

kept=  # a directory of this machine that the root has as /var/cache/ccache

in_namespaces() {
  local net=$1 root=$2
  shift 2
  unshare ${net:+"$net"} --mount --pid --fork --kill-child -- bash -euc '
    [[ $1 != --net ]] || ip link set lo up
    root=$2 kept=$3; shift 3
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    [[ -z $kept ]] || mount --bind "$kept" "$root/var/cache/ccache"
    exec chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      HOME=/root CCACHE_DIR=/var/cache/ccache LANG=C.UTF-8 http_proxy="${http_proxy-}" https_proxy="${https_proxy-}" "$@"' _ "$net" "$root" "$kept" "$@"
}

# prove_in_bare_root COST PROOF: `prove ROOT LOG` in a bare Debian, unless the proof that the function PROOF names is
# there. Uses `checkout`, `say`, `die`, `suite` if it is set and setup_proof.sh; sets `base`, its archive.
prove_in_bare_root() {
  [[ ${DMISE_BARE_ROOT:-0} == 1 ]] || { say "skipped: set DMISE_BARE_ROOT=1 to spend $1 on it"; exit 77; }
  [[ -z ${suite-} || " ${DMISE_BARE_RELEASES-$suite} " == *" $suite "* ]] || { say "skipped: not among DMISE_BARE_RELEASES"; exit 77; }
  ((EUID == 0)) || die "needs root"
  command -v debootstrap >/dev/null || die "needs debootstrap"
  mkdir -p "$proofs"
  local proof
  proof=$("$2")
  if [[ -f $proof ]]; then
    say "proved before: $(cat "$proof")"
    exit 0
  fi
  base=$("$checkout/launch/stack/base-system.sh" ${suite-})
  work=$(mktemp -d "$proofs/root.XXXXXX")
  trap 'rm -rf --one-file-system "$work" "$work".*' EXIT
  prove "$work" "${proof%.proof}.log"
  write_proof "$proof" "$SECONDS"
}
