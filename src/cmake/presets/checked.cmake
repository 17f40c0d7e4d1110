# Initial cache (GNU): what `debug` and `sanitize` look for in one build, for .ci/run; a warning is an error.
#   cmake -C src/cmake/presets/checked.cmake -S . -B build-checked
# Every check of the compiler at run time, traps, signaling NaN (flags: src/cmake/compiler_flags.cmake), AddressSanitizer, and of
# UndefinedBehaviorSanitizer what Debug does not check better: left out, beside what `sanitize` leaves out, are extents of arrays
# (bounds; -fcheck=bounds knows those of all arrays) and sums of addresses (pointer-overflow; an index so large is out of bounds).
# Without optimisation, which takes twice as long to compile with a sanitizer; without the ends of scopes (a third of the
# compilation), as gfortran 12 marks none: a pointer out of a BLOCK is found neither with nor without them.
# Leaks: ASAN_OPTIONS=detect_leaks=0 (the reason stands in tests/CMakeLists.txt).
set(CMAKE_BUILD_TYPE Checked CACHE STRING "" FORCE)
set(LAGAMINE_WERROR ON CACHE BOOL "")
set(sanitizers "-g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all")
set(left_out "-fno-sanitize=signed-integer-overflow,null,object-size,alignment,bounds,pointer-overflow")
set(CMAKE_C_FLAGS_CHECKED "${sanitizers}" CACHE STRING "")
set(CMAKE_Fortran_FLAGS_CHECKED "${sanitizers} ${left_out} -fno-sanitize-address-use-after-scope" CACHE STRING "")
