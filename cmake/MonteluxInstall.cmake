# cmake --install: the program, the library as one static archive, its headers and a package for find_package(Montelux).
include(CMakePackageConfigHelpers)

# The layers are archives of their own, of which a user needs none: the installed library holds all of their objects.
set(objects "")
foreach(layer ${montelux_layers} page)
  if(TARGET montelux_${layer})
    get_target_property(type montelux_${layer} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      list(APPEND objects $<TARGET_OBJECTS:montelux_${layer}>)
    endif()
  endif()
endforeach()

find_package(OpenEXR 3 REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(muparser REQUIRED)
find_package(embree ${embree_VERSION_MAJOR} QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED CONFIG)
endif()
set(MONTELUX_EMBREE_MAJOR ${embree_VERSION_MAJOR})

set(module_folder ${CMAKE_INSTALL_LIBDIR}/montelux)
add_library(montelux_library STATIC ${objects})
add_library(Montelux::montelux ALIAS montelux_library)
set_target_properties(montelux_library PROPERTIES OUTPUT_NAME montelux EXPORT_NAME montelux LINKER_LANGUAGE CXX)
target_compile_features(montelux_library INTERFACE cxx_std_20)
target_link_libraries(montelux_library PRIVATE embree OpenEXR::OpenEXR PNG::PNG JPEG::JPEG fmt::fmt muparser::muparser ZLIB::ZLIB
                      Threads::Threads TBB::tbb ${CMAKE_DL_LIBS})
# The module of image formats is found as any library of the program that uses it.
target_link_options(montelux_library INTERFACE $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${module_folder}>)
if(MONTELUX_SANITIZE)
  # A sanitizer calls dlopen in our place, and a RUNPATH holds only for what calls it; an RPATH holds for all libraries.
  target_link_options(montelux_library INTERFACE -fsanitize=${MONTELUX_SANITIZE}
                      $<INSTALL_INTERFACE:LINKER:--disable-new-dtags>)
endif()

file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/montelux/*.h)
set(inside content.h describe.h parameters.h picture.h)  # what the sources alone include
list(TRANSFORM inside PREPEND ${CMAKE_SOURCE_DIR}/src/montelux/)
list(REMOVE_ITEM headers ${inside})
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/montelux)
install(TARGETS montelux_library EXPORT MonteluxTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS montelux_codec LIBRARY DESTINATION ${module_folder})
install(TARGETS montelux RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
file(RELATIVE_PATH from_program /${CMAKE_INSTALL_BINDIR} /${module_folder})
set_target_properties(montelux PROPERTIES INSTALL_RPATH "$ORIGIN/${from_program}")

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Montelux)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/MonteluxConfig.cmake.in ${CMAKE_BINARY_DIR}/MonteluxConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/MonteluxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/MonteluxConfig.cmake ${CMAKE_BINARY_DIR}/MonteluxConfigVersion.cmake
        DESTINATION ${package_folder})
install(EXPORT MonteluxTargets NAMESPACE Montelux:: DESTINATION ${package_folder})

# Completion, where the shells look for it; printed by the program itself.
set(completion ${CMAKE_BINARY_DIR}/completion)
set(completion_files "")
foreach(shell bash zsh fish)
  set(file ${completion}/montelux.${shell})
  add_custom_command(OUTPUT ${file} COMMAND ${CMAKE_COMMAND} -E make_directory ${completion}
                     COMMAND montelux completion ${shell} > ${file} DEPENDS montelux VERBATIM)
  list(APPEND completion_files ${file})
endforeach()
add_custom_target(montelux_completion ALL DEPENDS ${completion_files})
install(FILES ${completion}/montelux.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME montelux)
install(FILES ${completion}/montelux.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _montelux)
install(FILES ${completion}/montelux.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME montelux.fish)
