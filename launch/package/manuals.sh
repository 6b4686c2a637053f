#!/usr/bin/env bash
# manuals.sh BIN OUT [EMULATOR]: manual pages, completions and JSON Schemas, printed by the programs in BIN, below OUT as they
# are installed below share. EMULATOR runs programs of another processor.
set -euo pipefail

bin=$1 out=$2 emulator=("${@:3}")
pages=$out/man/man1
rm -rf "$out/man" "$out/bash-completion" "$out/zsh" "$out/dmise"
mkdir -p "$pages" "$out/dmise/schema" "$out/bash-completion/completions" "$out/zsh/vendor-completions"

run() { "${emulator[@]}" "$bin/$1" "${@:2}"; }
page() {  # NAME PROGRAM ARGUMENT..
  run "${@:2}" | gzip -9n >"$pages/$1.1.gz"
}

page dmise dmise man
for command in $(run dmise man --list); do
  page "dmise-$command" dmise man "$command"
done
for program in "$bin"/dmise-*; do
  name=${program##*/}
  [[ $name == dmise-bench || $name == dmise-validate || $name == dmise-studies || ! -x $program ]] || page "$name" "$name" --man
done
run dmise completion bash >"$out/bash-completion/completions/dmise"
run dmise completion zsh >"$out/zsh/vendor-completions/_dmise"
for kind in scenario dataset camera site materials; do
  run dmise schema "$kind" >"$out/dmise/schema/$kind.schema.json"
done
