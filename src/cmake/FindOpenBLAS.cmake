# OpenBLAS: dense kernels for MUMPS, and the switch of its threads. Defines the target OpenBLAS::OpenBLAS.
find_library(OPENBLAS_LIBRARY openblas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenBLAS
  REQUIRED_VARS OPENBLAS_LIBRARY
  REASON_FAILURE_MESSAGE "OpenBLAS is missing: install libopenblas-dev (Debian, Ubuntu) or set OPENBLAS_LIBRARY")
if(OpenBLAS_FOUND AND NOT TARGET OpenBLAS::OpenBLAS)
  add_library(OpenBLAS::OpenBLAS UNKNOWN IMPORTED)
  set_target_properties(OpenBLAS::OpenBLAS PROPERTIES IMPORTED_LOCATION "${OPENBLAS_LIBRARY}")
endif()
mark_as_advanced(OPENBLAS_LIBRARY)
