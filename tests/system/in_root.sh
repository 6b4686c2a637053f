# Sourced by the tests that run commands in the root of a bare Debian.

# in_root ROOT COMMAND..: in namespaces of its own, so that no mount or process outlives it.
in_root() { in_namespaces '' "$@"; }
# The same without a network but loopback.
in_root_offline() { in_namespaces --net "$@"; }

in_namespaces() {
  unshare ${1:+"$1"} --mount --pid --fork --kill-child -- bash -euc '
    [[ $1 != --net ]] || ip link set lo up
    root=$2; shift 2
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    exec chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      HOME=/root LANG=C.UTF-8 http_proxy="${http_proxy-}" https_proxy="${https_proxy-}" "$@"' _ "$@"
}
