# What a person can choose when configuring.
option(LINESCOPE_TESTS "Build the tests" ON)
option(LINESCOPE_BENCH "Build the benchmarks (Google Benchmark; peers where they are installed)" ON)
option(LINESCOPE_GUI "Build the viewer (VTK and Qt)" ON)
option(LINESCOPE_FUZZ "Build libFuzzer targets (needs clang)" OFF)
set(LINESCOPE_SANITIZE "" CACHE STRING "Sanitizers for own code: empty, 'address,undefined' or 'thread'")
set(LINESCOPE_SHARED_DATA "${CMAKE_CURRENT_SOURCE_DIR}/../shared/data" CACHE PATH
    "Folder with the real recordings read by the tests labelled 'real'")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
