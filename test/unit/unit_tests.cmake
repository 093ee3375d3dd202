# unit tests
add_tracker_test(geometry_unit_tests SOURCES
  unit/depth_image_test.cpp
  unit/mesh_loader_test.cpp
  unit/pinhole_camera_test.cpp
  unit/pose_test.cpp
  unit/symmetry_test.cpp
  unit/triangle_mesh_test.cpp)
add_tracker_test(parameter_unit_tests SOURCES
  unit/object_model_test.cpp
  unit/tracker_parameters_test.cpp)

# The shipped meshes are what the script makes, byte for byte.
if(NOT PYTHON_EXECUTABLE)
  find_program(PYTHON_EXECUTABLE NAMES python3)
endif()
add_test(NAME shipped_meshes_are_reproducible COMMAND ${PYTHON_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/make_meshes --check)
