# Tests of the ROS layer. Those named *_rostest need a master; ctest runs them through rostest in the devel space's environment.
if(NOT TARGET depth_object_tracker_ros)
  return()
endif()

add_tracker_test(ros_conversions_test
  SOURCES ros/image_conversions_test.cpp ros/camera_conversions_test.cpp ros/pose_validation_test.cpp ros/object_source_test.cpp
          ros/overlay_test.cpp
  LIBRARIES depth_object_tracker_ros)
add_tracker_test(ros_inputs_test
  SOURCES ros/camera_info_matcher_test.cpp ros/frame_inbox_test.cpp ros/parameter_loader_test.cpp ros/pose_memory_test.cpp
          ros/tracker_diagnostics_test.cpp
          ros/twist_buffer_test.cpp
  LIBRARIES depth_object_tracker_ros)
add_tracker_test(tracker_session_test SOURCES ros/tracker_session_test.cpp LIBRARIES depth_object_tracker_ros)
add_tracker_test(moving_camera_test SOURCES ros/moving_camera_test.cpp LIBRARIES depth_object_tracker_ros)

add_tracker_test(robot_session_test SOURCES ros/robot_session_test.cpp LIBRARIES depth_object_tracker_ros)

# add_ros_test(NAME SOURCES...): a gtest program, and the test file NAME.test that starts it with a master of its own.
function(add_ros_test name)
  if(ARGN)
    add_executable(${name} ${ARGN})
    target_link_libraries(${name} PRIVATE depth_object_tracker_ros depth_object_tracker_warnings GTest::gtest)
    target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/support)
    target_compile_definitions(${name} PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
    add_dependencies(${name} depth_object_tracker_nodelets)
  endif()
  add_test(NAME ${name}
    COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh rostest ${CMAKE_CURRENT_SOURCE_DIR}/ros/${name}.test)
  set_tests_properties(${name} PROPERTIES TIMEOUT 600
    ENVIRONMENT "PATH=/usr/bin:$ENV{PATH};ROS_HOME=${CMAKE_BINARY_DIR}/ros_home;ROS_HOSTNAME=localhost")
endfunction()

# add_script_test(NAME COMMAND...): a program that needs the devel space but no master.
function(add_script_test name)
  add_test(NAME ${name} COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh ${ARGN})
  set_tests_properties(${name} PROPERTIES TIMEOUT 120
    ENVIRONMENT "PATH=/usr/bin:$ENV{PATH};ROS_HOME=${CMAKE_BINARY_DIR}/ros_home;ROS_HOSTNAME=localhost")
endfunction()

add_script_test(launch_files_test
  ${CMAKE_CURRENT_SOURCE_DIR}/ros/check_launch_files.py ${PROJECT_SOURCE_DIR}/launch ${PROJECT_SOURCE_DIR}/README.md)

find_program(ROSTEST_PROGRAM rostest)
if(ROSTEST_PROGRAM)
  add_ros_test(initial_pose_rostest ros/initial_pose_rostest.cpp)
  add_ros_test(live_reconfigure_rostest ros/live_reconfigure_rostest.cpp)
  add_ros_test(robot_rostest ros/robot_rostest.cpp)
  add_ros_test(output_frames_rostest ros/output_frames_rostest.cpp)
  add_ros_test(tracker_bad_input_rostest ros/tracker_bad_input_rostest.cpp)
  add_ros_test(tracker_bad_start_rostest ros/tracker_bad_start_rostest.cpp)
  add_ros_test(tracker_diagnostics_rostest ros/tracker_diagnostics_rostest.cpp)
  add_ros_test(tracker_outputs_rostest ros/tracker_outputs_rostest.cpp)
  add_ros_test(tracker_overload_rostest ros/tracker_overload_rostest.cpp)
  add_ros_test(tracker_services_rostest ros/tracker_services_rostest.cpp)
  add_ros_test(zero_copy_rostest ros/zero_copy_rostest.cpp)
  if(WITH_RVIZ_PANEL)
    add_ros_test(tracker_panel_rostest ros/tracker_panel_rostest.cpp)
    target_link_libraries(tracker_panel_rostest PRIVATE depth_object_tracker_rviz)
    target_compile_definitions(tracker_panel_rostest PRIVATE QT_NO_KEYWORDS)
  endif()
  add_ros_test(track_launch_rostest)
  add_ros_test(tracker_node_rostest)
  add_ros_test(demo_rostest ros/demo_rostest.cpp)
  target_link_libraries(demo_rostest PRIVATE depth_object_tracker_ros_simulator)
  add_dependencies(demo_rostest demo_monitor)
  set_tests_properties(demo_rostest PROPERTIES RUN_SERIAL TRUE)
  add_ros_test(demo_robot_rostest ros/demo_robot_rostest.cpp)
  target_link_libraries(demo_robot_rostest PRIVATE depth_object_tracker_ros_simulator)
  add_dependencies(demo_robot_rostest demo_monitor)
  set_tests_properties(demo_robot_rostest PROPERTIES RUN_SERIAL TRUE)
else()
  message(STATUS "rostest not found: the tests that need a ROS master are left out")
endif()
