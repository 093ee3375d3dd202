# Tests of the simulated depth camera.
add_tracker_test(noise_statistics_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/noise_statistics_test.cpp ${CMAKE_CURRENT_LIST_DIR}/noise_statistics.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)
add_tracker_test(simulator_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/depth_sensor_test.cpp ${CMAKE_CURRENT_LIST_DIR}/hand_shapes_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/scene_simulator_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_writer_test.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)

if(NOT TARGET depth_object_tracker_ros_simulator)
  return()
endif()

add_tracker_test(simulator_monitor_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/simulator_monitor_test.cpp
  LIBRARIES depth_object_tracker_ros_simulator)

find_program(ROSTEST_PROGRAM rostest)
if(ROSTEST_PROGRAM)
  add_executable(demo_rostest ${CMAKE_CURRENT_LIST_DIR}/demo_rostest.cpp)
  target_link_libraries(demo_rostest PRIVATE depth_object_tracker_ros_simulator depth_object_tracker_warnings GTest::gtest)
  add_dependencies(demo_rostest depth_object_tracker_nodelets demo_monitor)
  add_test(NAME demo_rostest
    COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh rostest ${CMAKE_CURRENT_LIST_DIR}/demo_rostest.test)
  set_tests_properties(demo_rostest PROPERTIES TIMEOUT 300 RUN_SERIAL TRUE
    ENVIRONMENT "PATH=/usr/bin:$ENV{PATH};ROS_HOME=${CMAKE_BINARY_DIR}/ros_home;ROS_HOSTNAME=localhost")
endif()
