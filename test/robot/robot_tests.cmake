# Tests of the robot's kinematics; know no ROS.
if(NOT TARGET depth_object_tracker_robot)
  return()
endif()

add_tracker_test(robot_test
  SOURCES
    ${CMAKE_CURRENT_LIST_DIR}/grasp_detector_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/hand_motion_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/joint_state_buffer_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/kinematic_correction_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/link_meshes_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/robot_model_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/robot_state_test.cpp
  LIBRARIES depth_object_tracker_robot tinyxml2)
