# One interface target with the compile options of every target of ours.
include(CheckCXXSourceRuns)

add_library(softland_options INTERFACE)
# Aggregates are filled with designated initializers and rely on the defaults of what is left out.
# Files that are compiled as one see each other's names, and would be warned of shadows.
set(shadow $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>)
target_compile_options(softland_options INTERFACE -Wall -Wextra ${shadow} -Wconversion -Wno-missing-field-initializers)
# GCC 12 takes assignments of literals to std::string for overlapping copies (GCC PR 105651), at -O1 for copies without end.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(softland_options INTERFACE -Wno-restrict -Wno-stringop-overflow)
endif()
if(CMAKE_UNITY_BUILD)  # files compiled as one see each other's names
  target_compile_options(softland_options INTERFACE -Wno-shadow)
endif()
if(SOFTLAND_WERROR)
  target_compile_options(softland_options INTERFACE -Werror)
  # The same fault of GCC 12 has other names, as other code is put around the literal.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(softland_options INTERFACE -Wno-error=stringop-overread -Wno-error=array-bounds)
  endif()
endif()

# AVX2 where the building machine has it (the program is built where it runs); no -ffast-math: NaN must stay visible.
set(CMAKE_REQUIRED_FLAGS -march=x86-64-v3)
check_cxx_source_runs("int main() { volatile double a = 2; return __builtin_fma(a, a, -4.0) == 0.0 ? 0 : 1; }" SOFTLAND_RUNS_X86_64_V3)
unset(CMAKE_REQUIRED_FLAGS)
# Whoever includes our headers needs the same: Eigen aligns by it.
set(SOFTLAND_CODE_OPTIONS)
if(SOFTLAND_RUNS_X86_64_V3)
  set(SOFTLAND_CODE_OPTIONS -march=x86-64-v3)
endif()
add_compile_options(${SOFTLAND_CODE_OPTIONS})
# -fno-math-errno and -fno-trapping-math change no value: they let sqrt and comparisons be vectorised.
add_compile_options(-fno-math-errno -fno-trapping-math)

if(SOFTLAND_SANITIZE)
  # Without the checks that fault anyway, or that the address sanitizer makes too: they take a quarter of the compile time.
  add_compile_options(-fsanitize=${SOFTLAND_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
                      -fno-sanitize=null,alignment,object-size,vptr)
  add_link_options(-fsanitize=${SOFTLAND_SANITIZE})
endif()
if(SOFTLAND_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# softland_offers(TARGET SCOPE FOLDER): lets TARGET include "FOLDER/...". The root is on no include path, so that a folder can be
# included only by those who name its library: build/views/FOLDER holds a link to it and nothing else.
function(softland_offers target scope folder)
  set(view ${PROJECT_BINARY_DIR}/views/${folder})
  cmake_path(GET folder PARENT_PATH parent)
  file(MAKE_DIRECTORY ${view}/${parent})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${view}/${folder} SYMBOLIC)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${view}>)
endfunction()

# Most of the time of compiling is reading headers and making code of templates, and files compiled as one share both: so all files of
# a folder are one unit, or a few where more than two processors would wait for it. A large unit takes up to 3 GB, and the garbage
# collection of GCC a tenth of the time until it is told that there are: a smaller machine, or container, compiles fewer files as one,
# each such unit in less than 1.3 GB.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY) # [MiB]
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
if(EXISTS /sys/fs/cgroup/memory.max)
  file(READ /sys/fs/cgroup/memory.max limit)
  string(STRIP "${limit}" limit)
  if(limit MATCHES "^[0-9]+$")
    math(EXPR limit "${limit} / 1048576")
    if(limit LESS memory)
      set(memory ${limit})
    endif()
  endif()
endif()
set(SOFTLAND_MEMORY "" CACHE STRING "MiB of memory to compile in, instead of what the machine has")
if(SOFTLAND_MEMORY)
  set(memory ${SOFTLAND_MEMORY})
endif()
set(SOFTLAND_LARGE_UNITS OFF)
if(CMAKE_UNITY_BUILD AND memory GREATER_EQUAL 7600) # 8 GB, less what firmware and kernel keep
  set(SOFTLAND_LARGE_UNITS ON)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(softland_options INTERFACE "SHELL:--param ggc-min-heapsize=1300000") # no option of the code: made_with lists those
  endif()
endif()

# softland_compiled_as(TARGET hot|warm|cold [UNIT files]): to run fast (-O3), to run well (-O1: what goes from closing to closing), or to
# be compiled fast (-Og: text and JSON, of which GCC takes a third less); with so many files in a unit where more than two processors
# compile, all files without.
function(softland_compiled_as target kind)
  cmake_parse_arguments(ARG "" "UNIT" "" ${ARGN})
  if(kind STREQUAL "warm")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  elseif(kind STREQUAL "cold")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
  endif()
  if(SOFTLAND_LARGE_UNITS)
    if(NOT ARG_UNIT OR processors LESS_EQUAL 2)
      set(ARG_UNIT 0)
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${ARG_UNIT})
  endif()
endfunction()

# softland_arrows(FOLDER TARGET USES...): what the tests of arrows read: the folder of a target, and the libraries that it names.
function(softland_arrows folder target)
  list(FILTER ARGN INCLUDE REGEX "^softland_")
  set_property(GLOBAL APPEND PROPERTY SOFTLAND_FOLDERS ${folder})
  set_property(GLOBAL PROPERTY SOFTLAND_TARGET_${folder} ${target})
  set_property(GLOBAL PROPERTY SOFTLAND_USES_${folder} ${ARGN})
  set_property(GLOBAL PROPERTY SOFTLAND_FOLDER_${target} ${folder})
endfunction()

# softland_library(NAME [FOLDER folder] [KIND hot|warm|cold] [UNIT files] SOURCES ... USES ...): a static library of the folder, NAME unless it
# is given, linked only to what it names; hot unless it says how.
function(softland_library name)
  cmake_parse_arguments(ARG "" "FOLDER;KIND;UNIT" "SOURCES;USES" ${ARGN})
  if(NOT ARG_FOLDER)
    set(ARG_FOLDER ${name})
  endif()
  if(NOT ARG_KIND)
    set(ARG_KIND hot)
  endif()
  add_library(softland_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(softland_${name} PUBLIC $<BUILD_INTERFACE:softland_options> ${ARG_USES})
  softland_offers(softland_${name} PUBLIC ${ARG_FOLDER})
  softland_compiled_as(softland_${name} ${ARG_KIND} UNIT ${ARG_UNIT})
  softland_arrows(${ARG_FOLDER} softland_${name} ${ARG_USES})
endfunction()

# softland_joined(LIBRARY OTHERS...): with SOFTLAND_JOINED, the files of OTHERS are compiled as one unit with those of LIBRARY, on which
# OTHERS build: on two processors this takes a third less time than a unit for each, which all read the same headers and make code of the
# same templates. OTHERS stay as libraries without files. Such a unit takes 4 GB.
function(softland_joined library)
  if(NOT SOFTLAND_JOINED OR NOT SOFTLAND_LARGE_UNITS OR memory LESS 11400 OR processors GREATER 2) # 12 GB, less what firmware and kernel keep
    return()
  endif()
  get_target_property(joined_folder ${library} SOURCE_DIR)
  set(none ${PROJECT_BINARY_DIR}/joined.cc)
  file(GENERATE OUTPUT ${none} CONTENT "namespace softland {}\n")
  foreach(other IN LISTS ARGN)
    get_target_property(folder ${other} SOURCE_DIR)
    get_target_property(sources ${other} SOURCES)
    foreach(source IN LISTS sources)
      target_sources(${library} PRIVATE ${folder}/${source})
      foreach(property SKIP_UNITY_BUILD_INCLUSION COMPILE_DEFINITIONS)  # CMake keeps them for each folder that has a target of the file
        get_source_file_property(value ${folder}/${source} TARGET_DIRECTORY ${other} ${property})
        if(value)
          set_property(SOURCE ${folder}/${source} DIRECTORY ${joined_folder} PROPERTY ${property} ${value})
        endif()
      endforeach()
    endforeach()
    set_property(TARGET ${other} PROPERTY SOURCES ${none})
    get_target_property(uses ${other} LINK_LIBRARIES)
    list(FILTER uses EXCLUDE REGEX "softland_options")
    list(REMOVE_ITEM uses ${library} ${ARGN})
    target_link_libraries(${library} PRIVATE ${uses})
    get_property(name GLOBAL PROPERTY SOFTLAND_FOLDER_${other})
    softland_offers(${library} PRIVATE ${name})
  endforeach()
endfunction()
