# The OpenNI2 camera's nodelet and node, in a library of their own: the tracker does without OpenNI2.
if(NOT WITH_ROS OR NOT TARGET depth_object_tracker_camera)
  return()
endif()

add_library(depth_object_tracker_ros_camera SHARED
  src/ros/openni2_camera_nodelet.cpp
  src/ros/openni2_camera_options.cpp
  src/ros/openni2_camera_publisher.cpp
)
target_link_libraries(depth_object_tracker_ros_camera
  PUBLIC depth_object_tracker_ros depth_object_tracker_camera
  PRIVATE depth_object_tracker_warnings)
add_dependencies(depth_object_tracker_ros_camera ${PROJECT_NAME}_gencfg)

add_library(depth_object_tracker_camera_nodelets SHARED src/ros/openni2_camera_plugin.cpp)
target_link_libraries(depth_object_tracker_camera_nodelets
  PRIVATE depth_object_tracker_ros_camera depth_object_tracker_warnings)

add_executable(openni2_camera_node src/ros/openni2_camera_node.cpp)
target_link_libraries(openni2_camera_node PRIVATE depth_object_tracker_ros_camera depth_object_tracker_warnings)
