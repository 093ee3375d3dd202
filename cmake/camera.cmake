# depth_object_tracker_camera: depth cameras and .oni recordings through OpenNI2; knows no ROS. Optional.
find_path(OPENNI2_INCLUDE_DIR OpenNI.h PATH_SUFFIXES openni2)
find_library(OPENNI2_LIBRARY OpenNI2)
mark_as_advanced(OPENNI2_INCLUDE_DIR OPENNI2_LIBRARY)
if(NOT OPENNI2_INCLUDE_DIR OR NOT OPENNI2_LIBRARY)
  message(STATUS "depth_object_tracker: OpenNI2 (libopenni2-dev) was not found: without the OpenNI2Camera nodelet")
  return()
endif()

add_library(depth_object_tracker_camera SHARED
  src/camera/depth_camera.cpp
  src/camera/depth_camera_options.cpp
  src/camera/depth_frame.cpp
  src/camera/device_clock.cpp
  src/camera/device_finder.cpp
  src/camera/openni2_device.cpp
  src/camera/openni2_runtime.cpp
)
target_include_directories(depth_object_tracker_camera
  PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/cmake/no_ros
  PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
target_include_directories(depth_object_tracker_camera SYSTEM PRIVATE ${OPENNI2_INCLUDE_DIR})
target_link_libraries(depth_object_tracker_camera
  PUBLIC Threads::Threads
  PRIVATE depth_object_tracker_warnings ${OPENNI2_LIBRARY})
