#!/usr/bin/env bash
# apt-settings.sh ROOT [SUITE]: the mirrors, keys and proxies of this machine into the Debian system below ROOT, so that it
# fetches its packages from where this machine does. SUITE: its release, by default this machine's; of another release it gets
# Debian's own packages.
set -euo pipefail

root=$1 here=$(. /etc/os-release && echo "$VERSION_CODENAME")
suite=${2:-$here}
rm -f "$root/etc/apt/sources.list"
for file in sources.list sources.list.d trusted.gpg trusted.gpg.d keyrings auth.conf auth.conf.d; do
  [[ ! -e /etc/apt/$file ]] || cp -a "/etc/apt/$file" "$root/etc/apt/"
done
if [[ $suite != "$here" ]]; then
  rm -rf "$root"/etc/apt/sources.list{,.d}
  apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
    sed -n "s,^\\([^ ]*\\) $here,deb \\1 $suite,p" >"$root/etc/apt/sources.list"
fi
mkdir -p "$root/usr/share/keyrings" "$root/etc/ssl/certs"
cp -a /usr/share/keyrings/. "$root/usr/share/keyrings/"
apt-config dump | grep -E '^Acquire::(http|https|ftp)' >"$root/etc/apt/apt.conf.d/80host" || true
[[ ! -e /etc/ssl/certs/ca-certificates.crt ]] ||
  cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
