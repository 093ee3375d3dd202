# PRECOMPILE_HEADERS: other packages' headers are read once for each library and once for all tests. Off by default, so that a
# missing include shows. scripts/test takes ROS: a build without ROS then shares the core's objects through ccache, which needs
# CCACHE_SLOPPINESS=pch_defines,time_macros.
set(PRECOMPILE_HEADERS OFF CACHE STRING "Precompile other packages' headers: OFF, ROS (for the ROS layer alone) or ALL")
set_property(CACHE PRECOMPILE_HEADERS PROPERTY STRINGS OFF ROS ALL)

set(CORE_HEADERS <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky> <Eigen/Eigenvalues>
  <algorithm> <cmath> <functional> <memory> <optional> <sstream> <stdexcept> <string> <vector>)
set(ROS_HEADERS ${CORE_HEADERS} <chrono> <mutex> <thread> <boost/make_shared.hpp> <ros/ros.h> <geometry_msgs/PoseWithCovarianceStamped.h>
  <geometry_msgs/TwistStamped.h> <sensor_msgs/CameraInfo.h> <sensor_msgs/Image.h> <sensor_msgs/JointState.h> <tf2/buffer_core.h>)
set(TEST_HEADERS ${CORE_HEADERS} <gtest/gtest.h>)

# precompile_headers(TARGET HEADERS...)
function(precompile_headers target)
  if(PRECOMPILE_HEADERS STREQUAL "ALL" OR (PRECOMPILE_HEADERS STREQUAL "ROS" AND target STREQUAL "depth_object_tracker_ros"))
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# share_precompiled_headers(TARGET OWNER HEADERS...): the owner, a program that is never linked, is made by the first call.
function(share_precompiled_headers target owner)
  if(NOT PRECOMPILE_HEADERS STREQUAL "ALL")
    return()
  endif()
  if(NOT TARGET ${owner})
    file(WRITE ${CMAKE_BINARY_DIR}/${owner}.cpp "int main() {}\n")
    add_executable(${owner} EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/${owner}.cpp)
    target_link_libraries(${owner} PRIVATE depth_object_tracker_core depth_object_tracker_warnings GTest::gtest)
    target_precompile_headers(${owner} PRIVATE ${ARGN})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
