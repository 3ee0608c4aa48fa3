# planbench_library(NAME SOURCES ... [LINK ...]): a static library of one room, target planbench_NAME.
# planbench_program(NAME SOURCES ... [LINK ...]): a program in bin/.
# planbench_test(NAME SOURCES ... [LINK ...]): a GoogleTest program, its cases discovered by CTest.

add_library(planbench_options INTERFACE)
target_include_directories(planbench_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(planbench_options INTERFACE -Wall -Wextra -Wno-psabi)
if(PLANBENCH_WERROR)
  target_compile_options(planbench_options INTERFACE -Werror)
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

function(planbench_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(planbench_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(planbench_${name} PUBLIC planbench_options ${ARG_LINK}
                                          PRIVATE ${ARG_PRIVATE_LINK})
endfunction()

function(planbench_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK})
endfunction()

function(planbench_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE planbench_options ${ARG_LINK} GTest::gtest GTest::gmock
                                        GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    PLANBENCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    PLANBENCH_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT})
endfunction()
