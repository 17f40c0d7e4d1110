# Initial cache: every check at run time, traps on invalid, zero, overflow; a warning is an error (flags:
# src/cmake/compiler_flags.cmake).
#   cmake -C src/cmake/presets/debug.cmake -S . -B build-debug
set(CMAKE_BUILD_TYPE Debug CACHE STRING "" FORCE)
set(LAGAMINE_WERROR ON CACHE BOOL "")
