#!/bin/sh
# Set up, build, and run the tests: all of them, or those whose label or name is given.
#   sh tests/run.sh [-v] [--preset NAME] [--coverage] [LABEL-or-NAME...]
# -v shows what tests print when they pass: `sh tests/run.sh -v tangents` is the table of all laws.
# --preset builds and runs in build-NAME with src/cmake/presets/NAME.cmake: debug, sanitize, ... (default: release, in build/).
# --coverage is the preset of that name, and a table of the share of lines that ran, file by file (tests/coverage.py).
# A label is a folder of tests/; a name may be a part of a test's name (`ctest -N` in build/ lists them).
# Ends with 0 only if every test passed and at least one ran; 2 if something is missing or unknown.
set -u
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 2
. "$root/src/cmake/setup.sh"

show=--output-on-failure
while [ $# -gt 0 ]; do
  case $1 in
    -v) show=--verbose ;;
    --coverage) preset=coverage ;;
    --preset)
      preset=${2:-}
      shift
      ;;
    -*)
      sed -n '3,8s/^# \{0,1\}//p' "$0" >&2
      exit 2
      ;;
    *) break ;;
  esac
  shift
done
if [ ! -f "$root/src/cmake/presets/$preset.cmake" ]; then
  echo "run.sh: no preset '$preset' in src/cmake/presets" >&2
  exit 2
fi
[ "$preset" = release ] || build="$root/build-$preset"

setup_packages
configure || exit 1
cd "$build" || exit 1

# Several tests run at once: each on one thread, unless it asks for more itself.
OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}
export OMP_NUM_THREADS

# Names of the tests that a `ctest` selection finds.
names() {
  ctest -N "$@" | sed -n 's/^ *Test *#[0-9]*: *\([^ ]*\).*$/\1/p'
}

chosen=''
targets=unit_tests
[ $# -gt 0 ] || targets=all
for word in "$@"; do
  found=$(names -L "^$word\$")
  [ -n "$found" ] || found=$(names -R "$word")
  if [ -z "$found" ]; then
    echo "run.sh: no label or test '$word'" >&2
    ctest --print-labels >&2
    exit 2
  fi
  for name in $found; do
    case $name in test_*) ;; *) targets=all ;; esac
    chosen="$chosen${chosen:+|}$(printf '%s' "$name" | sed 's/[.+]/[&]/g')"
  done
done
# None chosen: every name.
if [ -n "$chosen" ]; then chosen="^($chosen)\$"; else chosen=.; fi
build_targets "$targets" || exit 1

if [ "$preset" != coverage ]; then
  exec ctest $show --no-tests=error -j "$jobs" -R "$chosen"
fi
# Only what runs now is counted.
find . -name '*.gcda' -exec rm -f {} +
ctest $show --no-tests=error -j "$jobs" -R "$chosen"
status=$?
python3 "$root/tests/coverage.py" "$build" || status=1
exit $status
