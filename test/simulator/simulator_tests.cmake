# Tests of the simulated depth camera.
add_tracker_test(noise_statistics_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/noise_statistics_test.cpp ${CMAKE_CURRENT_LIST_DIR}/noise_statistics.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)
