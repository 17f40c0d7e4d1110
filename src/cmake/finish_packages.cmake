# Run by cpack on what was installed: Debian wants manual pages compressed, and no path of libraries that the loader finds by itself.
file(GLOB_RECURSE pages "${CPACK_TEMPORARY_DIRECTORY}/*.1")
foreach(page IN LISTS pages)
  execute_process(COMMAND gzip -9nf "${page}" RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "gzip ${page} ended with ${status}")
  endif()
endforeach()
file(GLOB_RECURSE programs "${CPACK_TEMPORARY_DIRECTORY}/*")
list(FILTER programs INCLUDE REGEX "/bin/(lagamine|remdata|remdata_gmsh)$")
foreach(program IN LISTS programs)
  file(RPATH_REMOVE FILE "${program}")   # as in cmake_install.cmake
endforeach()
