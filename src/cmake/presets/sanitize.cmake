# Initial cache (GNU): AddressSanitizer and UndefinedBehaviorSanitizer; a finding ends the program. Without optimisation, which takes
# twice as long to compile, and without the compiler's own checks (Debug has them), which would end a program before the finding.
#   cmake -C src/cmake/presets/sanitize.cmake -S . -B build-sanitize
# Left out is what gfortran 12 does itself: it works out bounds of absent and unallocated arrays, which it does not use, from what is
# on the stack (signed-integer-overflow), and addresses of arrays without elements (null; a real one is still a fault);
# and what finds nothing here but takes a third of the compilation: sizes of objects, which only an optimised build knows, and
# alignment, as no address of Fortran is cast.
# Leaks: ASAN_OPTIONS=detect_leaks=0 (the reason stands in tests/CMakeLists.txt).
set(CMAKE_BUILD_TYPE Sanitize CACHE STRING "" FORCE)
set(sanitizers "-g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all")
set(CMAKE_C_FLAGS_SANITIZE "${sanitizers}" CACHE STRING "")
set(CMAKE_Fortran_FLAGS_SANITIZE "${sanitizers} -fno-sanitize=signed-integer-overflow,null,object-size,alignment" CACHE STRING "")
