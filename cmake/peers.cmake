# track_icp and track_pcl: other trackers on the same frames, for comparison. Only where PCL is found; know no ROS.
option(BUILD_PEERS "Build the comparison trackers where PCL is found" ON)
if(NOT BUILD_PEERS OR SANITIZE)
  return()
endif()
# Not PCLConfig.cmake: on Debian it wants VTK and MPI even for the parts that know neither.
find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(PCL QUIET IMPORTED_TARGET pcl_features>=1.10 pcl_registration>=1.10 pcl_tracking>=1.10)
endif()
if(NOT PCL_FOUND)
  message(STATUS "PCL was not found: no comparison trackers (track_icp, track_pcl)")
  return()
endif()

add_executable(track_icp
  src/peers/icp_tracker.cpp
  src/peers/peer_run.cpp
  src/peers/track_icp.cpp
  src/peers/visible_surface.cpp
)
add_executable(track_pcl
  src/peers/mesh_samples.cpp
  src/peers/particle_filter_tracker.cpp
  src/peers/peer_run.cpp
  src/peers/track_pcl.cpp
)
foreach(peer track_icp track_pcl)
  target_link_libraries(${peer} PRIVATE depth_object_tracker_tools depth_object_tracker_warnings PkgConfig::PCL)
  # gcc 12 takes Eigen's cross products of float vectors, inlined from PCL's headers, for reads out of bounds.
  target_compile_options(${peer} PRIVATE -Wno-array-bounds)
endforeach()
