# Tests of the ROS layer. Those named *_rostest need a master; ctest runs them through rostest in the devel space's environment.
if(NOT TARGET depth_object_tracker_ros)
  return()
endif()

add_tracker_test(ros_conversions_test
  SOURCES ros/image_conversions_test.cpp ros/camera_conversions_test.cpp ros/pose_validation_test.cpp ros/object_source_test.cpp
          ros/lying_messages_test.cpp ros/overlay_test.cpp
  LIBRARIES depth_object_tracker_ros)
add_tracker_test(ros_inputs_test
  SOURCES ros/camera_info_matcher_test.cpp ros/frame_inbox_test.cpp ros/parameter_loader_test.cpp ros/pose_memory_test.cpp
          ros/tracker_diagnostics_test.cpp
          ros/throttled_log_test.cpp ros/twist_buffer_test.cpp
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
  set_ros_test(${name} 600)
endfunction()

# add_script_test(NAME COMMAND...): a program that needs the devel space but no master.
function(add_script_test name)
  add_test(NAME ${name} COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh ${ARGN})
  set_ros_test(${name} 300)
endfunction()

add_script_test(launch_files_test
  ${CMAKE_CURRENT_SOURCE_DIR}/ros/check_launch_files.py ${PROJECT_SOURCE_DIR}/launch ${PROJECT_SOURCE_DIR}/README.md)

add_script_test(object_list_test /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/ros/check_object_list.py)
add_executable(master_loss_test ros/master_loss_test.cpp)
target_link_libraries(master_loss_test PRIVATE depth_object_tracker_ros depth_object_tracker_warnings GTest::gtest)
target_include_directories(master_loss_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_compile_definitions(master_loss_test PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
add_script_test(tracker_outlives_the_master ${CMAKE_CURRENT_SOURCE_DIR}/ros/check_master_loss.py
  $<TARGET_FILE:tracker_node> $<TARGET_FILE:master_loss_test> ${PROJECT_SOURCE_DIR}/meshes/bracket.obj)
set_ros_test(tracker_outlives_the_master 400)

find_program(ROSTEST_PROGRAM rostest)
if(ROSTEST_PROGRAM)
  add_ros_test(initial_pose_rostest ros/initial_pose_rostest.cpp)
  add_ros_test(live_reconfigure_rostest ros/live_reconfigure_rostest.cpp)
  add_ros_test(robot_rostest ros/robot_rostest.cpp)
  add_ros_test(robot_inputs_rostest ros/robot_inputs_rostest.cpp)
  add_ros_test(output_frames_rostest ros/output_frames_rostest.cpp)
  add_ros_test(tracker_bad_input_rostest ros/tracker_bad_input_rostest.cpp)
  add_executable(test_fault_injector ros/fault_injector_node.cpp)
  target_link_libraries(test_fault_injector PRIVATE depth_object_tracker_warnings depth_object_tracker_ros)
  add_ros_test(fault_injection_rostest ros/fault_injection_rostest.cpp)
  add_dependencies(fault_injection_rostest test_fault_injector)
  set_ros_test(fault_injection_rostest 1000)
  add_ros_test(tracker_bad_start_rostest ros/tracker_bad_start_rostest.cpp)
  add_ros_test(tracker_diagnostics_rostest ros/tracker_diagnostics_rostest.cpp)
  add_ros_test(tracker_options_rostest ros/tracker_options_rostest.cpp)
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
  add_ros_test(many_objects_rostest ros/many_objects_rostest.cpp)
  target_link_libraries(many_objects_rostest PRIVATE depth_object_tracker_simulator)
  set_tests_properties(many_objects_rostest PROPERTIES RUN_SERIAL TRUE)
  add_ros_test(track_respawn_rostest ros/track_respawn_rostest.cpp)
  add_ros_test(many_search_rostest ros/many_search_rostest.cpp)
  target_link_libraries(many_search_rostest PRIVATE depth_object_tracker_simulator)
  add_ros_test(load_cycles_rostest ros/load_cycles_rostest.cpp)
  set_ros_test(load_cycles_rostest 1000)
  add_ros_test(relay_joint_commands_rostest)
  if(WITH_FIDUCIALS)
    add_ros_test(fiducial_tracker_rostest ros/fiducial_tracker_rostest.cpp)
    add_dependencies(fiducial_tracker_rostest depth_object_tracker_fiducial_nodelets)
  endif()
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
