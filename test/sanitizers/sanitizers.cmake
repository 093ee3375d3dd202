# In a build with a sanitizer the launch files' managers have it too: roslaunch finds the devel space's program `nodelet` before
# Debian's.
if(SANITIZE AND TARGET depth_object_tracker_ros)
  #catkin_lint: skip
  # Beside share/nodelet/cmake, or Debian's lib/ARCHITECTURE/cmake/nodelet.
  find_program(SYSTEM_NODELET_PROGRAM nodelet
    PATHS ${nodelet_DIR}/../../../lib/nodelet ${nodelet_DIR}/../../../nodelet NO_DEFAULT_PATH)
  if(NOT SYSTEM_NODELET_PROGRAM)
    message(FATAL_ERROR "the program nodelet of the package nodelet is not near ${nodelet_DIR}")
  endif()
  add_executable(sanitized_nodelet_manager sanitizers/nodelet_manager.cpp sanitizers/keep_libraries.cpp)
  target_link_libraries(sanitized_nodelet_manager PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)
  target_compile_definitions(sanitized_nodelet_manager PRIVATE SYSTEM_NODELET_PROGRAM="${SYSTEM_NODELET_PROGRAM}")
  set_target_properties(sanitized_nodelet_manager PROPERTIES
    ENABLE_EXPORTS ON OUTPUT_NAME nodelet RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/nodelet)
endif()
