#!/bin/sh
# What the solver costs, and CalculiX on the same problem. Measured, not judged: no part of ctest.
#   sh tests/bench/run.sh [--meshes "12x18 24x36 48x72"] [--repeat N] [--threads-repeat N] [--write]
#                         [--ccx] [--ccx-meshes "12x18 24x36"] [--install-ccx]
# --write        put the table into tests/bench/README.md
# --ccx          run CalculiX too, where it is installed; --install-ccx installs it first
# Builds in build/ unless LAGAMINE_BIN names a folder of programs. Results: out/bench/bench.md and bench.csv.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
. "$root/src/cmake/setup.sh"

for word in "$@"; do
  case "$word" in
    -h | --help)
      sed -n '2,7s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    --install-ccx)
      if ! command -v ccx >/dev/null 2>&1; then
        as_root apt-get install -y -q --no-install-recommends calculix-ccx >/dev/null 2>&1 ||
          { as_root apt-get update -q >/dev/null && as_root apt-get install -y -q --no-install-recommends calculix-ccx >/dev/null; } ||
          { echo "CalculiX could not be installed from here: apt-get install calculix-ccx" >&2; exit 2; }
      fi
      ;;
  esac
done

if [ -z "${LAGAMINE_BIN:-}" ]; then
  setup_packages
  configure >&2 && build_targets programs >&2 || exit 1
  LAGAMINE_BIN="$build/bin"
fi
export LAGAMINE_BIN
exec "${LAGAMINE_PYTHON:-python3}" "$root/tests/bench/bench.py" "$@"
