# How the sources of this project are compiled, by compiler: the target lagamine_flags. Ours are linked with it PRIVATE, so that a
# project that uses the library keeps flags of its own. The tests run with GNU; other compilers get what they have of the same.
#   strict   the standard and warnings
#   checks   Debug and Checked: what a run checks of itself
#   results  no sums in another order than written: results are the same bits on any number of threads
add_library(lagamine_flags INTERFACE)

# flags_of(COMPILERS [STRICT f...] [CHECKS f...] [RESULTS f...] [NATIVE f...] [WERROR f...])   COMPILERS: ids, separated by commas
function(flags_of compilers)
  cmake_parse_arguments(PARSE_ARGV 1 flags "" "" "STRICT;CHECKS;RESULTS;NATIVE;WERROR")
  set(here "$<COMPILE_LANG_AND_ID:Fortran,${compilers}>")
  target_compile_options(lagamine_flags INTERFACE
    "$<${here}:${flags_STRICT}>"
    "$<${here}:${flags_RESULTS}>"
    "$<$<AND:${here},$<OR:$<CONFIG:Debug>,$<CONFIG:Checked>>>:${flags_CHECKS}>"
    "$<$<AND:${here},$<CONFIG:Debug>>:-g;-O1>"
    "$<$<AND:${here},$<BOOL:${LAGAMINE_NATIVE}>>:${flags_NATIVE}>"
    "$<$<AND:${here},$<BOOL:${LAGAMINE_WERROR}>>:${flags_WERROR}>")
endfunction()

# A member of a family seldom needs every argument of the family's interface: no warning for those. Nor for what may be uninitialised:
# where gfortran optimises it takes the bounds of an array, and the length of a text, that are allocated by assignment for such (GCC
# bug 77504), in some 180 places. What surely is uninitialised is reported (-Wuninitialized, of -Wall), and checked builds fill reals
# with signalling NaN.
# Memory that temporaries do not get ends the program in words (-fcheck=mem, src/base/memory_limits.f90), not in a crash.
flags_of(GNU
  STRICT -fcheck=mem -std=f2008 -pedantic -Wall -Wextra -Wno-unused-dummy-argument -Wno-maybe-uninitialized
         -Wimplicit-interface -Wconversion -fimplicit-none
  CHECKS -fcheck=all,no-array-temps -ffpe-trap=invalid,zero,overflow -finit-real=snan -fbacktrace
  NATIVE -march=native
  WERROR -Werror)
flags_of(Intel,IntelLLVM
  STRICT "SHELL:-stand f08" "SHELL:-warn all,nounused"
  CHECKS "SHELL:-check all,noarg_temp_created,nouninit" -fpe0 -init=snan,arrays -traceback
  RESULTS -fp-model=precise
  NATIVE -xHost
  WERROR "SHELL:-warn errors")
flags_of(LLVMFlang,Flang
  NATIVE -march=native)

set(here "$<COMPILE_LANG_AND_ID:C,GNU,Clang,AppleClang>")
target_compile_options(lagamine_flags INTERFACE "$<${here}:-Wall;-Wextra>" "$<$<AND:${here},$<BOOL:${LAGAMINE_WERROR}>>:-Werror>")
