# oracle tests
add_tracker_test(model_oracle_tests SOURCES
  oracle/measured_image_test.cpp
  oracle/pixel_density_test.cpp)
add_tracker_test(likelihood_oracle_tests SOURCES
  oracle/hidden_edges_test.cpp
  oracle/likelihood_gradient_test.cpp
  oracle/occlusion_brute_force_test.cpp)
add_tracker_test(engine_oracle_tests SOURCES
  oracle/engine_test.cpp)
add_tracker_test(level_oracle_tests SOURCES
  oracle/level_likelihood_test.cpp)
target_compile_definitions(level_oracle_tests PRIVATE SHARED_DATA_FOLDER="${SHARED_DATA_FOLDER}")
add_tracker_test(renderer_oracle_tests SOURCES
  oracle/renderer_test.cpp)
add_tracker_test(filter_oracle_tests SOURCES
  oracle/informed_proposal_test.cpp
  oracle/kalman_test.cpp
  oracle/proposal_test.cpp)
