# What is installed without the ROS layer; cmake/ros.cmake installs all of it where the layer is built.
if(WITH_ROS)
  return()
endif()
include(GNUInstallDirs)
install(TARGETS
  depth_object_tracker_core
  depth_object_tracker_simulator
  depth_object_tracker_tools
  simulate_scene
  track_sequence
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(PROGRAMS scripts/benchmark_sequences DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/${PROJECT_NAME} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN ros EXCLUDE)
install(DIRECTORY config meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})
