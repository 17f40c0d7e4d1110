# Initial cache (GNU): counts how often each line runs (tests/coverage.sh builds and reads it).
#   cmake -C src/cmake/presets/coverage.cmake -S . -B build-coverage
set(CMAKE_BUILD_TYPE Coverage CACHE STRING "" FORCE)
foreach(language IN ITEMS C Fortran)
  # Atomic: threads and processes of one test write the same counters.
  set(CMAKE_${language}_FLAGS_COVERAGE "-g -O1 --coverage -fprofile-update=atomic" CACHE STRING "")
endforeach()
