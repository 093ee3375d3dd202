# The nodelet under a stream of images with all that happens in a day; scripts/soak runs it for long.
if(NOT TARGET depth_object_tracker_ros OR NOT ROSTEST_PROGRAM)
  return()
endif()

add_executable(tracker_soak_rostest soak/soak_client.cpp soak/soak_scene.cpp soak/tracker_soak_rostest.cpp)
target_include_directories(tracker_soak_rostest PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/support)
target_compile_definitions(tracker_soak_rostest PRIVATE PROJECT_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
target_link_libraries(tracker_soak_rostest PRIVATE depth_object_tracker_ros depth_object_tracker_warnings GTest::gtest)
add_dependencies(tracker_soak_rostest depth_object_tracker_nodelets)
function(add_soak_test name)
  add_test(NAME ${name} COMMAND ${CATKIN_DEVEL_PREFIX}/env.sh rostest ${CMAKE_CURRENT_SOURCE_DIR}/soak/${name}.test)
  set_ros_test(${name} 600)
endfunction()

add_soak_test(tracker_soak_rostest)
