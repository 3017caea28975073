# One package for many x86-64 machines: the program in a build for each instruction set, so that it uses as many lanes as
# a processor has, and a launcher that starts the right one. All builds have the options of this one.
include(ExternalProject)
set(MONTELUX_BUILDS "x86-64-v3;x86-64-v4" CACHE STRING
    "Instruction sets, the smallest first: x86-64-v2 (4 lanes), x86-64-v3 (8), x86-64-v4 (16)")
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  message(FATAL_ERROR "MONTELUX_PORTABLE is for x86-64, not ${CMAKE_SYSTEM_PROCESSOR}")
endif()

set(staged ${CMAKE_BINARY_DIR}/staged)
set(before "")
foreach(build ${MONTELUX_BUILDS})
  if(NOT build MATCHES "^x86-64-v[234]$")
    message(FATAL_ERROR "MONTELUX_BUILDS: \"${build}\" is not one of x86-64-v2, x86-64-v3, x86-64-v4")
  endif()
  # One after the other, since each uses all processors.
  ExternalProject_Add(montelux_${build}
    SOURCE_DIR ${CMAKE_SOURCE_DIR} BINARY_DIR ${CMAKE_BINARY_DIR}/${build} DEPENDS ${before}
    CMAKE_ARGS -DMONTELUX_PORTABLE=OFF -DMONTELUX_ARCH=${build} -DMONTELUX_TESTS=OFF -DMONTELUX_BENCH=OFF
               -DMONTELUX_WERROR=${MONTELUX_WERROR} -DMONTELUX_SPECTRUM_SIZE=${MONTELUX_SPECTRUM_SIZE}
               -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
               -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS} -DCMAKE_INSTALL_PREFIX=${staged}/${build}
               -DCMAKE_INSTALL_LIBDIR=${CMAKE_INSTALL_LIBDIR} -DCMAKE_INSTALL_BINDIR=bin
    BUILD_ALWAYS ON USES_TERMINAL_CONFIGURE ON USES_TERMINAL_BUILD ON)
  set(before montelux_${build})
endforeach()

add_subdirectory(apps/launcher)
install(PROGRAMS $<TARGET_FILE:montelux_launcher> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME montelux)
set(builds ${CMAKE_INSTALL_LIBEXECDIR}/montelux)
foreach(build ${MONTELUX_BUILDS})
  install(PROGRAMS ${staged}/${build}/bin/montelux DESTINATION ${builds}/${build}/bin)
  install(DIRECTORY ${staged}/${build}/${CMAKE_INSTALL_LIBDIR}/montelux DESTINATION ${builds}/${build}/${CMAKE_INSTALL_LIBDIR})
endforeach()
# The library for programs of users, and what does not depend on the processor, are those of the smallest set.
list(GET MONTELUX_BUILDS 0 smallest)
install(DIRECTORY ${staged}/${smallest}/ DESTINATION . PATTERN bin EXCLUDE)
