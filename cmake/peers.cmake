# track_icp and track_pcl: other trackers on the same frames, for comparison. Only where PCL is found; know no ROS.
option(BUILD_PEERS "Build the comparison trackers where PCL is found" ON)
if(NOT BUILD_PEERS OR SANITIZE)
  return()
endif()
# Not PCLConfig.cmake: on Debian it wants VTK and MPI even for the parts that know neither. Of pkg-config only the include
# folders: it would link HDF5 and MPI.
find_package(PkgConfig QUIET)
find_package(OpenMP QUIET COMPONENTS CXX)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(PCL QUIET pcl_features>=1.10 pcl_registration>=1.10 pcl_tracking>=1.10)
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
  target_include_directories(${peer} SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
  target_link_libraries(${peer} PRIVATE depth_object_tracker_tools depth_object_tracker_warnings
    pcl_registration pcl_tracking pcl_features pcl_filters pcl_search pcl_kdtree pcl_octree pcl_common)
  # gcc 12 takes Eigen's cross products of float vectors, inlined from PCL's headers, for reads out of bounds.
  target_compile_options(${peer} PRIVATE -Wno-array-bounds)
  if(OpenMP_CXX_FOUND)
    target_link_libraries(${peer} PRIVATE OpenMP::OpenMP_CXX)
  endif()
endforeach()
