# Tests of the fiducial tracker; know no ROS.
if(NOT WITH_FIDUCIALS)
  return()
endif()

add_tracker_test(fiducials_test
  SOURCES
    ${CMAKE_CURRENT_LIST_DIR}/fiducial_map_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/fiducial_points_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/fiducial_pose_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/fiducial_tracker_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/pose_kalman_filter_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/tag_detector_test.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_fiducials GTest::gmock)
