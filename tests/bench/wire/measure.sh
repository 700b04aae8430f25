#!/usr/bin/env bash
# Bytes and CPU time of a frame in each codec, on the same frames. Run it after `./dev build`; its
# options are those of build/weft_wire_bench. The general compressor comes from npm, into the build
# folder; without it the others are measured.
set -euo pipefail

here="$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")"
build="$here/../../../build"
into="$build/wire"
module=''

mkdir -p "$into/npm"
"$build/weft_wire_bench" --out "$into" "$@"
[[ " $* " != *" --help "* ]] || exit 0
if npm install --no-save --no-audit --no-fund --prefix "$into/npm" meshoptimizer@1.3.0 >&2; then
  module="$into/npm/node_modules/meshoptimizer/meshopt_encoder.js"
fi
node "$here/wire.mjs" "$into" "$module"
