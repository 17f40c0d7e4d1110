# `cpack` in the build folder makes packages for Debian and Ubuntu: lagamine (programs, manual, decks), lagamine-dev (the library for
# programs with members of their own), and lagamine-gmsh, what calls Gmsh, where that is found. Needs dpkg-dev.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lagamine)
set(CPACK_PACKAGE_VENDOR "the LAGAMINE 2D developers")
# Debian's Maintainer is who makes the package and must have an address: that of DEBFULLNAME and DEBEMAIL, as Debian's own tools take it. The
# project has none: where nobody is named, the address is one that cannot exist (RFC 2606) and is seen to be so.
# Nothing of it is kept between two runs of CMake: who packages next is asked anew.
if(NOT CPACK_PACKAGE_CONTACT)
  if(DEFINED ENV{DEBEMAIL})
    set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
    string(STRIP "${CPACK_PACKAGE_CONTACT}" CPACK_PACKAGE_CONTACT)
  else()
    set(CPACK_PACKAGE_CONTACT "LAGAMINE 2D developers <no-address@lagamine.invalid>")
  endif()
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME lagamine)
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
"Large strain, contact with friction, new meshes in the course of a run, heat,
 phases of steel; driven by decks of cards. With the remesher, reports of
 results as one page with pictures, import of drawings and meshes, the manual
 and decks with references.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "python3 (>= 3.9), python3-numpy, python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "python3-meshio, python3-ezdxf")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "lagamine-gmsh")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME lagamine-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"The static library with its modules, for programs that add laws and elements
 of their own: find_package(lagamine) of CMake.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "gfortran, libmumps-seq-dev, libmetis-dev, libhdf5-dev, libopenblas-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS programs)

set(components programs development)
if(TARGET remdata_gmsh)
  list(APPEND components gmsh)
  set(CPACK_DEBIAN_GMSH_PACKAGE_NAME lagamine-gmsh)
  set(CPACK_COMPONENT_GMSH_DESCRIPTION
"The program by which the remesher asks Gmsh for the mesh of a contour for
 which a deck gives no zones.")
  set(CPACK_DEBIAN_GMSH_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_GMSH_DEPENDS programs)
endif()
set(CPACK_COMPONENTS_ALL ${components})

# The texts that Debian wants beside every package.
set(debian "${CMAKE_BINARY_DIR}/debian")
file(READ "${CMAKE_SOURCE_DIR}/LICENSE" license_text)
string(REGEX REPLACE "\n\n" "\n.\n" license_text "${license_text}")
string(REGEX REPLACE "\n" "\n " license_text "${license_text}")
string(REGEX REPLACE "\n *$" "\n" license_text "${license_text}")
string(REGEX MATCH "Copyright [^\n]*" copyright_line "${license_text}")
file(WRITE "${debian}/copyright" "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: lagamine

Files: *
${copyright_line}
License: BSD-3-Clause
 ${license_text}")
file(WRITE "${debian}/changelog" "lagamine (${PROJECT_VERSION}) bookworm; urgency=medium

  * Made by cpack from the sources of version ${PROJECT_VERSION}.

 -- ${CPACK_PACKAGE_CONTACT}  Thu, 01 Jan 2026 00:00:00 +0000
")
find_program(GZIP gzip)
mark_as_advanced(GZIP)
if(GZIP)
  execute_process(COMMAND "${GZIP}" -9nf "${debian}/changelog")
  foreach(component IN LISTS components)
    string(TOUPPER "${component}" key)
    install(FILES "${debian}/copyright" "${debian}/changelog.gz"
      DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME}" COMPONENT ${component})
  endforeach()
endif()
configure_file("${CMAKE_CURRENT_LIST_DIR}/package_settings.cmake.in" "${debian}/package_settings.cmake" @ONLY)
set(CPACK_PROJECT_CONFIG_FILE "${debian}/package_settings.cmake")
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/finish_packages.cmake")   # CMake 3.19 or later
include(CPack)
