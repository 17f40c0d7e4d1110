# Shared by tests/run.sh and decks/run.sh, which source it after setting `root` to the project's folder. POSIX sh.
#   setup_packages        install what is missing, or say what to install and stop with 2
#   configure             prepare $build with the initial cache $preset of src/cmake/presets; sets and exports LAGAMINE_PYTHON
#                         (empty where there is none)
#   build_targets NAME... build these in $build: all, programs, unit_tests
# and the variables `build` (the build folder: $root/build), `preset` (release) and `jobs` (how many things to do at once).

packages="gfortran make cmake libmumps-seq-dev libmetis-dev libhdf5-dev libopenblas-dev python3 python3-h5py python3-matplotlib \
python3-meshio python3-ezdxf"
build="$root/build"
preset=release

# Two at most: a compiler of this code wants about a gigabyte.
jobs=$(nproc 2>/dev/null || echo 1)
[ "$jobs" -le 2 ] || jobs=2

# One apt-get command, as root; fails where we may not.
as_root() {
  if [ "$(id -u)" = 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    sudo -n env DEBIAN_FRONTEND=noninteractive "$@"
  else
    return 1
  fi
}

missing_packages() {
  for package in $packages; do
    # shellcheck disable=SC2016  # the dollar is for dpkg-query
    case "$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null)" in
      *" installed") ;;
      *) printf '%s ' "$package" ;;
    esac
  done
}

setup_packages() {
  # Without dpkg nothing is known about names of packages: CMake will say which library it does not find.
  command -v dpkg-query >/dev/null 2>&1 || return 0
  missing=$(missing_packages)
  [ -n "$missing" ] || return 0
  echo "installing: $missing"
  # The list of packages may be old or absent: try with it as it is, then renewed.
  # shellcheck disable=SC2086  # one word per package
  as_root apt-get install -y -q --no-install-recommends $missing >/dev/null 2>&1 ||
    { as_root apt-get update -q && as_root apt-get install -y -q --no-install-recommends $missing; }
  missing=$(missing_packages)
  [ -n "$missing" ] || return 0
  echo "These packages are needed and could not be installed from here:" >&2
  echo "  $missing" >&2
  echo "Install them as root: apt-get update && apt-get install $missing" >&2
  exit 2
}

configure() {
  cmake -C "$root/src/cmake/presets/$preset.cmake" -S "$root" -B "$build" || return 1
  LAGAMINE_PYTHON=$(sed -n 's/^LAGAMINE_PYTHON:FILEPATH=//p' "$build/CMakeCache.txt")
  export LAGAMINE_PYTHON
}

build_targets() {
  cmake --build "$build" --parallel "$jobs" --target "$@"
}
