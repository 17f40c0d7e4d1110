# HDF5 with its Fortran interface. Defines the target HDF5::Fortran. Executables with the property HDF5_ARCHIVES have the library's
# archives linked into them, where there are any and they can be linked: of 6 ms that a program takes to start with the shared library
# of Debian, 4 are spent on what that loads for reading from the network (libcurl and 20 more).
find_package(HDF5 QUIET COMPONENTS Fortran)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HDF5Fortran
  REQUIRED_VARS HDF5_Fortran_LIBRARIES HDF5_Fortran_INCLUDE_DIRS
  VERSION_VAR HDF5_VERSION
  REASON_FAILURE_MESSAGE "HDF5 with Fortran is missing: install libhdf5-dev (Debian, Ubuntu) or set HDF5_ROOT")
if(HDF5Fortran_FOUND AND NOT TARGET HDF5::Fortran)
  set(hdf5_archives "")
  foreach(library IN LISTS HDF5_Fortran_LIBRARIES)
    string(REGEX REPLACE "/libhdf5([^/]*)\\.so$" "/libhdf5\\1.a" archive "${library}")
    if(EXISTS "${archive}")
      list(APPEND hdf5_archives "${archive}")
    else()
      list(APPEND hdf5_archives "${library}")
    endif()
  endforeach()
  # what was found of other archives is not true of these
  if(NOT "${hdf5_archives}" STREQUAL "${HDF5_ARCHIVES_TRIED}")
    unset(HDF5_ARCHIVES_LINK CACHE)
    set(HDF5_ARCHIVES_TRIED "${hdf5_archives}" CACHE INTERNAL "Archives of HDF5 that HDF5_ARCHIVES_LINK tells of")
  endif()
  include(CheckFortranSourceCompiles)
  set(CMAKE_REQUIRED_INCLUDES ${HDF5_Fortran_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_LIBRARIES ${hdf5_archives})
  set(CMAKE_REQUIRED_QUIET TRUE)
  check_fortran_source_compiles("program check
    use hdf5, only: h5open_f
    implicit none
    integer :: flag
    call h5open_f(flag)
    end program" HDF5_ARCHIVES_LINK SRC_EXT f90)
  foreach(variable IN ITEMS INCLUDES LIBRARIES QUIET)
    unset(CMAKE_REQUIRED_${variable})
  endforeach()
  if(NOT HDF5_ARCHIVES_LINK)
    set(hdf5_archives "${HDF5_Fortran_LIBRARIES}")
  endif()
  add_library(HDF5::Fortran INTERFACE IMPORTED)
  set(hdf5_wants_archives "$<BOOL:$<TARGET_PROPERTY:HDF5_ARCHIVES>>")
  foreach(library archive IN ZIP_LISTS HDF5_Fortran_LIBRARIES hdf5_archives)
    target_link_libraries(HDF5::Fortran INTERFACE "$<IF:${hdf5_wants_archives},${archive},${library}>")
  endforeach()
  target_include_directories(HDF5::Fortran INTERFACE "${HDF5_Fortran_INCLUDE_DIRS}")
endif()
