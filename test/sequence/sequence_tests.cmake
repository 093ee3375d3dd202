# sequence tests: the whole tracker on small simulated scenes, and on recorded ones where they are there
add_tracker_test(tracker_sequence_tests
  SOURCES
    sequence/covariance_test.cpp
    sequence/determinism_test.cpp
    sequence/input_test.cpp
    sequence/motion_test.cpp
    sequence/scripted_scene.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)
