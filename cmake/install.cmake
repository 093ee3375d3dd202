# What is installed: a catkin install space with the ROS layer, a plain one without.
if(WITH_ROS)
  install(TARGETS
    depth_object_tracker_core
    depth_object_tracker_nodelets
    depth_object_tracker_robot
    depth_object_tracker_ros
    depth_object_tracker_ros_simulator
    depth_object_tracker_simulator
    depth_object_tracker_tools
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
  if(WITH_RVIZ_PANEL)
    install(TARGETS depth_object_tracker_rviz LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
  endif()
  install(TARGETS demo_monitor initialisation_trials load_nodelet mesh_reader pixel_model_curves pose_marker scene_to_bag simulate_scene simulator_node track_bag track_sequence tracker_node
    RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  if(WITH_FIDUCIALS)
    install(TARGETS depth_object_tracker_fiducial_nodelets depth_object_tracker_fiducials depth_object_tracker_ros_fiducials
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
    install(TARGETS fiducial_tracker_node place_fiducials track_fiducials RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
  if(TARGET depth_object_tracker_camera)
    install(TARGETS depth_object_tracker_camera depth_object_tracker_camera_nodelets depth_object_tracker_ros_camera
      ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
      RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
    install(TARGETS openni2_camera_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
  catkin_install_python(PROGRAMS scripts/evaluate scripts/paper_experiments scripts/plot_benchmark scripts/play_bag scripts/relay_joint_commands scripts/slip_roc scripts/track_many
    DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  install(DIRECTORY scripts/evaluation scripts/experiments DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} FILES_MATCHING PATTERN *.py)
  if(TARGET track_icp)
    install(TARGETS track_icp track_pcl RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endif()
  install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
  install(DIRECTORY config launch meshes rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
else()
  #catkin_lint: skip
  include(GNUInstallDirs)
  if(WITH_ROBOT)
    install(TARGETS depth_object_tracker_robot LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
  install(TARGETS depth_object_tracker_core EXPORT depth_object_tracker_targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT depth_object_tracker_targets DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/${PROJECT_NAME})
  install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/cmake/depth_object_trackerConfig.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/${PROJECT_NAME})
  install(TARGETS
    depth_object_tracker_simulator
    depth_object_tracker_tools
    initialisation_trials
    pixel_model_curves
    simulate_scene
    track_sequence
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(WITH_FIDUCIALS)
    install(TARGETS depth_object_tracker_fiducials LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(TARGETS place_fiducials track_fiducials RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  install(TARGETS mesh_reader RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/${PROJECT_NAME})
  if(TARGET depth_object_tracker_camera)
    install(TARGETS depth_object_tracker_camera LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
  install(PROGRAMS scripts/evaluate scripts/paper_experiments scripts/plot_benchmark DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY scripts/evaluation scripts/experiments DESTINATION ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME} FILES_MATCHING PATTERN *.py)
  if(TARGET track_icp)
    install(TARGETS track_icp track_pcl RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
  install(DIRECTORY include/${PROJECT_NAME} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN ros EXCLUDE PATTERN rviz EXCLUDE)
  install(DIRECTORY config meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME})
endif()
