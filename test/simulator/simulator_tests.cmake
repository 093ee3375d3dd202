# Tests of the simulated depth camera.
add_tracker_test(noise_statistics_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/noise_statistics_test.cpp ${CMAKE_CURRENT_LIST_DIR}/noise_statistics.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)
add_tracker_test(simulator_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/depth_sensor_test.cpp ${CMAKE_CURRENT_LIST_DIR}/hand_shapes_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/scene_simulator_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scene_writer_test.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)

if(TARGET depth_object_tracker_robot)
  add_tracker_test(robot_arm_test
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/robot_arm_test.cpp
    LIBRARIES depth_object_tracker_simulator)
endif()

if(NOT TARGET depth_object_tracker_ros_simulator)
  return()
endif()

add_tracker_test(simulator_monitor_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/simulator_monitor_test.cpp
  LIBRARIES depth_object_tracker_ros_simulator)
