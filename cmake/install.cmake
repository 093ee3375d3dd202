# What is installed: a catkin install space with the ROS layer, a plain one without.
if(WITH_ROS)
  install(TARGETS
    depth_object_tracker_core
    depth_object_tracker_nodelets
    depth_object_tracker_ros
    depth_object_tracker_ros_simulator
    depth_object_tracker_simulator
    depth_object_tracker_tools
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  install(TARGETS demo_monitor scene_to_bag simulate_scene simulator_node track_sequence tracker_node
    RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  if(TARGET depth_object_tracker_camera)
    install(TARGETS depth_object_tracker_camera depth_object_tracker_camera_nodelets depth_object_tracker_ros_camera
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
    install(TARGETS openni2_camera_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
  catkin_install_python(PROGRAMS scripts/benchmark_sequences scripts/plot_benchmark scripts/play_bag
    DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
  install(DIRECTORY config launch meshes rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
else()
  #catkin_lint: skip
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
  if(TARGET depth_object_tracker_camera)
    install(TARGETS depth_object_tracker_camera LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
  install(PROGRAMS scripts/benchmark_sequences scripts/plot_benchmark DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY include/${PROJECT_NAME} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN ros EXCLUDE)
  install(DIRECTORY config meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})
endif()
