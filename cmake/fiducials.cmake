# depth_object_tracker_fiducials: AprilTags on the object, the paper's comparison method. Only where libapriltag is found;
# knows no ROS.
find_path(APRILTAG_INCLUDE_DIR apriltag/apriltag.h PATHS /opt/ros/noetic/include)
find_library(APRILTAG_LIBRARY apriltag PATHS /opt/ros/noetic/lib)
set(WITH_FIDUCIALS OFF)
if(NOT APRILTAG_INCLUDE_DIR OR NOT APRILTAG_LIBRARY)
  message(STATUS "depth_object_tracker: without fiducials; libapriltag (libapriltag-dev) was not found")
  return()
endif()
set(WITH_FIDUCIALS ON)

add_library(depth_object_tracker_fiducials SHARED
  src/fiducials/fiducial_map.cpp
  src/fiducials/fiducial_points.cpp
  src/fiducials/fiducial_pose.cpp
  src/fiducials/fiducial_tracker.cpp
  src/fiducials/pose_kalman_filter.cpp
  src/fiducials/tag_detector.cpp
)
#catkin_lint: ignore_once external_interface_path external_include_path
target_include_directories(depth_object_tracker_fiducials SYSTEM PRIVATE ${APRILTAG_INCLUDE_DIR})
target_link_libraries(depth_object_tracker_fiducials
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings yaml-cpp ${APRILTAG_LIBRARY})
