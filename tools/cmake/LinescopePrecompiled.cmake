# Headers that almost every file reads, compiled once: one set for libraries, one for test programs.
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without them; the code must compile either way.
set(linescope_common_headers
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <memory> <optional> <span> <string> <string_view>
  <utility> <vector> <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <tl/expected.hpp>)

add_library(linescope_library_headers STATIC ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
target_link_libraries(linescope_library_headers PRIVATE
  linescope_warnings linescope_sanitize Eigen3::Eigen fmt::fmt tl::expected)
target_precompile_headers(linescope_library_headers PRIVATE ${linescope_common_headers})

# What tests and programs spend their time on is in the libraries; their own code is compiled far more often than it
# matters how fast it is. A quarter of the time of compiling it.
set(linescope_outer_code $<$<CONFIG:RelWithDebInfo>:-O1>)

if(LINESCOPE_TESTS)
  add_executable(linescope_test_headers ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
  target_link_libraries(linescope_test_headers PRIVATE
    linescope_warnings linescope_sanitize Eigen3::Eigen fmt::fmt tl::expected GTest::gmock GTest::gtest_main)
  target_compile_options(linescope_test_headers PRIVATE ${linescope_outer_code})
  target_precompile_headers(linescope_test_headers PRIVATE ${linescope_common_headers} <gmock/gmock.h> <gtest/gtest.h>)
endif()
