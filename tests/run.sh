#!/bin/sh
# Set up, build, and run the tests: all of them, or those whose label or name is given.
#   sh tests/run.sh [-v] [LABEL-or-NAME...]
# -v shows what tests print when they pass: `sh tests/run.sh -v tangents` is the table of all laws.
# A label is a folder of tests/; a name may be a part of a test's name (`ctest -N` in build/ lists them).
# Ends with 0 only if every test passed and at least one ran; 2 if something is missing or unknown.
set -u
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 2
. "$root/src/cmake/setup.sh"

show=--output-on-failure
if [ "${1:-}" = -v ]; then
  show=--verbose
  shift
fi

setup_packages
configure_and_build || exit 1
cd "$build" || exit 1

# Several tests run at once: each on one thread, unless it asks for more itself.
OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}
export OMP_NUM_THREADS

# Names of the tests that a `ctest` selection finds.
names() {
  ctest -N "$@" | sed -n 's/^ *Test *#[0-9]*: *\([^ ]*\).*$/\1/p'
}

if [ $# -eq 0 ]; then
  exec ctest $show --no-tests=error -j "$jobs"
fi

chosen=''
for word in "$@"; do
  found=$(names -L "^$word\$")
  [ -n "$found" ] || found=$(names -R "$word")
  if [ -z "$found" ]; then
    echo "run.sh: no label or test '$word'" >&2
    ctest --print-labels >&2
    exit 2
  fi
  for name in $found; do
    chosen="$chosen${chosen:+|}$(printf '%s' "$name" | sed 's/[.+]/[&]/g')"
  done
done
exec ctest $show --no-tests=error -j "$jobs" -R "^($chosen)\$"
