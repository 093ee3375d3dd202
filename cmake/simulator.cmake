# depth_object_tracker_simulator: a simulated depth camera; knows no ROS. simulate_scene writes its images as scene folders.
add_library(depth_object_tracker_simulator SHARED
  src/simulator/arm.cpp
  src/simulator/crossing_scene.cpp
  src/simulator/depth_sensor.cpp
  src/simulator/grasp_chooser.cpp
  src/simulator/hand_and_arm.cpp
  src/simulator/hand_shapes.cpp
  src/simulator/hand_slips.cpp
  src/simulator/motion_clock.cpp
  src/simulator/object_motion.cpp
  src/simulator/passing_occluders.cpp
  src/simulator/random_source.cpp
  src/simulator/ray_cast.cpp
  src/simulator/robot_signals.cpp
  src/simulator/scene_simulator.cpp
  src/simulator/scene_writer.cpp
  src/simulator/simulation_config.cpp
  src/simulator/smooth_motion.cpp
  src/simulator/static_world.cpp
)
if(WITH_ROBOT)
  target_sources(depth_object_tracker_simulator PRIVATE
    src/simulator/finger_closer.cpp
    src/simulator/joint_trajectory.cpp
    src/simulator/robot_arm.cpp)
  target_compile_definitions(depth_object_tracker_simulator PRIVATE DEPTH_OBJECT_TRACKER_HAVE_ROBOT)
  target_link_libraries(depth_object_tracker_simulator PUBLIC depth_object_tracker_robot)
endif()
if(WITH_FIDUCIALS)
  target_sources(depth_object_tracker_simulator PRIVATE
    src/simulator/gray_camera.cpp
    src/simulator/stereo_pair.cpp
    src/simulator/tag_placement.cpp
    src/simulator/tag_texture.cpp)
  target_compile_definitions(depth_object_tracker_simulator PRIVATE DEPTH_OBJECT_TRACKER_HAVE_FIDUCIALS)
  target_link_libraries(depth_object_tracker_simulator PUBLIC depth_object_tracker_fiducials)

  add_executable(place_fiducials src/simulator/place_fiducials.cpp)
  target_link_libraries(place_fiducials PRIVATE depth_object_tracker_simulator depth_object_tracker_warnings CLI11::CLI11)
endif()
target_include_directories(depth_object_tracker_simulator PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/cmake/no_ros)
target_link_libraries(depth_object_tracker_simulator
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings opencv_core opencv_imgcodecs nlohmann_json::nlohmann_json)
precompile_headers(depth_object_tracker_simulator ${CORE_HEADERS})

add_executable(simulate_scene src/simulator/simulate_scene.cpp)
target_link_libraries(simulate_scene PRIVATE depth_object_tracker_simulator depth_object_tracker_warnings CLI11::CLI11)
