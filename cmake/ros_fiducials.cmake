# The fiducial tracker's nodelet and node.
if(NOT WITH_ROS OR NOT WITH_FIDUCIALS)
  return()
endif()

add_library(depth_object_tracker_ros_fiducials SHARED
  src/ros/fiducial_options.cpp
  src/ros/fiducial_tracker_nodelet.cpp
  src/ros/gray_conversions.cpp
)
target_link_libraries(depth_object_tracker_ros_fiducials
  PUBLIC depth_object_tracker_ros depth_object_tracker_fiducials
  PRIVATE depth_object_tracker_warnings)

add_library(depth_object_tracker_fiducial_nodelets SHARED src/ros/fiducial_tracker_plugin.cpp)
target_link_libraries(depth_object_tracker_fiducial_nodelets
  PRIVATE depth_object_tracker_ros_fiducials depth_object_tracker_warnings)

add_executable(fiducial_tracker_node src/ros/fiducial_tracker_node.cpp)
target_link_libraries(fiducial_tracker_node PRIVATE depth_object_tracker_ros_fiducials depth_object_tracker_warnings)
