# unit tests
add_tracker_test(geometry_unit_tests SOURCES
  unit/depth_image_test.cpp
  unit/level_of_detail_test.cpp
  unit/mesh_loader_test.cpp
  unit/mesh_ply_header_test.cpp
  unit/pinhole_camera_test.cpp
  unit/pose_test.cpp
  unit/stable_poses_test.cpp
  unit/symmetry_test.cpp
  unit/triangle_mesh_test.cpp)
add_tracker_test(file_unit_tests SOURCES unit/file_access_test.cpp unit/isolated_mesh_loader_test.cpp)
target_include_directories(file_unit_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
add_dependencies(file_unit_tests mesh_reader)
add_tracker_test(input_check_unit_tests SOURCES unit/input_check_test.cpp)
add_tracker_test(image_points_unit_tests SOURCES
  unit/oriented_point_grid_test.cpp
  unit/oriented_points_test.cpp
  unit/plane_finder_test.cpp)
add_tracker_test(pair_votes_unit_tests SOURCES unit/image_draws_test.cpp unit/pair_votes_test.cpp)
target_include_directories(pair_votes_unit_tests PRIVATE ${PROJECT_SOURCE_DIR}/src)
add_tracker_test(parameter_unit_tests SOURCES
  unit/object_model_test.cpp
  unit/tracker_parameters_test.cpp)
add_tracker_test(estimate_board_unit_tests SOURCES unit/estimate_board_test.cpp)
add_tracker_test(filter_unit_tests SOURCES
  unit/filter_calibration_test.cpp
  unit/filter_occlusion_tiles_test.cpp
  unit/filter_pose_smoother_test.cpp
  unit/filter_pose_statistics_test.cpp
  unit/filter_random_test.cpp
  unit/filter_resampling_test.cpp
  unit/filter_worker_pool_test.cpp)
add_tracker_test(model_unit_tests SOURCES
  unit/angle_belief_test.cpp
  unit/distractors_test.cpp
  unit/doubt_test.cpp
  unit/grasp_memory_test.cpp
  unit/illusions_test.cpp
  unit/model_occlusion_chain_test.cpp
  unit/model_process_test.cpp
  unit/model_slip_test.cpp
  unit/pose_sampler_test.cpp
  unit/pose_search_test.cpp
  unit/search_region_test.cpp
  unit/frame_budget_test.cpp
  unit/tracker_time_and_status_test.cpp)

# The shipped meshes are what the script makes, byte for byte.
if(NOT PYTHON_EXECUTABLE)
  find_program(PYTHON_EXECUTABLE NAMES python3)
endif()
add_test(NAME shipped_meshes_are_reproducible COMMAND ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/make_meshes --check)
