# HDF5 with its Fortran interface. Defines the target HDF5::Fortran.
find_package(HDF5 QUIET COMPONENTS Fortran)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HDF5Fortran
  REQUIRED_VARS HDF5_Fortran_LIBRARIES HDF5_Fortran_INCLUDE_DIRS
  VERSION_VAR HDF5_VERSION
  REASON_FAILURE_MESSAGE "HDF5 with Fortran is missing: install libhdf5-dev (Debian, Ubuntu) or set HDF5_ROOT")
if(HDF5Fortran_FOUND AND NOT TARGET HDF5::Fortran)
  add_library(HDF5::Fortran INTERFACE IMPORTED)
  set_target_properties(HDF5::Fortran PROPERTIES
    INTERFACE_LINK_LIBRARIES "${HDF5_Fortran_LIBRARIES}" INTERFACE_INCLUDE_DIRECTORIES "${HDF5_Fortran_INCLUDE_DIRS}")
endif()
