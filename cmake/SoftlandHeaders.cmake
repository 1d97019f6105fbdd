# Half of compiling a file is reading the headers of others, so those are compiled once for each kind of target: hot, to run fast, cold
# and test, to be compiled fast. Only where several files are compiled as one, and see each other's headers anyway. A compiler launcher
# does without: ccache cannot look into a precompiled header.
set(SOFTLAND_PRECOMPILED OFF)
if(CMAKE_UNITY_BUILD AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(SOFTLAND_PRECOMPILED ON)
endif()
# Three quarters of the time of -O3.
set(SOFTLAND_COLD $<$<CONFIG:Release>:-O1>)

set(standard_headers <algorithm> <array> <chrono> <cmath> <filesystem> <functional> <map> <memory> <mutex> <optional> <set> <span>
    <string> <string_view> <variant> <vector>)
set(library_headers <Eigen/Core> <fmt/format.h> <nlohmann/json.hpp>)

# softland_headers(KIND [OPTIONS ...] [USES ... READS ...]): the headers for targets of a kind, with those READS of libraries it USES.
function(softland_headers kind)
  cmake_parse_arguments(ARG "" "" "OPTIONS;USES;READS" ${ARGN})
  if(NOT SOFTLAND_PRECOMPILED)
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/generated/${kind}_headers.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(softland_${kind}_headers OBJECT ${source})
  target_compile_options(softland_${kind}_headers PRIVATE ${ARG_OPTIONS})
  target_link_libraries(softland_${kind}_headers PRIVATE softland_options Boost::headers Eigen3::Eigen fmt::fmt
                        nlohmann_json::nlohmann_json ${ARG_USES})
  target_precompile_headers(softland_${kind}_headers PRIVATE ${standard_headers} ${library_headers} ${ARG_READS})
endfunction()

# softland_compiled_as(TARGET hot|cold|test)
function(softland_compiled_as target kind)
  if(NOT kind STREQUAL "hot")
    target_compile_options(${target} PRIVATE ${SOFTLAND_COLD})
  endif()
  if(SOFTLAND_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM softland_${kind}_headers)
  endif()
endfunction()

softland_headers(hot)
softland_headers(cold OPTIONS ${SOFTLAND_COLD})
