# Compiler settings that every target shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
# The library may become a part of a shared one. Hidden symbols cannot be replaced at run time, so that calls stay direct
# and functions can be inlined as in a program.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()

set(MONTELUX_ARCH "native" CACHE STRING "Instruction set, as the compiler's -march takes it (native, x86-64-v3, x86-64-v4, ...)")
set(MONTELUX_SANITIZE "" CACHE STRING "Sanitizers, comma-separated, as -fsanitize takes them")
set(MONTELUX_SPECTRUM_SIZE 3 CACHE STRING "Components of what a path carries: 3, or 4 (src/color/spectrum.h)")
if(NOT MONTELUX_SPECTRUM_SIZE MATCHES "^[34]$")
  message(FATAL_ERROR "MONTELUX_SPECTRUM_SIZE must be 3 or 4, not \"${MONTELUX_SPECTRUM_SIZE}\"")
endif()
option(MONTELUX_PORTABLE "Build the program for several instruction sets, with a launcher (cmake/MonteluxPortable.cmake)" OFF)
option(MONTELUX_TESTS "Build the tests" ON)
option(MONTELUX_FULL_TESTS "Build and run the slow tests, too" OFF)
option(MONTELUX_BENCH "Build the benchmarks" OFF)
option(MONTELUX_WERROR "Treat warnings as errors" ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

add_library(montelux_options INTERFACE)
target_include_directories(montelux_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
target_compile_definitions(montelux_options INTERFACE MONTELUX_SPECTRUM_SIZE=${MONTELUX_SPECTRUM_SIZE})
# No contraction and no reassociation: a lane of a pack and a single float round alike.
target_compile_options(montelux_options INTERFACE
  -march=${MONTELUX_ARCH} -ffp-contract=off -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion -Wno-psabi)
# Masks of one lane are bool, and code for any number of lanes joins them by & and |.
target_compile_options(montelux_options INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-bitwise-instead-of-logical>)
if(MONTELUX_WERROR)
  target_compile_options(montelux_options INTERFACE -Werror)
endif()
if(MONTELUX_SANITIZE)
  target_compile_options(montelux_options INTERFACE -fsanitize=${MONTELUX_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(montelux_options INTERFACE -fsanitize=${MONTELUX_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND MONTELUX_SANITIZE MATCHES "address")
    # Otherwise clang 14 stores packs of 64 bytes on stacks that it has aligned to 32 bytes only.
    target_compile_options(montelux_options INTERFACE "SHELL:-mllvm -asan-stack-dynamic-alloca=0")
  endif()
endif()
