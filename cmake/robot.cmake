# depth_object_tracker_robot: a robot's kinematics from its URDF. Knows no ROS; kdl_parser alone comes from there.
set(WITH_ROBOT OFF)
find_package(urdfdom QUIET)
find_package(orocos_kdl QUIET)
find_path(KDL_PARSER_INCLUDE_DIR kdl_parser/kdl_parser.hpp PATHS /opt/ros/noetic/include)
find_library(KDL_PARSER_LIBRARY kdl_parser PATHS /opt/ros/noetic/lib)
if(urdfdom_FOUND AND orocos_kdl_FOUND AND KDL_PARSER_INCLUDE_DIR AND KDL_PARSER_LIBRARY)
  set(WITH_ROBOT ON)
elseif(WITH_ROS)
  message(FATAL_ERROR "The ROS layer needs urdfdom, orocos_kdl and kdl_parser (liburdfdom-dev, liborocos-kdl-dev, libkdl-parser-dev)")
else()
  message(STATUS "depth_object_tracker: without robot kinematics; urdfdom, orocos_kdl or kdl_parser was not found")
  return()
endif()

add_library(depth_object_tracker_robot SHARED
  src/robot/arm_solver.cpp
  src/robot/grasp_detector.cpp
  src/robot/hand_motion.cpp
  src/robot/joint_state_buffer.cpp
  src/robot/kinematic_correction.cpp
  src/robot/link_chain.cpp
  src/robot/link_meshes.cpp
  src/robot/robot_model.cpp
  src/robot/robot_occluder.cpp
  src/robot/robot_state.cpp
  src/robot/twist_buffer.cpp
)
#catkin_lint: ignore_once external_interface_path external_include_path
# SYSTEM: warnings in the headers of other packages are not ours to mend.
target_include_directories(depth_object_tracker_robot SYSTEM
  PUBLIC ${urdfdom_headers_INCLUDE_DIRS} ${orocos_kdl_INCLUDE_DIRS}
  PRIVATE ${KDL_PARSER_INCLUDE_DIR} ${urdfdom_INCLUDE_DIRS})
target_link_libraries(depth_object_tracker_robot
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings ${urdfdom_LIBRARIES} ${orocos_kdl_LIBRARIES} ${KDL_PARSER_LIBRARY})
precompile_headers(depth_object_tracker_robot ${CORE_HEADERS})
count_lines(depth_object_tracker_robot)
