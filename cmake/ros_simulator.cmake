# The simulator's nodelet and node; the monitor that compares the tracker with its ground truth.
if(NOT WITH_ROS)
  return()
endif()

add_library(depth_object_tracker_ros_simulator SHARED
  src/ros/simulator_joints.cpp
  src/ros/simulator_monitor.cpp
  src/ros/simulator_nodelet.cpp
  src/ros/simulator_options.cpp
  src/ros/simulator_publisher.cpp
)
target_link_libraries(depth_object_tracker_ros_simulator
  PUBLIC depth_object_tracker_ros depth_object_tracker_simulator
  PRIVATE depth_object_tracker_warnings)

target_sources(depth_object_tracker_nodelets PRIVATE src/ros/simulator_plugin.cpp)
target_link_libraries(depth_object_tracker_nodelets PRIVATE depth_object_tracker_ros_simulator)

add_executable(simulator_node src/ros/simulator_node.cpp)
target_link_libraries(simulator_node PRIVATE depth_object_tracker_ros_simulator depth_object_tracker_warnings)

add_executable(demo_monitor src/ros/simulator_monitor_node.cpp)
target_link_libraries(demo_monitor PRIVATE depth_object_tracker_ros_simulator depth_object_tracker_warnings)
