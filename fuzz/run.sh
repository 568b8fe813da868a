#!/bin/sh
# Fuzzes TARGET (scene or store) for SECONDS: fuzz/run.sh TARGET SECONDS. Starts from the shipped scenes and a stored
# solution; what is found lies in fuzz/artifacts, the corpus in fuzz/corpus.
set -eu
cd "$(dirname "$0")"
target=$1
seconds=$2
corpus=corpus/$target
mkdir -p "$corpus"
case $target in
scene) cp ../scenes/*.toml ../scenes/*/*.toml "$corpus" ;;
store)
    # the first byte chooses the file: see fuzz_targets/store.rs (6 = history.csv, 5 = summary.json, 7 = provenance.json)
    for entry in ../fem_reference/solutions/scaled-plate-*/coarse; do
        name=$(basename "$(dirname "$entry")")
        { printf '\006'; head -20 "$entry/history.csv"; } > "$corpus/$name-history"
        { printf '\005'; cat "$entry/summary.json"; } > "$corpus/$name-summary"
        { printf '\007'; cat "$entry/provenance.json"; } > "$corpus/$name-provenance"
        { printf '\004'; cat "$entry/checksums.sha256"; } > "$corpus/$name-checksums"
    done
    ;;
*) echo "unknown target $target: scene or store" >&2; exit 2 ;;
esac
exec cargo fuzz run --sanitizer none "$target" -- -max_total_time="$seconds" -max_len=8192 -timeout=20 \
    -print_final_stats=1 ${3:+"$3"}
