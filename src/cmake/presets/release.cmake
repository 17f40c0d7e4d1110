# Initial cache: what users run.
#   cmake -C src/cmake/presets/release.cmake -S . -B build
set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
