#!/usr/bin/env bash
# manuals.sh BIN OUT: manual pages, completions and JSON Schemas, printed by the programs in BIN, below OUT as they are installed
# below share.
set -euo pipefail

bin=$1 out=$2
pages=$out/man/man1
rm -rf "$out/man" "$out/bash-completion" "$out/zsh" "$out/dmise"
mkdir -p "$pages" "$out/dmise/schema" "$out/bash-completion/completions" "$out/zsh/vendor-completions"

page() {  # NAME COMMAND..
  "${@:2}" | gzip -9n >"$pages/$1.1.gz"
}

page dmise "$bin/dmise" man
for command in $("$bin/dmise" man --list); do
  page "dmise-$command" "$bin/dmise" man "$command"
done
for program in "$bin"/dmise-*; do
  name=${program##*/}
  [[ $name == dmise-bench || ! -x $program ]] || page "$name" "$program" --man
done
"$bin/dmise" completion bash >"$out/bash-completion/completions/dmise"
"$bin/dmise" completion zsh >"$out/zsh/vendor-completions/_dmise"
for kind in scenario dataset camera site materials; do
  "$bin/dmise" schema "$kind" >"$out/dmise/schema/$kind.schema.json"
done
