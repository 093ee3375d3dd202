# Tests of the command-line tools; know no ROS.
add_library(small_scene STATIC tools/small_scene.cpp)
target_include_directories(small_scene PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/tools ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_link_libraries(small_scene
  PUBLIC depth_object_tracker_core
  PRIVATE depth_object_tracker_warnings nlohmann_json::nlohmann_json opencv_core opencv_imgcodecs)

add_tracker_test(tools_test
  SOURCES tools/bop_scene_test.cpp tools/evaluation_test.cpp
  LIBRARIES small_scene depth_object_tracker_tools GTest::gmock)
add_tracker_test(track_sequence_test
  SOURCES tools/track_sequence_test.cpp
  LIBRARIES small_scene nlohmann_json::nlohmann_json opencv_core opencv_imgcodecs GTest::gmock)
target_compile_definitions(track_sequence_test PRIVATE TRACK_SEQUENCE="$<TARGET_FILE:track_sequence>")
add_dependencies(track_sequence_test track_sequence)

add_test(NAME troubleshooting_quotes_messages
  COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/check_troubleshooting ${PROJECT_SOURCE_DIR})

add_test(NAME documentation_is_true
  COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/check_documentation ${PROJECT_SOURCE_DIR})

# The program of doc/core_api.md; check_install_tree builds it from the installed package, too.
function(add_example_test name)
  add_executable(${name} ${PROJECT_SOURCE_DIR}/doc/example/${name}.cpp)
  target_link_libraries(${name} PRIVATE depth_object_tracker_core)
  add_test(NAME example_${name} COMMAND ${name} ${ARGN})
endfunction()
add_example_test(follow_object ${PROJECT_SOURCE_DIR}/meshes/drill.obj)

if(TARGET scene_to_bag)
  add_tracker_test(scene_to_bag_test
    SOURCES tools/scene_to_bag_test.cpp
    LIBRARIES small_scene depth_object_tracker_ros opencv_core opencv_imgcodecs GTest::gmock)
  target_compile_definitions(scene_to_bag_test PRIVATE SCENE_TO_BAG="$<TARGET_FILE:scene_to_bag>")
  add_dependencies(scene_to_bag_test scene_to_bag)

  add_tracker_test(track_bag_test
    SOURCES tools/track_bag_test.cpp
    LIBRARIES small_scene depth_object_tracker_ros GTest::gmock)
  target_compile_definitions(track_bag_test PRIVATE SCENE_TO_BAG="$<TARGET_FILE:scene_to_bag>"
    SIMULATE_SCENE="$<TARGET_FILE:simulate_scene>" TRACK_BAG="$<TARGET_FILE:track_bag>"
    TRACK_SEQUENCE="$<TARGET_FILE:track_sequence>")
  add_dependencies(track_bag_test scene_to_bag simulate_scene track_bag track_sequence)

  add_test(NAME replay_launch_test
    COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh ${CMAKE_CURRENT_SOURCE_DIR}/tools/replay_simulated
      ${PROJECT_SOURCE_DIR}/meshes/drill.obj)
  set_tests_properties(replay_launch_test PROPERTIES RUN_SERIAL TRUE)
  set_ros_test(replay_launch_test 300)

  add_test(NAME replay_loop_rostest
    COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh ${CMAKE_CURRENT_SOURCE_DIR}/tools/replay_looped
      ${PROJECT_SOURCE_DIR}/meshes/drill.obj)
  set_tests_properties(replay_loop_rostest PROPERTIES RUN_SERIAL TRUE)
  set_ros_test(replay_loop_rostest 300)
endif()
