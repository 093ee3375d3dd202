# Command-line programs that need ROS.
if(NOT WITH_ROS)
  return()
endif()

add_executable(scene_to_bag src/tools/scene_bag_writer.cpp src/tools/scene_to_bag.cpp)
target_include_directories(scene_to_bag SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(scene_to_bag
  PRIVATE depth_object_tracker_tools depth_object_tracker_warnings CLI11::CLI11 ${catkin_LIBRARIES})
add_dependencies(scene_to_bag ${${PROJECT_NAME}_EXPORTED_TARGETS})

add_executable(track_bag
  src/tools/bag_recording.cpp
  src/tools/bag_tracker.cpp
  src/tools/result_bag.cpp
  src/tools/track_bag.cpp
  src/tools/track_bag_options.cpp)
target_link_libraries(track_bag
  PRIVATE depth_object_tracker_ros depth_object_tracker_tools depth_object_tracker_warnings CLI11::CLI11)
