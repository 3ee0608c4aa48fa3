# Finds LCM 1.3.1 (Debian 12: headers and library, no CMake package) and newer ones.
# Defines LCM::lcm, LCM_GEN (the code generator) and LCM_VERSION.
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
find_library(LCM_LIBRARY lcm)
find_program(LCM_GEN lcm-gen)
if(LCM_INCLUDE_DIR AND EXISTS ${LCM_INCLUDE_DIR}/lcm/lcm_version.h)
  file(STRINGS ${LCM_INCLUDE_DIR}/lcm/lcm_version.h lcm_version_lines REGEX "define LCM_.*VERSION")
  string(REGEX MATCHALL "[0-9]+" lcm_version_parts "${lcm_version_lines}")
  list(JOIN lcm_version_parts "." LCM_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR LCM_GEN)
if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES
    IMPORTED_LOCATION ${LCM_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)
