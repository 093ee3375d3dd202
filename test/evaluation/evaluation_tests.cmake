# Tests of the command evaluate, one per Python file. They want Debian's python3, which has numpy, scipy and matplotlib.
set(EVALUATION_PYTHON /usr/bin/python3 CACHE FILEPATH "Python that runs the tests of evaluate")
set(EVALUATION_TESTS
  aggregate bags bop_layout calibration command comparison episodes estimates experiments mesh_points motion_quality occlusion pose_errors poses report
  states statistics symmetries ycbineoat_layout)
set(EVALUATION_ENVIRONMENT
  "PYTHONPATH=${PROJECT_SOURCE_DIR}/scripts:${CMAKE_CURRENT_SOURCE_DIR}/evaluation"
  "TRACK_SEQUENCE=$<TARGET_FILE:track_sequence>"
  "SIMULATE_SCENE=$<TARGET_FILE:simulate_scene>"
  "WITH_FIDUCIALS=${WITH_FIDUCIALS}"
  "WITH_ROBOT=${WITH_ROBOT}")
if(TARGET track_icp)
  list(APPEND EVALUATION_TESTS peers)
  list(APPEND EVALUATION_ENVIRONMENT "TRACK_ICP=$<TARGET_FILE:track_icp>" "TRACK_PCL=$<TARGET_FILE:track_pcl>")
endif()

if(TARGET track_bag)
  list(APPEND EVALUATION_ENVIRONMENT "TRACK_BAG=$<TARGET_FILE:track_bag>")
endif()

foreach(name IN LISTS EVALUATION_TESTS)
  add_test(NAME evaluation_${name}
    COMMAND ${EVALUATION_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/${name}_test.py)
  set_tests_properties(evaluation_${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT_S} ENVIRONMENT "${EVALUATION_ENVIRONMENT}")
endforeach()
