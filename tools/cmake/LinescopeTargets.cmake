# One place that says how our own code is compiled; third-party headers stay outside of it.
add_library(linescope_warnings INTERFACE)
target_compile_options(linescope_warnings INTERFACE
  $<$<COMPILE_LANGUAGE:C,CXX>:-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror>)

add_library(linescope_sanitize INTERFACE)
if(LINESCOPE_SANITIZE)
  target_compile_options(linescope_sanitize INTERFACE
    -fsanitize=${LINESCOPE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -g)
  target_link_options(linescope_sanitize INTERFACE -fsanitize=${LINESCOPE_SANITIZE})
endif()

# linescope_library(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): the library of one folder.
function(linescope_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} linescope_sanitize PRIVATE ${ARG_PRIVATE} linescope_warnings)
  target_precompile_headers(${name} REUSE_FROM linescope_library_headers)
endfunction()

# linescope_fast_loops(NAME): for a library whose loops are the whole cost of a stage. Older compilers' -O2 leaves loops
# of three and nine rolled, and in position-independent code small functions are only inlined when nobody may replace
# them from outside. Without precompiled headers: GCC takes the optimization level from those, and forgets the -O3.
function(linescope_fast_loops name)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    target_compile_options(${name} PRIVATE -O3 -fno-semantic-interposition)
    set_target_properties(${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# linescope_program(NAME SOURCES... LIBS...): an installed program.
function(linescope_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} linescope_warnings linescope_sanitize)
  target_compile_options(${name} PRIVATE ${linescope_outer_code})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# What the sanitizer builds need of the tests: all unit and fuzz tests, and those in which threads meet.
add_custom_target(tests_sanitized)
add_custom_target(tests_threads)

# linescope_test(NAME LABELS unit surface SOURCES ... LIBS ... [TIMEOUT s] [THREADS] [QT]): one GoogleTest program, a CTest
# test per case. THREADS: worth running under ThreadSanitizer. QT: linked with Qt, which brings compiler options that the
# precompiled headers were not made with.
function(linescope_test name)
  cmake_parse_arguments(ARG "THREADS;QT" "TIMEOUT" "LABELS;SOURCES;LIBS" ${ARGN})
  if(ARG_THREADS)
    list(APPEND ARG_LABELS threads)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(LINESCOPE_SANITIZE)
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")  # instrumented and less optimized
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} linescope_test_support GTest::gmock GTest::gtest_main
    linescope_warnings linescope_sanitize)
  target_compile_options(${name} PRIVATE ${linescope_outer_code})
  if(NOT ARG_QT)
    target_precompile_headers(${name} REUSE_FROM linescope_test_headers)
    # GCC 12 sees ghosts in std::string built from a literal, and with precompiled headers it says so.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
  endif()
  if("unit" IN_LIST ARG_LABELS OR "fuzz" IN_LIST ARG_LABELS)
    add_dependencies(tests_sanitized ${name})
  endif()
  if(ARG_THREADS)
    add_dependencies(tests_threads ${name})
  endif()
  # Values without a printer are bytes, pointers among them: a test would have another name every day.
  gtest_discover_tests(${name} NO_PRETTY_VALUES DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 TEST_LIST ${name}_cases
    PROPERTIES TIMEOUT ${ARG_TIMEOUT})
  # gtest_discover_tests flattens lists in PROPERTIES, so several labels are set once the cases are known.
  set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
  file(WRITE ${labels_file}
    "if(${name}_cases)\n  set_tests_properties(\${${name}_cases} PROPERTIES LABELS \"${ARG_LABELS}\")\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})
endfunction()
