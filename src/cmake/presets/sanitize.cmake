# Initial cache (GNU): AddressSanitizer and UndefinedBehaviorSanitizer, which end a program at the first finding. Without the
# compiler's own checks (Debug has them), so that what users run is what is looked at.
#   cmake -C src/cmake/presets/sanitize.cmake -S . -B build-sanitize
set(CMAKE_BUILD_TYPE Sanitize CACHE STRING "" FORCE)
foreach(language IN ITEMS C Fortran)
  set(CMAKE_${language}_FLAGS_SANITIZE "-g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined"
    CACHE STRING "")
endforeach()
