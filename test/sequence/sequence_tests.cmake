# sequence tests: the whole tracker on small simulated scenes, and on recorded ones where they are there
add_tracker_test(tracker_sequence_tests
  SOURCES
    sequence/covariance_test.cpp
    sequence/determinism_test.cpp
    sequence/fast_object_test.cpp
    sequence/free_turn_test.cpp
    sequence/input_test.cpp
    sequence/live_parameters_test.cpp
    sequence/look_alikes_test.cpp
    sequence/many_objects_test.cpp
    sequence/motion_test.cpp
    sequence/own_arm_test.cpp
    sequence/palm_test.cpp
    sequence/reacquisition_test.cpp
    sequence/score_test.cpp
    sequence/scripted_scene.cpp
    sequence/slip_test.cpp
  LIBRARIES depth_object_tracker_simulator depth_object_tracker_tools)

if(TARGET depth_object_tracker_robot)
  add_tracker_test(robot_occluder_test
    SOURCES sequence/occluder_trial.cpp sequence/robot_occluder_test.cpp
    LIBRARIES depth_object_tracker_simulator depth_object_tracker_robot)
  add_tracker_test(held_occlusion_test
    SOURCES sequence/held_occlusion_test.cpp sequence/scripted_scene.cpp
    LIBRARIES depth_object_tracker_simulator depth_object_tracker_robot depth_object_tracker_tools)
endif()

add_tracker_test(recorded_scenes_tests SOURCES sequence/recorded_scenes_test.cpp LIBRARIES depth_object_tracker_tools)
target_compile_definitions(recorded_scenes_tests PRIVATE SHARED_DATA_FOLDER="${SHARED_DATA_FOLDER}")
