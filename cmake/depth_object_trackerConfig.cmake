# find_package(depth_object_tracker) of an install without ROS: the core. With ROS catkin makes its own.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/depth_object_tracker_targets.cmake)
set(depth_object_tracker_LIBRARIES depth_object_tracker_core)
set(depth_object_tracker_INCLUDE_DIRS "")  # the target brings them
