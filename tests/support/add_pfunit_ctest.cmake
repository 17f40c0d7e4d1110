# Stand-in for pFUnit's function of the same name, for machines without pFUnit: same arguments, same test files.
#   add_pfunit_ctest(NAME TEST_SOURCES a.pf... [OTHER_SOURCES b.f90...] [LINK_LIBRARIES l...] [LABELS l...]
#                    [WORKING_DIRECTORY d])
# Needs `pf_python`, a Python 3.6 or newer.

set(pf_folder "${CMAKE_CURRENT_LIST_DIR}")
set(pf_build "${CMAKE_CURRENT_BINARY_DIR}/funit")

add_custom_command(OUTPUT "${pf_build}/funit_numbers.f90"
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${pf_build}"
  COMMAND "${pf_python}" "${pf_folder}/pf_asserts.py" "${pf_build}/funit_numbers.f90"
  DEPENDS "${pf_folder}/pf_asserts.py" VERBATIM)
add_library(funit STATIC
  "${pf_folder}/funit_report.f90" "${pf_folder}/funit_compare.f90" "${pf_folder}/funit_basic.f90"
  "${pf_build}/funit_numbers.f90" "${pf_folder}/funit_run.f90" "${pf_folder}/funit.f90")
set_target_properties(funit PROPERTIES Fortran_MODULE_DIRECTORY "${pf_build}/modules")
target_include_directories(funit PUBLIC "${pf_build}/modules")
target_link_libraries(funit PRIVATE lagamine_flags)

function(add_pfunit_ctest name)
  cmake_parse_arguments(PARSE_ARGV 1 pf "" "WORKING_DIRECTORY" "TEST_SOURCES;OTHER_SOURCES;LINK_LIBRARIES;LABELS")
  if(pf_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "add_pfunit_ctest(${name}): only pFUnit itself knows ${pf_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT pf_TEST_SOURCES)
    message(FATAL_ERROR "add_pfunit_ctest(${name}): no TEST_SOURCES")
  endif()

  set(modules)
  set(translated)
  foreach(source IN LISTS pf_TEST_SOURCES)
    get_filename_component(path "${source}" ABSOLUTE)
    get_filename_component(module "${source}" NAME_WE)
    file(RELATIVE_PATH label "${CMAKE_SOURCE_DIR}" "${path}")
    set(out "${CMAKE_CURRENT_BINARY_DIR}/${name}.dir/${module}.F90")
    add_custom_command(OUTPUT "${out}"
      COMMAND "${pf_python}" "${pf_folder}/pf_translate.py" "${path}" "${out}" --label "${label}"
      DEPENDS "${path}" "${pf_folder}/pf_translate.py" VERBATIM)
    list(APPEND modules "${module}")
    list(APPEND translated "${out}")
  endforeach()
  # The list of tests is known now, and a change of it comes through here: no rule is needed.
  set(driver "${CMAKE_CURRENT_BINARY_DIR}/${name}.dir/${name}_driver.f90")
  execute_process(COMMAND "${pf_python}" "${pf_folder}/pf_translate.py" --driver "${driver}" ${modules}
    RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "add_pfunit_ctest(${name}): cannot write ${driver}")
  endif()

  add_executable(${name} ${translated} ${pf_OTHER_SOURCES} "${driver}")
  set(modules_here "${CMAKE_CURRENT_BINARY_DIR}/${name}.dir/modules")
  set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY "${modules_here}")
  target_include_directories(${name} PRIVATE "${modules_here}" "${CMAKE_CURRENT_SOURCE_DIR}")
  target_link_libraries(${name} ${pf_LINK_LIBRARIES} funit)
  if(NOT pf_WORKING_DIRECTORY)
    set(pf_WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
  endif()
  add_test(NAME ${name} COMMAND ${name} -v WORKING_DIRECTORY "${pf_WORKING_DIRECTORY}")
  # The closing line must be there: a `stop` inside a test would end with code 0 too.
  set_tests_properties(${name} PROPERTIES
    PASS_REGULAR_EXPRESSION "[1-9][0-9]* tests, 0 failures" LABELS "${pf_LABELS}")
endfunction()
