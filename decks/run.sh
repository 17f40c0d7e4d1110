#!/bin/sh
# Set up, build, run decks and draw their results.
#   sh decks/run.sh [NAME...] [-- OPTION...]
# NAME is a deck, NAME.lag in a folder of decks/ (default: upsetting); its results come into out/NAME. What follows `--` is
# handed to lagamine:   sh decks/run.sh upsetting -- -p nx=24 -p ny=36
# Ends with the exit code of lagamine (the first that is not 0); 2 if something is missing or unknown.
set -u
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 2
. "$root/src/cmake/setup.sh"

# The path of a deck, or nothing.
deck_file() {
  for file in "$root"/decks/*/"$1".lag; do
    if [ -f "$file" ]; then
      printf '%s\n' "$file"
      return
    fi
  done
}

known_decks() {
  for file in "$root"/decks/*/*.lag; do
    printf ' %s' "$(basename -- "$file" .lag)"
  done
}

# Force and radius of the billet at 30, 44 and 60 % of its height, linear between the steps.
billet_result() {
  echo "  upset %   force kN   radius mm"
  LC_ALL=C awk -F, '
    NR == 1 {
      for (k = 1; k <= NF; k++) {
        name = $k
        sub(/ \[.*/, "", name)
        column[name] = k
      }
      travel = column["displacement_y_upper"]; force = column["force_y_upper"]; radius = column["mid_radius"]
      n = split("30 44 60", percent, " ")
      next_one = 1
      next
    }
    {
      while (next_one <= n) {
        wanted = 15*percent[next_one]/100
        if (-$travel < wanted - 1e-9) break
        share = (NR > 2 && -$travel > u) ? (wanted - u)/(-$travel - u) : 1
        printf "  %5d %12.2f %11.4f\n", percent[next_one], (f + share*($force - f))/1000, r + share*($radius - r)
        next_one++
      }
      u = -$travel; f = $force; r = $radius
    }
    END { for (; next_one <= n; next_one++) printf "  %5d  not reached\n", percent[next_one] }' "$1"
}

# The last row of the history: the time, dies and probes.
last_row() {
  LC_ALL=C awk -F, '
    NR == 1 { n = split($0, name, ",") }
    { last = $0 }
    END {
      split(last, value, ",")
      if (NR > 1) for (k = 1; k <= n; k++) if (k == 1 || k > 14) printf "  %-32s %.6g\n", name[k], value[k]
    }' "$1"
}

# The page with pictures, or why there is none.
draw() {
  if [ -x "$build/bin/lagareport" ]; then
    "$build/bin/lagareport" "$1" --quiet || echo "no pictures: lagareport ended with $?" >&2
    return
  fi
  python=${LAGAMINE_PYTHON:-$(command -v python3)}
  lacking=''
  for module in numpy h5py matplotlib; do
    "${python:-false}" -c "import $module" >/dev/null 2>&1 || lacking="$lacking python3-$module"
  done
  echo "no pictures: lagareport was not built; packages missing for ${python:-python3, itself missing}:${lacking:- none}" >&2
}

# Is this file of the present run?
fresh() {
  [ -n "$(find "$1" -newer "$root/out/.started" 2>/dev/null)" ]
}

# Run one deck and show what came out.
run_deck() {
  folder="$root/out/$1"
  file=$(deck_file "$1")
  shift
  mkdir -p "$folder" && : >"$root/out/.started" || exit 5
  code=0
  program=lagamine
  # a deck that asks for new meshes runs in a cycle
  if grep -q "^REMSH" "$file"; then program=lagacycle; fi
  "$build/bin/$program" "$file" --out "$folder" "$@" || code=$?
  # Results of an earlier run, or none, are not shown: with --check, or where the deck was refused.
  fresh "$folder/history.csv" || return "$code"
  echo "history.csv:"
  case "$file" in
    */upsetting.lag) billet_result "$folder/history.csv" ;;
    *) last_row "$folder/history.csv" ;;
  esac
  draw "$folder"
  echo "results in $folder"
  ! fresh "$folder/report.html" || echo "  pictures   $folder/report.html"
  for file in "$folder"/*.xdmf; do
    ! fresh "$file" || echo "  ParaView   $file"
  done
  return "$code"
}

names=''
while [ $# -gt 0 ]; do
  case "$1" in
    --) shift; break ;;
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
  esac
  case "$1" in
    *[!A-Za-z0-9_-]* | '') found='' ;;
    *) found=$(deck_file "$1") ;;
  esac
  if [ -z "$found" ]; then
    echo "run.sh: no deck '$1'; decks:$(known_decks)" >&2
    exit 2
  fi
  names="$names $1"
  shift
done

setup_packages
configure && build_targets programs || exit 1

status=0
for name in ${names:-upsetting}; do
  run_deck "$name" "$@" || { code=$?; [ "$status" -ne 0 ] || status=$code; }
done
exit "$status"
