#!/usr/bin/env bash
# needed.sh PROGRAM..: the packages of this release that hold the libraries which these programs and modules are linked to.
set -euo pipefail

linked=$(readelf -d "$@" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort -u)
loaded=$(ldd "$@")
{
  echo libosmesa6  # is loaded by name, for drawing without a graphics processor
  for library in $linked; do
    path=$(awk -v name="$library" '$1 == name && $3 ~ "^/" { path = $3 } END { print path }' <<<"$loaded")
    [[ -n $path ]] || continue  # the loader itself
    path=$(readlink -f "$path")
    dpkg-query -S "$path" 2>/dev/null || dpkg-query -S "${path#/usr}" 2>/dev/null ||
      { echo "needed.sh: $path is of no package" >&2; exit 1; }
  done
} | sed 's/:.*//' | sort -u
