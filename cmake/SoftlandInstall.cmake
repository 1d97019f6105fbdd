# `cmake --install BUILD --prefix PREFIX`: the program with its scenes, manual page and completions; the libraries with their headers,
# all of them below include/softland and by that name; a CMake package and a pkg-config file. Everything is found relative to its own
# place.
include(CMakePackageConfigHelpers)

set(libraries base document sampling store integrators waveforms exchange model objectives config optimizers closing devices search exploration inverse reports)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/softland)

# The program is softland::program outside; softland::softland is all that softland/softland.h needs.
set_target_properties(softland PROPERTIES EXPORT_NAME program)
install(TARGETS softland EXPORT softland)
add_library(softland_public INTERFACE)
target_link_libraries(softland_public INTERFACE softland_exploration softland_inverse)
target_include_directories(softland_public INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>)
set_target_properties(softland_public PROPERTIES EXPORT_NAME softland)
add_library(softland::softland ALIAS softland_public)
install(TARGETS softland_public EXPORT softland INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/softland)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.svg")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES document/uplot/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE.uPlot)

# What the program says of itself with --help is written as a manual page and as completions when it is installed.
foreach(made man_page:softland.1:${CMAKE_INSTALL_MANDIR}/man1 bash_completion:softland:${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  string(REPLACE ":" ";" made ${made})
  list(GET made 0 maker)
  list(GET made 1 file)
  list(GET made 2 folder)
  set(file ${PROJECT_BINARY_DIR}/from_help/${file})
  install(CODE "
    file(MAKE_DIRECTORY \"${PROJECT_BINARY_DIR}/from_help\")
    execute_process(COMMAND sh \"${PROJECT_SOURCE_DIR}/cmake/${maker}.sh\" \"$<TARGET_FILE:softland>\"
                    OUTPUT_FILE \"${file}\" COMMAND_ERROR_IS_FATAL ANY)")
  install(FILES ${file} DESTINATION ${folder})
endforeach()

foreach(name ${libraries})
  set_target_properties(softland_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS softland_${name} EXPORT softland INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
set(public_headers ${PROJECT_BINARY_DIR}/package/include)
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DFROM=${PROJECT_SOURCE_DIR}\" \"-DTO=${public_headers}\" \"-DFOLDERS=${libraries};studies\"
                          -P \"${PROJECT_SOURCE_DIR}/cmake/public_headers.cmake\" COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${public_headers}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/softland)
install(FILES ${PROJECT_BINARY_DIR}/generated/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/softland)

install(EXPORT softland NAMESPACE softland:: FILE softlandTargets.cmake DESTINATION ${package_folder})
configure_package_config_file(cmake/softlandConfig.cmake.in ${PROJECT_BINARY_DIR}/package/softlandConfig.cmake
                              INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/softlandConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/softlandConfig.cmake ${PROJECT_BINARY_DIR}/package/softlandConfigVersion.cmake
              cmake/SoftlandDependencies.cmake DESTINATION ${package_folder})

# Each library after those that use it.
set(link_line ${libraries})
list(REVERSE link_line)
list(TRANSFORM link_line PREPEND -lsoftland_)
list(JOIN link_line " " SOFTLAND_LINK_LINE)
list(JOIN SOFTLAND_CODE_OPTIONS " " SOFTLAND_CODE_OPTIONS_LINE)
file(RELATIVE_PATH SOFTLAND_PREFIX_FROM_PKGCONFIG ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/softland.pc.in ${PROJECT_BINARY_DIR}/package/softland.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/softland.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
