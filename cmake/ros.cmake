# The ROS 1 layer: library, nodelets and nodes. cmake/catkin.cmake has found what it needs.
if(NOT WITH_ROS)
  return()
endif()

add_library(depth_object_tracker_ros SHARED
  src/ros/camera_conversions.cpp
  src/ros/camera_info_matcher.cpp
  src/ros/drop_watch.cpp
  src/ros/frame_inbox.cpp
  src/ros/frame_lookup.cpp
  src/ros/hand_messages.cpp
  src/ros/held_motion.cpp
  src/ros/image_conversions.cpp
  src/ros/initial_pose_marker.cpp
  src/ros/initial_pose_resolver.cpp
  src/ros/live_reconfigure.cpp
  src/ros/manager_watch.cpp
  src/ros/marker_builder.cpp
  src/ros/message_conversions.cpp
  src/ros/object_source.cpp
  src/ros/overlay.cpp
  src/ros/parameter_loader.cpp
  src/ros/particle_messages.cpp
  src/ros/pose_memory.cpp
  src/ros/pose_messages.cpp
  src/ros/pose_validation.cpp
  src/ros/rate_meter.cpp
  src/ros/result_publisher.cpp
  src/ros/robot_connection.cpp
  src/ros/robot_options.cpp
  src/ros/self_check.cpp
  src/ros/status_builder.cpp
  src/ros/status_reason.cpp
  src/ros/tracker_diagnostics.cpp
  src/ros/tracker_nodelet.cpp
  src/ros/tracker_services.cpp
  src/ros/tracker_session.cpp
  src/ros/tracker_worker.cpp
  src/ros/transform_feed.cpp)
target_include_directories(depth_object_tracker_ros PUBLIC include)
#catkin_lint: ignore_once external_interface_path external_include_path
# SYSTEM: warnings in the headers of other packages are not ours to mend.
target_include_directories(depth_object_tracker_ros SYSTEM PUBLIC ${catkin_INCLUDE_DIRS})
target_link_libraries(depth_object_tracker_ros
  PUBLIC depth_object_tracker_robot ${catkin_LIBRARIES}
  PRIVATE depth_object_tracker_warnings nlohmann_json::nlohmann_json)
precompile_headers(depth_object_tracker_ros ${ROS_HEADERS})
add_dependencies(depth_object_tracker_ros mesh_reader ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})

# The plugins, apart from the classes so that tests and plain nodes can link those.
add_library(depth_object_tracker_nodelets SHARED src/ros/tracker_plugin.cpp)
target_link_libraries(depth_object_tracker_nodelets PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)

# What track.launch loads the tracker with.
add_executable(load_nodelet src/ros/load_nodelet_node.cpp)
target_link_libraries(load_nodelet PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)
add_dependencies(depth_object_tracker_nodelets load_nodelet)

add_executable(pose_marker src/ros/pose_marker_node.cpp)
target_link_libraries(pose_marker PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)

add_executable(tracker_node src/ros/tracker_node.cpp)
target_link_libraries(tracker_node PRIVATE depth_object_tracker_ros depth_object_tracker_warnings)
