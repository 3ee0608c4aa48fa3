# planbench_rooms([EXCEPT ...]): adds every folder here that has a CMakeLists.txt; their order does not matter.
# planbench_library(NAME SOURCES ... [LINK ...] [PRIVATE_LINK ...]): a static library of one room, target planbench_NAME.
# planbench_program(NAME SOURCES ... [LINK ...]): a program in bin/, which the target planbench_programs builds.
# planbench_planner(NAME SOURCES ... [LINK ...] [PRIVATE_LINK ...]): a planner: the library planbench_planner_NAME, and
#   of it and main.cc the program planner_NAME, which `benchmark_driver --launch` finds by that name.
# planbench_test(NAME SOURCES ... [LINK ...]): a GoogleTest program in tests/, its cases discovered by CTest.
# planbench_embed(OUTPUT FUNCTION HEADER FILES...): the source OUTPUT that defines FUNCTION of HEADER, which returns the
#   files as EmbeddedFile (common/embedded_file.h).
# planbench_benchmark(NAME [LINK ...]): a program in benchmarks/, made of NAME.cc.

add_library(planbench_options INTERFACE)
target_include_directories(planbench_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/planbench>)
target_compile_options(planbench_options INTERFACE "$<BUILD_INTERFACE:-Wall;-Wextra>" -Wno-psabi)
target_link_libraries(planbench_options INTERFACE Eigen3::Eigen fmt::fmt)
if(PLANBENCH_WERROR)
  target_compile_options(planbench_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(PLANBENCH_SANITIZE)
  target_compile_options(planbench_options INTERFACE
    -fsanitize=${PLANBENCH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(planbench_options INTERFACE -fsanitize=${PLANBENCH_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 takes members of std::regex for uninitialised where a sanitizer's code stands in between.
    target_compile_options(planbench_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# The headers that most files use take longer than what the files themselves say, so they are compiled once. No file
# relies on it: the preset dev goes without.
set(common_headers <algorithm> <cmath> <filesystem> <fstream> <functional> <map> <memory> <mutex> <optional> <random>
    <set> <span> <string> <thread> <vector> <Eigen/Geometry> <fmt/format.h> <fmt/ranges.h>)
function(planbench_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK" ${ARGN})
  if(PLANBENCH_PRECOMPILE)
    file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc CONTENT "")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
    target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  endif()
endfunction()
function(planbench_reuse target precompiled)
  if(PLANBENCH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
endfunction()

# What ./run needs, without the tests.
add_custom_target(planbench_programs)

function(planbench_rooms)
  cmake_parse_arguments(ARG "" "" "EXCEPT" ${ARGN})
  file(GLOB lists RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS */CMakeLists.txt)
  foreach(list ${lists})
    get_filename_component(room ${list} DIRECTORY)
    if(NOT room IN_LIST ARG_EXCEPT)
      add_subdirectory(${room})
    endif()
  endforeach()
endfunction()

function(planbench_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(planbench_${name} STATIC ${ARG_SOURCES})
  # clang-tidy reads the rooms before anything is generated.
  set(generated ${ARG_SOURCES})
  list(FILTER generated INCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  set_source_files_properties(${generated} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(planbench_${name} PUBLIC planbench_options ${ARG_LINK}
                                          PRIVATE ${ARG_PRIVATE_LINK})
  planbench_reuse(planbench_${name} planbench_headers)
endfunction()

function(planbench_embed output function header)
  list(JOIN ARGN "|" files)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${header} -DFUNCTION=${function} "-DFILES=${files}"
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    VERBATIM)
endfunction()

function(planbench_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK})
  planbench_reuse(${name} planbench_headers)
  add_dependencies(planbench_programs ${name})
  # Beside each other, where they find each other; the names to call are planbench-NAME, for /usr/bin has a logger.
  install(TARGETS ${name} DESTINATION lib/planbench)
  string(REPLACE "_" "-" link "planbench-${name}")
  install(CODE "set(folder \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/bin)
file(MAKE_DIRECTORY \${folder})
file(CREATE_LINK ../lib/planbench/${name} \${folder}/${link} SYMBOLIC)")
endfunction()

function(planbench_planner name)
  planbench_library(planner_${name} ${ARGN})
  target_link_libraries(planbench_planner_${name} PUBLIC planbench_planning)
  planbench_program(planner_${name}
    SOURCES main.cc
    LINK planbench_planner_${name} planbench_messaging)
endfunction()

function(planbench_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK} GTest::gtest GTest::gmock
                                        GTest::gtest_main)
  planbench_reuse(${name} planbench_test_headers)
  target_compile_definitions(${name} PRIVATE
    PLANBENCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    PLANBENCH_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()

function(planbench_benchmark name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(${name} ${name}.cc)
  target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK})
  target_compile_definitions(${name} PRIVATE PLANBENCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/benchmarks)
endfunction()
