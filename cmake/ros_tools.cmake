# Command-line programs that need ROS.
add_executable(scene_to_bag src/tools/scene_to_bag.cpp src/tools/scene_bag_writer.cpp)
target_include_directories(scene_to_bag SYSTEM PRIVATE ${catkin_INCLUDE_DIRS} ${CATKIN_DEVEL_PREFIX}/include)
target_link_libraries(scene_to_bag
  PRIVATE depth_object_tracker_tools depth_object_tracker_warnings CLI11::CLI11 ${catkin_LIBRARIES})
add_dependencies(scene_to_bag ${${PROJECT_NAME}_EXPORTED_TARGETS})
list(APPEND ROS_INSTALL_TARGETS scene_to_bag)

catkin_install_python(PROGRAMS scripts/benchmark_sequences scripts/play_bag
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
