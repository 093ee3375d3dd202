# depth_object_tracker_tools and the command-line programs. Know no ROS.
add_library(depth_object_tracker_tools SHARED
  src/tools/bop_models_info.cpp
  src/tools/bop_scene.cpp
  src/tools/depth_picture.cpp
  src/tools/estimate_csv.cpp
  src/tools/json_file.cpp
  src/tools/nearest_point_index.cpp
  src/tools/occlusion_picture.cpp
  src/tools/pose_error.cpp
  src/tools/progress_bar.cpp
  src/tools/scene_pictures.cpp
  src/tools/sequence_inputs.cpp
  src/tools/sequence_run.cpp
  src/tools/sequence_summary.cpp
  src/tools/trace_writer.cpp
  src/tools/track_sequence_options.cpp
  src/tools/visibility_file.cpp
)
target_link_libraries(depth_object_tracker_tools
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings nlohmann_json::nlohmann_json CLI11::CLI11 opencv_core opencv_imgcodecs)
precompile_headers(depth_object_tracker_tools ${CORE_HEADERS})

add_executable(track_sequence src/tools/track_sequence.cpp)
target_link_libraries(track_sequence PRIVATE depth_object_tracker_tools depth_object_tracker_warnings)

add_executable(initialisation_trials
  src/tools/image_evidence.cpp
  src/tools/initialisation_trial.cpp
  src/tools/initialisation_trials.cpp
  src/tools/trial_scene.cpp
)
target_include_directories(initialisation_trials PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
target_link_libraries(initialisation_trials
  PRIVATE depth_object_tracker_tools depth_object_tracker_simulator depth_object_tracker_warnings CLI11::CLI11
    nlohmann_json::nlohmann_json)
add_executable(pixel_model_curves src/tools/pixel_model_curves.cpp)
target_link_libraries(pixel_model_curves PRIVATE depth_object_tracker_core depth_object_tracker_warnings CLI11::CLI11)

if(WITH_FIDUCIALS)
  add_executable(track_fiducials src/tools/stereo_scene.cpp src/tools/track_fiducials.cpp)
  target_link_libraries(track_fiducials PRIVATE depth_object_tracker_fiducials depth_object_tracker_tools
    depth_object_tracker_warnings nlohmann_json::nlohmann_json CLI11::CLI11 opencv_core opencv_imgcodecs)
endif()
